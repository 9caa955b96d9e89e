//! Kernels made of spline pieces.

use std::f64::consts::PI;

use super::KernelShape;
use crate::{Number, power::integer_power};

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
    fn value<T: Number>(_dimension: usize, q: T) -> T {
        let rest = -q + 2.0;
        let inner = q * q * (q * 0.5 - 1.0) + 2.0 / 3.0;
        of_pieces(q, inner, rest * rest * rest * (1.0 / 6.0))
    }

    #[inline]
    fn derivative_over_q<T: Number>(_dimension: usize, q: T) -> T {
        let rest = -q + 2.0;
        of_pieces(q, q * 1.5 - 2.0, rest * rest * -0.5 / q)
    }

    #[inline]
    fn second_derivative<T: Number>(_dimension: usize, q: T) -> T {
        of_pieces(q, q * 3.0 - 2.0, -q + 2.0)
    }
}

/// The inner piece for `q < 1`, the outer one for `q < 2`. All are computed and one is chosen, here and
/// below, so that loops over distances fill vector registers.
#[inline]
fn of_pieces<T: Number>(q: T, inner: T, outer: T) -> T {
    T::select(q.below(1.0), inner, T::select(q.below(2.0), outer, T::zero()))
}

/// Quintic spline (Schoenberg's M6), support `3h`: CTVF, and Dual-support (19).
///
/// `f = (3 - q)^5 - 6 (2 - q)^5 + 15 (1 - q)^5`, each term only where its base is positive;
/// `alpha_d = 1/120`, `7 / (478 pi)`, `1 / (120 pi)`. CTVF has `h` with the support `3h`, as here;
/// the `h` of Dual-support is the support radius, three times ours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct QuinticSpline;

impl KernelShape for QuinticSpline {
    const NAME: &'static str = "quintic_spline";
    const SUPPORT: f64 = 3.0;

    fn normalisation(dimension: usize) -> f64 {
        match dimension {
            1 => 1.0 / 120.0,
            2 => 7.0 / (478.0 * PI),
            3 => 1.0 / (120.0 * PI),
            _ => f64::NAN,
        }
    }

    #[inline]
    fn value<T: Number>(_dimension: usize, q: T) -> T {
        let square = q * q;
        let inner = square * (square * (-q + 3.0) * 10.0 - 60.0) + 66.0;
        let outer = outer_terms(q, 5);
        T::select(q.below(1.0), inner, outer)
    }

    #[inline]
    fn derivative_over_q<T: Number>(_dimension: usize, q: T) -> T {
        let inner = q * q * (q * -50.0 + 120.0) - 120.0;
        let outer = outer_terms(q, 4) * -5.0 / q;
        T::select(q.below(1.0), inner, outer)
    }

    #[inline]
    fn second_derivative<T: Number>(_dimension: usize, q: T) -> T {
        let inner = q * q * (q * -200.0 + 360.0) - 120.0;
        let outer = outer_terms(q, 3) * 20.0;
        T::select(q.below(1.0), inner, outer)
    }
}

/// `(3 - q)^n - 6 (2 - q)^n`, each term only where its base is positive.
#[inline]
fn outer_terms<T: Number>(q: T, exponent: u32) -> T {
    let positive = |base: T| T::select(base.above(0.0), base, T::zero());
    let far = integer_power(positive(-q + 3.0), exponent);
    far - integer_power(positive(-q + 2.0), exponent) * 6.0
}
