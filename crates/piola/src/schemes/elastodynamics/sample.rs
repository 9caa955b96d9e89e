//! The fields of the formulation.

use super::Elastodynamics;
use crate::fields::{FieldDescription, FieldKind};
use crate::schemes::solid::{Row, append_field, append_rows};

pub(super) const FIELDS: [FieldDescription; 14] = [
    FieldDescription::new("position", "m", FieldKind::Vector, "current position x"),
    FieldDescription::new("displacement", "m", FieldKind::Vector, "displacement u = x - X"),
    FieldDescription::new("velocity", "m/s", FieldKind::Vector, "velocity v"),
    FieldDescription::new("acceleration", "m/s2", FieldKind::Vector, "rate of the velocity"),
    FieldDescription::new(
        "deformation_gradient",
        "1",
        FieldKind::Tensor,
        "deformation gradient F, row by row",
    ),
    FieldDescription::new(
        "determinant",
        "1",
        FieldKind::Scalar,
        "determinant of F in the resolved dimensions",
    ),
    FieldDescription::new(
        "stress",
        "Pa",
        FieldKind::Tensor,
        "first Piola-Kirchhoff stress P without viscosity, row by row",
    ),
    FieldDescription::new("cauchy_stress", "Pa", FieldKind::Tensor, "Cauchy stress, row by row"),
    FieldDescription::new(
        "principal_stress",
        "Pa",
        FieldKind::Scalar,
        "largest principal Cauchy stress in the resolved dimensions",
    ),
    FieldDescription::new(
        "von_mises",
        "Pa",
        FieldKind::Scalar,
        "von Mises stress of all three dimensions",
    ),
    FieldDescription::new(
        "strain_energy",
        "J/m3",
        FieldKind::Scalar,
        "strain energy per reference volume",
    ),
    FieldDescription::new(
        "convexity",
        "1",
        FieldKind::Scalar,
        "smallest modulus of a wave over that at rest: below zero the material is unstable",
    ),
    FieldDescription::new(
        "neighbors",
        "1",
        FieldKind::Scalar,
        "number of particles in the support",
    ),
    FieldDescription::new("volume", "m3", FieldKind::Scalar, "reference quadrature volume V"),
];

impl<const D: usize> Elastodynamics<D> {
    /// Appends a field of some particles.
    pub(super) fn sample_field(
        &mut self,
        time: f64,
        state: &[f64],
        field: &str,
        particles: &[u32],
        values: &mut Vec<f64>,
    ) {
        let mut rate = Vec::new();
        match field {
            "acceleration" => {
                rate.resize(state.len(), 0.0);
                crate::schemes::Scheme::rates(self, time, state, &mut rate);
            }
            "position" | "displacement" | "velocity" | "neighbors" | "volume" => self.load(state),
            _ => {
                self.load(state);
                self.evaluate(time);
            }
        }
        for &particle in particles {
            let a = particle as usize;
            match field {
                "position" => values.extend_from_slice(self.position(a).as_slice()),
                "displacement" => values.extend_from_slice(self.displacement[a].as_slice()),
                "velocity" => values.extend_from_slice(self.velocity[a].as_slice()),
                "acceleration" => {
                    values.extend_from_slice(&rate[a * Row::<D>::LENGTH..][..D]);
                }
                "neighbors" => values.push(self.matrix.row(a).len().saturating_sub(1) as f64),
                "volume" => values.push(self.particles.volume[a]),
                _ => self.sample_material(field, a, values),
            }
        }
    }

    /// Appends a field that belongs to the deformation of one particle.
    fn sample_material(&self, field: &str, a: usize, values: &mut Vec<f64>) {
        let kind = self.mixture[a] as usize;
        let (mixture, gradient) = (&self.mixtures[kind], &self.gradient[a]);
        match field {
            "stress" => append_rows(&self.stress[a], values),
            "strain_energy" => values.push(mixture.energy(gradient)),
            "convexity" => {
                let [least, _] = mixture.wave_moduli(gradient);
                values.push(least / self.moduli_at_rest[kind][0]);
            }
            "principal_stress" => {
                let mut cauchy = Vec::with_capacity(D * D);
                self.append_mean("cauchy_stress", a, &mut cauchy);
                let tensor = crate::Tensor::<D>::from_fn(|i, j| {
                    0.5 * (cauchy[i * D + j] + cauchy[j * D + i])
                });
                values.push(piola_formulas::tensor::largest_eigenvalue(&tensor));
            }
            _ => self.append_mean(field, a, values),
        }
    }

    /// Appends the mean of a field over the materials of a particle.
    fn append_mean(&self, field: &str, a: usize, values: &mut Vec<f64>) {
        let mixture = &self.mixtures[self.mixture[a] as usize].0;
        let mut sum: Vec<f64> = Vec::new();
        for (material, share) in mixture {
            let mut own = Vec::with_capacity(D * D);
            append_field(&material.law, &self.gradient[a], field, &mut own);
            sum.resize(own.len(), 0.0);
            sum.iter_mut().zip(own).for_each(|(sum, own)| *sum += share * own);
        }
        values.append(&mut sum);
    }
}
