//! What acts on particles from outside: forces and prescribed motion, with the power and the momentum that
//! enter with them.

use super::ledger::Total;
use crate::Vector;
use crate::boundaries::prescribed::PrescribedComponents;
use crate::parallel::{ExactSums, Reduce as _, Team};

/// A particle as what acts on it sees it.
pub(crate) struct Acted<const D: usize> {
    /// Mass in kg.
    pub mass: f64,
    pub position: Vector<D>,
    pub velocity: Vector<D>,
}

/// What acts on some particles by each of K mechanisms, summed without rounding.
#[derive(Default)]
pub(crate) struct Acts<const K: usize>(ExactSums);

impl<const K: usize> Acts<K> {
    /// Adds what acts on a particle by one mechanism.
    pub fn add(&mut self, mechanism: usize, total: &Total) {
        let mut all = [Total::ZERO; K];
        all[mechanism] = *total;
        self.0.add(&all);
    }

    /// The totals by mechanism of all particles of a team.
    pub fn close(self, team: &Team) -> [Total; K] {
        team.close(self.0)
    }
}

/// The total of a force in N on each of `count` particles, and on those of other ranks.
pub(crate) fn over_all<const D: usize>(
    team: &Team,
    count: usize,
    particle: impl Fn(usize) -> Acted<D> + Sync,
    force: impl Fn(usize, f64) -> Vector<D> + Sync,
) -> Total {
    team.sums(count, |a, total: &mut Total| {
        let Acted { mass, position, velocity } = particle(a);
        total.push(&position, &velocity, &force(a, mass));
    })
}

/// Lets forces in N act on particles, and shows what each of them does.
pub(crate) fn push<const D: usize>(
    forces: impl Iterator<Item = (usize, Vector<D>)>,
    particle: impl Fn(usize) -> Acted<D>,
    acceleration: &mut [Vector<D>],
    mut see: impl FnMut(&Total),
) {
    for (a, force) in forces {
        let Acted { mass, position, velocity } = particle(a);
        acceleration[a] += force / mass;
        see(&Total::by(&position, &velocity, &force));
    }
}

/// Replaces accelerations of prescribed components by the rates of their values; what that takes is a
/// force, which is shown.
pub(crate) fn prescribe<const D: usize>(
    prescribed: &PrescribedComponents,
    time: f64,
    particle: impl Fn(usize) -> Acted<D>,
    acceleration: &mut [Vector<D>],
    mut see: impl FnMut(&Total),
) {
    for entry in prescribed.iter() {
        let Acted { mass, position, velocity } = particle(entry.particle);
        let own = &mut acceleration[entry.particle][entry.component];
        let wanted = entry.value.rate(entry.place, time);
        let mut force = Vector::<D>::zeros();
        force[entry.component] = mass * (wanted - *own);
        *own = wanted;
        see(&Total::by(&position, &velocity, &force));
    }
}
