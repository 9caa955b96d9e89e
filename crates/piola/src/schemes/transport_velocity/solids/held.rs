//! Particles of solids that move as prescribed.

use super::Solids;
use crate::Vector;
use crate::schemes::ledger::Total;
use crate::schemes::momentum::add_moments;
use crate::schemes::transport_velocity::TransportVelocity;

impl<const D: usize> TransportVelocity<D> {
    /// Sets prescribed velocities of solids in a state at a time in s. What that takes, of energy and of
    /// momentum, is from walls, so that the ledger is exact for velocities that change.
    pub(in super::super) fn hold_velocities(&self, time: f64, state: &mut [f64]) -> Total {
        let mut total = Total::default();
        let Some(Solids { held, .. }) = self.solids.as_deref() else { return total };
        let (own, _) = self.parts(state);
        for entry in held.iter() {
            let velocity = &mut own.velocity[entry.particle][entry.component];
            let (mass, old) = (self.mass[entry.particle], *velocity);
            let new = entry.value.value(entry.place, time);
            if new != old {
                *velocity = new;
                total.power += 0.5 * mass * (new - old) * (new + old);
                let mut momentum = Vector::zeros();
                momentum[entry.component] = mass * (new - old);
                add_moments(&own.position[entry.particle], &momentum, &mut total.force);
            }
        }
        total
    }

    /// Takes from the accelerations what prescribed velocities do not follow: the reaction, which
    /// is booked as that of walls. Such velocities are set, not integrated.
    pub(in super::super) fn hold_accelerations(&mut self) {
        let Some(Solids { held, .. }) = self.solids.as_deref() else { return };
        let places = self.support.list().places();
        for entry in held.iter() {
            let forces = &mut self.forces[places[entry.particle] as usize];
            let total = forces.total()[entry.component];
            forces.walls[entry.component] -= total;
        }
    }
}
