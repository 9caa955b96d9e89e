//! Particles of solids that move as prescribed.

use super::{Common, Hypoelastic};
use crate::Vector;
use crate::boundaries::prescribed::Entry;
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
        let hold = |entry: &Entry| {
            let row = common.row(entry.particle)?;
            let velocity = &mut own.velocity[row][entry.component];
            let (mass, old) = (common.mass[entry.particle], *velocity);
            let new = entry.at(time);
            if new == old {
                return None;
            }
            *velocity = new;
            let mut total = Total::of(0.5 * mass * (new - old) * (new + old));
            let mut momentum = Vector::zeros();
            momentum[entry.component] = mass * (new - old);
            add_moments(&own.position[row], &momentum, &mut total.force);
            Some(total)
        };
        common.team().sum_in_order(self.held.iter().filter_map(hold))
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
