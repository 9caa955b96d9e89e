//! What acts on particles from outside: forces and prescribed motion, with the power and the momentum that
//! enter with them.

use super::ledger::Total;
use crate::Vector;
use crate::boundaries::prescribed::PrescribedComponents;
use crate::parallel::{ExactSums, add_sums};

/// A particle as what acts on it sees it.
pub(crate) struct Acted<const D: usize> {
    /// Mass in kg.
    pub mass: f64,
    pub position: Vector<D>,
    pub velocity: Vector<D>,
}

/// Adds a force in N on each of so many particles, in chunks of so many, to a total.
pub(crate) fn over_all<const D: usize>(
    rows: [usize; 2],
    particle: impl Fn(usize) -> Acted<D> + Sync,
    force: impl Fn(usize, f64) -> Vector<D> + Sync,
    exact: &mut ExactSums,
) {
    let add = |a: usize, total: &mut Total| {
        let Acted { mass, position, velocity } = particle(a);
        total.push(&position, &velocity, &force(a, mass));
    };
    add_sums(rows, add, exact);
}

/// Lets forces in N act on particles, and adds what each of them does to a total.
pub(crate) fn push<const D: usize>(
    forces: impl Iterator<Item = (usize, Vector<D>)>,
    particle: impl Fn(usize) -> Acted<D>,
    acceleration: &mut [Vector<D>],
    exact: &mut ExactSums,
) {
    for (a, force) in forces {
        let Acted { mass, position, velocity } = particle(a);
        acceleration[a] += force / mass;
        exact.add(&Total::by(&position, &velocity, &force));
    }
}

/// Replaces accelerations of prescribed components by the rates of their values; what that takes is a
/// force, which is added to a total.
pub(crate) fn prescribe<const D: usize>(
    prescribed: &PrescribedComponents,
    time: f64,
    particle: impl Fn(usize) -> Acted<D>,
    acceleration: &mut [Vector<D>],
    exact: &mut ExactSums,
) {
    for entry in prescribed.iter() {
        let Acted { mass, position, velocity } = particle(entry.particle);
        let own = &mut acceleration[entry.particle][entry.component];
        let wanted = entry.rate(time);
        let mut force = Vector::<D>::zeros();
        force[entry.component] = mass * (wanted - *own);
        *own = wanted;
        exact.add(&Total::by(&position, &velocity, &force));
    }
}
