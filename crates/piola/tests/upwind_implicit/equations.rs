//! Residual and tangent.

use piola::Vector;
use piola::neighbors::Domain;
use piola::schemes::upwind::{ImplicitSettings, Settings, StepEquations, Upwind};
use piola::schemes::{Scheme, Theta, ThetaScheme};
use piola::solve::Newton;

use super::problems::{
    ALL_BUT_PRESSURE, EVERYTHING, bar, block, gamma, implicit, linear, plate, walk,
};
use crate::support::{Choice, PLAIN, disturbed, lattice, noise};

const STEP: f64 = 0.02;

/// Shows the equations of a step from a disturbed state.
fn with_equations<const D: usize, R>(
    choice: Choice<D>,
    settings: Settings,
    look: impl FnOnce(&mut StepEquations<'_, D>, &[f64]) -> R,
) -> R {
    let mut scheme = implicit(choice, settings).build(|_| Vector::zeros());
    let mut state = disturbed(&scheme, 0.02);
    scheme.constrain(0.0, &mut state);
    let found =
        scheme.with_step_equations(&Theta::CRANK_NICOLSON, [0.0, STEP], &state, |equations| {
            let mut x = equations.start();
            x.iter_mut().enumerate().for_each(|(k, x)| *x += 0.05 * noise(7 * k + 3));
            look(equations, &x)
        });
    found.expect("it was built for implicit steps")
}

fn norm(vector: &[f64]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn direction(count: usize) -> Vec<f64> {
    let direction: Vec<f64> = (0..count).map(|k| noise(5 * k + 1)).collect();
    let size = norm(&direction);
    direction.iter().map(|d| d / size).collect()
}

/// `|r(x + e d) - r(x) - e r'(x) d|` falls as e^2: Upwind (6.24) to (6.26) with every term on.
fn taylor<const D: usize>(choice: Choice<D>, settings: Settings) {
    with_equations(choice, settings, |equations, x| {
        let left = equations.remainders(x, &[1e-2, 1e-3, 1e-4, 1e-5, 1e-6]);
        for pair in left.windows(2) {
            let slope = (pair[0] / pair[1]).log10();
            assert!((slope - 2.0).abs() < 0.02, "{D}D {settings:?}: {left:?}");
        }
    });
}

#[test]
fn the_tangent_is_the_derivative_with_every_term_on() {
    taylor(bar(), EVERYTHING);
    taylor(plate(), EVERYTHING);
    taylor(block(), EVERYTHING);
    taylor(plate(), ALL_BUT_PRESSURE);
}

/// The blocks of the matrix give the products of dual numbers.
fn assembled<const D: usize>(choice: Choice<D>, settings: Settings) {
    with_equations(choice, settings, |equations, x| {
        let (count, direction) = (x.len(), direction(x.len()));
        let (mut product, mut expected) = (vec![0.0; count], vec![0.0; count]);
        equations.product(x, &direction, &mut expected);
        equations.assembled_product(x, &direction, &mut product).expect("it can be factorised");
        let difference: Vec<f64> = product.iter().zip(&expected).map(|(p, e)| p - e).collect();
        let error = norm(&difference) / norm(&expected);
        assert!(error < 1e-12, "{D}D {settings:?}: {error}");
    });
}

#[test]
fn the_assembled_tangent_is_that_of_dual_numbers() {
    let plain = Settings { tau_velocity: 0.0, reconstruction: false, ..ALL_BUT_PRESSURE };
    let direct = Settings { reconstruction: false, ..ALL_BUT_PRESSURE };
    for settings in [plain, direct, ALL_BUT_PRESSURE] {
        assembled(bar(), settings);
        assembled(plate(), settings);
        assembled(block(), settings);
    }
    let mut torus = plate();
    torus.domain = Domain::new([Some([-0.15, 1.15]), None]).expect("a sound box");
    assembled(torus, ALL_BUT_PRESSURE);
}

/// The state at the end of a step of backward Euler is one from which the rates of the explicit
/// passes lead back.
fn consistent<const D: usize>(choice: Choice<D>, settings: Settings) {
    let mut scheme = implicit(choice, settings).build(|_| Vector::zeros());
    let mut old = disturbed(&scheme, 0.02);
    scheme.constrain(0.0, &mut old);
    let (mut new, mut rate) = (old.clone(), vec![0.0; old.len()]);
    scheme.advance(&Theta::BACKWARD_EULER, 0.0, STEP, &old, &mut new).expect("a state exists");
    scheme.rates(STEP, &new, &mut rate);
    let rows = scheme.particle_count() * scheme.width();
    let largest = rate[..rows].iter().fold(0.0_f64, |most, r| most.max(r.abs()));
    for index in 0..rows {
        let error = (new[index] - old[index]) / STEP - rate[index];
        assert!(error.abs() < 1e-8 * largest, "{D}D {settings:?}: {index} is off by {error}");
    }
}

#[test]
fn steps_follow_the_rates_of_the_explicit_passes() {
    for settings in [PLAIN, ALL_BUT_PRESSURE, EVERYTHING] {
        consistent(bar(), settings);
        consistent(plate(), settings);
        consistent(block(), settings);
    }
}

/// U3: where the equations are linear the first step of Newton's method is the last one.
#[test]
fn a_linear_bar_takes_one_iteration() {
    let choice = Choice::new(lattice([10.0], [39]), linear(1e6)).fix(0, |x| x[0] < 1e-9);
    let mut scheme = implicit(choice, PLAIN)
        .build(|x| Vector::<1>::new((0.05 * std::f64::consts::PI * x[0]).sin()));
    for rule in [Theta::BACKWARD_EULER, Theta::CRANK_NICOLSON, Theta::MIDPOINT] {
        walk(&mut scheme, &rule, 0.01, 20, |scheme, state| {
            let mut figures = Vec::new();
            scheme.figures(state, &mut figures);
            assert_eq!(figures[..2], [1.0, 1.0], "{rule:?}");
        });
    }
}

/// The residuals of Newton's method in a step of a fast column, with linear equations solved well.
fn residuals<const D: usize>(scheme: &mut Upwind<D>, step: f64) -> Vec<f64> {
    let mut state = scheme.initial_state();
    scheme.constrain(0.0, &mut state);
    let found =
        scheme.with_step_equations(&Theta::CRANK_NICOLSON, [0.0, step], &state, |equations| {
            let mut x = equations.start();
            let newton = Newton { tolerance: 1e-11, most_iterations: 30, most_halvings: 10 };
            newton.find(equations, 0.0, &mut x, Vec::new()).expect("a state exists")
        });
    let found = found.expect("it was built for implicit steps");
    let before = found.iterations.iter().map(|iteration| iteration.residual);
    before.chain([found.residual]).collect()
}

#[test]
fn convergence_is_quadratic() {
    let impact = |settings: Settings| {
        let choice = Choice::new(lattice([1.0, 2.0], [5, 10]), gamma()).fix(1, |x| x[1] < 1e-9);
        implicit(choice, settings).build(|_| Vector::<2>::new(0.0, -1.5))
    };
    for settings in [PLAIN, ALL_BUT_PRESSURE, EVERYTHING] {
        let residuals = residuals(&mut impact(settings), 0.05);
        assert!(residuals.len() >= 4, "{settings:?}: {residuals:?}");
        // Each residual is below a multiple of the square of the one before, of which the tolerance of
        // the linear equations is a tenth, down to rounding.
        let last = residuals.len() - 1;
        for pair in residuals[last - 2..].windows(2) {
            let bound = (30.0 * pair[0] * pair[0]).max(1e-11);
            assert!(pair[1] <= bound, "{settings:?}: {residuals:?}");
        }
    }
}

/// Volume ratios as unknowns lead to the same states as those that are eliminated.
#[test]
fn eliminated_volume_ratios_change_nothing() {
    let end = |keeps_ratio: bool| {
        let mut choice = implicit(plate(), ALL_BUT_PRESSURE);
        choice.implicit = Some(ImplicitSettings { keeps_ratio, ..Default::default() });
        let mut scheme = choice.build(|x| Vector::<2>::new(0.0, -x[1]));
        let state = walk(&mut scheme, &Theta::CRANK_NICOLSON, STEP, 5, |_, _| {});
        (scheme, state)
    };
    let ((scheme, eliminated), (_, kept)) = (end(false), end(true));
    let difference = super::problems::difference(&scheme, &eliminated, &kept);
    assert!(difference < 1e-9, "{difference}");
}
