//! Particles of solids that move as prescribed.

use super::Solids;
use crate::schemes::transport_velocity::{Row, TransportVelocity};

impl<const D: usize> TransportVelocity<D> {
    /// Sets prescribed velocities of solids in rows of a state at a time in s.
    pub(in super::super) fn hold_velocities(&self, time: f64, rows: &mut [f64]) {
        for entry in self.solids.iter().flat_map(|solids| solids.held.iter()) {
            rows[entry.particle * Row::<D>::LENGTH + entry.component] =
                entry.value.value(entry.place, time);
        }
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
