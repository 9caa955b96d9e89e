//! The columns of the formulation and its fields.

use super::DualSupport;
use crate::fields::columns;
use crate::schemes::Scheme;
use crate::schemes::solid::{Measure, append_measure};

columns! {
    pub(super) struct Columns, ColumnsMut, enum Made;
    derived(0) position: Vector, "m", "current position x";
    evolved displacement: Vector, "m", "displacement u = x - X";
    evolved velocity: Vector, "m/s", "velocity v";
    kept kick: Vector, "m/s2", "acceleration for the next kick, zero where a velocity is prescribed";
    derived(1) acceleration: Vector, "m/s2", "rate of the velocity";
    derived(1) internal_force: Vector, "N", "force of the strain energy on the particle";
    derived(2) reaction: Vector, "N", "what holds the particle where it is prescribed";
    derived(0) deformation_gradient: Tensor, "1", "deformation gradient F, row by row";
    derived(0) determinant: Scalar, "1", "determinant of F in the resolved dimensions";
    derived(0) stress: Tensor, "Pa", "first Piola-Kirchhoff stress P, row by row";
    derived(0) cauchy_stress: Tensor, "Pa", "Cauchy stress, row by row";
    derived(0) von_mises: Scalar, "Pa", "von Mises stress of all three dimensions";
    derived(0) strain_energy: Scalar, "J/m3", "strain energy per reference volume";
    derived(0) hourglass_energy: Scalar, "J/m3", "hourglass energy per reference volume";
    constant neighbors: Scalar, "1", "number of particles in the support";
    constant volume: Scalar, "m3", "reference quadrature volume V";
}

impl<const D: usize> DualSupport<D> {
    /// The stages of observation: rates, then reactions.
    pub(super) fn make_fields(&mut self, stage: usize, time: f64, state: &[f64]) {
        if stage == 1 {
            let mut rate = std::mem::take(&mut self.rate);
            self.rates(time, state, &mut rate);
            self.rate = rate;
        } else {
            self.reaction = self.reactions_to(time, state);
        }
    }

    /// Appends a field of one particle.
    pub(super) fn push_field(
        &self,
        field: Made,
        at: &Columns<'_, D>,
        a: usize,
        values: &mut Vec<f64>,
    ) {
        let (discrete, displacement) = (&self.discrete, at.displacement);
        let per_volume =
            |part: usize| discrete.energy_of(displacement, a)[part] / discrete.particles.volume[a];
        let mut measure = |measure| {
            let gradient = discrete.displacement_gradient(displacement, a);
            append_measure(&discrete.material(a).law, &gradient, measure, values);
        };
        match field {
            Made::position => values.extend_from_slice(self.position(a, at).as_slice()),
            Made::acceleration => {
                values.extend_from_slice(self.columns(&self.rate).velocity[a].as_slice());
            }
            Made::internal_force => values.extend_from_slice(self.force[a].as_slice()),
            Made::reaction => values.extend_from_slice(self.reaction[a].as_slice()),
            Made::deformation_gradient => measure(Measure::DeformationGradient),
            Made::determinant => measure(Measure::Determinant),
            Made::stress => measure(Measure::Stress),
            Made::cauchy_stress => measure(Measure::CauchyStress),
            Made::von_mises => measure(Measure::VonMises),
            Made::strain_energy => values.push(per_volume(0)),
            Made::hourglass_energy => values.push(per_volume(1)),
            Made::neighbors => values.push(discrete.operator.neighbors(a) as f64),
            Made::volume => values.push(discrete.particles.volume[a]),
        }
    }
}
