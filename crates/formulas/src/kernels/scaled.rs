//! A kernel shape with its dimension and smoothing length.

use std::marker::PhantomData;

use super::KernelShape;
use crate::{Number, power::integer_power};

/// Kernel `K` in `D` dimensions with a smoothing length, whose factors are computed once.
///
/// The lengths `r` and `h` are metres, `W` is in m^-D.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaledKernel<K, const D: usize> {
    inverse_length: f64,
    value_factor: f64,
    shape: PhantomData<K>,
}

impl<K: KernelShape, const D: usize> ScaledKernel<K, D> {
    /// The kernel of a `smoothing_length` > 0; any other length gives infinite or NaN values.
    #[inline]
    pub fn new(smoothing_length: f64) -> Self {
        const { assert!(D >= 1 && D <= 3, "piola works in 1, 2 or 3 dimensions") };
        let inverse_length = 1.0 / smoothing_length;
        let value_factor = K::normalisation(D) * integer_power(inverse_length, D as u32);
        Self { inverse_length, value_factor, shape: PhantomData }
    }

    /// `W(r)`.
    #[inline]
    pub fn value<T: Number>(&self, r: T) -> T {
        K::value(D, r * self.inverse_length) * self.value_factor
    }

    /// `W'(r) / r`, so that the gradient is this times the vector from neighbour to particle.
    ///
    /// Finite at `r = 0`; see [`KernelShape::derivative_over_q`].
    #[inline]
    pub fn derivative_over_r<T: Number>(&self, r: T) -> T {
        let factor = self.value_factor * self.inverse_length * self.inverse_length;
        K::derivative_over_q(D, r * self.inverse_length) * factor
    }

    /// `W'(r)`.
    #[inline]
    pub fn derivative<T: Number>(&self, r: T) -> T {
        let factor = self.value_factor * self.inverse_length;
        K::derivative(D, r * self.inverse_length) * factor
    }

    /// `W''(r)`.
    #[inline]
    pub fn second_derivative<T: Number>(&self, r: T) -> T {
        let factor = self.value_factor * self.inverse_length * self.inverse_length;
        K::second_derivative(D, r * self.inverse_length) * factor
    }
}
