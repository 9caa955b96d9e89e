//! Corrections that make velocity gradients exact for linear fields.

use multiversion::multiversion;
use piola_formulas::tensor;

use crate::operators::{LANES, Lanes, Needs, NeighborBlock, all_of, total};
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
        parallel::for_each_chunk(&mut corrections, |first, rows| fill(self, first, rows));
        if let Some(solids) = &mut self.solids {
            solids.corrections = corrections;
        }
    }

    /// The sums of the particle at `place`, of which those with `i <= j` are filled.
    #[inline(always)]
    fn gather_moments(&self, place: usize, block: &mut NeighborBlock<D>) -> [[Lanes; D]; D] {
        let mut sums = [[[0.0; LANES]; D]; D];
        let mut rest = self.support.all(place);
        while self.support.fill(&mut rest, Needs::Slope, block) {
            for group in block.groups() {
                let sides = all_of(&self.sides, group.places);
                let own = self.continua.own(place, group.places);
                for lane in 0..LANES {
                    let neighbor = group.neighbor(lane);
                    let area = own[lane] * sides[lane].volume * neighbor.slope;
                    for (i, row) in sums.iter_mut().enumerate() {
                        let arm = neighbor.separation[i] * area;
                        for (j, sum) in row.iter_mut().enumerate().skip(i) {
                            sum[lane] -= arm * neighbor.separation[j];
                        }
                    }
                }
            }
        }
        sums
    }
}

/// The correction with these sums.
#[inline(never)]
fn correction<const D: usize>(sums: &[[Lanes; D]; D]) -> Tensor<D> {
    let sum = Tensor::<D>::from_fn(|i, j| total(sums[i.min(j)][i.max(j)]));
    match tensor::smallest_eigenvalue(&sum) > LEAST {
        true => tensor::inverse(&sum).unwrap_or_else(Tensor::identity),
        false => Tensor::identity(),
    }
}

/// Fills some rows.
#[multiversion(targets("x86_64+avx2"))]
fn fill<const D: usize>(scheme: &TransportVelocity<D>, first: usize, rows: &mut [Tensor<D>]) {
    let mut block = NeighborBlock::default();
    for (offset, row) in rows.iter_mut().enumerate() {
        let place = first + offset;
        *row = match scheme.support.list().is_passive(place) {
            true => Tensor::identity(),
            false => correction(&scheme.gather_moments(place, &mut block)),
        };
    }
}
