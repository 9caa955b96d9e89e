//! Kernels of a single polynomial piece: Lucy's, the linear and the quadratic.

use std::f64::consts::PI;

use super::{COINCIDENT, KernelShape};
use crate::Number;

/// Lucy's kernel `f = (1 + 3 q) (1 - q)^3`, support `h`: Elastodynamics (2.13).
///
/// `alpha_d = 5/4`, `5 / pi`, `105 / (16 pi)`. L. B. Lucy, Astron. J. 82 (1977), has `h` with the
/// support `h` too.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lucy;

impl KernelShape for Lucy {
    const NAME: &'static str = "lucy";
    const SUPPORT: f64 = 1.0;

    fn normalisation(dimension: usize) -> f64 {
        match dimension {
            1 => 5.0 / 4.0,
            2 => 5.0 / PI,
            3 => 105.0 / (16.0 * PI),
            _ => f64::NAN,
        }
    }

    #[inline]
    fn value<T: Number>(_dimension: usize, q: T) -> T {
        of_rest(Self::SUPPORT, q, |rest| (q * 3.0 + 1.0) * rest * rest * rest)
    }

    #[inline]
    fn derivative_over_q<T: Number>(_dimension: usize, q: T) -> T {
        of_rest(Self::SUPPORT, q, |rest| rest * rest * -12.0)
    }

    #[inline]
    fn second_derivative<T: Number>(_dimension: usize, q: T) -> T {
        of_rest(Self::SUPPORT, q, |rest| rest * (q * 3.0 - 1.0) * 12.0)
    }
}

/// Linear kernel `f = 1 - q / 2`, support `2h`, with a cusp at `q = 0`.
///
/// `alpha_d = 1/2`, `3 / (4 pi)`, `3 / (8 pi)`. Named, without a formula, in Upwind section 2.2,
/// after J. Bonet and S. Kulasegaram, Int. J. Numer. Meth. Eng. 52 (2001); the support `2h` is
/// our choice, that of the cubic spline. `f' = -1/2` up to the centre: `f' / q` grows without
/// bound and is set to zero at `q = 0`; `f''` leaves out the cusp and the kink at the support.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Linear;

impl KernelShape for Linear {
    const NAME: &'static str = "linear";
    const SUPPORT: f64 = 2.0;

    fn normalisation(dimension: usize) -> f64 {
        match dimension {
            1 => 0.5,
            2 => 3.0 / (4.0 * PI),
            3 => 3.0 / (8.0 * PI),
            _ => f64::NAN,
        }
    }

    #[inline]
    fn value<T: Number>(_dimension: usize, q: T) -> T {
        of_rest(Self::SUPPORT, q, |rest| rest * 0.5)
    }

    #[inline]
    fn derivative_over_q<T: Number>(dimension: usize, q: T) -> T {
        over_q(Self::derivative(dimension, q), q)
    }

    #[inline]
    fn derivative<T: Number>(_dimension: usize, q: T) -> T {
        T::select(q.below(Self::SUPPORT), T::from(-0.5), T::zero())
    }

    #[inline]
    fn second_derivative<T: Number>(_dimension: usize, _q: T) -> T {
        T::zero()
    }
}

/// Quadratic kernel `f = 3/16 (2 - q)^2`, support `2h`, with a cusp at `q = 0`.
///
/// `alpha_d = 1`, `2 / pi`, `5 / (4 pi)`. Named, without a formula, in Upwind section 2.2, after
/// G. R. Johnson, R. A. Stryk and S. R. Beissel, Comput. Meth. Appl. Mech. Eng. 139 (1996), who
/// wanted a slope that is steepest at the centre, so that particles pressed together repel each
/// other most. `f'(0) = -3/4`: `f' / q` grows without bound and is set to zero at `q = 0`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Quadratic;

impl KernelShape for Quadratic {
    const NAME: &'static str = "quadratic";
    const SUPPORT: f64 = 2.0;

    fn normalisation(dimension: usize) -> f64 {
        match dimension {
            1 => 1.0,
            2 => 2.0 / PI,
            3 => 5.0 / (4.0 * PI),
            _ => f64::NAN,
        }
    }

    #[inline]
    fn value<T: Number>(_dimension: usize, q: T) -> T {
        of_rest(Self::SUPPORT, q, |rest| rest * rest * (3.0 / 16.0))
    }

    #[inline]
    fn derivative_over_q<T: Number>(dimension: usize, q: T) -> T {
        over_q(Self::derivative(dimension, q), q)
    }

    #[inline]
    fn derivative<T: Number>(_dimension: usize, q: T) -> T {
        of_rest(Self::SUPPORT, q, |rest| rest * (-3.0 / 8.0))
    }

    #[inline]
    fn second_derivative<T: Number>(_dimension: usize, q: T) -> T {
        T::select(q.below(Self::SUPPORT), T::from(3.0 / 8.0), T::zero())
    }
}

/// A function of what remains from `q` to the support, zero at and beyond it.
#[inline]
fn of_rest<T: Number>(support: f64, q: T, function: impl FnOnce(T) -> T) -> T {
    T::select(q.below(support), function(-q + support), T::zero())
}

/// `derivative / q`, and zero at the tip of a cusp.
#[inline]
fn over_q<T: Number>(derivative: T, q: T) -> T {
    T::select(q.below(COINCIDENT), T::zero(), derivative / q)
}
