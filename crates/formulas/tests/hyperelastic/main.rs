//! Properties of every registered elastic solid, in every state of the missing dimensions.

use nalgebra::{DMatrix, Matrix3, Rotation3, SMatrix, Vector3};
use num_dual::{Dual64, HyperDual64};
use piola_formulas::hyperelastic::{
    HyperelasticLaw, HyperelasticResponse, LameConstants, Reduced, Tangent,
};
use piola_formulas::tensor;
use piola_formulas::volumetric::{MaterialError, StressState};
use proptest::prelude::*;

mod derivatives;
mod energies;
mod many;

const YOUNG: f64 = 2.5e6;
const POISSON: f64 = 0.3;

fn constants() -> LameConstants {
    LameConstants::from_young(YOUNG, POISSON).expect("parameters in range")
}

/// Laws of a name, all of them of the same small-strain constants.
fn samples(name: &str) -> Vec<HyperelasticLaw> {
    let (constants, kappa) = (constants(), constants().bulk_modulus());
    let mu = constants.mu;
    match name {
        "linear_elastic" => vec![HyperelasticLaw::linear_elastic(constants)],
        "saint_venant_kirchhoff" => vec![HyperelasticLaw::saint_venant_kirchhoff(constants)],
        "neo_hookean" => vec![HyperelasticLaw::neo_hookean(constants)],
        "neo_hookean_logarithmic" => vec![HyperelasticLaw::neo_hookean_logarithmic(constants)],
        "mooney_rivlin" => [(0.4, 0.1), (0.6, -0.1), (0.0, 0.5)]
            .map(|(c10, c01)| HyperelasticLaw::mooney_rivlin(c10 * mu, c01 * mu, kappa))
            .map(|law| law.expect("parameters in range"))
            .to_vec(),
        "ogden" => {
            let three = [(0.6 * mu / 1.3, 1.3), (0.5 * mu / 5.0, 5.0), (-0.9 * mu / 2.0, -2.0)];
            [&[(mu, 2.0)][..], &[(-2.0 * mu / 0.7, -0.7)], &three]
                .map(|terms| HyperelasticLaw::ogden(terms, kappa).expect("parameters in range"))
                .to_vec()
        }
        "hyperelastic" => energies::samples(mu, kappa),
        _ => panic!("the law `{name}` is registered and has no samples to test"),
    }
}

fn all_samples() -> Vec<HyperelasticLaw> {
    HyperelasticLaw::NAMES.into_iter().flat_map(samples).collect()
}

fn laws() -> impl Strategy<Value = HyperelasticLaw> {
    prop::sample::select(all_samples())
}

/// Displacement gradients of all sizes of strain that keep the volume positive.
fn gradients() -> impl Strategy<Value = Matrix3<f64>> {
    let entries = prop::array::uniform9(-0.28..0.28_f64);
    let scale = prop_oneof![Just(1.0), (-9.0..0.0_f64).prop_map(|power| 10.0_f64.powf(power))];
    (entries, scale).prop_map(|(entries, scale)| Matrix3::from_row_slice(&entries) * scale)
}

fn rotations() -> impl Strategy<Value = Matrix3<f64>> {
    prop::array::uniform3(-3.0..3.0_f64)
        .prop_map(|axis| Rotation3::from_scaled_axis(Vector3::from(axis)).into_inner())
}

fn close(a: f64, b: f64, bound: f64) -> Result<(), TestCaseError> {
    prop_assert!((a - b).abs() <= bound, "{a} against {b}, bound {bound:e}");
    Ok(())
}

/// The bounds of the tests below are roundings of the modulus, of the strain and its square: a
/// term of the stress of a large strain can be the difference of numbers of that size.
fn modulus() -> f64 {
    constants().pressure_wave_modulus()
}

