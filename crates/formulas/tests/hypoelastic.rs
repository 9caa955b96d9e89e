//! Exact solutions of hypoelastic and elastic-plastic solids.

use nalgebra::{Matrix3, Rotation3, Vector3};
use num_dual::Dual64;
use piola_formulas::hypoelastic::{
    EquationOfState, JohnsonCook, PressureLaw, Strength, advance, jaumann_rate, shear_energy,
    von_mises,
};

const G: f64 = 3.0;

fn simple_shear(rate: f64) -> Matrix3<f64> {
    Matrix3::new(0.0, rate, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
}

/// Error of simple shear to gamma = 2 in this many steps against `s_xy = G sin gamma`,
/// `s_xx = -s_yy = G (1 - cos gamma)`.
fn error_of_shear(steps: u32) -> f64 {
    let (rate, end) = (0.7, 2.0 / 0.7);
    let mut deviator = Matrix3::zeros();
    for _ in 0..steps {
        deviator = advance(G, &deviator, &simple_shear(rate), end / f64::from(steps));
    }
    let (sine, cosine) = 2.0_f64.sin_cos();
    let (xx, xy) = (G * (1.0 - cosine), G * sine);
    (deviator - Matrix3::new(xx, xy, 0.0, xy, -xx, 0.0, 0.0, 0.0, 0.0)).norm()
}

#[test]
fn simple_shear_oscillates_under_the_rate_of_jaumann() {
    let errors = [20, 40, 80].map(error_of_shear);
    assert!(errors[2] < 1e-3, "{errors:?}");
    for pair in errors.windows(2) {
        assert!((pair[0] / pair[1] - 4.0).abs() < 0.1, "second order: {errors:?}");
    }
}

#[test]
fn the_rate_is_that_of_the_steps() {
    let gradient = Matrix3::new(0.1_f64, 0.7, -0.3, 0.2, -0.4, 0.5, 0.9, 0.6, 0.25);
    let deviator = Matrix3::new(1.0, 0.4, 0.2, 0.4, -0.3, 0.6, 0.2, 0.6, -0.7);
    let rate = jaumann_rate(G, &deviator, &gradient);
    let step = 1e-6;
    let ahead = advance(G, &deviator, &gradient, step);
    let behind = advance(G, &deviator, &gradient, -step);
    let difference = (ahead - behind) / (2.0 * step);
    assert!((difference - rate).norm() < 1e-8 * rate.norm());
    assert!(rate.trace().abs() < 1e-14);
    assert!((rate - rate.transpose()).norm() < 1e-14);
}

#[test]
fn the_rate_turns_with_the_observer() {
    let gradient = Matrix3::new(0.1_f64, 0.7, -0.3, 0.2, -0.4, 0.5, 0.9, 0.6, 0.25);
    let deviator = Matrix3::new(1.0, 0.4, 0.2, 0.4, -0.3, 0.6, 0.2, 0.6, -0.7);
    let turn = *Rotation3::from_scaled_axis(Vector3::new(0.3, -1.1, 0.8)).matrix();
    // An observer who turns with the spin W sees L' = Q L Q^T + W.
    let spin = Vector3::new(0.5, 0.2, -0.9).cross_matrix();
    let turned = turn * deviator * turn.transpose();
    let seen = jaumann_rate(G, &turned, &(turn * gradient * turn.transpose() + spin));
    let expected = turn * jaumann_rate(G, &deviator, &gradient) * turn.transpose() + spin * turned
        - turned * spin;
    assert!((seen - expected).norm() < 1e-13);
}

#[test]
fn a_stress_that_turns_keeps_its_invariants() {
    let spin = Vector3::new(5.0, 2.0, -9.0).cross_matrix();
    let mut deviator = Matrix3::new(1.0_f64, 0.4, 0.2, 0.4, -0.3, 0.6, 0.2, 0.6, -0.7);
    let (before, determinant) = (von_mises(&deviator), deviator.determinant());
    for _ in 0..1000 {
        deviator = advance(G, &deviator, &spin, 0.01);
    }
    assert!((von_mises(&deviator) / before - 1.0).abs() < 1e-12);
    assert!((deviator.determinant() / determinant - 1.0).abs() < 1e-11);
}

#[test]
fn plane_strain_has_a_third_component() {
    let gradient = Matrix3::from_diagonal(&Vector3::new(0.01, 0.0, 0.0));
    let deviator = advance(G, &Matrix3::zeros(), &gradient, 1.0);
    let expected = Vector3::new(4.0, -2.0, -2.0) * (G * 0.01 / 3.0);
    assert!((deviator - Matrix3::from_diagonal(&expected)).norm() < 1e-16);
    // Confined compression: von Mises 2 G eps, and shear: sqrt 3 times it.
    assert!((von_mises(&deviator) - 2.0 * G * 0.01).abs() < 1e-15);
    assert!((von_mises(&simple_shear(1.0)) - 1.5_f64.sqrt()).abs() < 1e-15);
    let shear = simple_shear(1.0) + simple_shear(1.0).transpose();
    assert!((von_mises(&shear) - 3.0_f64.sqrt()).abs() < 1e-15);
}

const JOHNSON_COOK: JohnsonCook = JohnsonCook {
    yield_stress: 9.0,
    hardening: 29.0,
    exponent: 0.31,
    rate_factor: 0.025,
    reference_rate: 1.0,
    softening: 1.09,
    reference_temperature: 300.0,
    melting_temperature: 1356.0,
};

#[test]
fn stresses_return_to_the_yield_surface() {
    let (shear_modulus, plastic, temperature, step) = (400.0, 0.2, 500.0, 1e-3);
    let laws = [
        Strength::Linear { yield_stress: 10.0, hardening: 0.0 },
        Strength::Linear { yield_stress: 10.0, hardening: 50.0 },
        Strength::JohnsonCook(JOHNSON_COOK),
    ];
    for (number, law) in laws.into_iter().enumerate() {
        for trial in [21.0, 40.0, 500.0, 5e4] {
            let returned = law.return_to_surface(trial, shear_modulus, plastic, temperature, step);
            let (strain, increment) = (plastic + returned.increment, returned.increment);
            let flow = match law {
                Strength::Linear { yield_stress, hardening } => yield_stress + hardening * strain,
                Strength::JohnsonCook(law) => {
                    law.flow_stress(strain, increment / step, temperature)
                }
                Strength::Elastic => unreachable!("it is not in the list"),
            };
            let stress = trial * returned.scale;
            if returned.increment == 0.0 {
                assert_eq!((returned.scale, number, trial), (1.0, 2, 21.0));
                continue;
            }
            assert!((stress / flow - 1.0).abs() < 1e-9, "law {number}, {trial}: {stress} {flow}");
            assert!((stress - (trial - 3.0 * shear_modulus * increment)).abs() < 1e-9 * trial);
            assert!((returned.stress - stress).abs() < 1e-9 * trial);
        }
        let within = law.return_to_surface(5.0, shear_modulus, plastic, temperature, step);
        assert_eq!((within.scale, within.increment), (1.0, 0.0));
    }
    let elastic = Strength::Elastic.return_to_surface(1e9, 1.0, 0.0, 300.0, 1.0);
    assert_eq!(elastic.scale, 1.0);
}

#[test]
fn johnson_and_cooks_stress_hardens_and_softens() {
    let at = |strain, rate, temperature| JOHNSON_COOK.flow_stress(strain, rate, temperature);
    assert_eq!(at(0.0, 0.0, 300.0), 9.0);
    assert_eq!(at(1.0, 0.5, 250.0), 38.0);
    let fast = 38.0 * (1.0 + 0.025 * 1e4_f64.ln());
    assert!((at(1.0, 1e4, 300.0) - fast).abs() < 1e-12);
    assert_eq!(at(1.0, 1e4, 1356.0), 0.0);
    let half = at(1.0, 0.0, 828.0) / 38.0;
    assert!((half - (1.0 - 0.5_f64.powf(1.09))).abs() < 1e-12);
}

const LAWS: [PressureLaw; 3] = [
    PressureLaw::Linear,
    PressureLaw::Tait { exponent: 4.0 },
    PressureLaw::MieGrueneisen { slope: 1.338, gruneisen: 2.0 },
];

fn state(law: PressureLaw) -> EquationOfState {
    EquationOfState { density: 2785.0, wave_speed: 5328.0, law, spall_strength: f64::INFINITY }
}

#[test]
fn a_shock_lands_on_the_hugoniot() {
    let state = state(LAWS[2]);
    for speed in [10.0, 500.0, 3100.0, 8000.0] {
        // Conservation across a shock that moves with U = c + S u into solid at rest.
        let shock = state.wave_speed + 1.338 * speed;
        let density = state.density * shock / (shock - speed);
        let pressure = state.density * shock * speed;
        let found = state.pressure(density, 0.5 * speed * speed);
        assert!((found / pressure - 1.0).abs() < 1e-11, "{speed} m/s: {found} {pressure}");
    }
}

#[test]
fn the_wave_speed_is_the_slope_of_the_pressure_at_constant_entropy() {
    for law in LAWS {
        let state = state(law);
        for ratio in [0.98, 1.0 - 1e-9, 1.0 + 1e-9, 1.1, 1.3] {
            let (density, energy) = (2785.0 * ratio, 2e4);
            let by_density: Dual64 =
                state.pressure(Dual64::new(density, 1.0), Dual64::from_re(energy));
            let by_energy: Dual64 =
                state.pressure(Dual64::from_re(density), Dual64::new(energy, 1.0));
            let pressure = state.pressure(density, energy);
            // de = p / rho^2 drho.
            let slope = by_density.eps + by_energy.eps * pressure / (density * density);
            let square = state.wave_speed_squared(density, energy);
            assert!((slope / square - 1.0).abs() < 1e-12, "{law:?} at {ratio}");
            let rest: f64 = state.wave_speed_squared(2785.0, 0.0);
            assert!((rest / (5328.0 * 5328.0) - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
fn the_energy_of_compression_is_the_work_of_the_pressure() {
    for law in &LAWS[..2] {
        let state = state(*law);
        for ratio in [0.9, 1.05] {
            let density: f64 = 2785.0 * ratio;
            let step = 1e-4 * 2785.0;
            let energy = |density: f64| state.compression_energy(density, 0.0);
            let slope = (energy(density + step) - energy(density - step)) / (2.0 * step);
            let expected = state.pressure(density, 0.0) / (density * density);
            assert!((slope / expected - 1.0).abs() < 1e-6, "{law:?}: {slope} {expected}");
        }
        assert_eq!(state.compression_energy(2785.0, 0.0), 0.0);
    }
}

/// What is torn bears its spall strength, its energy is the work of that, and both go back the same way.
#[test]
fn a_solid_tears_at_its_spall_strength() {
    let strength = 1.2e9;
    for law in LAWS {
        let whole = state(law);
        let torn = EquationOfState { spall_strength: strength, ..whole };
        let pressures: [(f64, f64); 4] = [1.05, 0.999, 0.9, 0.5].map(|ratio| {
            let density = 2785.0 * ratio;
            (whole.pressure(density, 0.0), torn.pressure(density, 0.0))
        });
        for (whole, torn) in pressures {
            assert_eq!(torn, whole.max(-strength), "{law:?}");
        }
        assert_eq!(pressures[3].1, -strength);
        let opening: Dual64 = torn.pressure(Dual64::new(1500.0, 1.0), Dual64::from_re(0.0));
        assert_eq!(opening.eps, 0.0);
        let speeds = [whole, torn].map(|state| state.wave_speed_squared(1500.0, 0.0));
        assert_eq!(speeds[0], speeds[1]);
    }
    for law in &LAWS[..2] {
        let torn = EquationOfState { spall_strength: strength, ..state(*law) };
        for density in [2770.0, 2600.0, 1400.0] {
            let energy = |density: f64| torn.compression_energy(density, 0.0);
            let slope = (energy(density + 0.1) - energy(density - 0.1)) / 0.2;
            let expected = torn.pressure(density, 0.0) / (density * density);
            assert!((slope / expected - 1.0).abs() < 1e-5, "{law:?} at {density}");
        }
    }
}

/// In simple shear the energy is `tau gamma / 2`, and it is that of all nine components.
#[test]
fn the_energy_of_shear_is_half_of_stress_times_strain() {
    let (strain, density) = (0.01, 3.0);
    let one_side = simple_shear(G * strain);
    let stress = one_side + one_side.transpose();
    assert!(
        (shear_energy(&stress, G, density) - 0.5 * G * strain * strain / density).abs() < 1e-15
    );
}
