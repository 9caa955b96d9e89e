//! Numbers with their first derivative, of any number type.

use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};

use crate::Number;

/// A number with its derivative by one variable.
///
/// Unlike the dual numbers of `num-dual` it is made of any [`Number`], so that derivatives can be recorded for a device,
/// with the bits that a processor finds.
///
/// ```
/// use piola_formulas::{Number, Slope};
///
/// let x = Slope::variable(2.0_f64);
/// let y = x * x * 3.0 + Number::recip(x);
/// assert_eq!((y.value, y.slope), (12.5, 11.75));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slope<T> {
    /// The number.
    pub value: T,
    /// Its derivative.
    pub slope: T,
}

impl<T: Number> Slope<T> {
    /// The variable itself.
    #[inline(always)]
    pub fn variable(value: T) -> Self {
        Self { value, slope: T::one() }
    }

    /// What does not depend on the variable.
    #[inline(always)]
    pub fn constant(value: T) -> Self {
        Self { value, slope: T::zero() }
    }

    /// A function of it, with its value and its derivative.
    #[inline(always)]
    fn chain(self, value: T, derivative: T) -> Self {
        Self { value, slope: self.slope * derivative }
    }
}

impl<T: Number> From<f64> for Slope<T> {
    #[inline(always)]
    fn from(value: f64) -> Self {
        Self::constant(T::from(value))
    }
}

impl<T: Number> Zero for Slope<T> {
    #[inline(always)]
    fn zero() -> Self {
        Self::constant(T::zero())
    }

    #[inline(always)]
    fn is_zero(&self) -> bool {
        self.value.is_zero() && self.slope.is_zero()
    }
}

impl<T: Number> One for Slope<T> {
    #[inline(always)]
    fn one() -> Self {
        Self::constant(T::one())
    }
}

impl<T: Number> Neg for Slope<T> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, slope: -self.slope }
    }
}

impl<T: Number> Slope<T> {
    /// The slope of `a b`.
    #[inline(always)]
    fn product(a: Self, b: Self, _: T) -> T {
        a.slope * b.value + b.slope * a.value
    }

    /// That of `a / b`, which has this value.
    #[inline(always)]
    fn quotient(a: Self, b: Self, value: T) -> T {
        (a.slope - value * b.slope) / b.value
    }
}

/// An operation with its assignment, and that with a constant, by what it does to values and to slopes.
macro_rules! operation {
    ($trait:ident $method:ident $assign:ident $assign_method:ident $operator:tt, $slope:expr, $of_constant:expr) => {
        impl<T: Number> $trait for Slope<T> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let value = self.value $operator other.value;
                let slope: fn(Self, Self, T) -> T = $slope;
                Self { value, slope: slope(self, other, value) }
            }
        }

        impl<T: Number> $trait<f64> for Slope<T> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                let slope: fn(T, f64) -> T = $of_constant;
                Self { value: self.value $operator other, slope: slope(self.slope, other) }
            }
        }

        impl<T: Number> $assign for Slope<T> {
            #[inline(always)]
            fn $assign_method(&mut self, other: Self) {
                *self = *self $operator other;
            }
        }
    };
}

operation!(Add add AddAssign add_assign +, |a, b, _| a.slope + b.slope, |slope, _| slope);
operation!(Sub sub SubAssign sub_assign -, |a, b, _| a.slope - b.slope, |slope, _| slope);
operation!(Mul mul MulAssign mul_assign *, Self::product, |slope, by| slope * by);
operation!(Div div DivAssign div_assign /, Self::quotient, |slope, by| slope / by);

impl<T: Number> Number for Slope<T> {
    type Mask = T::Mask;
    type Real = T::Real;

    #[inline(always)]
    fn re(self) -> T::Real {
        self.value.re()
    }

    #[inline(always)]
    fn lift(real: T::Real) -> Self {
        Self::constant(T::lift(real))
    }

