//! Explicit integrators: their orders, what they make of what nothing damps, and what they refuse.

use std::f64::consts::{PI, TAU};

use crate::support::{Choice, PLAIN, energy, lattice};
use piola::Vector;
use piola::schemes::upwind::{Settings, Upwind};
use piola::schemes::{Scheme, boxed};
use piola::time::{Executor, IntegratorKind, Outcome, StepControl};
use piola_formulas::volumetric::VolumetricLaw;
use std::sync::atomic::AtomicBool;

/// A bar of the gamma law, clamped at one end, that swings by a tenth of its length.
fn bar(settings: Settings) -> Upwind<1> {
    let law =
        VolumetricLaw::gamma_law_from_wave_speed(10.0, 1000.0, 7.0).expect("a sound material");
    let mut choice = Choice::new(lattice([1.0], [20]), law).fix(0, |x| x[0] < 1e-9);
    choice.settings = settings;
    choice.smoothing_ratio = 1.0;
    choice.gravity[0] = 0.5;
    choice.build(|x| Vector::<1>::new(0.5 * (0.5 * PI * x[0]).sin()))
}

fn march(kind: IntegratorKind, scheme: &mut dyn Scheme, end: f64, steps: usize) -> Vec<f64> {
    let mut state = scheme.initial_state();
    scheme.constrain(0.0, &mut state);
    let mut new = state.clone();
    let mut integrator = kind.build(scheme).expect("it moves the scheme");
    let step = end / steps as f64;
    for count in 0..steps {
        let time = count as f64 * step;
        integrator
            .step(scheme, time, step, &state, &mut new)
            .expect("explicit methods find a state");
        std::mem::swap(&mut state, &mut new);
    }
    state
}

/// Every number of the state, the ledger included, approaches the same with its order.
#[test]
fn explicit_integrators_have_their_orders() {
    let exact = march(IntegratorKind::SspRk3, &mut bar(PLAIN), 0.3, 8000);
    for (kind, order) in [
        (IntegratorKind::TvdRk2, 2.0),
        (IntegratorKind::SspRk3, 3.0),
        (IntegratorKind::KickDriftKick, 2.0),
    ] {
        let error = |steps: usize| {
            let state = march(kind, &mut bar(PLAIN), 0.3, steps);
            let squares = state.iter().zip(&exact).map(|(a, b)| (a - b) * (a - b));
            squares.sum::<f64>().sqrt()
        };
        let errors = [200, 400, 800].map(error);
        let found = (errors[1] / errors[2]).log2();
        assert!((found - order).abs() < 0.1, "{kind:?} has order {found}: {errors:?}");
    }
}

/// The energy of one mode of a linear bar changes by the factor that is stated, step for step.
#[test]
fn one_mode_grows_and_decays_as_stated() {
    // Few, so that the fastest mode, twice as fast, has stable steps, too.
    let cells = 2;
    let linear = VolumetricLaw::linear(1000.0).expect("a sound material");
    for kind in [IntegratorKind::TvdRk2, IntegratorKind::SspRk3, IntegratorKind::KickDriftKick] {
        let mut choice = Choice::new(lattice([1.0], [cells]), linear).fix(0, |x| x[0] < 1e-9);
        choice.density = 10.0;
        choice.smoothing_ratio = 1.0;
        // The equations of motion, 2 u1 - u2 = (w dx / c)^2 2 u1 and 2 (u2 - u1) = (w dx / c)^2 u2 by
        // central differences with half a mass at the end, have u1 = u2 with w = c / (sqrt(2) dx).
        let mut scheme = choice.build(|x| Vector::<1>::new(if x[0] > 0.0 { 1e-6 } else { 0.0 }));
        let frequency = 10.0 * cells as f64 / 2.0_f64.sqrt();
        let (phase, steps) = (0.4, 100_u8);
        let start = energy(&scheme, &scheme.initial_state());
        let end = f64::from(steps) * phase / frequency;
        let state = march(kind, &mut scheme, end, steps.into());
        let found = energy(&scheme, &state) / start;
        let integrator = kind.build(&mut scheme).expect("it moves the scheme");
        let factor = integrator.energy_factor(phase).expect("it is known");
        let stated = factor.powi(steps.into());
        // Kick-drift-kick keeps an energy of its own, which differs by (w dt)^2 / 4.
        let tolerance = if kind == IntegratorKind::KickDriftKick { 0.04 } else { 1e-4 * stated };
        assert!((found - stated).abs() < tolerance, "{kind:?}: {found} for {stated}");
    }
}

