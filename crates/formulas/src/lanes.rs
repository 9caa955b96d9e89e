//! Four numbers at once.

use std::ops::{
    Add, AddAssign, BitAnd, BitOr, Div, DivAssign, Mul, MulAssign, Neg, Not, Sub, SubAssign,
};

use num_traits::{One, Zero};

use crate::Number;
use crate::functions::{self, Bits};

/// Numbers in a vector register.
pub const WIDTH: usize = 4;

/// A [`Number`] of several independent ones, of which loops over neighbours are made.
pub trait Lanes: Number {
    /// Its numbers, lane by lane.
    fn load(numbers: [f64; WIDTH]) -> Self;

    /// The numbers of its lanes.
    fn store(self) -> [f64; WIDTH];
}

/// Four independent numbers, a lane each.
///
/// It is aligned as a register is: loops over numbers that are not take up to half as long again,
/// depending on where the stack happens to lie. All its methods are always inlined, so that they are
/// compiled for the instructions of the loop that calls them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(32))]
pub struct Lanes4([f64; WIDTH]);

/// The outcome of four comparisons.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mask4([bool; WIDTH]);

impl Lanes for Lanes4 {
    #[inline(always)]
    fn load(numbers: [f64; WIDTH]) -> Self {
        Self(numbers)
    }

    #[inline(always)]
    fn store(self) -> [f64; WIDTH] {
        self.0
    }
}

impl Lanes4 {
    #[inline(always)]
    fn each(self, f: impl Fn(f64) -> f64) -> Self {
        let [a, b, c, d] = self.0;
        Self([f(a), f(b), f(c), f(d)])
    }
}

impl From<f64> for Lanes4 {
    #[inline(always)]
    fn from(number: f64) -> Self {
        Self([number; WIDTH])
    }
}

impl Zero for Lanes4 {
    #[inline(always)]
    fn zero() -> Self {
        Self::from(0.0)
    }

    #[inline(always)]
    fn is_zero(&self) -> bool {
        self.0 == [0.0; WIDTH]
    }
}

impl One for Lanes4 {
    #[inline(always)]
    fn one() -> Self {
        Self::from(1.0)
    }
}

impl Neg for Lanes4 {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        let [a, b, c, d] = self.0;
        Self([-a, -b, -c, -d])
    }
}

// Written out lane by lane: functions that take functions are slow to compile, in loops that are made for
// every kind of law.
macro_rules! operator {
    ($($operator:ident $method:ident $assign:ident $assign_method:ident $op:tt;)*) => {$(
        impl $operator for Lanes4 {
            type Output = Self;

            #[inline(always)]
            fn $method(self, Self([p, q, r, s]): Self) -> Self {
                let [a, b, c, d] = self.0;
                Self([a $op p, b $op q, c $op r, d $op s])
            }
        }

        impl $operator<f64> for Lanes4 {
            type Output = Self;

            #[inline(always)]
            fn $method(self, x: f64) -> Self {
                let [a, b, c, d] = self.0;
                Self([a $op x, b $op x, c $op x, d $op x])
            }
        }

        impl $assign for Lanes4 {
            #[inline(always)]
            fn $assign_method(&mut self, Self([p, q, r, s]): Self) {
                let [a, b, c, d] = self.0;
                self.0 = [a $op p, b $op q, c $op r, d $op s];
            }
        }
    )*};
}

operator! {
    Add add AddAssign add_assign +;
    Sub sub SubAssign sub_assign -;
    Mul mul MulAssign mul_assign *;
    Div div DivAssign div_assign /;
}

impl BitAnd for Mask4 {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(std::array::from_fn(|lane| self.0[lane] & other.0[lane]))
    }
}

impl BitOr for Mask4 {
    type Output = Self;

    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(std::array::from_fn(|lane| self.0[lane] | other.0[lane]))
    }
}

impl Not for Mask4 {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        Self(std::array::from_fn(|lane| !self.0[lane]))
    }
}

impl Number for Lanes4 {
    type Mask = Mask4;
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
    fn less(self, Self([p, q, r, s]): Self) -> Mask4 {
        let [a, b, c, d] = self.0;
        Mask4([a < p, b < q, c < r, d < s])
    }

    #[inline(always)]
    fn at_most(self, Self([p, q, r, s]): Self) -> Mask4 {
        let [a, b, c, d] = self.0;
        Mask4([a <= p, b <= q, c <= r, d <= s])
    }

    #[inline(always)]
    fn select(mask: Mask4, yes: Self, no: Self) -> Self {
        let ([a, b, c, d], [p, q, r, s], [w, x, y, z]) = (yes.0, no.0, mask.0);
        let (a, b) = (if w { a } else { p }, if x { b } else { q });
        let (c, d) = (if y { c } else { r }, if z { d } else { s });
        Self([a, b, c, d])
    }

    /// Computes both only where lanes differ.
    #[inline(always)]
    fn choose(mask: Mask4, yes: impl FnOnce() -> Self, no: impl FnOnce() -> Self) -> Self {
        if mask.0 == [false; WIDTH] {
            return no();
        }
        let yes = yes();
        if mask.0 == [true; WIDTH] { yes } else { Self::select(mask, yes, no()) }
    }

