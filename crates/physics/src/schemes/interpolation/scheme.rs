//! The study as integrators, clock and output see it: nothing in it depends on time.

use super::Interpolation;
use crate::fields::{FieldDescription, columns};
use crate::schemes::{
    Accounts, Capability, Health, Particle, Scheme, SchemeDescription, StepLimit,
};

/// What the study is called and what it shows.
pub const DESCRIPTION: SchemeDescription = SchemeDescription {
    name: "interpolation",
    matter: None,
    offers: &[Capability::Kicks],
    fields: Made::FIELDS,
    energies: &[],
    ledger: Accounts::NONE,
    figures: &[
        ("ghosts", "1"),
        ("smallest_ghost_value", "1"),
        ("largest_ghost_value", "1"),
        ("condition", "1"),
        ("boundary_error", "1"),
    ],
};

columns! {
    enum Made;
    constant position: Vector, "m", "position x";
    constant function: Scalar, "1", "the function f";
    constant approximation: Scalar, "1", "its interpolation, `<f> = W f`";
    constant error: Scalar, "1", "`<f> - f`";
    constant gradient: Vector, "1/m", "the sum `<grad f> = X f`";
    constant second_gradient: Tensor, "1/m2", "the gradient of that, row by row";
    constant neighbors: Scalar, "1", "number of particles and ghosts in the support";
    constant volume: Scalar, "m3", "quadrature volume V";
}

impl<const D: usize> Scheme for Interpolation<D> {
    fn description(&self) -> &'static SchemeDescription {
        &DESCRIPTION
    }

    fn dimension(&self) -> usize {
        D
    }

    fn particle_count(&self) -> usize {
        self.particles.len()
    }

    #[inline(never)]
    fn initial_state(&self) -> Vec<f64> {
        Vec::new()
    }

    #[inline(never)]
    fn rates(&mut self, _time: f64, _state: &[f64], _rate: &mut [f64]) {}

    fn has_rates(&self) -> bool {
        false
    }

    fn settable(&self, _index: usize) -> &'static [&'static str] {
        &[]
    }

    #[inline(never)]
    fn constrain(&self, _time: f64, _state: &mut [f64]) {}

    #[inline(never)]
    fn inspect(&mut self, _state: &[f64], limits: &mut Vec<StepLimit>) -> Health {
        limits.clear();
        Health { smallest_ratio: 1.0, ..Health::NEUTRAL }
    }

    #[inline(never)]
    fn figures(&self, _state: &[f64], figures: &mut Vec<f64>) {
        let outcome = &self.outcome;
        let [smallest, largest] = outcome.ghosts;
        figures.extend([outcome.count, smallest, largest, outcome.condition, outcome.error]);
    }

    #[inline(never)]
    fn energies(&self, _state: &[f64], _energies: &mut [f64]) {}

    #[inline(never)]
    fn momentum(&self, _state: &[f64], momentum: &mut [f64]) {
        momentum.fill(0.0);
    }

    #[inline(never)]
    fn derive(
        &self,
        _state: &[f64],
        field: &FieldDescription,
        particles: &[u32],
        values: &mut Vec<f64>,
    ) {
        let Some(made) = Made::of(field) else { return };
        for &particle in particles {
            let a = particle as usize;
            match made {
                Made::position => values.extend_from_slice(self.particles.position[a].as_slice()),
                Made::function => values.push(self.function[a]),
                Made::approximation => values.push(self.approximation[a]),
                Made::error => values.push(self.approximation[a] - self.function[a]),
                Made::gradient => values.extend_from_slice(self.gradient[a].as_slice()),
                Made::second_gradient => {
                    values.extend(self.second_gradient[a].transpose().iter());
                }
                Made::neighbors => values.push(self.value.row(a).count() as f64 - 1.0),
                Made::volume => values.push(self.particles.volume[a]),
            }
        }
    }

    fn bodies(&self) -> &[u32] {
        &self.particles.body
    }

    fn ids(&self) -> &[u32] {
        &self.particles.id
    }

    /// Nothing moves.
    fn mass(&self, _index: usize) -> f64 {
        0.0
    }

    fn particle(&self, index: usize) -> Particle {
        Particle::of(&self.particles, index)
    }

    #[inline(never)]
    fn neighborhood(&self, index: usize) -> Vec<u32> {
        let row = self.value.row(index).map(|(b, _)| b);
        row.filter(|&b| b as usize != index && (b as usize) < self.particles.len()).collect()
    }

    fn stability_advice(&self) -> &'static str {
        "nothing moves here"
    }

    fn collapse_advice(&self, _index: usize) -> String {
        "nothing moves here".to_owned()
    }

    #[inline(never)]
    fn memory(&self) -> usize {
        self.value.memory()
            + size_of_val(self.particles.position.as_slice())
            + 2 * size_of_val(self.function.as_slice())
            + size_of_val(self.gradient.as_slice())
            + size_of_val(self.second_gradient.as_slice())
    }
}
