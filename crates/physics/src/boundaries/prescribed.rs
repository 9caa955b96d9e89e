//! Velocity components with prescribed values (Dirichlet conditions).

use std::sync::Arc;

use super::function::{SpaceTime, padded};
use crate::Vector;

/// One velocity component of a set of particles, prescribed as a function of place and time.
///
/// Position follows by integration: with the rate of the value as acceleration and the value
/// itself set after each stage, a second-order integrator moves the particle by the trapezoidal
/// sum of the prescribed velocity.
#[derive(Clone)]
pub struct PrescribedVelocity {
    /// Name for messages.
    pub name: String,
    /// Particles by index in memory.
    pub particles: Vec<u32>,
    /// 0, 1 or 2 for x, y or z.
    pub component: usize,
    /// The velocity in m/s.
    pub value: Arc<dyn SpaceTime>,
}

/// The prescribed components of a whole run, particle by particle.
#[derive(Clone, Default)]
pub(crate) struct PrescribedComponents {
    entries: Vec<Entry>,
}

#[derive(Clone)]
pub(crate) struct Entry {
    pub particle: usize,
    pub component: usize,
    place: [f64; 3],
    value: Arc<dyn SpaceTime>,
    /// Value and rate, if they are the same at all times.
    steady: Option<[f64; 2]>,
}

impl Entry {
    fn new(particle: usize, component: usize, place: [f64; 3], value: Arc<dyn SpaceTime>) -> Self {
        let steady = value.is_steady().then(|| [value.value(place, 0.0), value.rate(place, 0.0)]);
        Self { particle, component, place, value, steady }
    }

    /// The velocity in m/s at a time in s.
    pub fn at(&self, time: f64) -> f64 {
        self.steady.map_or_else(|| self.value.value(self.place, time), |[value, _]| value)
    }

    /// Its rate in m/s^2.
    pub fn rate(&self, time: f64) -> f64 {
        self.steady.map_or_else(|| self.value.rate(self.place, time), |[_, rate]| rate)
    }

    /// Whether it is the same at all times.
    pub fn is_steady(&self) -> bool {
        self.steady.is_some()
    }
}

impl PrescribedComponents {
    /// Lists all prescribed components by particle. Where two conditions name the same component
    /// of a particle the later one holds.
    pub fn new<const D: usize>(conditions: &[PrescribedVelocity], positions: &[Vector<D>]) -> Self {
        let mut entries: Vec<Entry> = Vec::new();
        for condition in conditions {
            entries.extend(condition.particles.iter().map(|&particle| {
                let place = padded(&positions[particle as usize]);
                Entry::new(particle as usize, condition.component, place, condition.value.clone())
            }));
        }
        // A stable sort keeps the order of the conditions within one component.
        entries.sort_by_key(|entry| (entry.particle, entry.component));
        entries.reverse();
        entries.dedup_by_key(|entry| (entry.particle, entry.component));
        entries.reverse();
        Self { entries }
    }

    /// Those of some particles, of which `place` says where they stand now, in the same order.
    pub fn part(&self, place: impl Fn(usize) -> Option<usize>) -> Self {
        let moved =
            |entry: &Entry| Some(Entry { particle: place(entry.particle)?, ..entry.clone() });
        Self { entries: self.entries.iter().filter_map(moved).collect() }
    }

    /// Gives velocities the prescribed values of a time.
    pub fn impose<const D: usize>(&self, time: f64, velocity: &mut [Vector<D>]) {
        for entry in &self.entries {
            velocity[entry.particle][entry.component] = entry.at(time);
        }
    }

    /// Those of one particle.
    pub fn of(&self, particle: usize) -> &[Entry] {
        let first = self.entries.partition_point(|entry| entry.particle < particle);
        let own = &self.entries[first..];
        &own[..own.partition_point(|entry| entry.particle == particle)]
    }

    /// Whether nothing is prescribed.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    pub fn iter(&self) -> impl Iterator<Item = &Entry> {
        self.entries.iter()
    }
}
