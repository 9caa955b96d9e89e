//! Properties of every registered volumetric law, as it is and prestressed.

use num_dual::Dual64;
use piola_formulas::volumetric::{
    MaterialError, Prestressed, StressState, VolumetricLaw, VolumetricResponse, bulk_modulus,
};
use proptest::prelude::*;

/// Laws of a name to test; a registered name without any fails.
fn samples(name: &str) -> Vec<VolumetricLaw> {
    let gamma_law = |gamma| VolumetricLaw::gamma_law(2.5e5, gamma).expect("parameters in range");
    match name {
        "linear" => {
            vec![
                VolumetricLaw::linear(2.5e5).expect("parameters in range"),
                VolumetricLaw::linear(1e-3).expect("parameters in range"),
            ]
        }
        // Integers take another path than fractions, 1 another formula, 65 is beyond the integers'.
        "gamma_law" => [1.0, 1.0 + 1e-9, 1.4, 2.0, 7.0, 7.15, 65.0].map(gamma_law).to_vec(),
        _ => panic!("the law `{name}` is registered and has no samples to test"),
    }
}

fn all_samples() -> Vec<VolumetricLaw> {
    VolumetricLaw::NAMES.into_iter().flat_map(samples).collect()
}

fn laws() -> impl Strategy<Value = VolumetricLaw> {
    prop::sample::select(all_samples())
}

fn prestressed_laws() -> impl Strategy<Value = Prestressed> {
    (laws(), 0.8..1.25)
        .prop_map(|(law, ratio)| law.prestressed(ratio).expect("parameters in range"))
}

/// Volume ratios of all sizes of strain, small ones too.
fn volume_ratios() -> impl Strategy<Value = f64> {
    prop_oneof![
        0.5..2.0,
        (-6.0..-1.0, any::<bool>()).prop_map(|(exponent, expansion)| {
            let strain = 10.0_f64.powf(exponent);
            if expansion { 1.0 + strain } else { 1.0 - strain }
        })
    ]
}

/// Pressure and tangent against derivatives of the energy by dual numbers.
fn check_derivatives(law: &impl VolumetricResponse, ratio: f64) -> Result<(), TestCaseError> {
    let dual = Dual64::from_re(ratio).derivative();
    let (energy, pressure) = (law.energy(dual), law.pressure(dual));
    let tangent: f64 = law.tangent(ratio);
    // A few roundings of the pressure, and of J, which move the pressure by the tangent.
    let rounding = 1e-14 * tangent.max(law.tangent(1.0)).max(pressure.re.abs());
    prop_assert!((energy.re - law.energy::<f64>(ratio)).abs() < rounding);
    prop_assert!((pressure.re - law.pressure::<f64>(ratio)).abs() < rounding);
    prop_assert!((energy.eps + pressure.re).abs() < rounding, "{} {}", energy, pressure);
    prop_assert!((pressure.eps + tangent).abs() < 1e-13 * tangent, "{} {}", pressure, tangent);
    Ok(())
}

#[test]
fn every_registered_law_is_sampled_under_its_own_name() {
    for name in VolumetricLaw::NAMES {
        assert!(samples(name).iter().all(|law| law.name() == name));
    }
}

#[test]
fn undeformed_material_is_free_of_stress_and_energy() {
    for law in all_samples() {
        assert_eq!(law.pressure(1.0), 0.0, "{law:?}");
        assert_eq!(law.energy(1.0), 0.0, "{law:?}");
        assert_eq!(law.volume_ratio_at_pressure(0.0), Some(1.0), "{law:?}");
    }
}

#[test]
fn pressures_worked_out_by_hand() {
    let linear = VolumetricLaw::linear(8.0).unwrap();
    assert_eq!((linear.pressure(0.5), linear.energy(0.5), linear.tangent(0.5)), (4.0, 1.0, 8.0));
    // (1/2)^-7 - 1 = 127 and 7 (1/2)^-8 = 1792; the energy is 1/6 (2^6 - 1) - 1/2 = 10.
    let gamma = VolumetricLaw::gamma_law(3.0, 7.0).unwrap();
    assert_eq!((gamma.pressure(0.5), gamma.tangent(0.5)), (381.0, 5376.0));
    assert!((gamma.energy(0.5) - 30.0_f64).abs() < 1e-13);
    let logarithmic = VolumetricLaw::gamma_law(3.0, 1.0).unwrap();
    assert_eq!((logarithmic.pressure(0.5), logarithmic.tangent(0.5)), (3.0, 12.0));
    assert!((logarithmic.energy(2.0) - 3.0 * (1.0 - std::f64::consts::LN_2)).abs() < 1e-15);
}

