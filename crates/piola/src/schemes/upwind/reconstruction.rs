//! The pass that finds slopes for the reconstruction at mid-edges, Upwind (3.50) to (3.53).

use super::Upwind;
use crate::{Tensor, Vector, parallel};

/// Least-squares gradients of the reconstructed fields with respect to X.
///
/// The paper reconstructs the stress P; here it is the pressure, which with the averaged
/// cofactor gives the same flux and takes one gradient instead of `D * D`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slope<const D: usize> {
    /// Gradient of the velocity in 1/s.
    pub velocity: Tensor<D>,
    /// Gradient of the pressure in Pa/m.
    pub pressure: Vector<D>,
}

impl<const D: usize> Default for Slope<D> {
    fn default() -> Self {
        Self { velocity: Tensor::zeros(), pressure: Vector::zeros() }
    }
}

impl<const D: usize> Upwind<D> {
    /// Fills the slopes from the sides of the local pass, if the formulation reconstructs.
    pub(super) fn slope_pass(&mut self) {
        let Some(least_squares) = &self.least_squares else { return };
        let (sides, support) = (&self.sides, &self.support);
        parallel::for_each_chunk(&mut self.slopes, |first, rows| {
            for (offset, slope) in rows.iter_mut().enumerate() {
                let a = first + offset;
                let me = &sides[a];
                let mut sum = Slope::<D>::default();
                for &b in support.list.row(a) {
                    let other = &sides[b as usize];
                    let separation = support.domain.separation(&me.reference, &other.reference);
                    let weighted = separation / separation.norm_squared();
                    sum.velocity += (other.velocity - me.velocity) * weighted.transpose();
                    sum.pressure += weighted * (other.pressure - me.pressure);
                }
                let inverse = least_squares.inverse(a); // symmetric
                slope.velocity = sum.velocity * inverse;
                slope.pressure = inverse * sum.pressure;
            }
        });
    }
}
