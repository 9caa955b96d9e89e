//! What acts on the body from outside: tractions and prescribed motion, with the work and the
//! momentum that enter with them.

use super::fields::ColumnsMut;
use super::{BOUNDARY_MOTION, IMPULSES, KEPT, MECHANISMS, TRACTION, Upwind};
use crate::Vector;
use crate::parallel;
use crate::schemes::momentum::{MOST_COMPONENTS, add_moments, momentum_components};

impl<const D: usize> Upwind<D> {
    /// Numbers at the end of a state: the work of each mechanism, then the impulse of each way
    /// in which momentum enters, component by component, then the figures of implicit steps.
    pub(super) fn tail_length() -> usize {
        MECHANISMS.len() + IMPULSES.len() * momentum_components(D).len() + KEPT
    }

    /// Adds tractions and replaces the acceleration of prescribed components by the rate of
    /// their value, with the power and the momentum of both.
    pub(super) fn boundary_pass(&mut self, time: f64, rate: &mut [f64]) {
        let (own, tail) = ColumnsMut::<D>::of(rate, self.particles.len());
        debug_assert_eq!(tail.len(), Self::tail_length());
        let (powers, impulses) = tail.split_at_mut(MECHANISMS.len());
        let components = momentum_components(D).len();
        // The first are those of body forces, which the pair pass has added up.
        let (traction, boundary) = impulses[components..].split_at_mut(components);
        for load in &self.loaded {
            let (a, force) = (load.particle, load.force(time));
            for (component, force) in force.iter().enumerate() {
                own.velocity[a][component] += force / self.mass(a);
                powers[TRACTION] += force * self.sides[a].velocity[component];
            }
            add_moments(&self.sides[a].position, &force, traction);
        }
        for entry in self.prescribed.iter() {
            let (a, component) = (entry.particle, entry.component);
            let acceleration = &mut own.velocity[a][component];
            let wanted = entry.value.rate(entry.place, time);
            let reaction = self.mass(a) * (wanted - *acceleration);
            powers[BOUNDARY_MOTION] += reaction * self.sides[a].velocity[component];
            *acceleration = wanted;
            let mut force = Vector::zeros();
            force[component] = reaction;
            add_moments(&self.sides[a].position, &force, boundary);
        }
    }

    /// Momentum of all particles together.
    pub(super) fn momentum_of(&self, state: &[f64]) -> [f64; MOST_COMPONENTS] {
        let at = self.columns(state);
        parallel::sums(self.particles.len(), |a, sum| {
            add_moments(&at.position[a], &(at.velocity[a] * self.mass(a)), sum);
        })
    }
}
