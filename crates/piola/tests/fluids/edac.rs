//! The pressure of solids by integration (EDAC): the law of state without diffusion, and the decay of a
//! wave with it.

use std::f64::consts::PI;
use std::sync::Arc;

use piola::boundaries::PrescribedVelocity;
use piola::schemes::Scheme;
use piola::schemes::transport_velocity::{PressureRule, Settings, SolidsInput};
use piola::time::IntegratorKind;

use super::solids::{SETTINGS, SOLID};
use super::support::{Solids, change_rows, rows, solids_in_box, unit_box};

const SIDE: usize = 32;
const STEP: f64 = 2e-3;

fn edac(alpha: f64) -> Settings {
    Settings { pressure: PressureRule::Edac { alpha }, ..SETTINGS }
}

/// Density and pressure, by number.
fn pressures(scheme: &dyn Scheme, state: &[f64]) -> Vec<(f64, f64)> {
    rows(scheme, state).iter().map(|row| (row[4], row[5])).collect()
}

/// Rings of a block that moves at random, after some steps.
fn moved(settings: Settings) -> Vec<(f64, f64)> {
    let particles = unit_box::<2>(12, 0.1, 3);
    let (input, solids) = solids_in_box(particles, settings, vec![SOLID]);
    let mut scheme = Solids::new(input, solids).expect("the solid can be built");
    let mut state = scheme.initial_state();
    change_rows(&scheme, &mut state, |_, row| {
        row[0] = 0.2 * (2.0 * PI * row[2]).sin();
        row[1] = 0.2 * (2.0 * PI * row[3]).cos();
    });
    scheme.split().expect("it can be split").accelerate(0.0, &mut state);
    let mut new = state.clone();
    let mut integrator =
        IntegratorKind::KickDriftKick.build(&mut scheme).expect("it moves the scheme");
    for k in 0..60 {
        let time = 1e-3 * f64::from(k);
        integrator.step(&mut scheme, time, 1e-3, &state, &mut new).expect("it is explicit");
        std::mem::swap(&mut state, &mut new);
    }
    pressures(&scheme, &state)
}

#[test]
fn without_diffusion_the_pressure_of_solids_is_that_of_the_law_of_state() {
    let stiffness = SOLID.state.wave_speed * SOLID.state.wave_speed;
    let size = |found: &[(f64, f64)]| found.iter().map(|(_, p)| p.abs()).fold(0.0, f64::max);
    let off = |found: &[(f64, f64)]| {
        let all = found.iter().map(|(rho, p)| (p - stiffness * (rho - SOLID.state.density)).abs());
        all.fold(0.0, f64::max)
    };
    let [none, little, more] = [0.0, 1e-3, 1e-2].map(|alpha| moved(edac(alpha)));
    assert!(size(&none) > 1.0, "{}", size(&none));
    // Both are integrals of the same rates.
    assert!(off(&none) < 1e-12 * size(&none), "{:e} of {}", off(&none), size(&none));
    // Diffusion is linear in its factor while it is small.
    let ratio = off(&more) / off(&little);
    assert!(off(&little) < 1e-3 * size(&little), "{:e} of {}", off(&little), size(&little));
    assert!((9.0..10.1).contains(&ratio), "{ratio}");
    // And the state equation itself moves the block the same way.
    let algebraic = moved(SETTINGS);
    let pairs = none.iter().zip(&algebraic);
    let apart = pairs.map(|(one, two)| (one.1 - two.1).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-10 * size(&none), "{apart:e}");
}

#[test]
fn a_pressure_wave_in_a_solid_that_is_held_decays_as_diffusion_says() {
    const ALPHA: f64 = 0.4;
    let particles = unit_box::<2>(SIDE, 0.0, 1);
    let count = particles.len();
    let all: Vec<u32> = (0..count as u32).collect();
    let held = (0..2).map(|component| PrescribedVelocity {
        name: "all".into(),
        particles: all.clone(),
        component,
        value: Arc::new(0.0_f64),
    });
    let (input, solids) = solids_in_box(particles, edac(ALPHA), vec![SOLID]);
    let solids = SolidsInput { held: held.collect(), ..solids };
    let h = input.smoothing_length;
    let mut scheme = Solids::new(input, solids).expect("the solid can be built");
    let mut state = scheme.initial_state();
    change_rows(&scheme, &mut state, |_, row| row[5] = (2.0 * PI * row[2]).cos());
    let before = pressures(&scheme, &state);
    let terms = scheme.terms(0.0, &state);
    // A wave is an eigenvector on a lattice: its rate there, and nu_e k^2 of theory (23).
    let rate = -terms[0].0.pressure_diffusion / before[0].1;
    let expected = ALPHA * h * SOLID.state.wave_speed / 8.0 * (2.0 * PI).powi(2);
    assert!((rate / expected - 1.0).abs() < 0.03, "{rate} for {expected} 1/s");
    for ((_, pressure), (rates, _)) in before.iter().zip(&terms) {
        assert!((rates.pressure_diffusion + rate * pressure).abs() < 1e-12 * rate);
    }
    let mut new = state.clone();
    let mut integrator =
        IntegratorKind::KickDriftKick.build(&mut scheme).expect("it moves the scheme");
    for k in 0..100 {
        let time = STEP * f64::from(k);
        integrator.step(&mut scheme, time, STEP, &state, &mut new).expect("it is explicit");
        std::mem::swap(&mut state, &mut new);
    }
    let decay = (1.0 - rate * STEP).powi(100);
    assert!(decay < 0.9);
    for (found, start) in pressures(&scheme, &state).iter().zip(&before) {
        assert!((found.1 - start.1 * decay).abs() < 1e-12, "{} for {}", found.1, start.1 * decay);
        assert_eq!(found.0, start.0, "what is held is not compressed");
    }
}
