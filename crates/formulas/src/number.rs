//! The number types of all formulas.

use std::fmt::Debug;
use std::ops::{
    Add, AddAssign, BitAnd, BitOr, Div, DivAssign, Mul, MulAssign, Neg, Not, Sub, SubAssign,
};

use num_dual::DualNum;
use num_traits::{One, Zero};

use crate::functions::dual;

/// A number that a formula computes with: `f64`, a dual number that carries exact derivatives, or a
/// number that records what is done to it.
///
/// A formula never looks at a value in an `if`: comparisons give a [`Mask`](Number::Mask), by which
/// [`select`](Number::select) and [`choose`](Number::choose) pick a result. What does not depend on
/// numbers, such as a law's parameters, may branch. Numbers with derivatives are compared by their
/// real parts.
pub trait Number:
    nalgebra::Scalar
    + Copy
    + Zero
    + One
    + From<f64>
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
{
    /// The outcome of a comparison.
    type Mask: Copy
        + Debug
        + BitAnd<Output = Self::Mask>
        + BitOr<Output = Self::Mask>
        + Not<Output = Self::Mask>;

    /// The same number without derivatives.
    type Real: Number<Real = Self::Real, Mask = Self::Mask>;

    /// Its real part.
    fn re(self) -> Self::Real;

    /// A number without derivatives as one of these.
    fn lift(real: Self::Real) -> Self;

    /// Whether it is below another.
    fn less(self, other: Self) -> Self::Mask;

    /// Whether it is below another or equal.
    fn at_most(self, other: Self) -> Self::Mask;

    /// Whether it is below a constant.
    #[inline(always)]
    fn below(self, bound: f64) -> Self::Mask {
        self.less(Self::from(bound))
    }

    /// Whether it is above a constant.
    #[inline(always)]
    fn above(self, bound: f64) -> Self::Mask {
        Self::from(bound).less(self)
    }

    /// `yes` where the mask holds, `no` elsewhere.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// As [`select`](Number::select), for results of which a plain number computes only the one that is
    /// wanted: where one is expensive. A loop over it is not turned into vector operations.
    #[inline(always)]
    fn choose(mask: Self::Mask, yes: impl FnOnce() -> Self, no: impl FnOnce() -> Self) -> Self {
        Self::select(mask, yes(), no())
    }

    /// Repeats a step on some numbers until a condition holds, and at most this many times.
    fn repeat<const N: usize>(
        most: u32,
        state: [Self; N],
        until: impl Fn(&[Self; N]) -> Self::Mask,
        step: impl Fn([Self; N]) -> [Self; N],
    ) -> [Self; N];

    /// `1/x`.
    fn recip(self) -> Self;

    /// `|x|`.
    fn abs(self) -> Self;

    /// Square root.
    fn sqrt(self) -> Self;

    /// `e^x`.
    fn exp(self) -> Self;

    /// `e^x - 1`, with the digits of small x.
    fn exp_m1(self) -> Self;

    /// Natural logarithm.
    fn ln(self) -> Self;

    /// `ln(1 + x)`, with the digits of small x.
    fn ln_1p(self) -> Self;

    /// `x^exponent`.
    fn powf(self, exponent: f64) -> Self;

    /// Sine.
    fn sin(self) -> Self;

    /// Cosine.
    fn cos(self) -> Self;

    /// Angle of the point `(x, self)` with the first axis.
    fn atan2(self, x: Self) -> Self;
}

/// A [`Number`] whose real part is a plain number, at which a program may look: `f64` and dual numbers.
pub trait Scalar: Number<Mask = bool, Real = f64> {}

impl<T: Number<Mask = bool, Real = f64>> Scalar for T {}

impl<T: DualNum<Primitive = f64> + nalgebra::Scalar + Copy> Number for T {
    type Mask = bool;
    type Real = f64;

    #[inline(always)]
    fn re(self) -> f64 {
        num_dual::DualStruct::re(&self)
    }

    #[inline(always)]
    fn lift(real: f64) -> Self {
        Self::from(real)
    }

    #[inline(always)]
    fn less(self, other: Self) -> bool {
        Number::re(self) < Number::re(other)
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> bool {
        Number::re(self) <= Number::re(other)
    }

    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }

    #[inline(always)]
    fn choose(mask: bool, yes: impl FnOnce() -> Self, no: impl FnOnce() -> Self) -> Self {
        if mask { yes() } else { no() }
    }

    #[inline(always)]
    fn repeat<const N: usize>(
        most: u32,
        mut state: [Self; N],
        until: impl Fn(&[Self; N]) -> bool,
        step: impl Fn([Self; N]) -> [Self; N],
    ) -> [Self; N] {
        for _ in 0..most {
            if until(&state) {
                break;
            }
            state = step(state);
        }
        state
    }

    #[inline(always)]
    fn recip(self) -> Self {
        DualNum::recip(&self)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        num_traits::Signed::abs(&self)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        DualNum::sqrt(&self)
    }

    #[inline(always)]
    fn exp(self) -> Self {
        dual::exp(self)
    }

    #[inline(always)]
    fn exp_m1(self) -> Self {
        dual::exp_m1(self)
    }

    #[inline(always)]
    fn ln(self) -> Self {
        dual::ln(self)
    }

    #[inline(always)]
    fn ln_1p(self) -> Self {
        dual::ln_1p(self)
    }

    #[inline(always)]
    fn powf(self, exponent: f64) -> Self {
        dual::power(self, exponent)
    }

    #[inline(always)]
    fn sin(self) -> Self {
        dual::sin(self)
    }

    #[inline(always)]
    fn cos(self) -> Self {
        dual::cos(self)
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        dual::atan2(self, x)
    }
}
