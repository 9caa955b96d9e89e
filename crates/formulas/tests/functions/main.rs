//! The functions of numbers against their exact values, in lanes, and with derivatives.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::f64::consts::FRAC_PI_2;

use piola_formulas::functions::FARTHEST;
use piola_formulas::{Lanes, Lanes4, Number};

mod derivatives;
mod reference;

/// Arguments of each test.
const COUNT: usize = 4_000;

/// Numbers in [0, 1) that are the same on every machine.
fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Fails if the error over some arguments, of random numbers, reaches a bound in units.
fn check(
    name: &str,
    bound: f64,
    mut argument: impl FnMut(&mut dyn FnMut() -> f64) -> f64,
    error: impl Fn(f64) -> f64,
) {
    let (mut random, mut most) = (random(1), (0.0, 0.0));
    for _ in 0..COUNT {
        let x = argument(&mut random);
        let error = error(x);
        if error > most.0 {
            most = (error, x);
        }
    }
    let (error, at) = most;
    println!("{name}: {error:.3} at {at:?}");
    assert!(error < bound, "{name}: {error} units at {at:?}");
}

/// A number of either sign from `1e-lowest` to 1, with all sizes alike.
fn any_size(random: &mut dyn FnMut() -> f64, lowest: f64) -> f64 {
    let size = 10.0_f64.powf(-lowest * random());
    if random() < 0.5 { -size } else { size }
}

#[test]
fn exponentials_are_exact_but_for_the_last_digit() {
    let exp = |x| reference::exp(x).units(Number::exp(x));
    check("exp", 0.9, |r| 4.0 * r() - 2.0, exp);
    check("exp, any", 0.9, |r| 1455.0 * r() - 745.5, exp);
    check("exp, small", 0.9, |r| any_size(r, 18.0), exp);
    let exp_m1 = |x| reference::exp_m1(x).units(Number::exp_m1(x));
    check("exp_m1", 1.6, |r| 4.0 * r() - 2.0, exp_m1);
    check("exp_m1, any", 1.6, |r| 760.0 * r() - 50.5, exp_m1);
    check("exp_m1, small", 1.6, |r| any_size(r, 18.0), exp_m1);
}

#[test]
fn logarithms_are_exact_but_for_the_last_digit() {
    let ln = |x| reference::ln(x).units(Number::ln(x));
    check("ln", 0.9, |r| 3.0 * r() + 1e-3, ln);
    let any = f64::INFINITY.to_bits() as f64;
    check("ln, any", 0.9, |r| f64::from_bits((r() * any) as u64), ln);
    check("ln, near 1", 0.9, |r| 1.0 + 0.9 * any_size(r, 15.0), ln);
    let ln_1p = |x| reference::ln_1p(x).units(Number::ln_1p(x));
    check("ln_1p", 0.9, |r| 3.0 * r() - 0.99, ln_1p);
    check("ln_1p, small", 0.9, |r| 0.999_999 * any_size(r, 18.0), ln_1p);
    check("ln_1p, large", 0.9, |r| any_size(r, 20.0).abs() * 1e20, ln_1p);
}

#[test]
fn powers_have_their_digits() {
    for y in [0.31, 1.0 / 7.0, -2.0 / 3.0, 1.4, 2.0, 2.5, 7.15, -30.0, 250.0] {
        let error = |x: f64| {
            let error = reference::power(x, y).units(Number::powf(x, y));
            error / (1.0 + (y * x.ln()).abs() / 5.0)
        };
        check(&format!("power {y}"), 1.0, |r| 0.3 + 2.0 * r(), error);
        let widest = 300.0 / (2.0 + f64::abs(y));
        let any = |r: &mut dyn FnMut() -> f64| 10.0_f64.powf(widest * (2.0 * r() - 1.0));
        check(&format!("power {y}, any"), 1.0, any, error);
    }
}

#[test]
fn circular_functions_are_exact_but_for_the_last_digit() {
    for (name, quarters) in [("sin", 0), ("cos", 1)] {
        let function = |x| if quarters == 0 { Number::sin(x) } else { Number::cos(x) };
        let error = |x| reference::sin(x, quarters).units(function(x));
        check(name, 0.9, |r| 8.0 * r() - 4.0, error);
        check(name, 0.9, |r| FARTHEST * (2.0 * r() - 1.0), error);
        check(name, 0.9, |r| any_size(r, 15.0), error);
        // Next to multiples of a quarter of a turn.
        check(name, 0.9, |r| (6e5 * r()).round() * FRAC_PI_2, error);
    }
}

