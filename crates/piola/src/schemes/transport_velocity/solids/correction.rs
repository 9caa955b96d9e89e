//! Corrections that make velocity gradients exact for linear fields.

use piola_formulas::pairs::solid::Moments;
use piola_formulas::tensor;

use crate::Tensor;
use crate::operators::{Among, Term, gather};
use crate::schemes::transport_velocity::TransportVelocity;

/// Smallest eigenvalue of the matrix to be inverted that is trusted. At an edge of a body it is a
/// half, in a corner a quarter; a particle that has lost its neighbours gets no correction.
const LEAST: f64 = 0.1;

impl<const D: usize> TransportVelocity<D> {
    /// Fills the corrections `L_a = [ sum V_b (r_b - r_a) (x) grad W_ab ]^-1`, theory (74), over the own
    /// body and walls, where gradients are corrected. They are symmetric, as the sum is.
    pub(in super::super) fn correct_gradients(&mut self) {
        let Some(solids) = &mut self.solids else { return };
        let mut corrections = std::mem::take(&mut solids.corrections);
        corrections.fill(Tensor::identity());
        let source = (self.sides.as_slice(), &self.continua);
        let sum = Term { law: Moments::<D>, source, among: Among::All };
        let close = |_: usize, sums: &Tensor<D>, row: &mut _| *row = correction(sums);
        gather(&self.support, &sum, &mut corrections, |place| self.active(place), close);
        if let Some(solids) = &mut self.solids {
            solids.corrections = corrections;
        }
    }
}

/// The correction with these sums, of which those with `i <= j` are filled.
fn correction<const D: usize>(sums: &Tensor<D>) -> Tensor<D> {
    let sum = Tensor::<D>::from_fn(|i, j| sums[(i.min(j), i.max(j))]);
    match tensor::smallest_eigenvalue(&sum) > LEAST {
        true => tensor::inverse(&sum).unwrap_or_else(Tensor::identity),
        false => Tensor::identity(),
    }
}
