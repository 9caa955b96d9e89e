//! Infinitely differentiable kernels of compact support.
//!
//! Both are `exp(-1 / u)` times a power of `u = 1 - q^2`, with the support `h`. Their integrals
//! have no closed form: they are computed once per dimension, over the unit ball, where the
//! paper's (2.17) and (2.19) have an integral over a line (and (2.19) from -1 to -1).

use std::f64::consts::PI;
use std::sync::LazyLock;

use super::KernelShape;
use crate::{Number, power::integer_power};

/// A function of `exp(-1 / u)` and `u = 1 - q^2`, zero at and beyond the support.
///
/// Inside the support `u` is at least one rounding, so that `1 / u` and its powers are finite.
#[inline]
fn of_bump<T: Number>(q: T, function: impl FnOnce(T, T) -> T) -> T {
    let u = (-q + 1.0) * (q + 1.0);
    T::choose(u.above(0.0), || function((-u.recip()).exp(), u), T::zero)
}

/// Classical mollifier `f = exp(-1 / (1 - q^2))`, support `h`: Elastodynamics (2.17) corrected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Mollifier;

static MOLLIFIER: LazyLock<[f64; 3]> = LazyLock::new(normalisations::<Mollifier>);

impl KernelShape for Mollifier {
    const NAME: &'static str = "mollifier";
    const SUPPORT: f64 = 1.0;

    fn normalisation(dimension: usize) -> f64 {
        of_dimension(dimension, &MOLLIFIER)
    }

    #[inline]
    fn value<T: Number>(_dimension: usize, q: T) -> T {
        of_bump(q, |exponential, _| exponential)
    }

    #[inline]
    fn derivative_over_q<T: Number>(_dimension: usize, q: T) -> T {
        of_bump(q, |exponential, u| exponential / (u * u) * -2.0)
    }

    #[inline]
    fn second_derivative<T: Number>(_dimension: usize, q: T) -> T {
        of_bump(q, |exponential, u| {
            let inverse = u.recip();
            let inner = q * q * inverse * (inverse - 2.0) * 4.0 - 2.0;
            exponential * inverse * inverse * inner
        })
    }
}

/// Modified mollifier `f = exp(-1 / (1 - q^2)) (1 - q^2)^8`, support `h`: Elastodynamics (2.19)
/// corrected; close to the Gaussian `exp(-(3 q)^2 - 1)`, which (2.18) prints with `r / 3`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ModifiedMollifier;

static MODIFIED_MOLLIFIER: LazyLock<[f64; 3]> = LazyLock::new(normalisations::<ModifiedMollifier>);

impl KernelShape for ModifiedMollifier {
    const NAME: &'static str = "modified_mollifier";
    const SUPPORT: f64 = 1.0;

    fn normalisation(dimension: usize) -> f64 {
        of_dimension(dimension, &MODIFIED_MOLLIFIER)
    }

    #[inline]
    fn value<T: Number>(_dimension: usize, q: T) -> T {
        of_bump(q, |exponential, u| exponential * integer_power(u, 8))
    }

    #[inline]
    fn derivative_over_q<T: Number>(_dimension: usize, q: T) -> T {
        of_bump(q, |exponential, u| exponential * integer_power(u, 6) * (u * 8.0 + 1.0) * -2.0)
    }

    #[inline]
    fn second_derivative<T: Number>(_dimension: usize, q: T) -> T {
        of_bump(q, |exponential, u| {
            let slope = u * u * (u * 8.0 + 1.0) * -2.0;
            let curvature = q * q * (u * (u * 56.0 + 14.0) + 1.0) * 4.0;
            exponential * integer_power(u, 4) * (slope + curvature)
        })
    }
}

fn of_dimension(dimension: usize, normalisations: &[f64; 3]) -> f64 {
    match dimension {
        1..=3 => normalisations[dimension - 1],
        _ => f64::NAN,
    }
}

/// Inverse integrals of a shape of support 1 over the unit ball of 1, 2 and 3 dimensions.
fn normalisations<K: KernelShape>() -> [f64; 3] {
    let surfaces = [2.0, 2.0 * PI, 4.0 * PI];
    std::array::from_fn(|k| {
        let radial = |q: f64| K::value(k + 1, q) * integer_power(q, k as u32);
        1.0 / (surfaces[k] * integral_over_unit_interval(radial))
    })
}

/// Integral from 0 to 1 by the double-exponential rule of Takahasi and Mori (1974).
///
/// For integrands that are smooth inside the interval its error is below rounding at this step.
fn integral_over_unit_interval(integrand: impl Fn(f64) -> f64) -> f64 {
    const STEP: f64 = 1.0 / 64.0;
    const POINTS_PER_SIDE: i32 = 256;
    (-POINTS_PER_SIDE..=POINTS_PER_SIDE)
        .map(|k| {
            let t = f64::from(k) * STEP;
            let (rising, falling) = (Number::exp(t), Number::exp(-t));
            // `exp(-2 x)` of `x = pi/2 sinh t`; the argument is `(1 + tanh x)/2`.
            let power = Number::exp(-0.5 * PI * (rising - falling));
            let sum = 1.0 + power;
            let slope = 0.5 * PI * (rising + falling) * power / (sum * sum);
            integrand(1.0 / sum) * slope * STEP
        })
        .sum()
}