#[test]
fn angles_are_exact_but_for_the_last_digit() {
    for x in [1.0, -1.0, 0.3, 1e-3, -1e3, 7.0] {
        let error = |y| reference::atan2(y, x).units(Number::atan2(y, x));
        check("atan2", 1.6, |r| 4.0 * r() - 2.0, error);
        check("atan2, small", 1.6, |r| any_size(r, 12.0), error);
    }
}

/// The ordinary way and the one for all numbers, which a lane takes when there is another beside it.
#[test]
fn lanes_have_the_bits_of_plain_numbers() {
    type Both = (fn(f64) -> f64, fn(Lanes4) -> Lanes4);
    let functions: [Both; 9] = [
        (Number::exp, Number::exp),
        (Number::exp_m1, Number::exp_m1),
        (Number::ln, Number::ln),
        (Number::ln_1p, Number::ln_1p),
        (|x| Number::powf(x, 1.4), |x| x.powf(1.4)),
        (|x| Number::powf(x, -3.0), |x| x.powf(-3.0)),
        (Number::sin, Number::sin),
        (Number::cos, Number::cos),
        (|x| Number::atan2(x, 0.7 - x), |x| x.atan2(-x + 0.7)),
    ];
    let mut random = random(12);
    let mut numbers = || -> [f64; 4] {
        std::array::from_fn(|_| (random() - 0.3) * 10.0_f64.powf(20.0 * random() - 10.0))
    };
    for (which, (plain, lanes)) in functions.into_iter().enumerate() {
        for _ in 0..20_000 {
            let x = numbers();
            for beside in [x[3], f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -0.0, 1e-310, -2.0] {
                let x = [x[0], x[1], x[2].abs(), beside];
                let got = lanes(Lanes4::load(x)).store();
                for (x, got) in x.into_iter().zip(got) {
                    let expected = plain(x);
                    let same =
                        expected.to_bits() == got.to_bits() || (expected.is_nan() && got.is_nan());
                    assert!(same, "function {which} of {x}: {got}, not {expected}");
                }
            }
        }
    }
}

/// What the library gives, which is right there.
#[test]
fn functions_end_where_they_should() {
    let infinity = f64::INFINITY;
    let all =
        [0.0, 1.0, -1.0, 709.7, 709.8, -745.0, -746.0, 5e-324, 1e-310, -2.0, 709.782_712_893_384];
    for x in all.into_iter().chain([
        infinity,
        -infinity,
        f64::MAX,
        f64::MIN,
        f64::NAN,
        f64::MIN_POSITIVE,
    ]) {
        let close = |name: &str, got: f64, expected: f64| {
            let same = got == expected || (got.is_nan() && expected.is_nan());
            assert!(
                same || (got - expected).abs() <= 2e-16 * expected.abs(),
                "{name} {x}: {got}, not {expected}"
            );
        };
        close("exp", Number::exp(x), x.exp());
        close("exp_m1", Number::exp_m1(x), x.exp_m1());
        close("ln", Number::ln(x), x.ln());
        close("ln_1p", Number::ln_1p(x), x.ln_1p());
        for y in [0.0, 0.5, 1.0, -1.0, 3.0, -3.0, -4.0, 2.5, 1e17, infinity, -infinity, f64::NAN] {
            // Negative numbers have powers of whole exponents alone, and nothing comes of no number.
            let expected = match (x, y) {
                _ if x < 0.0 && (y.fract() != 0.0 || y.abs() > 1e15) => f64::NAN,
                _ if x == 1.0 && y.is_nan() => f64::NAN,
                _ => x.powf(y),
            };
            close(&format!("power {y} of"), Number::powf(x, y), expected);
            close(&format!("angle beside {y} of"), Number::atan2(x, y), x.atan2(y));
        }
        for far in [FARTHEST.next_up(), 1e300, infinity, f64::NAN] {
            assert!(Number::sin(far).is_nan() && Number::cos(-far).is_nan());
        }
    }
}
