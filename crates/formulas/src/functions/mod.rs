//! Exponentials, logarithms, powers and circular functions, the same to the bit on every machine.
//!
//! The functions of the C library, of Rust and of a GPU differ in the last digit, and from one version to
//! the next. These consist of additions, multiplications, divisions and choices, which IEEE 754 rounds in
//! one way, and are written once, generic over the number: a processor runs them one by one or in
//! [lanes](crate::Lanes4), and a device gets them as text that was recorded from the same bodies. Series
//! and constants are those of fdlibm (Sun Microsystems, 1993).
//!
//! Errors in the doc comments are the largest that `crates/formulas/tests/functions/` finds among some
//! hundred thousand arguments, rounded up, in units of the last place of the exact result. That place is
//! of the size of a subnormal number where the result is one.

mod angle;
pub(crate) mod dual;
mod exponential;

pub use angle::{FARTHEST, atan2, cos, sin};
pub use exponential::{exp, exp_m1, ln, ln_1p, power};

use crate::Number;

/// A number that is taken apart into a power of two and the rest.
pub trait Bits: Number {
    /// `2^k` for a whole number k from -1022 to 1023.
    fn two_to(self) -> Self;

    /// `k` of a positive normal number `m 2^k` with m from the root of 1/2 up to that of 2.
    fn exponent(self) -> Self;

    /// `m` of it.
    fn mantissa(self) -> Self;

    /// Whether a mask holds for sure, so that a shorter way leads to the same bits.
    fn surely(mask: Self::Mask) -> bool;
}

/// The bits of the root of 1/2, or the largest number below it.
pub const ROOT_OF_HALF: u64 = 0x3fe6_a09e_667f_3bcc;
const EXPONENT_OF_ONE: u64 = 1023 << 52;
const FROM_ROOT: u64 = EXPONENT_OF_ONE - ROOT_OF_HALF;

// By numbers whose last binary digits are a whole number: conversions are slow, and not there for four
// numbers at once.
impl Bits for f64 {
    #[inline(always)]
    fn two_to(self) -> Self {
        Self::from_bits((self + (ROUNDS + 1023.0)).to_bits() << 52)
    }

    #[inline(always)]
    fn exponent(self) -> Self {
        const TWO_TO_52: f64 = 4_503_599_627_370_496.0;
        let biased = self.to_bits().wrapping_add(FROM_ROOT) >> 52;
        Self::from_bits(biased | TWO_TO_52.to_bits()) - (TWO_TO_52 + 1023.0)
    }

    #[inline(always)]
    fn mantissa(self) -> Self {
        let bits = self.to_bits();
        let biased = bits.wrapping_add(FROM_ROOT) & (4095 << 52);
        Self::from_bits(bits.wrapping_sub(biased).wrapping_add(EXPONENT_OF_ONE))
    }

    #[inline(always)]
    fn surely(mask: bool) -> bool {
        mask
    }
}

/// Added and taken away again it leaves a whole number, of numbers below `2^51`.
const ROUNDS: f64 = 6_755_399_441_055_744.0;

/// The whole number next to one below `2^51`.
#[inline(always)]
fn rounded<T: Number>(x: T) -> T {
    (x + ROUNDS) - ROUNDS
}

/// A number between two bounds, the lower one for NaN.
#[inline(always)]
fn clamped<T: Number>(x: T, low: f64, high: f64) -> T {
    let x = T::select(x.above(low), x, T::from(low));
    T::select(x.below(high), x, T::from(high))
}

/// A number as the sum of two of half as many digits, of which products are exact.
#[inline(always)]
fn halves<T: Number>(x: T) -> [T; 2] {
    let wide = x * 134_217_729.0;
    let high = wide - (wide - x);
    [high, x - high]
}

/// Compiled once: a plain number calls these, as it would call those of a library.
pub(crate) mod plain {
    macro_rules! compiled {
        ($($name:ident($($x:ident),*);)*) => {$(
            #[inline(never)]
            pub fn $name($($x: f64),*) -> f64 {
                super::$name($($x),*)
            }
        )*};
    }
    compiled! {
        exp(x);
        exp_m1(x);
        ln(x);
        ln_1p(x);
        power(x, y);
        sin(x);
        cos(x);
        atan2(y, x);
    }
}
