//! The elastodynamics formulation as integrators, clock and output see it.

use super::fields::{ColumnsMut, Made};
use super::{ENERGIES, Elastodynamics, LEDGER, Matrices};
use crate::fields::FieldDescription;
use crate::parallel;
use crate::schemes::look::convexity_is_lost;
use crate::schemes::momentum::of_particles;
use crate::schemes::{
    Capability, Health, Particle, Phase, Scheme, SchemeDescription, SplitScheme, StepLimit,
};

/// What the formulation is called and what it shows.
pub const DESCRIPTION: SchemeDescription = SchemeDescription {
    name: "elastodynamics",
    matter: None,
    offers: &[Capability::Kicks],
    fields: Made::FIELDS,
    energies: &ENERGIES,
    ledger: LEDGER,
    figures: &[],
};

impl<const D: usize> Scheme for Elastodynamics<D> {
    fn description(&self) -> &'static SchemeDescription {
        &DESCRIPTION
    }

    fn dimension(&self) -> usize {
        D
    }

    fn particle_count(&self) -> usize {
        self.mass.len()
    }

    fn initial_state(&self) -> Vec<f64> {
        self.initial.clone()
    }

    fn rates(&mut self, time: f64, state: &[f64], rate: &mut [f64]) {
        let totals = self.evaluate(time, state, rate);
        LEDGER.write(D, &totals, ColumnsMut::<D>::of(rate, self.mass.len()).1);
    }

    fn constrain(&self, time: f64, state: &mut [f64]) {
        let (own, _) = ColumnsMut::<D>::of(state, self.mass.len());
        self.prescribed.impose(time, own.velocity);
    }

    fn inspect(&mut self, state: &[f64], limits: &mut Vec<StepLimit>) -> Health {
        self.look(state, limits)
    }

    fn warning(&self) -> Option<String> {
        let (index, gradient) = self.not_convex.as_ref()?;
        let advice = "add `scheme.viscosity`, or use another law";
        Some(convexity_is_lost(&self.particle(*index), gradient, advice))
    }

    fn energies(&self, state: &[f64], energies: &mut [f64]) {
        let at = self.columns(state);
        let mut displacement = at.displacement.to_vec();
        displacement.resize(self.displacement.len(), crate::Vector::zeros());
        match &self.matrices {
            Matrices::Strong(_) => self.append_kept(&mut displacement, at.tail),
            Matrices::Adjoint(operator) => {
                operator.continue_field(&self.plane_data(at.displacement), &mut displacement);
            }
        }
        let sums = parallel::sums::<[f64; 3]>(self.mass.len(), |a, sums| {
            sums[0] += 0.5 * self.mass[a] * at.velocity[a].norm_squared();
            let gradient = self.matrices.gradient_at(&displacement, a);
            let mixture = &self.mixtures[self.mixture[a] as usize];
            sums[1] += mixture.energy(&gradient) * self.particles.volume[a];
            if let Matrices::Adjoint(operator) = &self.matrices {
                sums[2] += operator.hourglass_energy(&displacement, &gradient, a);
            }
        });
        energies.copy_from_slice(&sums);
    }

    fn momentum(&self, state: &[f64], momentum: &mut [f64]) {
        let (at, reference) = (self.columns(state), &self.particles.position);
        let of = |a: usize| [reference[a] + at.displacement[a], at.velocity[a] * self.mass[a]];
        of_particles(self.mass.len(), of, momentum);
    }

    fn observe(&mut self, stage: usize, time: f64, state: &[f64]) {
        self.make_fields(stage, time, state);
    }

    fn derive(
        &self,
        state: &[f64],
        field: &FieldDescription,
        particles: &[u32],
        values: &mut Vec<f64>,
    ) {
        let (Some(made), at) = (Made::of(field), self.columns(state)) else { return };
        particles.iter().for_each(|&a| self.push_field(made, &at, a as usize, values));
    }

    fn phases(&self) -> Vec<&Phase> {
        vec![self.stages.phase()]
    }

    fn bodies(&self) -> &[u32] {
        &self.particles.body
    }

    fn ids(&self) -> &[u32] {
        &self.particles.id
    }

    fn mass(&self, index: usize) -> f64 {
        self.mass[index]
    }

    fn particle(&self, index: usize) -> Particle {
        Particle::of(&self.particles, index)
    }

    fn neighborhood(&self, index: usize) -> Vec<u32> {
        self.matrices.neighborhood(index)
    }

    /// Accelerations are kept in the state, for kicks.
    fn has_rates(&self) -> bool {
        false
    }

    fn settable(&self) -> &'static [&'static str] {
        &["velocity", "displacement"]
    }

    fn split(&mut self) -> Option<&mut dyn SplitScheme> {
        Some(self)
    }

    fn stability_advice(&self) -> &'static str {
        match self.not_convex {
            Some(_) => {
                "the material had lost its convexity before, which smaller steps do not bring back: \
                 add `scheme.viscosity`, or use another law"
            }
            None => "raise `scheme.viscosity` or `scheme.hourglass`",
        }
    }

    fn collapse_advice(&self, index: usize) -> String {
        let mixture = &self.mixtures[self.mixture[index] as usize];
        let [least, _] = mixture.wave_moduli(&self.gradient[index]);
        match least < 0.0 || self.not_convex.is_some() {
            true => "the material has lost its convexity at this deformation, which no numerical \
                     method can follow without a length: add `scheme.viscosity`, or use another law"
                .to_owned(),
            false => "lower `time.cfl`, or raise `scheme.hourglass`; laws of small strains do not \
                      resist being turned inside out"
                .to_owned(),
        }
    }

    fn memory(&self) -> usize {
        self.matrices.memory()
            + self.particles.memory()
            + size_of_val(self.displacement.as_slice())
            + 2 * size_of_val(self.velocity.as_slice())
            + size_of_val(self.force.as_slice())
            + size_of_val(self.gradient.as_slice())
            + size_of_val(self.gradient_rate.as_slice())
            + size_of_val(self.stress.as_slice())
            + size_of_val(self.tension.as_slice())
            + size_of_val(self.rate.as_slice())
    }
}
