//! The functions in whole numbers of many digits.

use num_bigint::BigInt;
use num_traits::{Signed, ToPrimitive, Zero};

/// Binary digits after the point: numbers down to `2^-70` keep twice those of double precision.
const POINT: u64 = 192;

/// `number 2^(power - POINT)`.
pub struct Exact {
    number: BigInt,
    power: i64,
}

impl Exact {
    fn fixed(number: BigInt) -> Self {
        Self { number, power: 0 }
    }

    /// Distance of a number from this one in units of the last place of this one.
    pub fn units(&self, got: f64) -> f64 {
        let (mantissa, exponent) = parts(got);
        let got = shifted(mantissa, exponent - self.power + POINT as i64);
        let size = self.number.bits() as i64 - 1 + self.power - POINT as i64;
        let unit = (size - 52).max(-1074);
        let difference = (got - &self.number).abs().to_f64().unwrap();
        difference * 2.0_f64.powi((self.power - POINT as i64 - unit) as i32)
    }
}

/// `m` and `e` of a number `m 2^e`.
fn parts(x: f64) -> (BigInt, i64) {
    let biased = ((x.to_bits() >> 52) & 2047) as i64;
    let digits = (x.to_bits() & ((1 << 52) - 1)) as i64;
    let mantissa = if biased == 0 { digits } else { digits | 1 << 52 };
    (BigInt::from(if x < 0.0 { -mantissa } else { mantissa }), biased.max(1) - 1075)
}

fn shifted(x: BigInt, by: i64) -> BigInt {
    if by >= 0 { x << by as u64 } else { x >> by.unsigned_abs() }
}

fn of(x: f64) -> BigInt {
    let (mantissa, exponent) = parts(x);
    shifted(mantissa, exponent + POINT as i64)
}

fn one() -> BigInt {
    BigInt::from(1) << POINT
}

fn times(a: &BigInt, b: &BigInt) -> BigInt {
    (a * b) >> POINT
}

fn over(a: &BigInt, b: &BigInt) -> BigInt {
    (a << POINT) / b
}

/// `sum_k term_k` until terms are zero.
fn sum(mut term: BigInt, next: impl Fn(&BigInt, i64) -> BigInt) -> BigInt {
    let (mut total, mut k) = (BigInt::zero(), 0);
    while !term.is_zero() && term != BigInt::from(-1) {
        total += &term;
        k += 1;
        term = next(&term, k);
    }
    total
}

/// `x - s x^3/3 + x^5/5 - ...`: arc tangent for s 1, its hyperbolic one for s -1.
fn odd_series(x: &BigInt, sign: i64) -> BigInt {
    let square = times(x, x) * -sign;
    let (mut power, mut total, mut k) = (x.clone(), BigInt::zero(), 1);
    while !power.is_zero() && power != BigInt::from(-1) {
        total += &power / k;
        power = times(&power, &square);
        k += 2;
    }
    total
}

fn reciprocal(x: i64) -> BigInt {
    one() / x
}

fn ln_2() -> BigInt {
    odd_series(&reciprocal(3), -1) * 2
}

pub fn pi() -> BigInt {
    (odd_series(&reciprocal(5), 1) * 4 - odd_series(&reciprocal(239), 1)) * 4
}

/// The whole number next to a quotient and the rest.
fn reduced(x: &BigInt, by: &BigInt) -> (i64, BigInt) {
    let count: BigInt = (x + by / 2) / by;
    let count = count.to_i64().unwrap();
    (count, x - by * count)
}

fn exp_of(x: &BigInt) -> Exact {
    let (power, rest) = reduced(x, &ln_2());
    Exact { number: sum(one(), |term, k| times(term, &rest) / k), power }
}

pub fn exp(x: f64) -> Exact {
    exp_of(&of(x))
}

pub fn exp_m1(x: f64) -> Exact {
    let Exact { number, power } = exp(x);
    Exact::fixed(shifted(number, power) - one())
}

/// `ln(number 2^-POINT)`.
fn ln_of(number: &BigInt) -> BigInt {
    let power = number.bits() as i64 - 1 - POINT as i64;
    let mantissa = shifted(number.clone(), -power);
    odd_series(&over(&(&mantissa - one()), &(&mantissa + one())), -1) * 2 + ln_2() * power
}

fn ln_fixed(x: f64) -> BigInt {
    let (mantissa, exponent) = parts(x);
    ln_of(&(mantissa << POINT)) + ln_2() * exponent
}

pub fn ln(x: f64) -> Exact {
    Exact::fixed(ln_fixed(x))
}

pub fn ln_1p(x: f64) -> Exact {
    Exact::fixed(ln_of(&(of(x) + one())))
}

pub fn power(x: f64, y: f64) -> Exact {
    let (mantissa, exponent) = parts(y);
    exp_of(&shifted(mantissa * ln_fixed(x), exponent))
}

/// `sin(x + quarters pi/2)`.
pub fn sin(x: f64, quarters: i64) -> Exact {
    let (count, rest) = reduced(&of(x), &(pi() / 2));
    let square = -times(&rest, &rest);
    let quarter = (count + quarters).rem_euclid(4);
    let odd = quarter % 2;
    let first = if odd == 1 { one() } else { rest };
    let value = sum(first, |term, k| times(term, &square) / ((2 * k - odd) * (2 * k + 1 - odd)));
    Exact::fixed(if quarter < 2 { value } else { -value })
}

pub fn atan2(y: f64, x: f64) -> Exact {
    let [up, along] = [y, x].map(|x| of(x.abs()));
    let steep = up > along;
    let mut tangent = if steep { over(&along, &up) } else { over(&up, &along) };
    // Of a fourth of the angle.
    for _ in 0..2 {
        let root = ((times(&tangent, &tangent) + one()) << POINT).sqrt();
        tangent = over(&tangent, &(one() + root));
    }
    let angle: BigInt = odd_series(&tangent, 1) * 4;
    let angle = if steep { pi() / 2 - angle } else { angle };
    let angle = if x < 0.0 { pi() - angle } else { angle };
    Exact::fixed(if y < 0.0 { -angle } else { angle })
}
