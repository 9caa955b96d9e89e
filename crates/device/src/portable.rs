//! Exponentials and logarithms of basic operations alone, the same to the bit on every machine.
//!
//! The functions of the C library, of Rust and of a GPU differ in the last digit. These are written
//! once, generic over the number: a processor runs them through [`Portable`], and a device gets them as
//! text that was recorded from the same bodies. Series and constants are those of fdlibm (Sun
//! Microsystems, 1993): errors below 1 unit in the last place for exp and ln, 2 for the two that keep the
//! digits of small arguments, `2 + 3 |y ln x|` for `x^y`. Sine, cosine and arc tangent are those of the
//! machine.

use piola_formulas::Number;

use crate::operators::operators;

/// A number that is taken apart into a power of two and the rest.
pub trait Bits: Number {
    /// `2^k` for a whole number k from -1022 to 1023.
    fn two_to(self) -> Self;

    /// `k` of a positive normal number `m 2^k`, `1 <= m < 2`.
    fn exponent(self) -> Self;

    /// `m` of it.
    fn mantissa(self) -> Self;
}

impl Bits for f64 {
    #[inline]
    fn two_to(self) -> Self {
        Self::from_bits(((self as i64 + 1023) as u64) << 52)
    }

    #[inline]
    fn exponent(self) -> Self {
        (((self.to_bits() >> 52) & 2047) as i64 - 1023) as Self
    }

    #[inline]
    fn mantissa(self) -> Self {
        Self::from_bits((self.to_bits() & ((1 << 52) - 1)) | (1023 << 52))
    }
}

const LN_2_HIGH: f64 = 6.931_471_803_691_238e-1;
const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10;
/// Added and taken away again it leaves a whole number.
const ROUNDS: f64 = 6_755_399_441_055_744.0;
/// Above it exp overflows, below the negative of the second it is zero.
const LARGEST: f64 = 709.782_712_893_384;
const SMALLEST: f64 = -745.133_219_101_941_2;

/// A number between two bounds; NaN stays.
fn clamped<T: Number>(x: T, low: f64, high: f64) -> T {
    let x = T::select(x.below(low), T::from(low), x);
    T::select(x.above(high), T::from(high), x)
}

/// `k` and `x - k ln 2`, by its two parts, of a bounded x.
fn reduced<T: Bits>(x: T) -> (T, T, T) {
    let k = (x * std::f64::consts::LOG2_E + ROUNDS) - ROUNDS;
    (k, x - k * LN_2_HIGH, k * LN_2_LOW)
}

/// What the exponential of a reduced argument is made of: `r c / (2 - c)`.
fn quotient<T: Bits>(r: T) -> T {
    let t = r * r;
    let series = t * 4.138_136_797_057_238_5e-8 - 1.653_390_220_546_525_2e-6;
    let series = t * series + 6.613_756_321_437_934e-5;
    let series = t * series - 2.777_777_777_701_559_3e-3;
    let c = r - t * (t * series + 1.666_666_666_666_660_2e-1);
    r * c / (-c + 2.0)
}

/// `x 2^k` in two steps, as `2^k` alone may be too small or large.
fn scaled<T: Bits>(x: T, k: T) -> T {
    let half = (k * 0.5 + ROUNDS) - ROUNDS;
    x * half.two_to() * (k - half).two_to()
}

/// `e^x`.
pub(crate) fn exp<T: Bits>(x: T) -> T {
    let bounded = clamped(x, -746.0, 710.0);
    // No whole number comes of NaN; what follows is not used then.
    let bounded = T::select(bounded.at_most(bounded), bounded, T::zero());
    let (k, high, low) = reduced(bounded);
    let r = high - low;
    let value = -((low - quotient(r)) - high) + 1.0;
    let value = scaled(value, k);
    let value = T::select(x.above(LARGEST), T::from(f64::INFINITY), value);
    let value = T::select(x.below(SMALLEST), T::zero(), value);
    T::select(x.at_most(x), value, x)
}

/// `e^x - 1`.
pub(crate) fn exp_m1<T: Bits>(x: T) -> T {
    let bounded = clamped(x, -40.0, 710.0);
    let bounded = T::select(bounded.at_most(bounded), bounded, T::zero());
    let (k, high, low) = reduced(bounded);
    let r = high - low;
    // e^r - 1 by its first two terms and a series, all of the size of r.
    let t = r * r;
    let mut series = T::from(1.0 / 6_227_020_800.0);
    for factorial in [479_001_600.0, 39_916_800.0, 3_628_800.0, 362_880.0, 40_320.0, 5_040.0, 720.0]
    {
        series = series * r + 1.0 / factorial;
    }
    for factorial in [120.0, 24.0, 6.0] {
        series = series * r + 1.0 / factorial;
    }
    let less_one = high + (t * 0.5 + (t * r * series - low));
    let power = clamped(k, -1022.0, 1023.0).two_to();
    let value = less_one * power + (power - 1.0);
    // 2^1024 does not exist: there the 1 is below all digits.
    let value = T::select(k.above(1023.0), scaled(less_one + 1.0, k), value);
    let value = T::select(x.above(LARGEST), T::from(f64::INFINITY), value);
    T::select(x.at_most(x), value, x)
}

