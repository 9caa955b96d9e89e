//! Runs of the formulation as a whole: what they conserve, and what they do not depend on.

use piola::schemes::Scheme;
use piola::schemes::transport_velocity::{
    Corrections, DensityRule, PressureRule, Settings, Shifting, TransportVelocity,
};
use piola::time::IntegratorKind;

use super::support::SETTINGS;
use super::taylor_green::vortices;

const STEP: f64 = 4e-4;

/// Takes `steps` steps from a state at `first` steps.
fn advance(scheme: &mut dyn Scheme, mut state: Vec<f64>, first: usize, steps: usize) -> Vec<f64> {
    let mut new = state.clone();
    let mut integrator = IntegratorKind::KickDriftKick.build(state.len());
    for count in first..first + steps {
        integrator.step(scheme, count as f64 * STEP, STEP, &state, &mut new);
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

#[test]
fn results_do_not_depend_on_when_lists_were_made() {
    for shifting in [SETTINGS.shifting, ITERATIVE] {
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
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads can be started").install(|| {
            let mut scheme = scheme(SETTINGS);
            let start = scheme.initial_state();
            bits(&advance(&mut scheme, start, 0, 20))
        })
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn the_ledger_closes_for_every_choice() {
    let choices = [
        SETTINGS,
        Settings { density: DensityRule::Continuity, artificial_viscosity: 0.2, ..SETTINGS },
        Settings { pressure: PressureRule::StateEquation, ..SETTINGS },
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
            let mut energies = [0.0; 2];
            scheme.energies(state, &mut energies);
            energies[0] + energies[1]
        };
        let before = total(&scheme, &start);
        let state = advance(&mut scheme, start, 0, 50);
        let work = &state[state.len() - scheme.mechanisms().len()..];
        let gained = total(&scheme, &state) - before;
        let balance = gained - work.iter().sum::<f64>();
        // Round-off of 50 sums over 1600 particles.
        assert!(balance.abs() < 1e-12 * before, "{settings:?}: {balance:e} of {before:e} J");
        let named = |name| work[scheme.mechanisms().iter().position(|m| *m == name).unwrap()];
        assert!(named("viscosity") < -1e-3 * before, "viscosity takes energy");
        assert!(named("artificial_viscosity") <= 0.0);
        if let PressureRule::Edac { .. } = settings.pressure {
            assert!(named("pressure_diffusion") < 0.0, "diffusion takes energy");
        }
    }
}

#[test]
fn momentum_is_kept_without_the_dilatation() {
    // All other terms are antisymmetric in a and b. CTVF (27)'s second term is not.
    let settings = Settings { corrections: Corrections::STRESS, ..SETTINGS };
    let mut scheme = scheme(settings);
    let start = scheme.initial_state();
    let momentum = |state: &[f64]| {
        let rows = state.chunks_exact(10).take(1600);
        rows.fold([0.0, 0.0], |sum, row| [sum[0] + row[0] / 1600.0, sum[1] + row[1] / 1600.0])
    };
    let before = momentum(&start);
    let after = momentum(&advance(&mut scheme, start, 0, 50));
    let change = (after[0] - before[0]).hypot(after[1] - before[1]);
    assert!(change < 1e-13, "{change:e} of speeds of 1 m/s");
}
