//! What steps keep, and how they follow the motion.

use piola::Vector;
use piola::operators::Correction;
use piola::schemes::upwind::{ImplicitSettings, Settings, WaveSpeed};
use piola::schemes::{Scheme, Theta, ThetaScheme, UnstableTheta};
use piola::solve::LinearMethod;

use super::problems::{
    ALL_BUT_PRESSURE, EVERYTHING, block, column, difference, gamma, implicit, linear, plate, walk,
};
use crate::support::{Choice, PLAIN, energy, imbalance, lattice, march};

/// Crank-Nicolson and the midpoint rule keep the energy of a linear body to rounding, at steps of
/// a fifth of its period and more; backward Euler loses it.
#[test]
fn energy_of_a_linear_column_is_kept() {
    for rule in [Theta::CRANK_NICOLSON, Theta::MIDPOINT] {
        let mut scheme = column(linear(1e6));
        let start = energy(&scheme, &scheme.initial_state());
        walk(&mut scheme, &rule, 0.08, 60, |scheme, state| {
            let change = energy(scheme, state) / start - 1.0;
            assert!(change.abs() < 1e-11, "{rule:?}: {change:e}");
        });
    }
    let mut scheme = column(linear(1e6));
    let start = energy(&scheme, &scheme.initial_state());
    let end = walk(&mut scheme, &Theta::BACKWARD_EULER, 0.08, 60, |_, _| {});
    assert!(energy(&scheme, &end) < 0.1 * start);
}

/// Upwind figure 6.9: of the gamma law the energy is bounded and not kept.
#[test]
fn energy_of_a_column_of_the_gamma_law_is_bounded() {
    for (rule, bound) in [(Theta::CRANK_NICOLSON, 0.06), (Theta::MIDPOINT, 0.06)] {
        let mut scheme = column(gamma());
        let start = energy(&scheme, &scheme.initial_state());
        let mut worst = 0.0_f64;
        walk(&mut scheme, &rule, 0.1, 80, |scheme, state| {
            worst = worst.max((energy(scheme, state) / start - 1.0).abs());
        });
        assert!(worst < bound && worst > 1e-6, "{rule:?}: {worst}");
    }
}

/// Orders in time by halving the step twice, with dissipation on.
#[test]
fn steps_have_the_order_they_should() {
    let end = |rule: &Theta, steps: usize| {
        let settings = Settings { tau_velocity: 0.2, ..PLAIN };
        let choice = Choice::new(lattice([1.0, 2.0], [3, 6]), gamma()).fix(1, |x| x[1] < 1e-9);
        let mut scheme = implicit(choice, settings).build(|x| Vector::<2>::new(0.0, -0.3 * x[1]));
        let state = walk(&mut scheme, rule, 0.1 / steps as f64, steps, |_, _| {});
        (scheme, state)
    };
    let theta = Theta::new(0.75).expect("a stable share");
    for (rule, order) in [
        (Theta::BACKWARD_EULER, 1.0),
        (theta, 1.0),
        (Theta::CRANK_NICOLSON, 2.0),
        (Theta::MIDPOINT, 2.0),
    ] {
        let [(scheme, coarse), (_, middle), (_, fine)] = [40, 80, 160].map(|n| end(&rule, n));
        let ratio = difference(&scheme, &coarse, &middle) / difference(&scheme, &middle, &fine);
        assert!((ratio.log2() - order).abs() < 0.15, "{rule:?}: {}", ratio.log2());
    }
    assert_eq!(Theta::new(0.4), Err(UnstableTheta { theta: 0.4 }));
}

/// Small implicit steps and small explicit ones end in the same state, with every term on.
#[test]
fn small_steps_agree_with_explicit_ones() {
    let build = || implicit(plate(), EVERYTHING).build(|x| Vector::<2>::new(0.0, -0.5 * x[1]));
    let mut scheme = build();
    let explicit = march(&mut build(), 5e-4, 40);
    let mut errors = Vec::new();
    for steps in [10, 20] {
        let end = walk(&mut scheme, &Theta::CRANK_NICOLSON, 0.02 / steps as f64, steps, |_, _| {});
        errors.push(difference(&scheme, &explicit, &end));
    }
    assert!(errors[1] < 2e-4 && errors[1] < 0.4 * errors[0], "{errors:?}");
}

