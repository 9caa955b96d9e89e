//! The columns of the formulation and its fields.

use super::Elastodynamics;
use super::stages::Pass;
use crate::fields::columns;
use crate::schemes::ledger::Totals;
use crate::schemes::solid::{Measure, append_measure, append_rows};

columns! {
    pub(super) struct Columns, ColumnsMut, enum Made;
    derived(0) position: Vector, "m", "current position x";
    evolved displacement: Vector, "m", "displacement u = x - X";
    evolved velocity: Vector, "m/s", "velocity v";
    kept kick: Vector, "m/s2", "acceleration for the next kick, zero where a velocity is prescribed";
    derived(2) acceleration: Vector, "m/s2", "rate of the velocity";
    derived(1) deformation_gradient: Tensor, "1", "deformation gradient F, row by row";
    derived(1) determinant: Scalar, "1", "determinant of F in the resolved dimensions";
    derived(1) stress: Tensor, "Pa", "first Piola-Kirchhoff stress P without viscosity, row by row";
    derived(1) cauchy_stress: Tensor, "Pa", "Cauchy stress, row by row";
    derived(1) principal_stress: Scalar, "Pa",
        "largest principal Cauchy stress in the resolved dimensions";
    derived(1) von_mises: Scalar, "Pa", "von Mises stress of all three dimensions";
    derived(1) strain_energy: Scalar, "J/m3", "strain energy per reference volume";
    derived(1) convexity: Scalar, "1",
        "smallest modulus of a wave over that at rest: below zero the material is unstable";
    constant neighbors: Scalar, "1", "number of particles in the support";
    constant volume: Scalar, "m3", "reference quadrature volume V";
}

impl<const D: usize> Elastodynamics<D> {
    /// The stages of observation: gradients with stresses and forces, then rates.
    pub(super) fn make_fields(&mut self, stage: usize, time: f64, state: &[f64]) {
        let at = self.columns(state);
        if stage == 1 {
            // Without edges and dissipation all follows from displacements.
            let is_elastic = self.matrices.edges().is_none() && !self.settings.is_viscous();
            if !(is_elastic && self.is_evaluated_at(&at)) {
                for pass in Pass::INTERNAL {
                    self.run(pass, time, &at, (&mut [], &mut Totals::default()));
                }
            }
        } else {
            let mut rate = std::mem::take(&mut self.rate);
            self.external_pass(time, &at, (&mut rate, &mut Totals::default()));
            self.rate = rate;
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
        let kind = self.mixture[a] as usize;
        let (mixture, gradient) = (&self.mixtures[kind], &self.gradient[a]);
        let mut mean = |measure| self.append_mean(measure, a, values);
        match field {
            Made::position => {
                values.extend_from_slice(
                    (self.particles.position[a] + at.displacement[a]).as_slice(),
                );
            }
            Made::acceleration => {
                values.extend_from_slice(self.columns(&self.rate).velocity[a].as_slice());
            }
            Made::deformation_gradient => mean(Measure::DeformationGradient),
            Made::determinant => mean(Measure::Determinant),
            Made::stress => append_rows(&self.stress[a], values),
            Made::cauchy_stress => mean(Measure::CauchyStress),
            Made::principal_stress => {
                let mut cauchy = Vec::with_capacity(D * D);
                self.append_mean(Measure::CauchyStress, a, &mut cauchy);
                let tensor = crate::Tensor::<D>::from_fn(|i, j| {
                    0.5 * (cauchy[i * D + j] + cauchy[j * D + i])
                });
                values.push(piola_formulas::tensor::largest_eigenvalue(&tensor));
            }
            Made::von_mises => mean(Measure::VonMises),
            Made::strain_energy => values.push(mixture.energy(gradient)),
            Made::convexity => {
                let [least, _] = mixture.wave_moduli(gradient);
                values.push(least / self.moduli_at_rest[kind][0]);
            }
            Made::neighbors => values.push(self.matrices.neighbors(a) as f64),
            Made::volume => values.push(self.particles.volume[a]),
        }
    }

    /// Appends the mean of a measure over the materials of a particle.
    fn append_mean(&self, measure: Measure, a: usize, values: &mut Vec<f64>) {
        let mixture = &self.mixtures[self.mixture[a] as usize].0;
        let mut sum: Vec<f64> = Vec::new();
        for (material, share) in mixture {
            let mut own = Vec::with_capacity(D * D);
            append_measure(&material.law, &self.gradient[a], measure, &mut own);
            sum.resize(own.len(), 0.0);
            sum.iter_mut().zip(own).for_each(|(sum, own)| *sum += share * own);
        }
        values.append(&mut sum);
    }
}
