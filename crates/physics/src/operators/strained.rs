//! What becomes of the sums of a particle: its gradient, and the derivatives of its energy.

use nalgebra::SMatrix;
use piola_formulas::Number;

use crate::Tensor;

/// Scratch of [`ReferenceGradient::strain`](super::ReferenceGradient::strain).
#[derive(Clone, Debug)]
pub struct Strained<const D: usize> {
    /// Displacement gradients A.
    pub gradient: Vec<Tensor<D>>,
    /// Derivatives of the energy by the sums of a particle, in J, and behind them zeros for images.
    pub tension: Vec<Tensor<D>>,
}

impl<const D: usize> Strained<D> {
    /// Bytes of it.
    pub fn memory(&self) -> usize {
        size_of_val(self.gradient.as_slice()) + size_of_val(self.tension.as_slice())
    }
}

/// Fills in the tensions of particles that follow each other, by that of one: what
/// [`ReferenceGradient::strain`](super::ReferenceGradient::strain) takes.
pub fn one_by_one<const D: usize>(
    tension: impl Fn(usize, &Tensor<D>) -> Tensor<D> + Sync,
) -> impl Fn(usize, &[Tensor<D>], &mut [Tensor<D>]) + Sync {
    move |first, gradients, tensions| {
        for ((a, gradient), own) in (first..).zip(gradients).zip(tensions) {
            *own = tension(a, gradient);
        }
    }
}

/// The derivatives by the sums of a particle of the energy of its material, which has the `tension`, and of its hourglass
/// energy with the stiffness 2 c: `T + 2 c (A S - M)` and `- 2 c A`, or of the only sum, where M is `A S`, `T - 2 c A S`.
#[inline]
pub(crate) fn stabilised<T: Number, const D: usize, const N: usize>(
    sums: &[SMatrix<T, D, D>; N],
    tension: SMatrix<T, D, D>,
    shape: &SMatrix<T, D, D>,
    stiffness: T,
) -> [SMatrix<T, D, D>; N] {
    let moment = sums[0] * shape;
    let mut derivatives = [tension; N];
    match derivatives.as_mut_slice() {
        [of_gradient, of_moment] => {
            *of_gradient += (moment - sums[1]).map(|entry| entry * stiffness);
            *of_moment = sums[0].map(|entry| entry * -stiffness);
        }
        // The moment is the product itself.
        all => all[0] -= moment.map(|entry| entry * stiffness),
    }
    derivatives
}
