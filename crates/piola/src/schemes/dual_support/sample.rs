//! The fields of the formulation.

use super::{DualSupport, Row};
use crate::fields::{FieldDescription, FieldKind};
use crate::schemes::Scheme;
use crate::schemes::solid::append_field;

pub(super) const FIELDS: [FieldDescription; 15] = [
    FieldDescription::new("position", "m", FieldKind::Vector, "current position x"),
    FieldDescription::new("displacement", "m", FieldKind::Vector, "displacement u = x - X"),
    FieldDescription::new("velocity", "m/s", FieldKind::Vector, "velocity v"),
    FieldDescription::new("acceleration", "m/s2", FieldKind::Vector, "rate of the velocity"),
    FieldDescription::new(
        "internal_force",
        "N",
        FieldKind::Vector,
        "force of the strain energy on the particle",
    ),
    FieldDescription::new(
        "reaction",
        "N",
        FieldKind::Vector,
        "what holds the particle where it is prescribed",
    ),
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
        "first Piola-Kirchhoff stress P, row by row",
    ),
    FieldDescription::new("cauchy_stress", "Pa", FieldKind::Tensor, "Cauchy stress, row by row"),
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
        "hourglass_energy",
        "J/m3",
        FieldKind::Scalar,
        "hourglass energy per reference volume",
    ),
    FieldDescription::new(
        "neighbors",
        "1",
        FieldKind::Scalar,
        "number of particles in the support",
    ),
    FieldDescription::new("volume", "m3", FieldKind::Scalar, "reference quadrature volume V"),
];

impl<const D: usize> DualSupport<D> {
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
        let mut reactions = Vec::new();
        match field {
            "reaction" => reactions = self.reactions(time, state),
            "acceleration" | "internal_force" => {
                rate.resize(state.len(), 0.0);
                self.rates(time, state, &mut rate);
            }
            _ => self.load(state),
        }
        for &particle in particles {
            let a = particle as usize;
            let start = a * Row::<D>::LENGTH;
            let row = &state[start..][..Row::<D>::LENGTH];
            match field {
                "position" => values.extend_from_slice(self.position(a, row).as_slice()),
                "displacement" => {
                    values.extend_from_slice(&row[Row::<D>::DISPLACEMENT..][..D]);
                }
                "velocity" => values.extend_from_slice(&row[..D]),
                "acceleration" => values.extend_from_slice(&rate[start..][..D]),
                "internal_force" => values.extend_from_slice(self.force[a].as_slice()),
                "reaction" => values.extend_from_slice(reactions[a].as_slice()),
                "neighbors" => values.push(self.discrete.support.list.row(a).len() as f64),
                "volume" => values.push(self.discrete.particles.volume[a]),
                _ => self.sample_material(field, a, values),
            }
        }
    }

    /// Appends a field that belongs to the deformation of one particle.
    fn sample_material(&self, field: &str, a: usize, values: &mut Vec<f64>) {
        let gradient = self.discrete.displacement_gradient(&self.displacement, a);
        let per_volume = |part: usize| {
            self.discrete.energy_of(&self.displacement, a)[part] / self.discrete.particles.volume[a]
        };
        match field {
            "strain_energy" => values.push(per_volume(0)),
            "hourglass_energy" => values.push(per_volume(1)),
            _ => append_field(&self.discrete.material(a).law, &gradient, field, values),
        }
    }
}
