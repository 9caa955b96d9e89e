//! A kernel at many distances at once, chosen once for all of them.

use super::{Kernel, KernelShape, KernelVisitor, ScaledKernel};

/// A kernel of a smoothing length that fills arrays: one indirect call for many neighbours.
///
/// Distances are given by their squares in m^2, all of them positive. Beyond the support
/// everything is zero.
pub trait ManyDistances: Send + Sync {
    /// Writes `W(r)` in m^-D for each square.
    fn values(&self, squares: &[f64], values: &mut [f64]);

    /// Writes `W'(r) / r` in m^-(D+2) for each square.
    fn slopes(&self, squares: &[f64], slopes: &mut [f64]);
}

impl<K: KernelShape, const D: usize> ManyDistances for ScaledKernel<K, D> {
    fn values(&self, squares: &[f64], values: &mut [f64]) {
        for (value, square) in values.iter_mut().zip(squares) {
            *value = self.value(square.sqrt());
        }
    }

    fn slopes(&self, squares: &[f64], slopes: &mut [f64]) {
        for (slope, square) in slopes.iter_mut().zip(squares) {
            *slope = self.derivative_over_r(square.sqrt());
        }
    }
}

struct Boxed<const D: usize>(f64);

impl<const D: usize> KernelVisitor for Boxed<D> {
    type Output = Box<dyn ManyDistances>;

    fn visit<K: KernelShape>(self, _shape: K) -> Self::Output {
        Box::new(ScaledKernel::<K, D>::new(self.0))
    }
}

impl Kernel {
    /// This kernel in `D` dimensions with a smoothing length in m, for loops over neighbours.
    pub fn many<const D: usize>(self, smoothing_length: f64) -> Box<dyn ManyDistances> {
        self.visit(Boxed::<D>(smoothing_length))
    }
}
