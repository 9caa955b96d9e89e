//! Exponentials, logarithms and powers.

use super::{Bits, ROUNDS, clamped, halves, rounded};
use crate::Number;

/// `ln 2` in two parts, of which a whole number times the first is exact.
const LN_2_HIGH: f64 = 6.931_471_803_691_238e-1;
const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10;
/// Between it and its negative exp is a normal number.
const ORDINARY: f64 = 700.0;
/// An exponent that makes a power of anything but 1 zero or infinite.
const MOST: f64 = 1e300;
/// Above it the digits of 1 are lost in a sum.
const FORGETS_ONE: f64 = 1e17;

/// `k` and `x - k ln 2`, by its two parts, of a bounded x.
#[inline(always)]
fn reduced<T: Bits>(x: T) -> [T; 3] {
    let k = rounded(x * std::f64::consts::LOG2_E);
    [k, x - k * LN_2_HIGH, k * LN_2_LOW]
}

/// `e^(high - low) - 1` less `high` of a reduced argument: `r c/(2 - c) - low`.
#[inline(always)]
fn above_first<T: Number>(high: T, low: T) -> T {
    let r = high - low;
    let t = r * r;
    let series = t * 4.138_136_797_057_238_5e-8 - 1.653_390_220_546_525_2e-6;
    let series = t * series + 6.613_756_321_437_934e-5;
    let series = t * series - 2.777_777_777_701_559_3e-3;
    let c = r - t * (t * series + 1.666_666_666_666_660_2e-1);
    r * c / (-c + 2.0) - low
}

/// `x 2^k` in two steps, as `2^k` alone may be too small or large.
#[inline(always)]
fn scaled<T: Bits>(x: T, k: T) -> T {
    let half = rounded(k * 0.5);
    x * half.two_to() * (k - half).two_to()
}

/// `e^x`: error below 0.9 units.
#[inline(always)]
pub fn exp<T: Bits>(x: T) -> T {
    exponential(x, T::zero())
}

/// `e^(x + rest)`, where the rest is below the digits of x.
#[inline(always)]
fn exponential<T: Bits>(x: T, rest: T) -> T {
    if T::surely(x.abs().below(ORDINARY)) {
        let [k, high, low] = reduced(x);
        return (above_first(high, low - rest) + high + 1.0) * k.two_to();
    }
    // From the lower bound on the result is less than half of the smallest number, where a rest may be large.
    let rest = T::select(x.abs().below(750.0), rest, T::zero());
    let [k, high, low] = reduced(clamped(x, -746.0, 710.0));
    let value = scaled(above_first(high, low - rest) + high + 1.0, k);
    T::select(x.at_most(x), value, x)
}

/// `e^x - 1`, with the digits of small x: error below 1.6 units.
#[inline(always)]
pub fn exp_m1<T: Bits>(x: T) -> T {
    if T::surely(x.abs().below(ORDINARY)) {
        let [k, high, low] = reduced(x);
        let power = k.two_to();
        return (above_first(high, low) + high) * power + (power - 1.0);
    }
    let [k, high, low] = reduced(clamped(x, -ORDINARY, 710.0));
    let less_one = above_first(high, low) + high;
    // 2^1024 does not exist: there the 1 is below all digits.
    let power = clamped(k, -1022.0, 1023.0).two_to();
    let value = less_one * power + (power - 1.0);
    let value = T::select(x.above(ORDINARY), scaled(less_one + 1.0, k), value);
    T::select(x.at_most(x), value, x)
}

/// `k` and `f` of a positive normal number `(1 + f) 2^k`.
#[inline(always)]
fn normal_taken_apart<T: Bits>(x: T) -> [T; 2] {
    [x.exponent(), x.mantissa() - 1.0]
}

/// As [`normal_taken_apart`], of smaller numbers, too: they are brought up by `2^54`.
#[inline(always)]
fn taken_apart<T: Bits>(x: T) -> [T; 2] {
    let tiny = x.below(f64::MIN_POSITIVE);
    let [k, f] = normal_taken_apart(T::select(tiny, x * 18_014_398_509_481_984.0, x));
    [T::select(tiny, k - 54.0, k), f]
}

/// `s` and `R` of `ln(1 + f) = f - f^2/2 + s (f^2/2 + R)`.
#[inline(always)]
fn rest_of_logarithm<T: Number>(f: T) -> [T; 2] {
    let s = f / (f + 2.0);
    let z = s * s;
    let w = z * z;
    let even = w
        * (w * (w * 1.531_383_769_920_937_3e-1 + 2.222_219_843_214_978_4e-1)
            + 3.999_999_999_940_942e-1);
    let odd = z
        * (w * (w * (w * 1.479_819_860_511_658_6e-1 + 1.818_357_216_161_805e-1)
            + 2.857_142_874_366_239e-1)
            + 6.666_666_666_666_735e-1);
    [s, even + odd]
}

