//! Kernels made of spline pieces.

use std::f64::consts::PI;

use super::KernelShape;
use crate::Scalar;

/// Cubic spline (Schoenberg's M4), support `2h`: Upwind (2.13), Elastodynamics (2.14).
///
/// `f = 2/3 - q^2 + q^3/2` for `q < 1`, `(2 - q)^3 / 6` for `q < 2`; `alpha_d = 1`, `15 / (7 pi)`,
/// `3 / (2 pi)`. Both papers have `h` with the support `2h`; Elastodynamics has `3/2 f`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CubicSpline;

impl KernelShape for CubicSpline {
    const NAME: &'static str = "cubic_spline";
    const SUPPORT: f64 = 2.0;

    #[inline]
    fn normalisation(dimension: usize) -> f64 {
        match dimension {
            1 => 1.0,
            2 => 15.0 / (7.0 * PI),
            3 => 3.0 / (2.0 * PI),
            _ => f64::NAN,
        }
    }

    #[inline]
    fn value<T: Scalar>(_dimension: usize, q: T) -> T {
        if q.re() < 1.0 {
            q * q * (q * 0.5 - 1.0) + 2.0 / 3.0
        } else if q.re() < 2.0 {
            let rest = -q + 2.0;
            rest * rest * rest * (1.0 / 6.0)
        } else {
            T::zero()
        }
    }

    #[inline]
    fn derivative_over_q<T: Scalar>(_dimension: usize, q: T) -> T {
        if q.re() < 1.0 {
            q * 1.5 - 2.0
        } else if q.re() < 2.0 {
            let rest = -q + 2.0;
            rest * rest * -0.5 / q
        } else {
            T::zero()
        }
    }

    #[inline]
    fn second_derivative<T: Scalar>(_dimension: usize, q: T) -> T {
        if q.re() < 1.0 {
            q * 3.0 - 2.0
        } else if q.re() < 2.0 {
            -q + 2.0
        } else {
            T::zero()
        }
    }
}
