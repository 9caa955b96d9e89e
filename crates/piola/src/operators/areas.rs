//! The areas through which particles act on each other.

use std::ops::Range;

use super::gradient::GradientOperator;
use crate::Vector;
use crate::neighbors::NeighborList;

/// Gradient coefficients times quadrature volumes, `V_a G_ab` in m^(D-1), of every pair both ways.
///
/// They are what the sums of a formulation use: with the adjoint form of [`GradientOperator`]
/// forces are `-sum_b P_b (V_b G_ba)`, gradients `1/V_a sum_b (f_b - f_a) (x) (V_a G_ab)`, and the
/// antisymmetric area between two particles is `C_ab = V_a G_ab - V_b G_ba`.
#[derive(Clone, Debug)]
pub struct PairAreas<const D: usize> {
    /// `V_a G_ab` for each entry of the list.
    forward: Vec<[f64; D]>,
    /// `V_b G_ba` for each entry of the list.
    adjoint: Vec<[f64; D]>,
    /// `V_a G_aa` for each particle.
    diagonal: Vec<[f64; D]>,
}

impl<const D: usize> PairAreas<D> {
    /// Bytes that an entry of the list costs in memory, and in a pass that uses both ways.
    pub const BYTES_PER_PAIR: usize = 2 * size_of::<[f64; D]>();

    /// The areas of an operator on `list` for the volumes V.
    pub fn new(operator: GradientOperator<D>, list: &NeighborList, volume: &[f64]) -> Self {
        let GradientOperator { mut forward, mut adjoint, mut diagonal } = operator;
        let scale = |g: &mut [f64; D], volume: f64| g.iter_mut().for_each(|x| *x *= volume);
        for (a, own) in diagonal.iter_mut().enumerate() {
            scale(own, volume[a]);
            let entries = list.range(a);
            forward[entries.clone()].iter_mut().for_each(|g| scale(g, volume[a]));
            for (&b, g) in list.row(a).iter().zip(&mut adjoint[entries]) {
                scale(g, volume[b as usize]);
            }
        }
        Self { forward, adjoint, diagonal }
    }

    /// `V_a G_ab` of the entries of one particle.
    #[inline]
    pub fn forward(&self, entries: Range<usize>) -> &[[f64; D]] {
        &self.forward[entries]
    }

    /// `V_b G_ba` of the entries of one particle.
    #[inline]
    pub fn adjoint(&self, entries: Range<usize>) -> &[[f64; D]] {
        &self.adjoint[entries]
    }

    /// `V_a G_aa` of one particle.
    #[inline]
    pub fn diagonal(&self, a: usize) -> Vector<D> {
        Vector::from(self.diagonal[a])
    }
}