/// The power method finds the fastest mode of central differences: at the free end, where half a mass
/// hangs on a one-sided slope, w = sqrt(2) c / dx.
#[test]
fn the_fastest_mode_is_found() {
    let linear = VolumetricLaw::linear(1000.0).expect("a sound material");
    let mut choice = Choice::new(lattice([1.0], [60]), linear).fix(0, |x| x[0] < 1e-9);
    choice.density = 10.0;
    choice.smoothing_ratio = 1.0;
    let mut scheme = choice.build(|_| Vector::<1>::zeros());
    let state = scheme.initial_state();
    let found = scheme.undamped_frequency(&state).expect("nothing damps it");
    let exact = 2.0_f64.sqrt() * 10.0 * 60.0;
    assert!((found / exact - 1.0).abs() < 0.05, "{found} for {exact}");
    let mut damped = bar(Settings { tau_velocity: 0.5, ..PLAIN });
    assert_eq!(damped.undamped_frequency(&state), None);
}

/// Many periods by kick-drift-kick: the energy stays within the square of the fastest phase.
#[test]
fn kick_drift_kick_keeps_energy_over_many_periods() {
    let mut scheme = bar(PLAIN);
    let steps = 40_000;
    let start = scheme.initial_state();
    let fastest = scheme.undamped_frequency(&start).expect("nothing damps it");
    let phase = 0.3;
    let end = f64::from(steps) * phase / fastest;
    assert!(end * fastest / TAU > 1000.0);
    let work = 0.5 * 1000.0; // largest of gravity, g m u
    let before = energy(&scheme, &start);
    let state = march(IntegratorKind::KickDriftKick, &mut scheme, end, steps as usize);
    let off = crate::support::imbalance(&scheme, before, &state).abs();
    assert!(off < 0.25 * phase * phase * (before + work), "{off} J of {before} J");
}

/// An integrator is built for a scheme, which has to offer what it needs; those that can are named.
#[test]
fn what_cannot_move_a_scheme_is_not_built() {
    let dissipating = || bar(Settings { tau_velocity: 0.5, ..PLAIN });
    let able = ["tvd_rk2", "ssp_rk3"];
    for kind in IntegratorKind::ALL {
        let mut scheme = dissipating();
        match kind.build(&mut scheme) {
            Ok(integrator) => {
                assert!(able.contains(&kind.name()), "{kind:?} serves");
                let control = StepControl::Cfl(0.3);
                let mut executor = Executor::new(boxed(scheme), integrator, control, 0.01);
                let summary = executor.run(&AtomicBool::new(false), &mut |_| {});
                assert_eq!(summary.expect("nobody looks").outcome, Outcome::Completed);
            }
            Err(refused) => {
                assert_eq!(refused.able, able);
                let message = refused.to_string();
                assert!(message.contains("those that can: `tvd_rk2`, `ssp_rk3`"), "{message}");
            }
        }
    }
    // One that was built for another scheme says so and moves nothing in silence.
    let mut integrator =
        IntegratorKind::KickDriftKick.build(&mut bar(PLAIN)).expect("it has kicks");
    let mut scheme = dissipating();
    let state = scheme.initial_state();
    let mut new = state.clone();
    let taken = integrator.step(&mut scheme, 0.0, 1e-4, &state, &mut new);
    assert_eq!(taken.expect_err("it cannot move it").kind(), "unserved");
}
