//! The areas through which particles act on each other.

use std::ops::Range;

use piola_formulas::pairs::{AreaPair, Areas};

use super::frozen::FrozenRows;
use super::gradient::GradientOperator;
use crate::Vector;
use crate::neighbors::NeighborList;

/// Gradient coefficients times quadrature volumes, `V_a G_ab`, of every pair both ways.
///
/// They are what the sums of a formulation use: with the adjoint form of [`GradientOperator`]
/// forces are `-sum_b P_b (V_b G_ba)`, gradients `1/V_a sum_b (f_b - f_a) (x) (V_a G_ab)`, and the
/// antisymmetric area between two particles is `C_ab = V_a G_ab - V_b G_ba`.
#[derive(Clone, Debug)]
pub struct PairAreas<const D: usize> {
    /// The neighbours.
    pub pairs: FrozenRows<AreaPair<D>>,
    /// `V_a G_aa` of each particle in m^(D-1).
    diagonal: Vec<Vector<D>>,
}

impl<const D: usize> PairAreas<D> {
    /// The areas of an operator on `list` for the volumes V in m^D.
    pub fn new(operator: &GradientOperator<D>, list: &NeighborList, volume: &[f64]) -> Self {
        let row = |a: usize| {
            let forward = operator.forward(list.range(a)).iter();
            let both = forward.zip(operator.adjoint(list.range(a)));
            list.row(a).iter().zip(both).map(move |(&b, (forward, adjoint))| {
                let area = Vector::from(*forward) * volume[a];
                (b, Areas { area, transposed: Vector::from(*adjoint) * volume[b as usize] })
            })
        };
        let diagonal = volume.iter().enumerate().map(|(a, v)| operator.diagonal(a) * *v);
        let pairs = FrozenRows::new((0..list.len()).map(row));
        Self { pairs, diagonal: diagonal.collect() }
    }

    /// Those of some particles, of which `place` says where others stand now.
    pub fn part(&self, own: Range<usize>, place: impl Fn(u32) -> u32) -> Self {
        Self { pairs: self.pairs.part(own.clone(), place), diagonal: self.diagonal[own].to_vec() }
    }

    /// `V_a G_aa` in m^(D-1).
    #[inline]
    pub fn diagonal(&self, a: usize) -> Vector<D> {
        self.diagonal[a]
    }

    /// Bytes of all areas, which a pass over pairs reads.
    pub fn memory(&self) -> usize {
        self.pairs.memory() + size_of_val(self.diagonal.as_slice())
    }
}
