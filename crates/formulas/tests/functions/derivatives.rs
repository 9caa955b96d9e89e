//! Functions of numbers with derivatives.

use num_dual::{Dual3_64, Dual64, DualNum, HyperDual64};
use piola_formulas::Number;

use super::random;

/// A function as ours and as that of the library, with the range of its arguments.
macro_rules! functions {
    ($($name:literal: $range:expr, $ours:expr, $theirs:expr;)*) => {
        fn ours<T: DualNum<Primitive = f64> + nalgebra::Scalar + Copy>(name: &str, x: T) -> T {
            match name {
                $($name => { let f: fn(T) -> T = $ours; f(x) })*
                _ => unreachable!(),
            }
        }

        fn theirs<T: DualNum<Primitive = f64> + nalgebra::Scalar + Copy>(name: &str, x: T) -> T {
            match name {
                $($name => { let f: fn(T) -> T = $theirs; f(x) })*
                _ => unreachable!(),
            }
        }

        const ALL: &[(&str, [f64; 2])] = &[$(($name, $range)),*];
    };
}

functions! {
    "exp": [-30.0, 30.0], |x| Number::exp(x), |x| DualNum::exp(&x);
    "exp_m1": [-3.0, 30.0], |x| Number::exp_m1(x), |x| DualNum::exp_m1(&x);
    "ln": [1e-3, 30.0], |x| Number::ln(x), |x| DualNum::ln(&x);
    "ln_1p": [-0.9, 30.0], |x| Number::ln_1p(x), |x| DualNum::ln_1p(&x);
    "a root": [1e-3, 30.0], |x| Number::powf(x, 0.31), |x| DualNum::powf(&x, 0.31);
    "square": [-30.0, 30.0], |x| Number::powf(x, 2.0), |x| x * x;
    "inverse": [-30.0, 30.0], |x| Number::powf(x, -1.0), |x| DualNum::recip(&x);
    "power": [1e-3, 30.0], |x| Number::powf(x, 7.15), |x| DualNum::powf(&x, 7.15);
    "sin": [-30.0, 30.0], |x| Number::sin(x), |x| DualNum::sin(&x);
    "cos": [-30.0, 30.0], |x| Number::cos(x), |x| DualNum::cos(&x);
    "angle": [-3.0, 3.0], |x| Number::atan2(x, x * x + 0.5), |x| DualNum::atan2(&x, x * x + 0.5);
    "angle behind": [-3.0, 3.0], |x| Number::atan2(x, -x * x - 0.5), |x| DualNum::atan2(&x, -x * x - 0.5);
}

/// That of the library has errors of its own, of a few roundings and those of a power.
fn close(name: &str, x: f64, ours: f64, theirs: f64, size: f64) {
    let difference = (ours - theirs).abs();
    let rounding = 32.0 * f64::EPSILON * size.max(theirs.abs());
    assert!(difference <= rounding, "{name} at {x}: {ours}, not {theirs}");
}

#[test]
fn values_are_those_of_plain_numbers_and_derivatives_those_of_the_library() {
    let mut random = random(11);
    for (name, [low, high]) in ALL {
        // Of angles terms of the size of 1 cancel.
        let size = if name.starts_with("angle") { 4.0 } else { 0.0 };
        for _ in 0..20_000 {
            let x = low + (high - low) * random();
            let value = ours(name, x);
            let first = Dual64::new(x, 1.0);
            let (got, expected) = (ours(name, first), theirs(name, first));
            assert_eq!(got.re.to_bits(), value.to_bits(), "{name} at {x}");
            close(name, x, got.eps, expected.eps, size);
            let second = HyperDual64::new(x, 1.0, 1.0, 0.0);
            let (got, expected) = (ours(name, second), theirs(name, second));
            assert_eq!(got.re.to_bits(), value.to_bits(), "{name} at {x}");
            close(name, x, got.eps1, expected.eps1, size);
            close(name, x, got.eps1eps2, expected.eps1eps2, expected.eps1.abs() + size);
            let third = Dual3_64::new(x, 1.0, 0.0, 0.0);
            let (got, expected) = (ours(name, third), theirs(name, third));
            assert_eq!(got.re.to_bits(), value.to_bits(), "{name} at {x}");
            close(name, x, got.v3, expected.v3, expected.v2.abs() + expected.v1.abs() + size);
        }
    }
}

#[test]
fn values_at_the_ends_are_those_of_plain_numbers() {
    let ends = [0.0, -1.0, 1.0, 1e-150, 800.0, -800.0, f64::MAX, f64::INFINITY, f64::NEG_INFINITY];
    for (name, _) in ALL {
        for x in ends.into_iter().chain([f64::NAN]) {
            let (plain, dual) = (ours(name, x), ours(name, Dual64::new(x, 1.0)).re);
            // The root has an infinite derivative at zero.
            let is_root = *name == "a root" && x == 0.0;
            let same = plain == dual || (plain.is_nan() && dual.is_nan()) || is_root;
            assert!(same, "{name} at {x}: {dual}, not {plain}");
        }
    }
}

#[test]
fn powers_of_zero_have_derivatives_that_are_not_infinite() {
    let zero = Dual64::new(0.0, 1.0);
    for (exponent, value, slope) in
        [(2.5, 0.0, 0.0), (1.3, 0.0, 0.0), (1.0, 0.0, 1.0), (0.0, 1.0, 0.0)]
    {
        let power = Number::powf(zero, exponent);
        assert_eq!([power.re, power.eps], [value, slope], "{exponent}");
    }
}
