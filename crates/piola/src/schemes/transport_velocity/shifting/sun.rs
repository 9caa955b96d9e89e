//! SPST: a velocity deviation from the crowding of neighbours.

use crate::parallel;
use crate::schemes::transport_velocity::{Shifting, TransportVelocity};

impl<const D: usize> TransportVelocity<D> {
    /// Replaces the deviations of the sides by those of the current places,
    /// `d_a = -f Ma 2h c sum V_b (1 + R (W_ab / W(dx))^4) grad W_ab`, CTVF (35), where the Mach
    /// number is that of the largest speed now: `Ma c = max |u|`.
    pub(in super::super) fn shift(&mut self) {
        let Shifting::Sun { factor } = self.settings.shifting else { return };
        let speed = self.largest_speed();
        let scale = -factor * speed * 2.0 * self.support.smoothing_length();
        let (forces, list) = (&self.forces, self.support.list());
        parallel::for_each_chunk(&mut self.sides, |first, sides| {
            for (offset, side) in sides.iter_mut().enumerate() {
                if !list.is_passive(first + offset) {
                    side.deviation = forces[first + offset].crowding * scale;
                }
            }
        });
    }

    /// Largest speed of the fluid in m/s.
    pub(in super::super) fn largest_speed(&self) -> f64 {
        let list = self.support.list();
        let square =
            parallel::maximum(self.sides.len(), 0.0, |place| match list.is_passive(place) {
                true => 0.0,
                false => self.sides[place].velocity.norm_squared(),
            });
        square.sqrt()
    }

    /// The kernel at a distance of one spacing, in m^-D.
    pub(in super::super) fn value_at_spacing(&self, smoothing_length: f64) -> f64 {
        self.support.kernel().value(D, self.particles.spacing[0], smoothing_length)
    }
}
