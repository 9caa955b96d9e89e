//! Runs of the formulation as a whole: what they conserve, and what they do not depend on.

use piola::schemes::transport_velocity::{
    Corrections, DensityRule, PressureRule, Settings, Shifting, TransportVelocity,
};
use piola::schemes::{Ledger, Scheme};
use piola::time::IntegratorKind;

use super::support::{SETTINGS, change_rows, rows};
use super::taylor_green::vortices;

const STEP: f64 = 4e-4;

/// Takes `steps` steps from a state at `first` steps.
fn advance(scheme: &mut dyn Scheme, mut state: Vec<f64>, first: usize, steps: usize) -> Vec<f64> {
    let mut new = state.clone();
    let mut integrator = IntegratorKind::KickDriftKick.build(scheme).expect("it moves the scheme");
    for count in first..first + steps {
        integrator
            .step(scheme, count as f64 * STEP, STEP, &state, &mut new)
            .expect("explicit methods always find a state");
        std::mem::swap(&mut state, &mut new);
    }
    state
}

fn bits(state: &[f64]) -> Vec<u64> {
    state.iter().map(|value| value.to_bits()).collect()
}

/// Small and quick to move: 40 x 40 vortices, 60 steps of which renew the list some times.
fn scheme(settings: Settings) -> TransportVelocity<2> {
    vortices(40, 100.0, settings, 5)
}

const ITERATIVE: Shifting = Shifting::Iterative { tolerance: 1e-3, most_passes: 3 };
const BACKGROUND: Shifting = Shifting::Background { most: 1.0 };

#[test]
fn results_do_not_depend_on_when_lists_were_made() {
    for shifting in [SETTINGS.shifting, ITERATIVE, BACKGROUND] {
        let settings = Settings { shifting, ..SETTINGS };
        let mut whole = scheme(settings);
        let start = whole.initial_state();
        let expected = advance(&mut whole, start, 0, 60);
        let builds = whole.list_builds();
        assert!((2..40).contains(&builds), "a list lasts for some steps: {builds} in 60");
        // A scheme made anew every seven steps has lists of its own, and the state is all it needs.
        let mut state = scheme(settings).initial_state();
        for first in (0..60).step_by(7) {
            state = advance(&mut scheme(settings), state, first, 7.min(60 - first));
        }
        assert_eq!(bits(&state), bits(&expected), "{shifting:?}");
    }
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let with = |threads: usize, shifting: Shifting| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads can be started").install(|| {
            let mut scheme = scheme(Settings { shifting, ..SETTINGS });
            let start = scheme.initial_state();
            bits(&advance(&mut scheme, start, 0, 20))
        })
    };
    for shifting in [SETTINGS.shifting, BACKGROUND] {
        assert_eq!(with(1, shifting), with(3, shifting), "{shifting:?}");
    }
}

/// Were both integrated, what they differ by would remain, theory (25), and grow over thousands of
/// steps: here it is there at the start.
#[test]
fn densities_and_pressures_do_not_drift_apart() {
    let settings = Settings { density: DensityRule::Continuity, ..SETTINGS };
    let mut scheme = scheme(settings);
    let mut start = scheme.initial_state();
    change_rows(&scheme, &mut start, |number, row| {
        row[4] *= 1.0 + 1e-3 * (number as f64).sin();
    });
    let state = advance(&mut scheme, start, 0, 50);
    let [density, wave_speed] = [1.0, 10.0];
    for row in rows(&scheme, &state) {
        let [rho, pressure] = [row[4], row[5]];
        let expected = density + pressure / (wave_speed * wave_speed);
        assert!((rho - expected).abs() < 1e-12 * expected, "{rho} for {expected} kg/m^3");
    }
}

#[test]
fn the_ledger_closes_for_every_choice() {
    let choices = [
        SETTINGS,
        Settings { density: DensityRule::Continuity, artificial_viscosity: 0.2, ..SETTINGS },
        Settings { pressure: PressureRule::StateEquation, ..SETTINGS },
        Settings { corrections: Corrections::GENERALISED, shifting: BACKGROUND, ..SETTINGS },
        Settings {
            density: DensityRule::Continuity,
            pressure: PressureRule::StateEquation,
            corrections: Corrections::NONE,
            shifting: Shifting::None,
            ..SETTINGS
        },
    ];
    for settings in choices {
        let mut scheme = scheme(settings);
        let start = scheme.initial_state();
        let total = |scheme: &TransportVelocity<2>, state: &[f64]| {
            let mut energies = [0.0; 3];
            scheme.energies(state, &mut energies);
            energies.iter().sum::<f64>()
        };
        let before = total(&scheme, &start);
        let state = advance(&mut scheme, start, 0, 50);
        let work = Ledger::of(&scheme, &state).work;
        let gained = total(&scheme, &state) - before;
        let balance = gained - work.iter().sum::<f64>();
        // Round-off of 50 sums over 1600 particles.
        assert!(balance.abs() < 1e-12 * before, "{settings:?}: {balance:e} of {before:e} J");
        let named = |name| {
            work[scheme.description().ledger.mechanisms.iter().position(|m| *m == name).unwrap()]
        };
        assert!(named("viscosity") < -1e-3 * before, "viscosity takes energy");
        assert!(named("artificial_viscosity") <= 0.0);
        if let PressureRule::Edac { .. } = settings.pressure {
            assert!(named("pressure_diffusion") < 0.0, "diffusion takes energy");
        }
    }
}

#[test]
fn momentum_enters_by_the_ways_in_and_no_other() {
    let mut scheme = scheme(SETTINGS);
    let start = scheme.initial_state();
    let momentum = |scheme: &TransportVelocity<2>, state: &[f64]| {
        let mut momentum = [0.0; 3];
        scheme.momentum(state, &mut momentum);
        momentum
    };
    let before = momentum(&scheme, &start);
    let state = advance(&mut scheme, start, 0, 50);
    let after = momentum(&scheme, &state);
    let ways = Ledger::of(&scheme, &state).impulses;
    for component in 0..2 {
        let entered: f64 = ways.iter().skip(component).step_by(3).sum();
        let balance = after[component] - before[component] - entered;
        assert!(balance.abs() < 1e-13, "component {component}: {balance:e} of a mass of 1 kg");
    }
    // Walls and body forces there are none; viscosity comes in pairs.
    assert!(ways[..2].iter().chain(&ways[3..5]).all(|impulse| *impulse == 0.0));
    assert!(ways[6..8].iter().all(|impulse| impulse.abs() < 1e-13));
}
