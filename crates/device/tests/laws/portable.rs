use piola_device::Portable;
use piola_formulas::Number;

use super::random;

/// Distance of a number from the true one in units of its last place, the true one being that of the C
/// library, which is itself within 0.6 of the truth.
fn units(got: f64, expected: f64) -> f64 {
    let unit = f64::from_bits(expected.abs().to_bits() + 1) - expected.abs();
    (got - expected).abs() / unit
}

#[test]
fn portable_functions_are_those_of_the_library_but_for_the_last_digit() {
    let mut random = random(5);
    for _ in 0..200_000 {
        let x = 40.0 * random() - 20.0;
        assert!(units(Portable(x).exp().0, x.exp()) <= 1.0, "exp {x}");
        assert!(units(Portable(x).exp_m1().0, x.exp_m1()) <= 2.0, "exp_m1 {x}");
        let small =
            (10.0_f64).powf(-18.0 * random()) * if random() < 0.5 { 1.0 } else { -1.0 } * 0.99;
        assert!(units(Portable(small).exp_m1().0, small.exp_m1()) <= 2.0, "exp_m1 {small}");
        assert!(units(Portable(small).ln_1p().0, small.ln_1p()) <= 2.0, "ln_1p {small}");
        let wide = (10.0_f64).powf(600.0 * random() - 300.0);
        assert!(units(Portable(wide).ln().0, wide.ln()) <= 1.0, "ln {wide}");
        let (base, exponent) = (10.0 * random(), 8.0 * random() - 4.0);
        let power = units(Portable(base).powf(exponent).0, base.powf(exponent));
        // The logarithm is good to one unit, its product with the exponent to half of one, and a unit of the
        // result is at least half of a rounding of it.
        assert!(power <= 2.0 + 3.0 * (exponent * base.ln()).abs(), "{base} to {exponent}: {power}");
    }
}

#[test]
fn portable_functions_end_where_those_of_the_library_do() {
    let all =
        [0.0, -0.0, 1.0, -1.0, f64::INFINITY, f64::NEG_INFINITY, 709.7, 709.8, -745.0, -746.0];
    for x in all.into_iter().chain([5e-324, 1e-310, -2.0, f64::MAX, f64::MIN, 709.782_712_893_384])
    {
        let close = |got: f64, expected: f64, name: &str| {
            let same = got == expected || (got.is_nan() && expected.is_nan());
            assert!(same || units(got, expected) <= 2.0, "{name} {x}: {got}, not {expected}");
        };
        close(Portable(x).exp().0, x.exp(), "exp");
        close(Portable(x).exp_m1().0, x.exp_m1(), "exp_m1");
        close(Portable(x).ln().0, x.ln(), "ln");
        close(Portable(x).ln_1p().0, x.ln_1p(), "ln_1p");
    }
    assert!(Portable(f64::NAN).exp().0.is_nan() && Portable(f64::NAN).ln_1p().0.is_nan());
    assert!(Portable(f64::NAN).exp_m1().0.is_nan() && Portable(f64::NAN).ln().0.is_nan());
}