/// Against the closed form evaluated with 60 digits, at strains that `1 + strain` keeps exactly.
#[test]
fn gamma_energy_keeps_its_digits_at_small_strain() {
    let rows = [
        (1.0, 1.0 / 1073741824.0, 4.3368086872493727e-19),
        (7.0, 1.0 / 1073741824.0, 3.0357660754200057e-18),
        (7.0, -1.0 / 131072.0, 2.0373095810091304e-10),
        (1.4, 1.0 / 1024.0, 6.670509133903549e-07),
        (7.0, -1.0 / 64.0, 0.0008913879930260716),
        (7.0, 1.0 / 64.0, 0.0008201020195744228),
        (1.0, 5.0 / 16.0, 0.04056628451635824),
        (7.0, -1.0 / 2.0, 10.0),
        (2.5, 3.0 / 2.0, 1.0019881418756469),
    ];
    for (gamma, strain, expected) in rows {
        let law = VolumetricLaw::gamma_law(1.0, gamma).unwrap();
        let error = (law.energy(1.0 + strain) / expected - 1.0_f64).abs();
        assert!(error < 2e-14, "gamma {gamma}, strain {strain}: error {error:e}");
    }
}

#[test]
fn wave_speeds_of_the_undeformed_state() {
    // Upwind (3.54): sqrt(kappa / rho), and (6.31): sqrt(gamma kappa / rho).
    let linear = VolumetricLaw::linear(4e6).unwrap();
    assert_eq!(linear.wave_speed(1.0, 1000.0), 4000.0_f64.sqrt());
    let gamma = VolumetricLaw::gamma_law(1e5 / 7.0, 7.0).unwrap();
    assert!((gamma.wave_speed(1.0, 1000.0) - 10.0_f64).abs() < 1e-14);
    for law in [
        VolumetricLaw::linear_from_wave_speed(12.5, 998.0),
        VolumetricLaw::gamma_law_from_wave_speed(12.5, 998.0, 7.15),
    ] {
        assert!((law.unwrap().wave_speed(1.0, 998.0) - 12.5_f64).abs() < 1e-14);
    }
}

/// Upwind (6.28): the linear law costs `kappa / 2` at `J = 0`; the powers and the logarithm of the gamma law have no bound
/// there. The modulus of small changes is gamma times kappa, to the bit, as cases divide by it.
#[test]
fn what_collapse_and_small_changes_cost() {
    assert!(!VolumetricLaw::linear(8.0).unwrap().resists_collapse());
    for gamma in [1.0, 1.4, 2.0, 7.0, 7.15, 65.0] {
        let law = VolumetricLaw::gamma_law(1.0, gamma).unwrap();
        assert!(law.resists_collapse(), "{gamma}");
        assert_eq!((law.tangent(1.0), law.modulus()), (gamma, 1.0));
    }
}

#[test]
fn pressures_that_no_volume_has() {
    let linear = VolumetricLaw::linear(100.0).unwrap();
    assert_eq!(linear.volume_ratio_at_pressure(100.0), None, "compressed to nothing");
    let gamma = VolumetricLaw::gamma_law(100.0, 7.0).unwrap();
    assert_eq!(gamma.volume_ratio_at_pressure(-100.0), None, "torn apart");
    for law in all_samples() {
        for pressure in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(law.volume_ratio_at_pressure(pressure), None, "{law:?} at {pressure}");
        }
    }
}

#[test]
fn parameters_out_of_range_are_refused_by_name() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        for (result, parameter) in [
            (VolumetricLaw::linear(bad), "bulk_modulus"),
            (VolumetricLaw::gamma_law(bad, 7.0), "bulk_modulus"),
            (VolumetricLaw::linear_from_wave_speed(bad, 1.0), "wave_speed"),
            (VolumetricLaw::linear_from_wave_speed(1.0, bad), "density"),
            (VolumetricLaw::gamma_law_from_wave_speed(bad, 1.0, 7.0), "wave_speed"),
        ] {
            let message = result.unwrap_err().to_string();
            assert_eq!(message, format!("`{parameter}` must be positive and finite, got {bad}"));
        }
        assert!(VolumetricLaw::linear(1.0).unwrap().prestressed(bad).is_err());
    }
    for gamma in [0.999, 0.0, -7.0, f64::NAN, f64::INFINITY] {
        for result in [
            VolumetricLaw::gamma_law(1.0, gamma),
            VolumetricLaw::gamma_law_from_wave_speed(1.0, 1.0, gamma),
        ] {
            assert!(matches!(result, Err(MaterialError::GammaBelowOne { .. })), "{gamma}");
        }
    }
}

#[test]
fn poisson_ratios_without_a_modulus_are_refused() {
    use StressState::*;
    for state in [UniaxialStress, UniaxialStrain, PlaneStress, PlaneStrain, ThreeDimensional] {
        for bad in [-1.0, 0.500001, 1.0, f64::NAN, f64::INFINITY] {
            assert!(bulk_modulus(1.0, bad, state).is_err(), "{state:?} {bad}");
        }
        assert!(bulk_modulus(f64::NAN, 0.3, state).is_err());
        let free_sideways = matches!(state, UniaxialStress | PlaneStress);
        assert_eq!(bulk_modulus(1.0, 0.5, state).is_ok(), free_sideways, "{state:?}");
    }
    let message = bulk_modulus(1.0, 0.5, PlaneStrain).unwrap_err().to_string();
    assert_eq!(message, "`poisson_ratio` must be above -1 and below 0.5, got 0.5");
}

