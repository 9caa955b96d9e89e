//! The functions and constants of expressions.
//!
//! Each is described once: its name, what it computes and its derivative. The evaluator, the
//! suggestions and the generated reference read this list.

use std::f64::consts::{PI, TAU};

use super::engine::Number;
use exmex::{BinOp, MakeOperators, Operator};
use piola_formulas::kernels::Kernel;

/// A function of expressions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Function {
    /// Its name.
    pub name: &'static str,
    /// Number of arguments.
    pub arguments: usize,
    /// One line of explanation.
    pub meaning: &'static str,
}

/// The named constants.
pub fn constants() -> &'static [(&'static str, f64)] {
    &[("pi", PI), ("tau", TAU)]
}

macro_rules! describe {
    (
        one: $($name:literal, $value:expr, $derivative:expr, $meaning:literal;)*
        two: $($name2:literal, $apply:expr, $meaning2:literal;)*
    ) => {
        /// All functions, those of one argument first.
        pub fn functions() -> &'static [Function] {
            &[
                $(Function { name: $name, arguments: 1, meaning: $meaning },)*
                $(Function { name: $name2, arguments: 2, meaning: $meaning2 },)*
            ]
        }

        /// Hands the operators and functions to `exmex`.
        #[derive(Clone, Debug)]
        pub(super) struct Operators;

        impl<T: Number> MakeOperators<T> for Operators {
            fn make<'a>() -> Vec<Operator<'a, T>> {
                let mut operators = arithmetic();
                $(operators.push(
                    Operator::make_unary($name, |x: T| x.chain($value, $derivative))
                );)*
                $(operators.push(Operator::make_bin($name2, binary($apply)));)*
                operators
            }
        }
    };
}

describe! {
    one:
    "sin", f64::sin, f64::cos, "sine of an angle in radians";
    "cos", f64::cos, |x| -x.sin(), "cosine of an angle in radians";
    "tan", f64::tan, |x| x.cos().powi(-2), "tangent of an angle in radians";
    "asin", f64::asin, |x| 1.0 / (1.0 - x * x).sqrt(), "inverse sine in radians";
    "acos", f64::acos, |x| -1.0 / (1.0 - x * x).sqrt(), "inverse cosine in radians";
    "atan", f64::atan, |x| 1.0 / (1.0 + x * x), "inverse tangent in radians";
    "sinh", f64::sinh, f64::cosh, "hyperbolic sine";
    "cosh", f64::cosh, f64::sinh, "hyperbolic cosine";
    "tanh", f64::tanh, |x| x.cosh().powi(-2), "hyperbolic tangent";
    "exp", f64::exp, f64::exp, "exponential";
    "ln", f64::ln, |x| 1.0 / x, "natural logarithm";
    "log", f64::ln, |x| 1.0 / x, "natural logarithm, the same as ln";
    "log10", f64::log10, |x| 1.0 / (x * std::f64::consts::LN_10), "logarithm to base 10";
    "sqrt", f64::sqrt, |x| 0.5 / x.sqrt(), "square root";
    "abs", f64::abs, sign, "absolute value";
    "sign", sign, zero, "-1 below 0, 0 at 0, 1 above";
    "step", step, zero, "0 below 0, 1 from 0 on";
    "smooth", smooth, bell,
        "0 below -1, 1 above 1, in between the step at 0 smoothed by the modified mollifier of radius 1";
    "floor", f64::floor, zero, "largest whole number not above";
    "ceil", f64::ceil, zero, "smallest whole number not below";
    "round", f64::round, zero, "nearest whole number";
    two:
    "min", |a: T, b: T| if a.value() <= b.value() || b.value().is_nan() { a } else { b },
        "the smaller of two";
    "max", |a: T, b: T| if a.value() >= b.value() || b.value().is_nan() { a } else { b },
        "the larger of two";
    "atan2", |a: T, b: T| T::arc_tangent(a, b), "angle of the point (b, a) in radians";
    "mod", |a: T, b: T| {
        let turns = (a.value() / b.value()).floor();
        a.sub(b.mul(T::from_number(turns)))
    }, "a - b floor(a / b), the remainder with the sign of b";
    "pow", |a: T, b: T| a.pow(b), "the same as a^b";
}

/// The operators `+ - * / ^`. The text that they are used with has all brackets, so that their
/// priorities do not matter. None is called commutative: `exmex` would reorder sums.
fn arithmetic<'a, T: Number>() -> Vec<Operator<'a, T>> {
    vec![
        Operator::make_bin("^", binary(|a: T, b: T| a.pow(b))),
        Operator::make_bin("*", binary(|a: T, b: T| a.mul(b))),
        Operator::make_bin("/", binary(|a: T, b: T| a.div(b))),
        Operator::make_bin("+", binary(|a: T, b: T| a.add(b))),
        Operator::make_bin_unary("-", binary(|a: T, b: T| a.sub(b)), |a: T| a.negative()),
    ]
}

fn binary<T: Number>(apply: fn(T, T) -> T) -> BinOp<T> {
    BinOp { apply, prio: 0, is_commutative: false }
}

fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}

fn step(x: f64) -> f64 {
    if x.is_nan() { x } else { f64::from(u8::from(x >= 0.0)) }
}

/// The modified mollifier of radius 1, Elastodynamics (2.19).
fn bell(x: f64) -> f64 {
    Kernel::ModifiedMollifier.value(1, x.abs(), 1.0)
}

/// The kernel approximation, Elastodynamics (2.4), of a step at 0 by the modified mollifier.
fn smooth(x: f64) -> f64 {
    if !(x.abs() < 1.0) {
        return 0.5 + 0.5 * x.signum();
    }
    // Simpson's rule from 0: the function is smooth, and 64 intervals leave 1e-9.
    const INTERVALS: u32 = 64;
    let width = x / f64::from(INTERVALS);
    let weight = |k: u32| match k {
        0 | INTERVALS => 1.0,
        _ if k % 2 == 1 => 4.0,
        _ => 2.0,
    };
    let sum: f64 = (0..=INTERVALS).map(|k| weight(k) * bell(f64::from(k) * width)).sum();
    0.5 + sum * width / 3.0
}

fn zero(_: f64) -> f64 {
    0.0
}
