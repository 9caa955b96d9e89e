//! Functions of numbers with derivatives, by Taylor series around their real parts.
//!
//! A series ends with the derivatives that a number carries, powers of the distance from the real part
//! being zero from then on. The value is that of the plain function to the bit: all other terms add zero,
//! unless a derivative is infinite, of which no number comes.

use num_dual::{DualNum, DualStruct};

use super::plain;

/// What carries derivatives, or none.
pub(crate) trait Differentiable: DualNum<Primitive = f64> + Copy {}

impl<T: DualNum<Primitive = f64> + Copy> Differentiable for T {}

/// `f(x)` from the value of f, the coefficients of its series in order, each of its order, and f as it is
/// where there is no series: where the value is infinite or no number.
#[inline(always)]
fn series<T: Differentiable, F: FnMut(f64) -> f64>(
    x: T,
    value: impl Fn(f64) -> f64,
    coefficients: impl Fn(f64, f64) -> F,
    of_library: impl Fn(&T) -> T,
) -> T {
    let re = DualStruct::re(&x);
    let value = value(re);
    if T::NDERIV == 0 {
        return T::from(value);
    }
    if !value.is_finite() {
        let other = of_library(&x);
        return if DualStruct::re(&other) == value { other } else { T::from(value) };
    }
    if !re.is_finite() {
        return T::from(value);
    }
    sum(value, x - re, coefficients(value, re))
}

#[inline(always)]
fn sum<T: Differentiable>(value: f64, distance: T, mut coefficient: impl FnMut(f64) -> f64) -> T {
    let (mut sum, mut power) = (T::from(value), distance);
    for order in 1..=T::NDERIV {
        sum += power * coefficient(order as f64);
        power *= distance;
    }
    sum
}

#[inline(always)]
pub(crate) fn exp<T: Differentiable>(x: T) -> T {
    series(x, plain::exp, |value, _| falling(value), T::exp)
}

#[inline(always)]
pub(crate) fn exp_m1<T: Differentiable>(x: T) -> T {
    series(x, plain::exp_m1, |_, re| falling(plain::exp(re)), T::exp_m1)
}

/// `c/k!`.
fn falling(mut term: f64) -> impl FnMut(f64) -> f64 {
    move |order| {
        term /= order;
        term
    }
}

#[inline(always)]
pub(crate) fn ln<T: Differentiable>(x: T) -> T {
    series(x, plain::ln, |_, re| of_logarithm(re), T::ln)
}

#[inline(always)]
pub(crate) fn ln_1p<T: Differentiable>(x: T) -> T {
    series(x, plain::ln_1p, |_, re| of_logarithm(re + 1.0), T::ln_1p)
}

/// `-(-1/x)^k/k`.
fn of_logarithm(x: f64) -> impl FnMut(f64) -> f64 {
    let mut term = -1.0;
    move |order| {
        term /= -x;
        term / order
    }
}

#[inline(always)]
pub(crate) fn power<T: Differentiable>(x: T, exponent: f64) -> T {
    let coefficients = |value: f64, re: f64| {
        let (mut binomial, mut power) = (1.0, value);
        move |order: f64| {
            binomial *= (exponent - (order - 1.0)) / order;
            power = if re == 0.0 { plain::power(re, exponent - order) } else { power / re };
            if binomial == 0.0 { 0.0 } else { binomial * power }
        }
    };
    series(x, |re| plain::power(re, exponent), coefficients, |x| x.powf(exponent))
}

#[inline(always)]
pub(crate) fn sin<T: Differentiable>(x: T) -> T {
    series(x, plain::sin, |value, re| turning(value, plain::cos(re)), T::sin)
}

#[inline(always)]
pub(crate) fn cos<T: Differentiable>(x: T) -> T {
    series(x, plain::cos, |value, re| turning(value, -plain::sin(re)), T::cos)
}

/// What follows in the series of a circular function after a value with a slope.
fn turning(mut value: f64, mut slope: f64) -> impl FnMut(f64) -> f64 {
    move |order| {
        (value, slope) = (slope / order, -value / order);
        value
    }
}

/// The angle between a point and its real part is the arc tangent of a ratio of zero value.
#[inline(always)]
pub(crate) fn atan2<T: Differentiable>(y: T, x: T) -> T {
    let (up, along) = (DualStruct::re(&y), DualStruct::re(&x));
    let value = plain::atan2(up, along);
    let size = up.abs().max(along.abs());
    if T::NDERIV == 0 {
        return T::from(value);
    }
    if !(size > 0.0 && size.is_finite()) {
        return y.atan2(x);
    }
    let (sine, cosine) = (up / size, along / size);
    let ratio = ((y - up) * cosine - (x - along) * sine) / (x * cosine + y * sine);
    let mut sign = -1.0;
    sum(value, ratio, |order| {
        if order % 2.0 == 0.0 {
            return 0.0;
        }
        sign = -sign;
        sign / order
    })
}
