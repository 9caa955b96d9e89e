//! The columns of the formulation and its fields.

use super::material::{Measure, append_rows};
use super::{LEDGER, LOAD_FACTOR, Matrices, TotalLagrangian};
use crate::Tensor;
use crate::fields::columns;
use crate::schemes::ledger::Totals;

columns! {
    pub(super) struct Columns, ColumnsMut, enum Made;
    derived(0) position: Vector, "m", "current position x";
    evolved displacement: Vector, "m", "displacement u = x - X";
    evolved velocity: Vector, "m/s", "velocity v";
    kept kick: Vector, "m/s2", "acceleration for the next kick, zero where a velocity is prescribed";
    derived(2) acceleration: Vector, "m/s2", "rate of the velocity";
    derived(1) internal_force: Vector, "N", "force of stresses on the particle";
    derived(3) reaction: Vector, "N", "force that holds the particle where its motion is prescribed";
    derived(1) deformation_gradient: Tensor, "1", "deformation gradient F, row by row";
    derived(1) determinant: Scalar, "1", "determinant of F in the resolved dimensions";
    derived(1) stress: Tensor, "Pa", "first Piola-Kirchhoff stress P without viscosity, row by row";
    derived(1) cauchy_stress: Tensor, "Pa", "Cauchy stress, row by row";
    derived(1) principal_stress: Scalar, "Pa",
        "largest principal Cauchy stress in the resolved dimensions";
    derived(1) von_mises: Scalar, "Pa", "von Mises stress of all three dimensions";
    derived(1) strain_energy: Scalar, "J/m3", "strain energy per reference volume";
    derived(1) hourglass_energy: Scalar, "J/m3", "hourglass energy per reference volume";
    derived(1) convexity: Scalar, "1",
        "smallest modulus of a wave over that at rest: below zero the material is unstable";
    constant neighbors: Scalar, "1", "number of particles in the support";
    constant volume: Scalar, "m3", "reference quadrature volume V";
}

impl<const D: usize> TotalLagrangian<D> {
    /// The stages of observation: gradients with stresses and forces, then rates, then reactions.
    pub(super) fn make_fields(&mut self, stage: usize, time: f64, state: &[f64]) {
        let at = self.columns(state);
        // Loads are those of the load factor where that stands for the time.
        let factor = LEDGER.behind(D, at.tail)[LOAD_FACTOR];
        let time = if self.is_static { factor } else { time };
        match stage {
            1 => {
                // Without edges and viscosity all follows from displacements.
                let is_elastic = self.matrices.edges().is_none() && !self.dissipation.is_viscous();
                if !(is_elastic && self.is_evaluated_at(&at)) {
                    self.evaluate_forces(time, &at);
                }
            }
            2 => {
                let mut rate = std::mem::take(&mut self.rate);
                self.external_pass(time, &at, (&mut rate, &mut Totals::default()));
                self.rate = rate;
            }
            _ => self.reaction = self.reactions_to(time, state),
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
        let (solid, gradient) = (&*self.solid, &self.strained.gradient[a]);
        let (mixture, volume) = (solid.mixture(a), solid.particles.volume[a]);
        match field {
            Made::position => values.extend_from_slice(self.position(a, at).as_slice()),
            Made::acceleration => {
                values.extend_from_slice(self.columns(&self.rate).velocity[a].as_slice());
            }
            Made::internal_force => values.extend_from_slice(self.force[a].as_slice()),
            Made::reaction => values.extend_from_slice(self.reaction[a].as_slice()),
            Made::deformation_gradient => {
                mixture.append(Measure::DeformationGradient, gradient, values);
            }
            Made::determinant => mixture.append(Measure::Determinant, gradient, values),
            Made::stress => match self.stress.get(a) {
                Some(stress) => append_rows(stress, values),
                None => append_rows(&mixture.stress(gradient), values),
            },
            Made::cauchy_stress => mixture.append(Measure::CauchyStress, gradient, values),
            Made::principal_stress => {
                let mut cauchy = Vec::with_capacity(D * D);
                mixture.append(Measure::CauchyStress, gradient, &mut cauchy);
                let tensor =
                    Tensor::<D>::from_fn(|i, j| 0.5 * (cauchy[i * D + j] + cauchy[j * D + i]));
                values.push(piola_formulas::tensor::largest_eigenvalue(&tensor));
            }
            Made::von_mises => mixture.append(Measure::VonMises, gradient, values),
            Made::strain_energy => values.push(mixture.energy(gradient)),
            Made::hourglass_energy => values.push(self.hourglass_energy(a) / volume),
            Made::convexity => {
                let [least, _] = mixture.wave_moduli(gradient);
                let at_rest = solid.moduli_at_rest(a)[0];
                // What is rigid has no waves.
                values.push(if at_rest > 0.0 { least / at_rest } else { 1.0 });
            }
            Made::neighbors => values.push(self.matrices.neighbors(a) as f64),
            Made::volume => values.push(volume),
        }
    }

    /// Hourglass energy of particle a in J at the evaluated state.
    fn hourglass_energy(&self, a: usize) -> f64 {
        match &self.matrices {
            Matrices::Strong(_) => 0.0,
            Matrices::Adjoint(discrete) => {
                let gradient = &self.strained.gradient[a];
                discrete.operator.hourglass_energy(&self.displacement, gradient, a)
            }
        }
    }
}
