//! Wendland's kernels, polynomials of the least degree for their smoothness.
//!
//! With `s = q / 2` each is `(1 - s)^n` times a polynomial of `s`. The function that is positive
//! definite in two and three dimensions is not the one of least degree in one, so each kernel
//! has two shapes. Source: H. Wendland, Adv. Comput. Math. 4 (1995) 389-396; shapes and
//! normalisations in W. Dehnen and H. Aly, Mon. Not. R. Astron. Soc. 425 (2012), table 1, which
//! writes them in `r / H` with the support radius `H`. Ours have the support `2h`, `H = 2h`.

use std::f64::consts::PI;

use super::KernelShape;
use crate::{Number, power::integer_power};

/// Support radius over smoothing length, for all three.
const SUPPORT: f64 = 2.0;

/// `(1 - s)^exponent` times the polynomial of these coefficients, lowest order first.
#[inline]
fn truncated<T: Number, const N: usize>(q: T, exponent: u32, coefficients: [f64; N]) -> T {
    let s = q * (1.0 / SUPPORT);
    let polynomial =
        coefficients.iter().rev().fold(T::zero(), |sum, &coefficient| sum * s + coefficient);
    // A choice instead of an early return lets loops over distances fill vector registers.
    let inside = integer_power(-s + 1.0, exponent) * polynomial;
    T::select(q.below(SUPPORT), inside, T::zero())
}

/// Normalisation of a smoothing length from that of the support radius.
fn of_support_radius(dimension: usize, normalisations: [f64; 3]) -> f64 {
    match dimension {
        1 => normalisations[0] / 2.0,
        2 => normalisations[1] / 4.0,
        3 => normalisations[2] / 8.0,
        _ => f64::NAN,
    }
}

/// Wendland C2, support `2h`, twice continuously differentiable.
///
/// `(1 - s)^4 (1 + 4 s)`, `alpha_d = 7 / (4 pi)`, `21 / (16 pi)` in 2D and 3D;
/// `(1 - s)^3 (1 + 3 s)`, `alpha_1 = 5/8` in 1D.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WendlandC2;

impl KernelShape for WendlandC2 {
    const NAME: &'static str = "wendland_c2";
    const SUPPORT: f64 = SUPPORT;

    fn normalisation(dimension: usize) -> f64 {
        of_support_radius(dimension, [5.0 / 4.0, 7.0 / PI, 21.0 / (2.0 * PI)])
    }

    #[inline]
    fn value<T: Number>(dimension: usize, q: T) -> T {
        match dimension {
            1 => truncated(q, 3, [1.0, 3.0]),
            _ => truncated(q, 4, [1.0, 4.0]),
        }
    }

    #[inline]
    fn derivative_over_q<T: Number>(dimension: usize, q: T) -> T {
        match dimension {
            1 => truncated(q, 2, [-3.0]),
            _ => truncated(q, 3, [-5.0]),
        }
    }

    #[inline]
    fn second_derivative<T: Number>(dimension: usize, q: T) -> T {
        match dimension {
            1 => truncated(q, 1, [-3.0, 9.0]),
            _ => truncated(q, 2, [-5.0, 20.0]),
        }
    }
}

/// Wendland C4, support `2h`, four times continuously differentiable.
///
/// `(1 - s)^6 (1 + 6 s + 35/3 s^2)`, `alpha_d = 9 / (4 pi)`, `495 / (256 pi)` in 2D and 3D;
/// `(1 - s)^5 (1 + 5 s + 8 s^2)`, `alpha_1 = 3/4` in 1D.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WendlandC4;

impl KernelShape for WendlandC4 {
    const NAME: &'static str = "wendland_c4";
    const SUPPORT: f64 = SUPPORT;

    fn normalisation(dimension: usize) -> f64 {
        of_support_radius(dimension, [3.0 / 2.0, 9.0 / PI, 495.0 / (32.0 * PI)])
    }

    #[inline]
    fn value<T: Number>(dimension: usize, q: T) -> T {
        match dimension {
            1 => truncated(q, 5, [1.0, 5.0, 8.0]),
            _ => truncated(q, 6, [1.0, 6.0, 35.0 / 3.0]),
        }
    }

    #[inline]
    fn derivative_over_q<T: Number>(dimension: usize, q: T) -> T {
        match dimension {
            1 => truncated(q, 4, [-3.5, -14.0]),
            _ => truncated(q, 5, [-14.0 / 3.0, -70.0 / 3.0]),
        }
    }

    #[inline]
    fn second_derivative<T: Number>(dimension: usize, q: T) -> T {
        match dimension {
            1 => truncated(q, 3, [-3.5, -10.5, 84.0]),
            _ => truncated(q, 4, [-14.0 / 3.0, -56.0 / 3.0, 490.0 / 3.0]),
        }
    }
}

/// Wendland C6, support `2h`, six times continuously differentiable.
///
/// `(1 - s)^8 (1 + 8 s + 25 s^2 + 32 s^3)`, `alpha_d = 39 / (14 pi)`, `1365 / (512 pi)` in 2D
/// and 3D; `(1 - s)^7 (1 + 7 s + 19 s^2 + 21 s^3)`, `alpha_1 = 55/64` in 1D.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WendlandC6;

impl KernelShape for WendlandC6 {
    const NAME: &'static str = "wendland_c6";
    const SUPPORT: f64 = SUPPORT;

    fn normalisation(dimension: usize) -> f64 {
        of_support_radius(dimension, [55.0 / 32.0, 78.0 / (7.0 * PI), 1365.0 / (64.0 * PI)])
    }

    #[inline]
    fn value<T: Number>(dimension: usize, q: T) -> T {
        match dimension {
            1 => truncated(q, 7, [1.0, 7.0, 19.0, 21.0]),
            _ => truncated(q, 8, [1.0, 8.0, 25.0, 32.0]),
        }
    }

    #[inline]
    fn derivative_over_q<T: Number>(dimension: usize, q: T) -> T {
        match dimension {
            1 => truncated(q, 6, [-4.5, -27.0, -52.5]),
            _ => truncated(q, 7, [-5.5, -38.5, -88.0]),
        }
    }

    #[inline]
    fn second_derivative<T: Number>(dimension: usize, q: T) -> T {
        match dimension {
            1 => truncated(q, 5, [-4.5, -22.5, 58.5, 472.5]),
            _ => truncated(q, 6, [-5.5, -33.0, 82.5, 880.0]),
        }
    }
}