fn check_stress_and_tangent<const D: usize>(
    law: HyperelasticLaw,
    state: StressState,
    a: &Matrix3<f64>,
) -> Result<(), TestCaseError> {
    let reduced = Reduced::<D>::new(law.clone(), state).expect("the state fits");
    let a = SMatrix::<f64, D, D>::from_fn(|i, j| a[(i, j)]);
    let stress = reduced.stress(&a);
    let tangent: Tangent<D> = reduced.tangent(&a);
    let mut bound = 2e-12 * modulus();
    if law.name() == "hyperelastic" {
        // The second derivative of a power 3/2 of I1 - 3, which goes with the square of the strain, goes with the
        // strain, and has as many digits as I1 - 3 has, where I1 is 3 and a little.
        let strain = a.amax().max(f64::MIN_POSITIVE);
        bound += modulus() * strain * (3.0 * f64::EPSILON / (strain * strain)).min(1.0);
    }
    for k in 0..D * D {
        let (i, j) = (k / D, k % D);
        let mut seeded = a.map(Dual64::from_re);
        seeded[(i, j)] = seeded[(i, j)].derivative();
        close(reduced.energy(&seeded).eps, stress[(i, j)], 2e-13 * modulus())?;
        for l in 0..D * D {
            let (m, n) = (l / D, l % D);
            let mut seeded = a.map(HyperDual64::from_re);
            seeded[(i, j)] = seeded[(i, j)].derivative1();
            seeded[(m, n)] = seeded[(m, n)].derivative2();
            let second = reduced.energy(&seeded).eps1eps2;
            close(second, tangent[m][n][(i, j)], bound)?;
            close(tangent[i][j][(m, n)], tangent[m][n][(i, j)], bound)?;
        }
    }
    Ok(())
}

/// Calls a generic function of the dimension for a state.
macro_rules! in_state {
    ($function:ident, $law:expr, $state:expr, $($rest:expr),*) => {
        match $state.dimension() {
            1 => $function::<1>($law.clone(), $state, $($rest),*),
            2 => $function::<2>($law.clone(), $state, $($rest),*),
            _ => $function::<3>($law.clone(), $state, $($rest),*),
        }
    };
}

#[test]
fn every_registered_law_is_sampled_under_its_own_name() {
    for name in HyperelasticLaw::NAMES {
        assert!(!samples(name).is_empty());
        assert!(samples(name).iter().all(|law| law.name() == name));
    }
}

#[test]
fn a_body_at_rest_has_neither_energy_nor_stress() {
    fn check<const D: usize>(law: HyperelasticLaw, state: StressState, _: ()) {
        let reduced = Reduced::<D>::new(law.clone(), state).expect("the state fits");
        let rest = SMatrix::<f64, D, D>::zeros();
        // A written energy has a large constant.
        let least = if law.name() == "hyperelastic" { f64::EPSILON * modulus() } else { 0.0 };
        assert!(reduced.energy(&rest).abs() <= least, "{law:?} {state:?}");
        let largest = reduced.stress(&rest).amax();
        assert!(largest <= 4.0 * f64::EPSILON * modulus(), "{law:?} {state:?}: {largest}");
    }
    for law in all_samples() {
        for state in StressState::ALL {
            in_state!(check, law, state, ());
        }
    }
}

