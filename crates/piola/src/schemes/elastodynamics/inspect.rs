//! One look over a state: is it sound, and how large may the next step be.

use super::Elastodynamics;
use crate::schemes::look::{Deformed, look};
use crate::schemes::solid::Row;
use crate::schemes::{Health, StepLimit};

impl<const D: usize> Elastodynamics<D> {
    /// The health of `state` and the bound on the step, theory (67): `eigenvalue`, from the largest
    /// frequency of the operator at rest, over the largest stiffening of a particle since.
    pub(super) fn look(&mut self, state: &[f64], limits: &mut Vec<StepLimit>) -> Health {
        self.load(state);
        let data = self.data_of(&self.displacement, state);
        let rows = &state[..self.mass.len() * Row::<D>::LENGTH];
        let figures = look(rows, |a| {
            let gradient = self.matrix.gradient_at(&self.displacement, &data, a);
            let kind = self.mixture[a] as usize;
            let mixture = &self.mixtures[kind];
            let moduli = mixture.wave_moduli(&gradient);
            let (at_rest, density) = (self.moduli_at_rest[kind], mixture.density());
            Deformed { gradient, moduli, at_rest, density }
        });
        self.not_convex = figures.not_convex().map(|a| {
            let gradient = self.matrix.gradient_at(&self.displacement, &data, a);
            (a, gradient)
        });
        limits.clear();
        limits.push(StepLimit {
            name: "eigenvalue",
            step: self.stable.step(figures.stiffening),
            particle: self.stable.particle,
            scaled: true,
        });
        figures.health
    }
}
