//! Whether the lattice of particles has folded, which no gradient sees.

use piola_formulas::tensor::determinant;

use super::Upwind;
use crate::parallel;
use crate::{Tensor, Vector};

/// Neighbours up to this many times the largest spacing of a particle make its corners: those along the
/// axes of a lattice, and not its diagonals.
const CLOSE: f64 = 1.1;

/// Directions whose determinant is below this share of the product of their lengths make no corner.
const FLAT: f64 = 0.1;

impl<const D: usize> Upwind<D> {
    /// The smallest volume of a corner now over its volume in the reference, over all corners: the
    /// spans of a particle with D of its closest neighbours. Where it is negative, the lattice has
    /// folded and neighbouring columns overlap, whatever the evolved F and J are.
    pub(super) fn least_corner(&self, state: &[f64]) -> f64 {
        let at = self.columns(state);
        let corner = |a: usize| self.least_corner_of(a, at.position);
        -parallel::maximum(self.particles.len(), f64::NEG_INFINITY, |a| -corner(a))
    }

    fn least_corner_of(&self, a: usize, place: &[Vector<D>]) -> f64 {
        // Two a lattice axis; a cloud may have more, of which the first serve.
        let mut spans = [(Vector::<D>::zeros(), Vector::<D>::zeros()); 8];
        let mut count = 0;
        for &b in self.support.list.row(a) {
            let reference = self.support.separation(&self.particles.position, a, b);
            if count < spans.len() && reference.norm() < CLOSE * self.particles.spacing[a] {
                let current = self.support.domain.separation(&place[a], &place[b as usize]);
                spans[count] = (reference, current);
                count += 1;
            }
        }
        let mut least = f64::INFINITY;
        let mut chosen = [0; D];
        Self::corners(&spans[..count], 0, 0, &mut chosen, &mut least);
        least
    }

    /// Goes over all choices of D spans in ascending order.
    fn corners(
        spans: &[(Vector<D>, Vector<D>)],
        depth: usize,
        first: usize,
        chosen: &mut [usize; D],
        least: &mut f64,
    ) {
        if depth == D {
            let columns = |side: fn(&(Vector<D>, Vector<D>)) -> &Vector<D>| -> Tensor<D> {
                Tensor::from_fn(|i, j| side(&spans[chosen[j]])[i])
            };
            let (reference, current) = (columns(|it| &it.0), columns(|it| &it.1));
            let volume = determinant(&reference);
            let lengths: f64 = chosen.iter().map(|&k| spans[k].0.norm()).product();
            if volume.abs() > FLAT * lengths {
                *least = least.min(determinant(&current) / volume);
            }
            return;
        }
        for k in first..spans.len() {
            chosen[depth] = k;
            Self::corners(spans, depth + 1, k + 1, chosen, least);
        }
    }
}
