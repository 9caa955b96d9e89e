//! Particles of solids that move as prescribed.

use super::{Common, Hypoelastic};
use crate::Vector;
use crate::boundaries::prescribed::PrescribedComponents;
use crate::schemes::ledger::Total;
use crate::schemes::momentum::add_moments;

impl<const D: usize> Hypoelastic<D> {
    /// Sets prescribed velocities of solids in a state at a time in s. What that takes, of energy and of
    /// momentum, is from walls, so that the ledger is exact for velocities that change.
    pub(super) fn hold_velocities(
        &self,
        common: &Common<D>,
        time: f64,
        state: &mut [f64],
    ) -> Total {
        if self.held.is_empty() {
            return Total::default();
        }
        let (own, _) = common.parts(state);
        let row = |number: usize| Some((common.row(number)?, common.mass[number]));
        let totals = hold(&self.held, time, row, own.position, own.velocity);
        common.team().sum_in_order(totals)
    }

    /// Takes from the accelerations what prescribed velocities do not follow: the reaction, which
    /// is booked as that of walls. Such velocities are set, not integrated.
    pub(super) fn hold_accelerations(&self, common: &mut Common<D>) {
        let places = common.support.list().places();
        for entry in self.held.iter() {
            let Some(row) = common.row(entry.particle) else { continue };
            let forces = &mut common.forces[places[row] as usize];
            let total = forces.total()[entry.component];
            forces.walls[entry.component] -= total;
        }
    }
}

/// Sets prescribed velocities at a time in s, of rows of positions and velocities, and tells what each change takes. `row`
/// has the row of a particle and its mass in kg, if it is there.
pub(in super::super) fn hold<const D: usize>(
    held: &PrescribedComponents,
    time: f64,
    row: impl Fn(usize) -> Option<(usize, f64)>,
    position: &[Vector<D>],
    velocity: &mut [Vector<D>],
) -> impl Iterator<Item = Total> {
    held.iter().filter_map(move |entry| {
        let (row, mass) = row(entry.particle)?;
        let velocity = &mut velocity[row][entry.component];
        let (new, old) = (entry.at(time), *velocity);
        if new == old {
            return None;
        }
        *velocity = new;
        let mut total = Total::of(0.5 * mass * (new - old) * (new + old));
        let mut momentum = Vector::zeros();
        momentum[entry.component] = mass * (new - old);
        add_moments(&position[row], &momentum, &mut total.force);
        Some(total)
    })
}