/// `ln(m 2^k) + correction` of a number and a small correction.
fn logarithm<T: Bits>(x: T, correction: T) -> T {
    let (k, m) = (x.exponent(), x.mantissa());
    let upper = m.above(std::f64::consts::SQRT_2);
    let k = T::select(upper, k + 1.0, k);
    let f = T::select(upper, m * 0.5, m) - 1.0;
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
    let half = f * f * 0.5;
    let rest = s * (half + (even + odd)) + (k * LN_2_LOW + correction);
    k * LN_2_HIGH - ((half - rest) - f)
}

/// `ln x`.
pub(crate) fn ln<T: Bits>(x: T) -> T {
    // Numbers below the smallest normal one are brought up by 2^54.
    let tiny = x.below(f64::MIN_POSITIVE);
    let normal = T::select(tiny, x * 18_014_398_509_481_984.0, x);
    let value = logarithm(normal, T::zero());
    let value = value - T::select(tiny, T::from(54.0 * std::f64::consts::LN_2), T::zero());
    limits(x, value)
}

/// `ln(1 + x)`.
pub(crate) fn ln_1p<T: Bits>(x: T) -> T {
    let sum = x + 1.0;
    // What the sum has lost, over the sum.
    let lost = x - (sum - 1.0);
    let correction = T::select(x.abs().below(1e15), lost / sum, T::zero());
    let value = logarithm(sum, correction);
    T::select(x.abs().below(1e-16), x, limits(sum, value))
}

/// The logarithm of numbers that have none, and of infinity.
fn limits<T: Number>(x: T, value: T) -> T {
    let value = T::select(x.above(f64::MAX), x, value);
    let value = T::select(x.at_most(T::zero()), T::from(f64::NEG_INFINITY), value);
    let value = T::select(x.below(0.0), T::from(f64::NAN), value);
    T::select(x.at_most(x), value, x)
}

/// `x^y` of an x that is not negative.
pub(crate) fn power<T: Bits>(x: T, y: T) -> T {
    exp(y * ln(x))
}

/// A double precision number that has the exponentials and logarithms of this module, and so those of
/// the emitted text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Portable(pub f64);

impl Portable {
    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }

    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }

    #[inline(always)]
    fn times(self, other: Self) -> Self {
        Self(self.0 * other.0)
    }

    #[inline(always)]
    fn over(self, other: Self) -> Self {
        Self(self.0 / other.0)
    }

    #[inline(always)]
    fn negated(self) -> Self {
        Self(-self.0)
    }

    #[inline(always)]
    fn is_zero_constant(self) -> bool {
        self.0 == 0.0
    }
}

operators!(Portable);

impl From<f64> for Portable {
    #[inline(always)]
    fn from(value: f64) -> Self {
        Self(value)
    }
}

impl Number for Portable {
    type Mask = bool;
    type Real = Self;

    #[inline(always)]
    fn re(self) -> Self {
        self
    }

    #[inline(always)]
    fn lift(real: Self) -> Self {
        real
    }

    #[inline(always)]
    fn less(self, other: Self) -> bool {
        self.0 < other.0
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> bool {
        self.0 <= other.0
    }

    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }

    #[inline(always)]
    fn choose(mask: bool, yes: impl FnOnce() -> Self, no: impl FnOnce() -> Self) -> Self {
        if mask { yes() } else { no() }
    }

    fn repeat<const N: usize>(
        most: u32,
        state: [Self; N],
        until: impl Fn(&[Self; N]) -> bool,
        step: impl Fn([Self; N]) -> [Self; N],
    ) -> [Self; N] {
        let portable = |state: [f64; N]| state.map(Self);
        let state = <f64 as Number>::repeat(
            most,
            state.map(|number| number.0),
            |state| until(&portable(*state)),
            |state| step(portable(state)).map(|number| number.0),
        );
        portable(state)
    }

    #[inline(always)]
    fn recip(self) -> Self {
        Self(1.0 / self.0)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs())
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    fn exp(self) -> Self {
        Self(exp(self.0))
    }

    fn exp_m1(self) -> Self {
        Self(exp_m1(self.0))
    }

    fn ln(self) -> Self {
        Self(ln(self.0))
    }

    fn ln_1p(self) -> Self {
        Self(ln_1p(self.0))
    }

    fn powf(self, exponent: f64) -> Self {
        Self(power(self.0, exponent))
    }

    fn sin(self) -> Self {
        Self(self.0.sin())
    }

    fn cos(self) -> Self {
        Self(self.0.cos())
    }

    fn atan2(self, x: Self) -> Self {
        Self(self.0.atan2(x.0))
    }
}
