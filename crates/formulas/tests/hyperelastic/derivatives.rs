//! Derivatives of laws by their constants against quotients of differences of laws with other constants.

use nalgebra::{Matrix3, SMatrix};
use piola_formulas::hyperelastic::{Constant, HyperelasticLaw, LameConstants, Reduced};
use piola_formulas::volumetric::StressState;
use proptest::prelude::*;

use super::{all_samples, close};

/// Constants of a law, with the law that their values make.
type Given = (&'static [Constant], fn([f64; 3]) -> HyperelasticLaw);

/// All ways to give a law its constants.
fn given(name: &str) -> Vec<Given> {
    use Constant::{
        BulkModulus, C01, C10, Lambda, Modulus, PoissonRatio, ShearModulus, ShearModulusAtLambda,
        YoungModulus,
    };
    macro_rules! of_two {
        ($law:expr) => {
            vec![
                (&[YoungModulus, PoissonRatio], |[e, nu, _]| {
                    $law(LameConstants::from_young(e, nu).expect("in range"))
                }),
                (&[BulkModulus, ShearModulus], |[kappa, mu, _]| {
                    $law(LameConstants::from_bulk(kappa, mu).expect("in range"))
                }),
                (&[Lambda, ShearModulusAtLambda], |[lambda, mu, _]| {
                    $law(LameConstants::new(lambda, mu).expect("in range"))
                }),
            ]
        };
    }
    match name {
        "linear_elastic" => of_two!(HyperelasticLaw::linear_elastic),
        "saint_venant_kirchhoff" => of_two!(HyperelasticLaw::saint_venant_kirchhoff),
        "neo_hookean" => of_two!(HyperelasticLaw::neo_hookean),
        "neo_hookean_logarithmic" => of_two!(HyperelasticLaw::neo_hookean_logarithmic),
        "mooney_rivlin" => vec![(&[C10, C01, BulkModulus], |[c10, c01, kappa]| {
            HyperelasticLaw::mooney_rivlin(c10, c01, kappa).expect("in range")
        })],
        "ogden" => vec![(&[Modulus(0), Modulus(1), BulkModulus], |[one, other, kappa]| {
            HyperelasticLaw::ogden(&[(one, 1.3), (-other, -2.4)], kappa).expect("in range")
        })],
        "hyperelastic" => vec![],
        _ => panic!("the law `{name}` is registered, and its constants are not here"),
    }
}

fn check<const D: usize>(
    (constants, law): Given,
    values: [f64; 3],
    state: StressState,
    a: &Matrix3<f64>,
) -> Result<(), TestCaseError> {
    let a = SMatrix::<f64, D, D>::from_fn(|i, j| a[(i, j)]);
    let reduced = |values| Reduced::<D>::new(law(values), state).expect("the state fits");
    for (number, &constant) in constants.iter().enumerate() {
        let at = |steps: f64| {
            let mut values = values;
            values[number] += steps * STEP;
            reduced(values).stress(&a)
        };
        let quotient = ((at(1.0) - at(-1.0)) * 8.0 - (at(2.0) - at(-2.0))) / (12.0 * STEP);
        let derivative = law(values).derivative(constant).expect("it is its own");
        // The second modulus of Ogden's law is given with the other sign.
        let sign = if constant == Constant::Modulus(1) { -1.0 } else { 1.0 };
        let found = reduced(values).stress_derivative(&a, &derivative) * sign;
        let modulus = law(values).small_strain().pressure_wave_modulus();
        for k in 0..D * D {
            let (i, j) = (k / D, k % D);
            close(found[(i, j)], quotient[(i, j)], 1e-7 * modulus)?;
        }
    }
    Ok(())
}

/// Constants are about one, but for Poisson's ratio. With this step, quotients of the fourth order are off by round-off
/// over the step, 1e-11, and by the fifth derivative: by `8 STEP^4/(1 - 2 nu)^6` of the modulus at most, 5e-10.
const STEP: f64 = 1e-4;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]
    #[test]
    fn derivatives_are_the_limits_of_differences(
        name in prop::sample::select(&HyperelasticLaw::NAMES[..]),
        entries in prop::array::uniform9(-0.28..0.28_f64),
        [one, other, third] in prop::array::uniform3(0.6..1.8_f64),
        poisson_ratio in -0.4..0.45_f64,
        state in prop::sample::select(&StressState::ALL[..]),
    ) {
        let a = Matrix3::from_row_slice(&entries);
        for given in given(name) {
            let values = match given.0[1] {
                Constant::PoissonRatio => [one, poisson_ratio, third],
                _ => [one, other, third],
            };
            match state.dimension() {
                1 => check::<1>(given, values, state, &a)?,
                2 => check::<2>(given, values, state, &a)?,
                _ => check::<3>(given, values, state, &a)?,
            }
        }
    }
}

#[test]
fn there_are_none_by_constants_of_other_laws() {
    for law in all_samples() {
        let own: Vec<_> = given(law.name()).iter().flat_map(|(constants, _)| *constants).collect();
        let all = [Constant::YoungModulus, Constant::C10, Constant::C01, Constant::Modulus(0)];
        for constant in all {
            let is_there = law.derivative(constant).is_some();
            assert_eq!(is_there, own.contains(&&constant), "{law:?} {constant:?}");
        }
        assert_eq!(law.derivative(Constant::Modulus(3)), None);
    }
}