/// A free body keeps linear momentum with every rule, and angular momentum with the midpoint rule.
#[test]
fn momentum_is_kept() {
    for (rule, kept) in [(Theta::CRANK_NICOLSON, 2), (Theta::MIDPOINT, 3)] {
        let choice = Choice::new(lattice([1.0, 2.0], [4, 8]), gamma());
        let mut scheme = implicit(choice, ALL_BUT_PRESSURE)
            .build(|x| Vector::<2>::new(0.3 - 0.5 * x[1], 0.4 * x[0] - 0.3 * x[1]));
        let momentum = |scheme: &piola::schemes::upwind::Upwind<2>, state: &[f64]| {
            let mut momentum = [0.0; 3];
            scheme.momentum(state, &mut momentum);
            momentum
        };
        let start = momentum(&scheme, &scheme.initial_state());
        let end = walk(&mut scheme, &rule, 0.05, 20, |_, _| {});
        let after = momentum(&scheme, &end);
        for component in 0..kept {
            let change = after[component] - start[component];
            assert!(change.abs() < 1e-6, "{rule:?} {component}: {change:e}");
        }
    }
}

/// The ledger has what gravity, a wall and the dissipation do, up to the second order of the steps.
#[test]
fn the_ledger_balances_to_second_order() {
    let error = |steps: usize| {
        let settings = Settings { tau_velocity: 0.5, ..PLAIN };
        let mut choice = Choice::new(lattice([1.0, 2.0], [3, 6]), gamma()).fix(1, |x| x[1] < 1e-9);
        choice.gravity = Vector::<2>::new(0.0, -9.81);
        let mut scheme = implicit(choice, settings).build(|_| Vector::zeros());
        let start = energy(&scheme, &scheme.initial_state());
        let end = walk(&mut scheme, &Theta::CRANK_NICOLSON, 0.2 / steps as f64, steps, |_, _| {});
        imbalance(&scheme, start, &end).abs()
    };
    let (coarse, fine) = (error(20), error(40));
    assert!(fine < 0.3 * coarse, "{coarse} {fine}");
}

/// Steps are the same to the bit for any number of threads, and depend on the state alone.
#[test]
fn results_do_not_depend_on_threads_or_on_what_was_before() {
    let run = |settings: Settings, method: LinearMethod, threads: usize, restart: bool| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads can be started").install(|| {
            let build = || {
                let mut choice =
                    Choice::new(lattice([3.0, 5.0], [35, 32]), gamma()).fix(1, |x| x[1] < 1e-9);
                choice = implicit(choice, settings);
                choice.implicit = Some(ImplicitSettings { method, ..Default::default() });
                choice.build(|_| Vector::<2>::new(0.0, -1.0))
            };
            let mut scheme = build();
            let mut state = scheme.initial_state();
            scheme.constrain(0.0, &mut state);
            for count in 0..2 {
                if restart {
                    scheme = build();
                }
                let old = state.clone();
                let time = 0.01 * f64::from(count);
                scheme
                    .advance(&Theta::CRANK_NICOLSON, time, 0.01, &old, &mut state)
                    .expect("a state exists");
            }
            state
        })
    };
    for (settings, method) in [
        (ALL_BUT_PRESSURE, LinearMethod::Direct),
        (ALL_BUT_PRESSURE, LinearMethod::Krylov),
        (EVERYTHING, LinearMethod::Direct),
    ] {
        let one = run(settings, method, 1, false);
        assert_eq!(one, run(settings, method, 3, true), "{settings:?} {method:?}");
    }
}

/// Both ways to solve linear equations lead to the same states, in 2D and in 3D.
#[test]
fn direct_and_iterative_solutions_agree() {
    fn end<const D: usize>(choice: Choice<D>, method: LinearMethod) -> (Vec<f64>, impl Scheme) {
        let settings = Settings {
            correction: Correction::Gradient,
            tau_velocity: 0.5,
            tau_pressure: 0.0,
            reconstruction: false,
            wave_speed: WaveSpeed::Constant,
        };
        let mut choice = implicit(choice, settings);
        choice.implicit = Some(ImplicitSettings { method, ..Default::default() });
        let mut scheme = choice.build(|x| Vector::from_fn(|i, _| -0.2 * x[i]));
        (walk(&mut scheme, &Theta::CRANK_NICOLSON, 0.05, 3, |_, _| {}), scheme)
    }
    let [(direct, scheme), (krylov, _)] =
        [LinearMethod::Direct, LinearMethod::Krylov].map(|method| end(plate(), method));
    assert!(difference(&scheme, &direct, &krylov) < 1e-8);
    let [(direct, scheme), (krylov, _)] =
        [LinearMethod::Direct, LinearMethod::Krylov].map(|method| end(block(), method));
    assert!(difference(&scheme, &direct, &krylov) < 1e-8);
}
