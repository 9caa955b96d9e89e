//! One look over a state: is it sound, and how large may the next step be.

use super::DualSupport;
use crate::schemes::look::{Deformed, look_at_solid};
use crate::schemes::solid::wave_moduli;
use crate::schemes::{Health, StepLimit};

impl<const D: usize> DualSupport<D> {
    /// The health of `state` and the bound on the step.
    ///
    /// `eigenvalue`: `2/omega` with the largest frequency of the whole discrete body at rest,
    /// hourglass term included, over the largest stiffening of a particle since, theory (50).
    pub(super) fn look(&mut self, state: &[f64], limits: &mut Vec<StepLimit>) -> Health {
        let at = self.columns(state);
        let columns = [at.velocity, at.displacement, at.kick];
        let mut gradients = std::mem::take(&mut self.strained.gradient);
        self.discrete.operator.gradients(at.displacement, &mut gradients);
        let (health, [stiffening, _], soft) = look_at_solid(columns, |a| {
            let gradient = gradients[a];
            let material = self.discrete.material(a);
            let at_rest = self.moduli_at_rest[self.discrete.particles.body[a] as usize];
            let moduli = match material.law.law().is_objective() {
                true => wave_moduli(&material.law, &gradient),
                false => at_rest,
            };
            Deformed { gradient, moduli, at_rest, density: material.density, thickening: 0.0 }
        });
        if let Some(a) = soft {
            self.not_convex = Some((a, gradients[a]));
        }
        self.strained.gradient = gradients;
        limits.clear();
        if self.is_static {
            // Nothing moves: rows hold another rate.
            return Health { largest_speed: 0.0, ..health };
        }
        let step = self.stable_step / stiffening.value.sqrt();
        limits.push(StepLimit::scaled("eigenvalue", step, self.stiffest));
        health
    }
}
