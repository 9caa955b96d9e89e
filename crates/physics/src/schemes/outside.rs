//! What acts on particles from outside: forces and prescribed motion, with the power and the momentum that
//! enter with them.

use super::ledger::Total;
use crate::Vector;
use crate::boundaries::prescribed::PrescribedComponents;
use crate::parallel;

/// A particle as what acts on it sees it.
pub(crate) struct Acted<const D: usize> {
    /// Mass in kg.
    pub mass: f64,
    pub position: Vector<D>,
    pub velocity: Vector<D>,
}

/// The total of a force in N on each of `count` particles.
pub(crate) fn over_all<const D: usize>(
    count: usize,
    particle: impl Fn(usize) -> Acted<D> + Sync,
    force: impl Fn(usize, f64) -> Vector<D> + Sync,
) -> Total {
    parallel::sums(count, |a, total: &mut Total| {
        let Acted { mass, position, velocity } = particle(a);
        total.push(&position, &velocity, &force(a, mass));
    })
}

/// Lets forces in N act on particles.
pub(crate) fn push<const D: usize>(
    forces: impl Iterator<Item = (usize, Vector<D>)>,
    particle: impl Fn(usize) -> Acted<D>,
    acceleration: &mut [Vector<D>],
    total: &mut Total,
) {
    for (a, force) in forces {
        let Acted { mass, position, velocity } = particle(a);
        acceleration[a] += force / mass;
        total.push(&position, &velocity, &force);
    }
}

/// Replaces accelerations of prescribed components by the rates of their values; what that takes is a
/// force.
pub(crate) fn prescribe<const D: usize>(
    prescribed: &PrescribedComponents,
    time: f64,
    particle: impl Fn(usize) -> Acted<D>,
    acceleration: &mut [Vector<D>],
    total: &mut Total,
) {
    for entry in prescribed.iter() {
        let Acted { mass, position, velocity } = particle(entry.particle);
        let own = &mut acceleration[entry.particle][entry.component];
        let wanted = entry.value.rate(entry.place, time);
        let mut force = Vector::<D>::zeros();
        force[entry.component] = mass * (wanted - *own);
        *own = wanted;
        total.push(&position, &velocity, &force);
    }
}
