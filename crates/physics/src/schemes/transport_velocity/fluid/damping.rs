//! Motion that dies out where it is, as on beaches that absorb waves, theory (92).

use std::sync::Arc;

use super::{Common, WeaklyCompressible};
use crate::boundaries::{SpaceTime, padded};
use crate::schemes::ledger::Total;
use crate::{Vector, parallel};

/// A rate at which the velocity of a fluid decays, as a function of place.
#[derive(Default)]
pub(super) struct Damping<const D: usize> {
    /// The rate in 1/s.
    rate: Option<Arc<dyn SpaceTime>>,
    /// What it does to the fluid in m/s^2, by place.
    accelerations: Vec<Vector<D>>,
}

impl<const D: usize> Damping<D> {
    /// That of a rate in 1/s, of this many particles.
    pub fn new(rate: Arc<dyn SpaceTime>, count: usize) -> Self {
        Self { rate: Some(rate), accelerations: vec![Vector::zeros(); count] }
    }

    /// The same for another number of particles.
    pub fn part(&self, count: usize) -> Self {
        self.rate.clone().map_or_else(Self::default, |rate| Self::new(rate, count))
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.rate.is_none()
    }

    /// The rate in 1/s at a place; no number where that is less than zero, so that the run ends.
    pub fn rate(&self, place: &Vector<D>) -> f64 {
        let rate = self.rate.as_ref().map_or(0.0, |rate| rate.value(padded(place), 0.0));
        if rate >= 0.0 { rate } else { f64::NAN }
    }
}

impl<const D: usize> WeaklyCompressible<D> {
    /// Adds the acceleration `-rate u` to the body forces.
    pub(super) fn damp(&mut self, common: &mut Common<D>) {
        let mut accelerations = std::mem::take(&mut self.damping.accelerations);
        let (damping, sides, list) = (&self.damping, &common.sides, common.support.list());
        let forces = &mut common.forces;
        parallel::for_each_pair_of_chunks(forces, &mut accelerations, |first, forces, rows| {
            for (place, (force, row)) in (first..).zip(forces.iter_mut().zip(rows)) {
                *row = match list.is_passive(place) {
                    true => Vector::zeros(),
                    false => sides[place].velocity * -damping.rate(&list.positions()[place]),
                };
                force.body_force += *row;
            }
        });
        self.damping.accelerations = accelerations;
    }

    /// The power of the damping and its force.
    pub(super) fn store_damping(&self, common: &Common<D>, state: &[f64]) -> Total {
        if self.damping.is_empty() {
            return Total::default();
        }
        let at = common.columns(state);
        let (places, first) = (common.support.list().places(), common.first());
        common.team().sums(places.len(), |row, sum: &mut Total| {
            let (number, place) = (first + row, places[row] as usize);
            let (damping, mass) = (self.damping.accelerations[place], common.mass[number]);
            if damping != Vector::<D>::zeros() && !common.is_wall[number] {
                sum.push(&at.position[row], &at.velocity[row], &(damping * mass));
                sum.growth += mass * damping.dot(&common.forces[place].total());
            }
        })
    }
}
