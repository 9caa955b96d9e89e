//! The facets around a place, for what is asked many times close to it.

use super::Triangle;
use super::triangle::{ends, passage};
use crate::Vector;

/// Those facets that may be less than a distance away from a place.
#[derive(Clone, Debug, Default)]
pub(in super::super) struct Local(Vec<Near>);

#[derive(Clone, Debug)]
struct Near {
    low: Vector<3>,
    high: Vector<3>,
    triangle: Triangle,
}

impl Local {
    /// Adds one.
    pub(super) fn push(&mut self, triangle: &Triangle) {
        let [low, high] = ends(triangle);
        self.0.push(Near { low, high, triangle: *triangle });
    }

    /// None of these facets is nearer to a point than this, in m; infinite without facets.
    pub(in super::super) fn clear(&self, point: &Vector<3>) -> f64 {
        let square = |near: &Near| {
            let beyond = (near.low - point).sup(&(point - near.high));
            beyond.map(|x| x.max(0.0)).norm_squared()
        };
        self.0.iter().map(square).fold(f64::INFINITY, f64::min).sqrt()
    }

    /// As [`super::Facets::change`], if all facets that are in the way are among these.
    pub(in super::super) fn change(&self, from: &Vector<3>, to: &Vector<3>) -> Option<i32> {
        let (low, high) = (from.inf(to), from.sup(to));
        let mut change = 0;
        for near in &self.0 {
            if (0..3).all(|axis| near.low[axis] <= high[axis] && near.high[axis] >= low[axis]) {
                change += passage(&near.triangle, from, to)?;
            }
        }
        Some(change)
    }
}
