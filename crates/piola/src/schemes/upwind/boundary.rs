//! The pass over loaded particles and prescribed components.

use super::{BOUNDARY_MOTION, MECHANISMS, Row, TRACTION, Upwind};

impl<const D: usize> Upwind<D> {
    /// Adds tractions and replaces the acceleration of prescribed components by the rate of
    /// their value, with the power of both.
    pub(super) fn boundary_pass(&mut self, time: f64, rate: &mut [f64]) {
        let (rows, powers) = rate.split_at_mut(self.particles.len() * Row::<D>::LENGTH);
        debug_assert_eq!(powers.len(), MECHANISMS.len());
        for load in &self.loaded {
            let a = load.particle;
            let row = &mut rows[a * Row::<D>::LENGTH..][..D];
            for (component, value) in load.value.iter().enumerate() {
                let force = load.area * value.value(load.place, time);
                row[component] += force / self.mass(a);
                powers[TRACTION] += force * self.sides[a].velocity[component];
            }
        }
        for entry in self.prescribed.iter() {
            let acceleration = &mut rows[entry.particle * Row::<D>::LENGTH + entry.component];
            let wanted = entry.value.rate(entry.place, time);
            let reaction = self.mass(entry.particle) * (wanted - *acceleration);
            powers[BOUNDARY_MOTION] +=
                reaction * self.sides[entry.particle].velocity[entry.component];
            *acceleration = wanted;
        }
    }
}