/// Tangents at rest against the textbook's moduli of each state.
#[test]
fn small_strains_see_young_and_poisson() {
    fn check<const D: usize>(law: HyperelasticLaw, state: StressState, moduli: [f64; 2]) {
        let tangent = Reduced::<D>::new(law.clone(), state)
            .expect("the state fits")
            .tangent(&SMatrix::zeros());
        let mu = YOUNG / (2.0 * (1.0 + POISSON));
        for k in 0..D * D {
            let (i, j) = (k / D, k % D);
            for l in 0..D * D {
                let (m, n) = (l / D, l % D);
                let expected = match (i == j, m == n) {
                    (true, true) => moduli[usize::from(i != m)],
                    (false, false) if i + j == m + n => mu,
                    _ => 0.0,
                };
                let got = tangent[m][n][(i, j)];
                assert!((got - expected).abs() < 1e-13 * moduli[0], "{law:?} {state:?}");
            }
        }
    }
    let (e, nu) = (YOUNG, POISSON);
    for law in all_samples() {
        for state in StressState::ALL {
            let moduli = match state {
                StressState::UniaxialStress => [e, f64::NAN],
                StressState::PlaneStress => [e / (1.0 - nu * nu), e * nu / (1.0 - nu * nu)],
                _ => {
                    let lambda = e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
                    [lambda + e / (1.0 + nu), lambda]
                }
            };
            in_state!(check, law, state, moduli);
        }
        let found = law.small_strain();
        assert!((found.young_modulus() / e - 1.0).abs() < 1e-14, "{law:?}");
        assert!((found.poisson_ratio() / nu - 1.0).abs() < 1e-13, "{law:?}");
    }
}

/// Energies worked out by hand at `F = diag(2, 1, 1)` and at a simple shear of 1.
#[test]
fn energies_worked_out_by_hand() {
    let constants = LameConstants::from_bulk(6.0, 4.0).unwrap();
    let stretch = Matrix3::from_diagonal(&Vector3::new(1.0, 0.0, 0.0));
    let mut shear = Matrix3::zeros();
    shear[(0, 1)] = 1.0;
    let lambda = 6.0 - 8.0 / 3.0;
    let (third, ln2) = (2.0_f64.powf(-2.0 / 3.0), std::f64::consts::LN_2);
    // I1 = 6, I2 = 9 of the stretch, I1 = I2 = 4 of the shear.
    let mooney = HyperelasticLaw::mooney_rivlin(1.5, 0.5, 6.0).unwrap();
    let ogden = HyperelasticLaw::ogden(&[(8.0, 1.0)], 6.0).unwrap();
    for (law, stretched, sheared) in [
        (HyperelasticLaw::linear_elastic(constants), 0.5 * lambda + 4.0, 2.0),
        (
            HyperelasticLaw::saint_venant_kirchhoff(constants),
            0.5 * lambda * 2.25 + 4.0 * 2.25,
            lambda / 8.0 + 4.0 * 0.75,
        ),
        (HyperelasticLaw::neo_hookean(constants), 3.0 + 2.0 * (6.0 * third - 3.0), 2.0),
        (
            HyperelasticLaw::neo_hookean_logarithmic(constants),
            2.0 * 3.0 - 4.0 * ln2 + 0.5 * lambda * ln2 * ln2,
            2.0,
        ),
        (mooney, 3.0 + 1.5 * (6.0 * third - 3.0) + 0.5 * (9.0 * third * third - 3.0), 2.0),
        // The stretches of the shear are the golden ratio and its inverse: they sum to sqrt 5.
        (ogden, 3.0 + 8.0 * (4.0 * third.sqrt() - 3.0), 8.0 * (5.0_f64.sqrt() - 2.0)),
    ] {
        let (got_stretched, got_sheared): (f64, f64) = (law.energy(&stretch), law.energy(&shear));
        assert!((got_stretched - stretched).abs() < 1e-13, "{law:?}: {got_stretched} {stretched}");
        assert!((got_sheared - sheared).abs() < 1e-13, "{law:?}: {got_sheared} {sheared}");
    }
}

