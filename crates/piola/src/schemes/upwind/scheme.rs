//! The upwind formulation as integrators, clock and output see it.

use piola_formulas::tensor;
use piola_formulas::volumetric::{VolumetricLaw, VolumetricResponse};

use super::local::deformation;
use super::{ENERGIES, FIGURES, IMPULSES, KEPT, MECHANISMS, Row, Upwind};
use crate::fields::{FieldDescription, columns};
use crate::parallel;
use crate::schemes::{
    Health, Particle, PartitionedScheme, Scheme, SchemeDescription, StepLimit, ThetaScheme,
};
use crate::solve::Costs;

columns! {
    enum Made;
    derived(0) position: Vector, "m", "current position x";
    derived(0) displacement: Vector, "m", "x - X";
    derived(0) velocity: Vector, "m/s", "velocity v";
    derived(1) acceleration: Vector, "m/s2", "rate of the velocity";
    derived(0) pressure: Scalar, "Pa", "pressure p(J), positive in compression";
    derived(0) volume_ratio: Scalar, "1", "volume ratio J as evolved";
    derived(0) determinant: Scalar, "1", "determinant of the deformation gradient";
    derived(0) deformation_gradient: Tensor, "1", "deformation gradient F, row by row";
    derived(0) density: Scalar, "kg/m3", "current density, from the evolved J";
    derived(0) wave_speed: Scalar, "m/s", "fastest wave, measured on the reference";
    constant smoothing_length: Scalar, "m", "smoothing length h";
    constant neighbors: Scalar, "1", "number of neighbours";
    constant volume: Scalar, "m3", "reference quadrature volume V";
}

/// What the formulation is called and what it shows.
pub const DESCRIPTION: SchemeDescription = SchemeDescription {
    name: "upwind",
    fields: Made::FIELDS,
    energies: &ENERGIES,
    mechanisms: &MECHANISMS,
    impulses: &IMPULSES,
    figures: &FIGURES,
};

