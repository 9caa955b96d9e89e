//! Corrections that make velocity gradients exact for linear fields.

use piola_formulas::tensor;

use crate::operators::{Needs, NeighborBlock};
use crate::schemes::transport_velocity::TransportVelocity;
use crate::{Tensor, parallel};

/// Smallest eigenvalue of the matrix to be inverted that is trusted. At an edge of a body it is a
/// half, in a corner a quarter; a particle that has lost its neighbours gets no correction.
const LEAST: f64 = 0.1;

impl<const D: usize> TransportVelocity<D> {
    /// Fills the corrections `L_a = [ sum V_b (r_b - r_a) (x) grad W_ab ]^-1`, theory (74), over the own
    /// body and walls, where gradients are corrected. They are symmetric, as the sum is.
    pub(in super::super) fn correct_gradients(&mut self) {
        let Some(solids) = &mut self.solids else { return };
        let mut corrections = std::mem::take(&mut solids.corrections);
        let (support, list, sides) = (&self.support, self.support.list(), &self.sides);
        parallel::for_each_chunk(&mut corrections, |first, rows| {
            let mut block = NeighborBlock::default();
            for (offset, row) in rows.iter_mut().enumerate() {
                let place = first + offset;
                *row = Tensor::identity();
                if list.is_passive(place) {
                    continue;
                }
                let (mut sum, mut rest) = (Tensor::<D>::zeros(), support.all(place));
                while support.fill(&mut rest, Needs::Slope, &mut block) {
                    for neighbor in block.iter().filter(|b| self.is_own(place, b.place)) {
                        let r = &neighbor.separation;
                        sum -= r * r.transpose() * (sides[neighbor.place].volume * neighbor.slope);
                    }
                }
                if tensor::smallest_eigenvalue(&sum) > LEAST {
                    *row = tensor::inverse(&sum).unwrap_or_else(Tensor::identity);
                }
            }
        });
        if let Some(solids) = &mut self.solids {
            solids.corrections = corrections;
        }
    }
}
