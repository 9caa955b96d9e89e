//! A kernel at many distances at once, chosen once for all of them.

use multiversion::multiversion;

use super::{Kernel, KernelShape, KernelVisitor, ScaledKernel};

/// What of a kernel a sum over neighbours needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Needs {
    /// Neither value nor slope, only who is there.
    Nothing,
    /// `W`.
    Value,
    /// `W' / r`.
    Slope,
    /// Both.
    Both,
}

/// A kernel of a smoothing length that fills arrays: one indirect call for many neighbours.
///
/// Distances are given by their squares in m^2, all of them positive. Beyond the support
/// everything is zero.
pub trait ManyDistances: Send + Sync {
    /// Writes `W(r)` in m^-D for each square.
    fn values(&self, squares: &[f64], values: &mut [f64]);

    /// Writes `W'(r) / r` in m^-(D+2) for each square.
    fn slopes(&self, squares: &[f64], slopes: &mut [f64]);

    /// Writes both, with one root a square.
    fn both(&self, squares: &[f64], values: &mut [f64], slopes: &mut [f64]);
}

impl<K: KernelShape, const D: usize> ManyDistances for ScaledKernel<K, D> {
    fn values(&self, squares: &[f64], values: &mut [f64]) {
        fill_values(self, squares, values);
    }

    fn slopes(&self, squares: &[f64], slopes: &mut [f64]) {
        fill_slopes(self, squares, slopes);
    }

    fn both(&self, squares: &[f64], values: &mut [f64], slopes: &mut [f64]) {
        fill_both(self, squares, values, slopes);
    }
}

#[multiversion(targets("x86_64+avx2+avx512f+avx512vl+avx512dq+avx512bw", "x86_64+avx2"))]
fn fill_values<K: KernelShape, const D: usize>(
    kernel: &ScaledKernel<K, D>,
    squares: &[f64],
    values: &mut [f64],
) {
    for (value, square) in values.iter_mut().zip(squares) {
        *value = kernel.value(square.sqrt());
    }
}

#[multiversion(targets("x86_64+avx2+avx512f+avx512vl+avx512dq+avx512bw", "x86_64+avx2"))]
fn fill_slopes<K: KernelShape, const D: usize>(
    kernel: &ScaledKernel<K, D>,
    squares: &[f64],
    slopes: &mut [f64],
) {
    for (slope, square) in slopes.iter_mut().zip(squares) {
        *slope = kernel.derivative_over_r(square.sqrt());
    }
}

#[multiversion(targets("x86_64+avx2+avx512f+avx512vl+avx512dq+avx512bw", "x86_64+avx2"))]
fn fill_both<K: KernelShape, const D: usize>(
    kernel: &ScaledKernel<K, D>,
    squares: &[f64],
    values: &mut [f64],
    slopes: &mut [f64],
) {
    for ((value, slope), square) in values.iter_mut().zip(slopes).zip(squares) {
        let distance = square.sqrt();
        *value = kernel.value(distance);
        *slope = kernel.derivative_over_r(distance);
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
