//! One look over a state: is it sound, and how large may the next step be.

use super::fields::Columns;
use super::settings::is_linear;
use super::{Configuration, Elastodynamics};
use crate::schemes::look::{Deformed, look_at_solid};
use crate::schemes::{Health, StepLimit};
use crate::{Tensor, Vector};

impl<const D: usize> Elastodynamics<D> {
    /// The health of `state` and the bound on the step, theory (67), of the body as it is deformed:
    /// `eigenvalue`, from the largest frequency of the operator at rest times the largest stiffening
    /// of a particle since, or `dissipation`, where that of viscosity and damping is the larger part.
    pub(super) fn look(&mut self, state: &[f64], limits: &mut Vec<StepLimit>) -> Health {
        let at = self.columns(state);
        let known = self.is_evaluated_at(&at);
        self.load(&at);
        let gradient_of = |a: usize| match known {
            true => self.gradient[a],
            false => self.matrices.gradient_at(&self.displacement, a),
        };
        let columns = [at.velocity, at.displacement, at.kick];
        let velocity = self.velocity(&at);
        let (health, [stiffening, thickening], soft) = look_at_solid(columns, |a| {
            let gradient = gradient_of(a);
            let kind = self.mixture[a] as usize;
            let mixture = &self.mixtures[kind];
            let moduli = mixture.wave_moduli(&gradient);
            let (at_rest, density) = (self.moduli_at_rest[kind], mixture.density());
            let thickening = self.thickening_at(a, &gradient, velocity);
            Deformed { gradient, moduli, at_rest, density, thickening }
        });
        if let Some(a) = soft {
            let gradient = gradient_of(a);
            self.not_convex = Some((a, gradient));
        }
        self.is_evaluated = known;
        limits.clear();
        let is_linear = self.mixtures.iter().all(is_linear);
        limits.push(self.stable.limit(stiffening, thickening, is_linear));
        health
    }

    /// By how much viscosity has grown at a particle since rest.
    fn thickening_at(&self, a: usize, gradient: &Tensor<D>, velocity: &[Vector<D>]) -> f64 {
        if !self.settings.is_viscous() {
            return 0.0;
        }
        let is_quadratic = self.settings.artificial_viscosity[1] > 0.0;
        let rate = is_quadratic.then(|| self.matrices.gradient_at(velocity, a));
        self.thickening(gradient, rate.as_ref(), a)
    }

    /// Whether the gradients at hand are those of the displacements of `state`: after a step they
    /// are, because forces have been taken there.
    pub(super) fn is_evaluated_at(&self, at: &Columns<'_, D>) -> bool {
        self.is_evaluated
            && self.settings.configuration == Configuration::Total
            && self.displacement[..self.mass.len()] == *at.displacement
    }
}
