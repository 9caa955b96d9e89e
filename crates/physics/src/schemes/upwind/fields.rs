//! The columns of the formulation and its fields.

use piola_formulas::tensor;
use piola_formulas::volumetric::VolumetricResponse;

use super::Upwind;
use crate::fields::columns;
use crate::schemes::Scheme;

columns! {
    pub(super) struct Columns, ColumnsMut, enum Made;
    evolved position: Vector, "m", "current position x";
    derived(0) displacement: Vector, "m", "x - X";
    evolved velocity: Vector, "m/s", "velocity v";
    derived(1) acceleration: Vector, "m/s2", "rate of the velocity";
    derived(0) pressure: Scalar, "Pa", "pressure p(J), positive in compression";
    evolved volume_ratio: Scalar, "1", "evolved volume ratio J";
    derived(0) determinant: Scalar, "1", "determinant of the deformation gradient";
    evolved deformation_gradient: Tensor, "1", "deformation gradient F, row by row";
    derived(0) density: Scalar, "kg/m3", "current density, from the evolved J";
    derived(0) wave_speed: Scalar, "m/s", "fastest wave speed, measured on the reference configuration";
    constant smoothing_length: Scalar, "m", "smoothing length h";
    constant neighbors: Scalar, "1", "number of neighbours";
    constant volume: Scalar, "m3", "reference quadrature volume V";
}

impl<const D: usize> Upwind<D> {
    /// The columns of a state.
    pub(super) fn columns<'a>(&self, state: &'a [f64]) -> Columns<'a, D> {
        Columns::of(state, self.particles.len())
    }

    /// The one stage of observation: rates.
    pub(super) fn make_fields(&mut self, time: f64, state: &[f64]) {
        let mut rate = std::mem::take(&mut self.observed);
        rate.resize(state.len(), 0.0);
        self.rates(time, state, &mut rate);
        self.observed = rate;
    }

    /// Appends the components of one field of one particle.
    pub(super) fn push_field(
        &self,
        field: Made,
        at: &Columns<'_, D>,
        a: usize,
        values: &mut Vec<f64>,
    ) {
        let ratio = at.volume_ratio[a];
        match field {
            Made::displacement => {
                let displacement = at.position[a] - self.particles.position[a];
                values.extend_from_slice(displacement.as_slice());
            }
            Made::acceleration => {
                let rate = self.columns(&self.observed);
                values.extend_from_slice(rate.velocity[a].as_slice());
            }
            Made::pressure => values.push(self.law(a).pressure(ratio)),
            Made::determinant => values.push(tensor::determinant(&at.deformation_gradient[a])),
            Made::density => values.push(self.reference[a].density / ratio),
            Made::wave_speed => values.push(self.wave_speed(a, at)),
            Made::smoothing_length => values.push(self.support.smoothing_length[a]),
            Made::neighbors => values.push(self.support.list.row(a).len() as f64),
            Made::volume => values.push(self.particles.volume[a]),
        }
    }
}
