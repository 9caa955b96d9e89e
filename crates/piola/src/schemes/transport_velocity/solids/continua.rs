//! Which particles are of one continuum, and which only touch.

use super::WALL;
use crate::Vector;
use crate::neighbors::Domain;
use crate::operators::{LANES, Lanes, all_of};

/// To which continuum particles belong, by place.
#[derive(Clone, Debug)]
pub(in super::super) struct Continua<const D: usize> {
    /// Numbers of continua; [`WALL`] belongs to all of them. Empty for fluids, where all is one.
    pub labels: Vec<u32>,
    /// Where particles began, in m; empty unless bodies touch themselves.
    pub starts: Vec<Vector<D>>,
    /// How far apart particles of one continuum may have begun, in m.
    farthest: f64,
    domain: Domain<D>,
}

impl<const D: usize> Continua<D> {
    /// Of `count` particles of solids, or of 0 for fluids. With `farthest` in m bodies touch themselves.
    pub fn new(count: usize, farthest: Option<f64>, domain: Domain<D>) -> Self {
        let starts = if farthest.is_some() { count } else { 0 };
        Self {
            labels: vec![0; count],
            starts: vec![Vector::zeros(); starts],
            farthest: farthest.unwrap_or(f64::INFINITY),
            domain,
        }
    }

    /// Whether two particles (places) belong to the same continuum: always in fluids; of solids one
    /// body and walls, and of a body that touches itself what began close to each other, theory (75).
    #[inline]
    pub fn is_own(&self, place: usize, other: usize) -> bool {
        let Some(label) = self.labels.get(other) else { return true };
        if *label == WALL {
            return true;
        }
        *label == self.labels[place] && (self.starts.is_empty() || self.began_close(place, other))
    }

    /// 1 for each of a group of places that is of the continuum of the particle at `place`, 0 for others.
    #[inline(always)]
    pub fn own(&self, place: usize, places: &[u32; LANES]) -> Lanes {
        if !self.starts.is_empty() {
            return self.own_by_starts(place, places);
        }
        let (mine, labels) = (self.labels[place], all_of(&self.labels, places));
        let mut own = [0.0; LANES];
        for (own, label) in own.iter_mut().zip(labels) {
            *own = if *label == mine || *label == WALL { 1.0 } else { 0.0 };
        }
        own
    }

    #[inline(never)]
    fn own_by_starts(&self, place: usize, places: &[u32; LANES]) -> Lanes {
        places.map(|other| f64::from(u8::from(self.is_own(place, other as usize))))
    }

    fn began_close(&self, place: usize, other: usize) -> bool {
        let apart = self.domain.separation(&self.starts[place], &self.starts[other]);
        apart.norm_squared() <= self.farthest * self.farthest
    }
}