impl<const D: usize> Scheme for Upwind<D> {
    fn description(&self) -> &'static SchemeDescription {
        &DESCRIPTION
    }

    fn dimension(&self) -> usize {
        D
    }

    fn particle_count(&self) -> usize {
        self.particles.len()
    }

    fn width(&self) -> usize {
        Row::<D>::LENGTH
    }

    fn initial_state(&self) -> Vec<f64> {
        let mut state = vec![0.0; self.particles.len() * Row::<D>::LENGTH + Self::tail_length()];
        let (length, position) = (Row::<D>::LENGTH, Row::<D>::POSITION);
        for (a, row) in state.chunks_exact_mut(length).take(self.particles.len()).enumerate() {
            row[..D].copy_from_slice(self.initial_velocity[a].as_slice());
            row[Row::<D>::VOLUME_RATIO] = 1.0;
            row[position..position + D].copy_from_slice(self.particles.position[a].as_slice());
            for i in 0..D {
                row[Row::<D>::DEFORMATION + i * D + i] = 1.0;
            }
        }
        state
    }

    fn rates(&mut self, time: f64, state: &[f64], rate: &mut [f64]) {
        self.rates_by_pass(time, state, rate, |_| {});
    }

    fn constrain(&self, time: f64, state: &mut [f64]) {
        for entry in self.prescribed.iter() {
            state[entry.particle * Row::<D>::LENGTH + entry.component] =
                entry.value.value(entry.place, time);
        }
    }

    fn inspect(&mut self, state: &[f64], limits: &mut Vec<StepLimit>) -> Health {
        self.look(state, limits)
    }

    fn figures(&self, state: &[f64], figures: &mut Vec<f64>) {
        figures.extend_from_slice(&state[state.len() - KEPT..]);
        figures.push(self.least_corner(state));
    }

    fn linear_costs(&self) -> Option<Costs> {
        self.implicit.as_ref().map(|parts| parts.costs())
    }

    fn energies(&self, state: &[f64], energies: &mut [f64]) {
        let row = |a: usize| &state[a * Row::<D>::LENGTH..][..Row::<D>::LENGTH];
        energies[0] = parallel::sum(self.particles.len(), |a| {
            0.5 * self.mass(a) * row(a)[..D].iter().map(|v| v * v).sum::<f64>()
        });
        energies[1] = parallel::sum(self.particles.len(), |a| {
            self.particles.volume[a] * self.law(a).energy(row(a)[Row::<D>::VOLUME_RATIO])
        });
    }

    fn momentum(&self, state: &[f64], momentum: &mut [f64]) {
        let all = self.momentum_of(state);
        momentum.copy_from_slice(&all[..momentum.len()]);
    }

    fn observe(&mut self, _stage: usize, time: f64, state: &[f64]) {
        let mut rate = std::mem::take(&mut self.observed);
        rate.resize(state.len(), 0.0);
        self.rates(time, state, &mut rate);
        self.observed = rate;
    }

    fn derive(
        &self,
        state: &[f64],
        field: &FieldDescription,
        particles: &[u32],
        values: &mut Vec<f64>,
    ) {
        let Some(made) = Made::of(field) else { return };
        for &particle in particles {
            let a = particle as usize;
            let row = &state[a * Row::<D>::LENGTH..][..Row::<D>::LENGTH];
            self.push_field(made, a, row, values);
        }
    }

    fn bodies(&self) -> &[u32] {
        &self.particles.body
    }

    fn ids(&self) -> &[u32] {
        &self.particles.id
    }

    fn particle(&self, index: usize) -> Particle {
        Particle {
            id: self.particles.id[index],
            reference: self.particles.position[index].iter().copied().collect(),
        }
    }

    fn neighborhood(&self, index: usize) -> Vec<u32> {
        self.support.list.row(index).to_vec()
    }

    fn stability_advice(&self) -> &'static str {
        "raise `scheme.tau_velocity`"
    }

    fn collapse_advice(&self, index: usize) -> String {
        match self.law(index).law {
            VolumetricLaw::Linear { .. } => "the linear law lets a volume vanish at finite \
                energy, Upwind (6.28): use the `gamma_law`, a lower speed or a stiffer material"
                .into(),
            VolumetricLaw::Gamma { .. } => "the gamma law resists collapse, so the step or the \
                stabilisation is at fault: lower `time.cfl`, or raise `scheme.tau_velocity`"
                .into(),
        }
    }

    fn memory(&self) -> usize {
        let (particles, support) = (&self.particles, &self.support);
        let inverse = self.least_squares.as_ref().map_or(0, |_| size_of::<crate::Tensor<D>>());
        size_of_val(particles.position.as_slice())
            + size_of_val(particles.volume.as_slice())
            + size_of_val(particles.weight.as_slice())
            + size_of_val(particles.spacing.as_slice())
            + size_of_val(particles.body.as_slice())
            + size_of_val(particles.id.as_slice())
            + size_of_val(support.smoothing_length.as_slice())
            + size_of_val(support.list.offsets())
            + size_of_val(support.list.indices())
            + size_of_val(support.reverse.as_slice())
            + size_of_val(self.reference.as_slice())
            + size_of_val(self.initial_velocity.as_slice())
            + size_of_val(self.nearest.as_slice())
            + size_of_val(self.body_acceleration.as_slice())
            + size_of_val(self.sides.as_slice())
            + size_of_val(self.slopes.as_slice())
            + inverse * particles.len()
            + self.areas.memory()
            + self.implicit.as_ref().map_or(0, |implicit| implicit.memory())
    }

    fn theta(&mut self) -> Option<&mut dyn ThetaScheme> {
        self.implicit.is_some().then_some(self as &mut dyn ThetaScheme)
    }

    fn partitioned(&mut self) -> Option<&mut dyn PartitionedScheme> {
        self.is_conservative().then_some(self as &mut dyn PartitionedScheme)
    }

    fn undamped_frequency(&mut self, state: &[f64]) -> Option<f64> {
        self.is_conservative().then(|| self.largest_frequency(state))
    }
}

impl<const D: usize> Upwind<D> {
    /// Appends the components of one field of one particle.
    fn push_field(&self, made: Made, a: usize, row: &[f64], values: &mut Vec<f64>) {
        let position = &row[Row::<D>::POSITION..Row::<D>::DEFORMATION];
        let ratio = row[Row::<D>::VOLUME_RATIO];
        match made {
            Made::position => values.extend_from_slice(position),
            Made::displacement => {
                let reference = self.particles.position[a].iter();
                values.extend(position.iter().zip(reference).map(|(x, reference)| x - reference));
            }
            Made::velocity => values.extend_from_slice(&row[..D]),
            Made::acceleration => {
                values.extend_from_slice(&self.observed[a * Row::<D>::LENGTH..][..D]);
            }
            Made::pressure => values.push(self.law(a).pressure(ratio)),
            Made::volume_ratio => values.push(ratio),
            Made::determinant => values.push(tensor::determinant(&deformation::<D>(row))),
            Made::deformation_gradient => {
                values.extend_from_slice(&row[Row::<D>::DEFORMATION..Row::<D>::LENGTH]);
            }
            Made::density => values.push(self.reference[a].density / ratio),
            Made::wave_speed => values.push(self.wave_speed(a, row)),
            Made::smoothing_length => values.push(self.support.smoothing_length[a]),
            Made::neighbors => values.push(self.support.list.row(a).len() as f64),
            Made::volume => values.push(self.particles.volume[a]),
        }
    }
}