/// Dual-support (52) with the term that it lacks, and (45) with its rows set right.
#[test]
fn tangents_are_the_corrected_ones_of_the_source() {
    let LameConstants { lambda, mu } = constants();
    let a = Matrix3::new(0.2, -0.1, 0.3, 0.05, -0.1, 0.2, -0.15, 0.1, 0.25);
    let gradient = a + Matrix3::identity();
    let (cofactor, j) = (tensor::cofactor(&gradient), tensor::determinant(&gradient));
    let three = StressState::ThreeDimensional;
    let law = HyperelasticLaw::neo_hookean_logarithmic(constants());
    let tangent = Reduced::<3>::new(law.clone(), three).unwrap().tangent(&a);
    let hooke = HyperelasticLaw::linear_elastic(constants());
    let linear = Reduced::<3>::new(hooke, three).unwrap().tangent(&a);
    for (i, jj, k, l) in (0..81).map(|n| (n / 27, n / 9 % 3, n / 3 % 3, n % 3)) {
        let delta = |a: usize, b: usize| f64::from(u8::from(a == b));
        // d cof F / dF: every row of two indices that differ from i, k and J, L.
        let sign = |a: usize, b: usize| [0.0, 1.0, -1.0][(b + 3 - a) % 3];
        let second = sign(i, k) * sign(jj, l) * gradient[((6 - i - k) % 3, (6 - jj - l) % 3)];
        let expected = mu * delta(i, k) * delta(jj, l)
            + (lambda * j.ln() - mu) / j * second
            + (lambda - lambda * j.ln() + mu) / (j * j) * cofactor[(i, jj)] * cofactor[(k, l)];
        let got = tangent[k][l][(i, jj)];
        assert!((got - expected).abs() < 1e-13 * modulus(), "{i}{jj}{k}{l}: {got} {expected}");
        let expected = lambda * delta(i, jj) * delta(k, l)
            + mu * (delta(i, k) * delta(jj, l) + delta(i, l) * delta(jj, k));
        assert!((linear[k][l][(i, jj)] - expected).abs() < 1e-13 * modulus());
    }
}

#[test]
fn parameters_come_back_from_every_pair() {
    let of_young = LameConstants::from_young(30e9, 0.25).unwrap();
    assert!((of_young.lambda - 12e9).abs() < 1e-4 && (of_young.mu - 12e9).abs() < 1e-4);
    let of_lame = LameConstants::new(12e9, 12e9).unwrap();
    assert_eq!((of_lame.young_modulus(), of_lame.poisson_ratio()), (30e9, 0.25));
    let of_bulk = LameConstants::from_bulk(20e9, 12e9).unwrap();
    assert_eq!((of_bulk.lambda, of_bulk.bulk_modulus()), (12e9, 20e9));
}

#[test]
fn parameters_out_of_range_are_refused() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(LameConstants::from_young(bad, 0.3).is_err());
        assert!(LameConstants::new(1.0, bad).is_err());
        assert!(LameConstants::from_bulk(bad, 1.0).is_err());
        assert!(LameConstants::from_bulk(1.0, bad).is_err());
        assert!(HyperelasticLaw::mooney_rivlin(bad, 0.0, 1.0).is_err());
        assert!(HyperelasticLaw::mooney_rivlin(1.0, 0.0, bad).is_err());
        assert!(HyperelasticLaw::ogden(&[(bad, 1.0)], 1.0).is_err());
        assert!(HyperelasticLaw::ogden(&[(1.0, 1.0)], bad).is_err());
    }
    for bad in [-1.0, 0.5, 0.7, f64::NAN] {
        let error = LameConstants::from_young(1.0, bad).unwrap_err();
        assert!(matches!(error, MaterialError::PoissonRatio { .. }), "{bad}");
    }
    let error = LameConstants::new(-1.0, 1.5).unwrap_err();
    assert_eq!(
        error.to_string(),
        "`lame_lambda` must be above -2/3 of the shear modulus, which is -1, got -1"
    );
    assert!(HyperelasticLaw::ogden(&[], 1.0).is_err());
    assert!(HyperelasticLaw::ogden(&[(1.0, 1.0); 4], 1.0).is_err());
    let error =
        Reduced::<2>::new(all_samples()[0].clone(), StressState::UniaxialStrain).unwrap_err();
    assert_eq!(error.to_string(), "UniaxialStrain does not exist in 2 dimensions");
}

#[test]
fn rotations_strain_what_is_not_objective() {
    let quarter = Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
    for law in all_samples() {
        let energy: f64 = law.energy(&(quarter - Matrix3::identity()));
        assert_eq!(energy.abs() < 1e-12 * modulus(), law.is_objective(), "{law:?}: {energy}");
    }
}

