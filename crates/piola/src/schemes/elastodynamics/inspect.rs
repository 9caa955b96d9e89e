//! One look over a state: is it sound, and how large may the next step be.

use piola_formulas::tensor;

use super::Elastodynamics;
use crate::Tensor;
use crate::parallel::CHUNK;
use crate::schemes::solid::Row;
use crate::schemes::{Health, StepLimit};

impl<const D: usize> Elastodynamics<D> {
    /// The health of `state` and the bound on the step, theory (67): `eigenvalue`, from the largest
    /// frequency of the operator at rest, over the largest stiffening of a particle since.
    pub(super) fn look(&mut self, state: &[f64], limits: &mut Vec<StepLimit>) -> Health {
        self.load(state);
        let data = self.data_of(&self.displacement, state);
        let (mut worst, mut stiffening) = (Health::NEUTRAL, 0.0_f64);
        for first in (0..self.mass.len()).step_by(CHUNK) {
            for a in first..(first + CHUNK).min(self.mass.len()) {
                let row = &state[a * Row::<D>::LENGTH..][..Row::<D>::LENGTH];
                if row.iter().any(|value| !value.is_finite()) {
                    worst.first_not_finite.get_or_insert(a);
                    continue;
                }
                let gradient = self.matrix.gradient_at(&self.displacement, &data, a);
                let kind = self.mixture[a] as usize;
                let mixture = &self.mixtures[kind];
                let [_, modulus] = mixture.wave_moduli(&gradient);
                stiffening = stiffening.max((modulus / self.modulus_at_rest[kind]).max(0.0));
                worst = worst.worse(Health {
                    largest_speed: Row::<D>::velocity(row).norm(),
                    largest_speed_particle: a,
                    largest_wave_speed: (modulus.max(0.0) / mixture.density()).sqrt(),
                    smallest_ratio: tensor::determinant(&(gradient + Tensor::identity())),
                    smallest_ratio_particle: a,
                    ..Health::NEUTRAL
                });
            }
        }
        limits.clear();
        limits.push(StepLimit {
            name: "eigenvalue",
            step: self.stable.step(stiffening),
            particle: self.stable.particle,
            scaled: true,
        });
        worst
    }
}