/// `ln((1 + f) 2^k) + correction` with a small correction.
#[inline(always)]
fn logarithm<T: Number>([k, f]: [T; 2], correction: T) -> T {
    let [s, series] = rest_of_logarithm(f);
    let half = f * f * 0.5;
    let rest = s * (half + series) + (k * LN_2_LOW + correction);
    k * LN_2_HIGH - ((half - rest) - f)
}

/// Whether a number is positive, normal and finite.
#[inline(always)]
fn is_normal<T: Number>(x: T) -> T::Mask {
    T::from(f64::MIN_POSITIVE).at_most(x) & x.at_most(T::from(f64::MAX))
}

/// `ln x`: error below 0.9 units.
#[inline(always)]
pub fn ln<T: Bits>(x: T) -> T {
    if T::surely(is_normal(x)) {
        return logarithm(normal_taken_apart(x), T::zero());
    }
    limits(x, logarithm(taken_apart(x), T::zero()))
}

/// `ln(1 + x)`, with the digits of small x: error below 0.9 units.
#[inline(always)]
pub fn ln_1p<T: Bits>(x: T) -> T {
    let sum = x + 1.0;
    let parts = normal_taken_apart(sum);
    let lost = x - (sum - 1.0);
    if T::surely(x.above(-1.0) & x.below(FORGETS_ONE)) {
        return logarithm(parts, lost / sum);
    }
    let lost = T::select(x.below(FORGETS_ONE), lost, T::zero());
    limits(sum, logarithm(parts, lost / sum))
}

/// The logarithm of numbers that have none, and of infinity.
#[inline(always)]
fn limits<T: Number>(x: T, value: T) -> T {
    let value = T::select(x.above(f64::MAX), x, value);
    let value = T::select(x.at_most(T::zero()), T::from(f64::NEG_INFINITY), value);
    T::select(T::zero().at_most(x), value, T::from(f64::NAN))
}

/// `x^y`: error below `1 + |y ln x|/5` units. Of a negative x it is NaN unless y is a whole number below
/// `2^51`; a zero counts as positive.
#[inline(always)]
pub fn power<T: Bits>(x: T, y: T) -> T {
    if T::surely(is_normal(x) & y.abs().below(MOST)) {
        let [product, rest] = times_logarithm(normal_taken_apart(x), y);
        return exponential(product, rest);
    }
    let size = x.abs();
    let [product, rest] = times_logarithm(taken_apart(size), clamped(y, -MOST, MOST));
    let value = exponential(product, rest);
    let (zero, infinity) = (T::zero(), T::from(f64::INFINITY));
    let at_zero = T::select(y.below(0.0), infinity, zero);
    let value = T::select(size.at_most(zero), at_zero, value);
    let at_infinity = T::select(y.above(0.0), infinity, zero);
    let value = T::select(size.above(f64::MAX), at_infinity, value);
    let value = T::select(x.at_most(x) & y.at_most(y), value, T::from(f64::NAN));
    let value = T::select(y.abs().at_most(zero), T::one(), value);
    let is_whole = (y - rounded(y)).abs().at_most(zero) & y.abs().below(ROUNDS / 3.0);
    let half = y * 0.5;
    let is_even = (half - rounded(half)).abs().at_most(zero);
    let signed = T::select(is_even, value, -value);
    let signed = T::select(is_whole, signed, T::from(f64::NAN));
    T::select(x.below(0.0), signed, value)
}

/// `y ln((1 + f) 2^k)` as the sum of a number and what is below its digits.
#[inline(always)]
fn times_logarithm<T: Number>([k, f]: [T; 2], y: T) -> [T; 2] {
    let [s, series] = rest_of_logarithm(f);
    let [upper, lower] = halves(f);
    let square = upper * 0.5 * upper;
    let square_rest = lower * 0.5 * (f + upper);
    // What sums of large numbers lose goes to small ones.
    let whole = k * LN_2_HIGH;
    let part = f - square;
    let first = whole + part;
    let lost = ((f - part) - square) + (part - (first - whole));
    let rest = lost + (s * (square + square_rest + series) - square_rest + k * LN_2_LOW);
    // The first half of its digits times those of y is exact.
    let ([high, low], [first_half, second_half]) = (halves(y), halves(first));
    let product = high * first_half;
    let rest = low * first_half + y * (second_half + rest);
    let sum = product + rest;
    [sum, rest - (sum - product)]
}