/// Rubber at many times its length, where the missing stretches are far from one and the stress
/// across is the difference of terms up to a hundred times the modulus.
#[test]
fn free_surfaces_stay_free_of_stress_at_large_stretches() {
    for law in all_samples().into_iter().filter(|law| law.name().starts_with("neo")) {
        for stretch in [0.05, 0.2, 0.5, 2.0, 5.0, 20.0] {
            let a = SMatrix::<f64, 2, 2>::new(stretch - 1.0, 0.3, 0.0, 0.0);
            let sheet = Reduced::<2>::new(law.clone(), StressState::PlaneStress).unwrap();
            let stress: Matrix3<f64> = law.stress(&sheet.in_three(&a));
            assert!(stress[(2, 2)].abs() < 1e-10 * modulus(), "{law:?} {stretch} {stress}");
            let bar = Reduced::<1>::new(law.clone(), StressState::UniaxialStress).unwrap();
            let a = SMatrix::<f64, 1, 1>::new(stretch - 1.0);
            let stress: Matrix3<f64> = law.stress(&bar.in_three(&a));
            assert!(stress[(2, 2)].abs() < 1e-10 * modulus(), "{law:?} {stretch} {stress}");
            assert_eq!(stress[(1, 1)], stress[(2, 2)]);
            assert!(stress[(0, 0)] * (stretch - 1.0) > 0.0, "{law:?} {stretch} {stress}");
        }
    }
}

/// Rounding makes the sign of a stress across that should vanish a matter of chance, so that a search
/// which may come back to the ends of its bracket goes to and fro for ever: about once in ten thousand.
#[test]
fn the_stretch_across_is_found_at_any_stretch() {
    let law =
        HyperelasticLaw::neo_hookean_logarithmic(LameConstants::from_young(0.2e6, 0.45).unwrap());
    let sheet = Reduced::<2>::new(law.clone(), StressState::PlaneStress).unwrap();
    for count in 0..100_000 {
        let stretch = 3.0 + 3e-5 * f64::from(count);
        let a = SMatrix::<f64, 2, 2>::new(1.1 / stretch.sqrt() - 1.0, 0.01, 0.02, stretch - 1.0);
        assert!(sheet.energy(&a).is_finite(), "at a stretch of {stretch}");
    }
}

/// The moduli of waves against the eigenvalues of the acoustic tensors that the tangent has.
fn check_wave_moduli<const D: usize>(
    law: HyperelasticLaw,
    state: StressState,
    gradient: &Matrix3<f64>,
) -> Result<(), TestCaseError> {
    let law = Reduced::<D>::new(law.clone(), state).expect("the state fits");
    let gradient = SMatrix::<f64, D, D>::from_fn(|i, j| gradient[(i, j)]);
    let tangent = law.tangent(&gradient);
    let deformation = gradient + SMatrix::identity();
    // A part of a rotation may turn a body inside out.
    prop_assume!(tensor::determinant(&deformation) > 0.1);
    let strain = DMatrix::from_fn(D, D, |i, j| deformation.column(i).dot(&deformation.column(j)));
    let directions = strain.symmetric_eigen().eigenvectors;
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    for n in directions.column_iter() {
        let acoustic = DMatrix::from_fn(D, D, |i, k| {
            let entries = (0..D * D).map(|entry| (entry / D, entry % D));
            entries.map(|(j, l)| n[j] * n[l] * tangent[k][l][(i, j)]).sum::<f64>()
        });
        let values = acoustic.symmetric_eigenvalues();
        (least, most) = (least.min(values.min()), most.max(values.max()));
    }
    // No stretch across may be free of stress.
    prop_assume!(law.stress(&gradient).iter().all(|stress| stress.is_finite()));
    let [slow, fast] = law.wave_moduli(&gradient);
    // Directions of equal stretches are any, to the root of rounding.
    let bound = 1e-6 * modulus() * (1.0 + fast.abs() / modulus());
    close(slow, least, bound)?;
    close(fast, most, bound)
}