proptest! {
    #[test]
    fn pressure_and_tangent_are_derivatives(law in laws(), ratio in volume_ratios()) {
        check_derivatives(&law, ratio)?;
    }

    #[test]
    fn prestressed_pressure_and_tangent_are_derivatives(
        law in prestressed_laws(),
        ratio in volume_ratios(),
    ) {
        check_derivatives(&law, ratio)?;
    }

    #[test]
    fn energy_is_positive_and_convex(law in laws(), a in volume_ratios(), b in volume_ratios()) {
        let energy = |ratio| law.energy::<f64>(ratio);
        prop_assert!(energy(a) > 0.0);
        prop_assert!(law.tangent::<f64>(a) > 0.0);
        let chord = 0.5 * (energy(a) + energy(b));
        prop_assert!(energy(0.5 * (a + b)) <= chord * (1.0 + 1e-12));
        prop_assert!(law.pressure::<f64>(a) * (1.0 - a) > 0.0, "pressure opposes the change");
    }

    #[test]
    fn volume_ratio_inverts_the_pressure(law in laws(), ratio in volume_ratios()) {
        let found = law.volume_ratio_at_pressure(law.pressure(ratio));
        // In strong tension the gamma law's pressure is flat: its roundings weigh more, and in
        // the end all of it is rounded to -kappa.
        let stiffness: f64 = law.tangent(ratio) / law.tangent(1.0);
        prop_assume!(stiffness > 1e-8);
        let bound = 1e-14 + 1e-15 / stiffness;
        prop_assert!(found.is_some_and(|found| (found - ratio).abs() < bound), "{:?}", found);
    }

    #[test]
    fn prestressed_volume_ratio_inverts_the_pressure(
        law in prestressed_laws(),
        ratio in 0.9..1.1,
    ) {
        let found = law.volume_ratio_at_pressure(law.pressure(ratio));
        let stiffness: f64 = law.tangent(ratio) / law.tangent(1.0 / law.reference_ratio);
        let bound = 1e-14 + 1e-15 / stiffness;
        prop_assert!(found.is_some_and(|found| (found - ratio).abs() < bound), "{:?}", found);
    }

    /// The same material point seen from both configurations.
    #[test]
    fn prestressed_law_is_its_base_seen_from_elsewhere(law in prestressed_laws(), ratio in 0.7..1.4) {
        let from_free = law.reference_ratio * ratio;
        prop_assert_eq!(law.pressure::<f64>(ratio), law.law.pressure(from_free));
        // The energy of a piece of stress-free volume V is V psi, and the piece measures J0 V.
        let energy = law.energy::<f64>(ratio) * law.reference_ratio;
        prop_assert!((energy / law.law.energy::<f64>(from_free) - 1.0).abs() < 1e-14);
        // A wave crosses a bar in the same time: its lengths are as 1 to J0, and so are the speeds.
        let density = 1234.5;
        let free: f64 = law.law.wave_speed(from_free, density);
        let prestressed: f64 = law.wave_speed(ratio, law.reference_density(density));
        prop_assert!((prestressed / (law.reference_ratio * free) - 1.0).abs() < 1e-14);
    }

    #[test]
    fn powers_by_products_are_the_general_powers(exponent in 1..=64u32, ratio in volume_ratios()) {
        let law = VolumetricLaw::gamma_law(1.0, exponent.into()).unwrap();
        let expected = ratio.powf(-f64::from(exponent)) - 1.0;
        let bound = 4.0 * f64::EPSILON * f64::from(exponent) * (expected.abs() + 1.0);
        prop_assert!((law.pressure(ratio) - expected).abs() <= bound);
    }

    /// Lame's constants know the states by another way.
    #[test]
    fn moduli_are_those_of_lame(young in 1.0..1e9, poisson in -0.9..0.49) {
        let mu = young / (2.0 * (1.0 + poisson));
        let lambda = 2.0 * mu * poisson / (1.0 - 2.0 * poisson);
        let plane_stress_lambda = 2.0 * lambda * mu / (lambda + 2.0 * mu);
        for (state, expected) in [
            (StressState::UniaxialStress, mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu)),
            (StressState::UniaxialStrain, lambda + 2.0 * mu),
            (StressState::PlaneStress, plane_stress_lambda + mu),
            (StressState::PlaneStrain, lambda + mu),
            (StressState::ThreeDimensional, lambda + 2.0 / 3.0 * mu),
        ] {
            let got = bulk_modulus(young, poisson, state).unwrap();
            prop_assert!((got / expected - 1.0).abs() < 1e-12, "{:?}: {} {}", state, got, expected);
        }
    }
}