    /// A lane that has done keeps its numbers while others go on.
    #[inline(always)]
    fn repeat<const N: usize>(
        most: u32,
        mut state: [Self; N],
        until: impl Fn(&[Self; N]) -> Mask4,
        step: impl Fn([Self; N]) -> [Self; N],
    ) -> [Self; N] {
        for _ in 0..most {
            let done = until(&state);
            if done == Mask4([true; WIDTH]) {
                break;
            }
            let next = step(state);
            state = std::array::from_fn(|k| Self::select(done, state[k], next[k]));
        }
        state
    }

    #[inline(always)]
    fn recip(self) -> Self {
        Self::from(1.0) / self
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.each(f64::abs)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let [a, b, c, d] = self.0;
        Self([a.sqrt(), b.sqrt(), c.sqrt(), d.sqrt()])
    }

    #[inline(always)]
    fn exp(self) -> Self {
        functions::exp(self)
    }

    #[inline(always)]
    fn exp_m1(self) -> Self {
        functions::exp_m1(self)
    }

    #[inline(always)]
    fn ln(self) -> Self {
        functions::ln(self)
    }

    #[inline(always)]
    fn ln_1p(self) -> Self {
        functions::ln_1p(self)
    }

    #[inline(always)]
    fn powf(self, exponent: f64) -> Self {
        functions::power(self, Self::from(exponent))
    }

    #[inline(always)]
    fn sin(self) -> Self {
        functions::sin(self)
    }

    #[inline(always)]
    fn cos(self) -> Self {
        functions::cos(self)
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        functions::atan2(self, x)
    }
}

impl Bits for Lanes4 {
    #[inline(always)]
    fn two_to(self) -> Self {
        self.each(f64::two_to)
    }

    #[inline(always)]
    fn exponent(self) -> Self {
        self.each(f64::exponent)
    }

    #[inline(always)]
    fn mantissa(self) -> Self {
        self.each(f64::mantissa)
    }

    #[inline(always)]
    fn surely(mask: Mask4) -> bool {
        mask == Mask4([true; WIDTH])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hyperelastic::{HyperelasticLaw, HyperelasticResponse, LameConstants};
    use crate::kernels::Kernel;
    use nalgebra::Matrix3;

    const NUMBERS: [[f64; WIDTH]; 2] = [[-1.5, 0.0, 0.25, 3.0], [0.5, 0.0, -0.75, 2.0]];

    #[test]
    fn lanes_do_what_single_numbers_do() {
        let [x, y] = NUMBERS.map(Lanes4::load);
        let check = |lanes: Lanes4, f: &dyn Fn(f64, f64) -> f64| {
            let [x, y] = NUMBERS;
            let expected: [f64; WIDTH] = std::array::from_fn(|k| f(x[k], y[k]));
            assert_eq!(lanes.store().map(f64::to_bits), expected.map(f64::to_bits));
        };
        check(x + y, &|x, y| x + y);
        check(x - y * 2.0, &|x, y| x - y * 2.0);
        check(x / (y + 7.0), &|x, y| x / (y + 7.0));
        check(x.abs().sqrt(), &|x, _| x.abs().sqrt());
        check(x.exp_m1().atan2(y), &|x, y| Number::atan2(Number::exp_m1(x), y));
        check((x * 300.0).exp().ln_1p(), &|x, _| Number::ln_1p(Number::exp(x * 300.0)));
        check(x.powf(3.0).ln(), &|x, _| Number::ln(Number::powf(x, 3.0)));
        check(x.sin() + y.cos(), &|x, y| Number::sin(x) + Number::cos(y));
        let both = x.below(1.0) & !y.at_most(Lanes4::zero());
        check(Lanes4::select(both, x, y), &|x, y| if x < 1.0 && y > 0.0 { x } else { y });
        let either = x.above(1.0) | y.below(0.0);
        check(Lanes4::choose(either, || x, || -y), &|x, y| if x > 1.0 || y < 0.0 { x } else { -y });
    }

    #[test]
    fn a_lane_stops_when_it_has_done() {
        let halve = |[x]: [Lanes4; 1]| [x * 0.5];
        let start = [Lanes4::load([8.0, 1.0, 3.0, 0.5])];
        let [x] = Lanes4::repeat(9, start, |[x]| x.at_most(Lanes4::one()), halve);
        assert_eq!(x.store(), [1.0, 1.0, 0.75, 0.5]);
        let [x] = Lanes4::repeat(1, start, |[x]| x.at_most(Lanes4::one()), halve);
        assert_eq!(x.store(), [4.0, 1.0, 1.5, 0.5]);
    }

    #[test]
    fn kernels_and_materials_are_the_same_in_lanes() {
        let radii = [0.1, 0.9, 1.7, 3.5];
        for kernel in Kernel::ALL {
            let lanes = kernel.value(2, Lanes4::load(radii), 0.7).store();
            assert_eq!(lanes, radii.map(|r| kernel.value(2, r, 0.7)), "{}", kernel.name());
        }
        let law = HyperelasticLaw::neo_hookean(LameConstants { lambda: 2.0, mu: 1.0 });
        let gradient = |k: usize| Matrix3::from_fn(|i, j| 0.1 * ((i + 2 * j + k) as f64).sin());
        let lanes =
            Matrix3::from_fn(|i, j| Lanes4::load(std::array::from_fn(|k| gradient(k)[(i, j)])));
        let stress: Matrix3<Lanes4> = law.stress(&lanes);
        for k in 0..WIDTH {
            let expected: Matrix3<f64> = law.stress(&gradient(k));
            assert_eq!(stress.map(|x| x.store()[k]), expected);
        }
    }
}