proptest! {
    #[test]
    fn wave_moduli_are_eigenvalues_of_the_acoustic_tensors(
        law in laws(),
        state in prop::sample::select(StressState::ALL.to_vec()),
        a in gradients(),
        r in rotations(),
        stretch in 0.5..3.0_f64,
    ) {
        prop_assume!(law.is_objective());
        in_state!(check_wave_moduli, law, state, &a)?;
        // All stretches are the same, or two of them.
        let even = r * stretch - Matrix3::identity();
        in_state!(check_wave_moduli, law, state, &even)?;
        let two = Matrix3::from_diagonal(&Vector3::new(stretch, stretch, 1.1)) - Matrix3::identity();
        in_state!(check_wave_moduli, law, state, &two)?;
    }

    #[test]
    fn stress_and_tangent_are_derivatives(
        law in laws(),
        state in prop::sample::select(StressState::ALL.to_vec()),
        a in gradients(),
    ) {
        in_state!(check_stress_and_tangent, law, state, &a)?;
    }

    #[test]
    fn rotations_cost_nothing(law in laws(), a in gradients(), r in rotations()) {
        prop_assume!(law.is_objective());
        let rotated = r * (a + Matrix3::identity()) - Matrix3::identity();
        let bound = 1e-13 * modulus();
        close(law.energy(&rotated), law.energy(&a), bound)?;
        let (stress, expected): (Matrix3<f64>, _) = (law.stress(&rotated), r * law.stress(&a));
        prop_assert!((stress - expected).amax() < 10.0 * bound, "{stress} {expected}");
        // Isotropic too: what is turned before it is strained answers alike.
        let turned = (a + Matrix3::identity()) * r - Matrix3::identity();
        close(law.energy(&turned), law.energy(&a), bound)?;
    }

    /// The energy of a small strain is quadratic, to the strain's own size and no worse.
    #[test]
    fn small_strains_keep_their_digits(law in laws(), a in gradients(), power in 3..8_i32) {
        // Instructions see I1, which is 3 and a little.
        prop_assume!(law.name() != "hyperelastic");
        let a = a * (10.0_f64.powi(-power) / a.amax().max(1e-300));
        let hooke = HyperelasticLaw::linear_elastic(constants());
        let symmetric = (a + a.transpose()) * 0.5;
        let (energy, expected): (f64, f64) = (law.energy(&symmetric), hooke.energy(&symmetric));
        prop_assume!(symmetric.amax() > 0.1 * a.amax());
        let bound = 20.0 * a.amax() + 1e-14 / a.amax();
        prop_assert!((energy / expected - 1.0).abs() < bound, "{energy} {expected}");
    }

    #[test]
    fn special_cases_of_ogden_are_the_others(a in gradients(), share in 0.1..0.9_f64) {
        let (mu, kappa) = (constants().mu, constants().bulk_modulus());
        let neo = HyperelasticLaw::neo_hookean(constants());
        let one = HyperelasticLaw::ogden(&[(mu, 2.0)], kappa).unwrap();
        let (c10, c01) = (0.5 * share * mu, 0.5 * (1.0 - share) * mu);
        let rivlin = HyperelasticLaw::mooney_rivlin(c10, c01, kappa).unwrap();
        let two = HyperelasticLaw::ogden(&[(2.0 * c10, 2.0), (-2.0 * c01, -2.0)], kappa).unwrap();
        for (law, ogden) in [(neo, one), (rivlin, two)] {
            close(law.energy(&a), ogden.energy(&a), 1e-14 * modulus())?;
            let (p, q): (Matrix3<f64>, Matrix3<f64>) = (law.stress(&a), ogden.stress(&a));
            prop_assert!((p - q).amax() < 1e-13 * modulus());
        }
    }
}
