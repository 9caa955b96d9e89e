//! Depths at places that follow each other closely.

use rayon::prelude::*;

use super::facets::Local;
use super::{Facets, Shape};
use crate::Vector;

/// Depths in a shape at one place after another. On which side of a surface of facets a place is takes time to tell; from a
/// place nearby where that is known, what lies between is enough.
pub(crate) struct Probe<'a, const D: usize> {
    shape: &'a Shape<D>,
    known: Vec<Known<'a>>,
}

/// What is known of a surface.
struct Known<'a> {
    facets: &'a Facets,
    /// Its facets around all places that are asked for, if these are close together.
    local: Option<Local>,
    /// The last place, and how often the surface winds round it.
    last: Option<(Vector<3>, i32)>,
    /// No facet is nearer to the last place, in m, of those around it if only these are known.
    clear: f64,
}

impl<'a, const D: usize> Probe<'a, D> {
    /// Depths in a shape.
    pub fn of(shape: &'a Shape<D>) -> Self {
        Self { shape, known: Vec::new() }
    }

    /// Depths in a shape at places in the ball of radius `reach` m around a point, as far as only what is in the ball counts.
    pub fn around(shape: &'a Shape<D>, point: &Vector<D>, reach: f64) -> Self {
        let mut known: Vec<Known<'a>> = Vec::new();
        shape.depth_by(point, &mut |facets, place, _| {
            // A surface that is there twice may be in two places.
            if facets.soundness().is_closed() {
                let twice = known.iter().position(|other| std::ptr::eq(other.facets, facets));
                let local = twice.is_none().then(|| facets.around(place, reach));
                twice.map(|index| known.swap_remove(index));
                known.push(Known { facets, local, last: None, clear: 0.0 });
            }
            0.0
        });
        Self { shape, known }
    }

    /// As [`Shape::depth`] where that is no further from 0 than `reach`, and beyond that of the same sign and at least `reach`. In a ball
    /// around a point it is nearer to 0: as far from facets as their boxes are, and from those in the ball alone.
    pub fn depth(&mut self, point: &Vector<D>, reach: f64) -> f64 {
        let known = &mut self.known;
        self.shape.depth_by(point, &mut |facets, place, further| {
            let known = Known::of(known, facets);
            let clear = match &known.local {
                Some(local) if further == 0.0 => local.clear(place).min(reach),
                _ => facets.distance_up_to(place, reach + further),
            };
            if known.side(place, clear).is_inside { clear } else { -clear }
        })
    }

    /// Whether a place with finite coordinates lies in the shape or on its boundary.
    pub fn contains(&mut self, point: &Vector<D>) -> bool {
        let known = &mut self.known;
        let depth = self.shape.depth_by(point, &mut |facets, place, further| {
            let side = Known::of(known, facets).side(place, 0.0);
            // It may be on the surface if it is not known to be off it.
            let distance = match side.is_off {
                true if further == 0.0 => 1.0,
                true => facets.distance_up_to(place, 2.0 * further),
                false => facets.distance(place),
            };
            if side.is_inside { distance } else { -distance }
        });
        depth >= 0.0
    }
}

impl<const D: usize> Shape<D> {
    /// The first of `count` points that lies deeper in the shape than it may: `point(i)` is one, with its largest depth in
    /// m.
    pub fn first_deeper(
        &self,
        count: usize,
        point: impl Fn(usize) -> (Vector<D>, f64) + Sync,
    ) -> Option<usize> {
        let (min, max) = self.bounding_box();
        let is_deeper = |probe: &mut Probe<'_, D>, i: usize| {
            let (x, most) = point(i);
            let is_near = (0..D).all(|axis| min[axis] <= x[axis] && x[axis] <= max[axis]);
            (is_near && probe.depth(&x, 2.0 * most) > most).then_some(i)
        };
        let all = (0..count).into_par_iter().map_init(|| Probe::of(self), is_deeper);
        all.find_first(Option::is_some).flatten()
    }
}

/// On which side of a surface a place is.
struct Side {
    is_inside: bool,
    /// Whether it is known not to be on the surface itself.
    is_off: bool,
}

impl<'a> Known<'a> {
    /// What is known of a surface.
    fn of<'b>(all: &'b mut Vec<Self>, facets: &'a Facets) -> &'b mut Self {
        let index = all.iter().position(|other| std::ptr::eq(other.facets, facets));
        let index = index.unwrap_or_else(|| {
            all.push(Self { facets, local: None, last: None, clear: 0.0 });
            all.len() - 1
        });
        &mut all[index]
    }

    /// The side on which a place is that has no facet nearer than `clear` m, of those around it if only these are known, from that of the last place where the surface
    /// is closed. The place is then the last one.
    fn side(&mut self, place: &Vector<3>, clear: f64) -> Side {
        if !self.facets.soundness().is_closed() {
            return Side { is_inside: self.facets.winding(place) > 0.5, is_off: false };
        }
        let followed = self.last.as_ref().and_then(|(last, winding)| {
            let is_clear = (place - last).norm() < (1.0 - 1e-9) * (self.clear + clear);
            let change = match (&self.local, is_clear) {
                (_, true) => Some(0),
                (Some(local), _) => local.change(last, place),
                (None, _) => self.facets.change(last, place),
            };
            Some(winding + change?)
        });
        let winding = followed.unwrap_or_else(|| self.facets.winding(place).round() as i32);
        (self.last, self.clear) = (Some((*place, winding)), clear);
        Side { is_inside: winding > 0, is_off: followed.is_some() }
    }
}
