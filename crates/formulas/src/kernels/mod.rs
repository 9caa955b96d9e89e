//! Smoothing kernels.
//!
//! A kernel is `W(r, h) = alpha_d / h^d f(q)` with `q = r / h`, where `d` is the dimension. The
//! *smoothing length* `h` and the *support radius*, beyond which `W` is zero, are different
//! things: a kernel knows its own [support](KernelShape::SUPPORT) in units of `h`, and papers
//! differ in that convention, as each kernel's description says.
//!
//! - [`KernelShape`] is `f` and its derivatives, on unit structs: what a loop is generic over.
//! - [`Kernel`] is the registry, by which a case file names a kernel.
//! - [`ScaledKernel`] is a shape with its dimension and `h`, whose factors are computed once.
//!
//! To add a kernel, implement [`KernelShape`] for a unit struct, list it in `registry.rs`, and add
//! its row to the references in `tests/kernels.rs`; all other tests run over the registry.

mod gaussian;
mod many;
mod mollifier;
mod polynomial;
mod registry;
mod scaled;
mod splines;
mod wendland;

pub use gaussian::Gaussian;
pub use many::{ManyDistances, Needs};
pub use mollifier::{ModifiedMollifier, Mollifier};
pub use polynomial::{Linear, Lucy, Quadratic};
pub use registry::{Kernel, KernelVisitor};
pub use scaled::ScaledKernel;
pub use splines::{CubicSpline, QuinticSpline};
pub use wendland::{WendlandC2, WendlandC4, WendlandC6};

use crate::Number;

/// Below this `q` a particle counts as at the kernel's centre: `1 / q` must not overflow.
const COINCIDENT: f64 = 1e-100;

/// The shape `f(q)` of a kernel and its normalisation; `q = r / h >= 0`.
///
/// Functions take the dimension because a kernel may have another shape in one dimension than in
/// two and three (Wendland's do). It is 1, 2 or 3, and a constant in any loop that cares for
/// speed. Everything is zero at and beyond the support.
pub trait KernelShape: Copy + Default + Send + Sync + 'static {
    /// The kernel's name in a case file.
    const NAME: &'static str;

    /// Support radius over smoothing length.
    const SUPPORT: f64;

    /// The factor `alpha_d` that makes the integral of `W` one in `dimension` dimensions.
    ///
    /// NaN for a dimension other than 1, 2 or 3.
    fn normalisation(dimension: usize) -> f64;

    /// Shape `f(q)`.
    fn value<T: Number>(dimension: usize, q: T) -> T;

    /// `f'(q) / q`, finite at `q = 0`.
    ///
    /// Where a kernel has a cusp and the limit is infinite it is zero at `q = 0`, so that the
    /// gradient of a particle's own kernel vanishes there by symmetry.
    fn derivative_over_q<T: Number>(dimension: usize, q: T) -> T;

    /// `f'(q)`; at the tip of a cusp the limit from above.
    #[inline]
    fn derivative<T: Number>(dimension: usize, q: T) -> T {
        Self::derivative_over_q(dimension, q) * q
    }

    /// `f''(q)`; where it jumps, the limit from above.
    fn second_derivative<T: Number>(dimension: usize, q: T) -> T;
}