    #[inline(always)]
    fn less(self, other: Self) -> T::Mask {
        self.value.less(other.value)
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> T::Mask {
        self.value.at_most(other.value)
    }

    #[inline(always)]
    fn select(mask: T::Mask, yes: Self, no: Self) -> Self {
        Self {
            value: T::select(mask, yes.value, no.value),
            slope: T::select(mask, yes.slope, no.slope),
        }
    }

    /// All steps are gone through: of those after the end nothing is kept.
    fn repeat<const N: usize>(
        most: u32,
        mut state: [Self; N],
        until: impl Fn(&[Self; N]) -> T::Mask,
        step: impl Fn([Self; N]) -> [Self; N],
    ) -> [Self; N] {
        for _ in 0..most {
            let (done, next) = (until(&state), step(state));
            state = std::array::from_fn(|k| Self::select(done, state[k], next[k]));
        }
        state
    }

    #[inline(always)]
    fn recip(self) -> Self {
        let value = self.value.recip();
        self.chain(value, -(value * value))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self::select(self.value.below(0.0), -self, self)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let value = self.value.sqrt();
        self.chain(value, value.recip() * 0.5)
    }

    #[inline(always)]
    fn exp(self) -> Self {
        let value = self.value.exp();
        self.chain(value, value)
    }

    #[inline(always)]
    fn exp_m1(self) -> Self {
        self.chain(self.value.exp_m1(), self.value.exp())
    }

    #[inline(always)]
    fn ln(self) -> Self {
        self.chain(self.value.ln(), self.value.recip())
    }

    #[inline(always)]
    fn ln_1p(self) -> Self {
        self.chain(self.value.ln_1p(), (self.value + 1.0).recip())
    }

    #[inline(always)]
    fn powf(self, exponent: f64) -> Self {
        self.chain(self.value.powf(exponent), self.value.powf(exponent - 1.0) * exponent)
    }

    #[inline(always)]
    fn sin(self) -> Self {
        self.chain(self.value.sin(), self.value.cos())
    }

    #[inline(always)]
    fn cos(self) -> Self {
        self.chain(self.value.cos(), -self.value.sin())
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        let square = self.value * self.value + x.value * x.value;
        let slope = (x.value * self.slope - self.value * x.slope) / square;
        Self { value: self.value.atan2(x.value), slope }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_dual::Dual64;

    /// Every function and operation against the dual numbers of a library.
    #[test]
    fn derivatives_are_those_of_dual_numbers() {
        fn all<T: Number>(x: T) -> [T; 15] {
            let y = x * x - 0.25;
            let with = |f: fn(T) -> T| f(y) + x;
            let mut product = y;
            product *= x;
            product /= y + 2.0;
            product -= x;
            [
                x / y - y / 3.0,
                with(T::recip),
                (-y).abs(),
                with(T::sqrt),
                with(T::exp),
                with(T::exp_m1),
                with(T::ln),
                with(T::ln_1p),
                y.powf(1.7),
                with(T::sin),
                with(T::cos),
                y.atan2(x),
                x.atan2(-y),
                T::select(x.below(1.0), x * 2.0, y),
                product,
            ]
        }
        for x in [0.7, 1.3, 2.9] {
            let expected = all(Dual64::from_re(x).derivative());
            for (k, (got, expected)) in all(Slope::variable(x)).iter().zip(expected).enumerate() {
                let close = |a: f64, b: f64| (a - b).abs() <= 8.0 * f64::EPSILON * (1.0 + b.abs());
                assert!(close(got.value, expected.re), "value {k} at {x}");
                assert!(close(got.slope, expected.eps), "slope {k} at {x}");
            }
        }
    }

    #[test]
    fn a_repetition_ends_where_its_condition_holds() {
        // x/8 by halving until it is below 1, from 5.
        let halve = |[x]: [Slope<f64>; 1]| [x * 0.5];
        let [x] = Slope::repeat(9, [Slope::variable(5.0)], |[x]| x.below(1.0), halve);
        assert_eq!((x.value, x.slope), (0.625, 0.125));
    }
}
