//! One look over a state: is it sound, and how large may the next step be.

use piola_formulas::hyperelastic::Reduced;
use piola_formulas::tensor;

use super::{DualSupport, Row};
use crate::Tensor;
use crate::parallel::CHUNK;
use crate::schemes::solid::wave_moduli;
use crate::schemes::{Health, StepLimit};

/// Figures of some particles.
#[derive(Clone, Copy)]
struct Figures {
    health: Health,
    /// Largest ratio of the wave speed to that at rest.
    stiffening: f64,
}

impl<const D: usize> DualSupport<D> {
    /// The health of `state` and the bound on the step.
    ///
    /// `eigenvalue`: `2/omega` with the largest frequency of the whole discrete body at rest,
    /// hourglass term included, over the largest stiffening of a particle since, theory (50).
    pub(super) fn look(&mut self, state: &[f64], limits: &mut Vec<StepLimit>) -> Health {
        self.load(state);
        let mut worst = Figures { health: Health::NEUTRAL, stiffening: 0.0 };
        for first in (0..self.mass.len()).step_by(CHUNK) {
            for a in first..(first + CHUNK).min(self.mass.len()) {
                let row = &state[a * Row::<D>::LENGTH..][..Row::<D>::LENGTH];
                if row.iter().any(|value| !value.is_finite()) {
                    worst.health.first_not_finite.get_or_insert(a);
                    continue;
                }
                let figures = self.look_at(a, row);
                worst.health = worst.health.worse(figures.health);
                worst.stiffening = worst.stiffening.max(figures.stiffening);
            }
        }
        limits.clear();
        if self.is_static {
            // Nothing moves: rows hold another rate.
            return Health { largest_speed: 0.0, ..worst.health };
        }
        limits.push(StepLimit {
            name: "eigenvalue",
            step: self.stable_step / worst.stiffening,
            particle: self.stiffest,
            scaled: true,
        });
        worst.health
    }

    fn look_at(&self, a: usize, row: &[f64]) -> Figures {
        let gradient = self.discrete.displacement_gradient(&self.displacement, a);
        let material = self.discrete.material(a);
        let law = &material.law;
        let at_rest = self.modulus_at_rest[self.discrete.particles.body[a] as usize];
        let modulus = match law.law().is_objective() {
            true => largest_wave_modulus(law, &gradient),
            false => at_rest,
        };
        Figures {
            health: Health {
                largest_speed: Row::<D>::velocity(row).norm(),
                largest_speed_particle: a,
                largest_wave_speed: (modulus.max(0.0) / material.density).sqrt(),
                smallest_ratio: tensor::determinant(&(gradient + Tensor::identity())),
                smallest_ratio_particle: a,
                ratio_mismatch: 0.0,
                first_not_finite: None,
                first_escaped: None,
            },
            stiffening: (modulus / at_rest).max(0.0).sqrt(),
        }
    }
}

/// Largest modulus of a wave in a principal direction of the deformation, Pa.
pub(super) fn largest_wave_modulus<const D: usize>(
    law: &Reduced<D>,
    displacement_gradient: &Tensor<D>,
) -> f64 {
    wave_moduli(law, displacement_gradient)[1]
}
