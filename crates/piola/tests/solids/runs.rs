//! Motion: periods, energies and momentum of whole bodies.

use std::sync::Arc;

use piola::Vector;
use piola::boundaries::{FollowerPressure, PrescribedVelocity, Traction};
use piola::schemes::total_lagrangian::{
    Gradients, Material, Settings, TotalLagrangian, TotalLagrangianError, TotalLagrangianInput,
};
use piola::schemes::{InputError, Observation, Scheme, momentum_components};
use piola::time::IntegratorKind;
use piola_formulas::hyperelastic::{HyperelasticLaw, LameConstants, Reduced};
use piola_formulas::volumetric::StressState;

use crate::clouds::Cloud;
use crate::fields::{Counted, fields_are_complete};
use crate::support::{march, noise, varying, work};

pub const DENSITY: f64 = 1000.0;

pub fn input<const D: usize>(
    cloud: &Cloud<D>,
    law: fn(LameConstants) -> HyperelasticLaw,
    state: StressState,
    velocity: impl Fn(&Vector<D>) -> Vector<D>,
) -> TotalLagrangianInput<D> {
    let constants = LameConstants::from_young(1e6, 0.3).expect("parameters in range");
    let law = Reduced::new(law(constants), state).expect("the state fits");
    let gradients = Gradients::PatchConsistent { areas: cloud.areas.clone() };
    let support = cloud.support();
    let (material, supports) =
        (Material { density: DENSITY, law }, (support.kernel, support.radius));
    let settings = Settings { gradients, hourglass: 0.1, ..Settings::default() };
    let velocity = cloud.particles.position.iter().map(velocity).collect();
    let bodies = TotalLagrangianInput::of_bodies(cloud.particles.clone(), &[material], supports);
    TotalLagrangianInput { settings, velocity, ..bodies }
}

/// A pressure in Pa all around a body that grows with time, and follows its surface.
pub fn submersion<const D: usize>(cloud: &Cloud<D>, rate: f64) -> FollowerPressure<D> {
    FollowerPressure {
        name: "water".into(),
        particles: (0..cloud.particles.len() as u32).collect(),
        areas: cloud.areas.clone(),
        places: vec![],
        value: varying(move |x, t| rate * t * (1.0 + x[1])),
    }
}

fn build<const D: usize>(input: TotalLagrangianInput<D>) -> TotalLagrangian<D> {
    TotalLagrangian::new(input).expect("the scheme exists")
}

pub fn total(scheme: &dyn Scheme, state: &[f64]) -> f64 {
    let mut energies = [0.0; 3];
    scheme.energies(state, &mut energies);
    energies.iter().sum()
}

pub fn stable_step(scheme: &mut dyn Scheme) -> f64 {
    let mut limits = Vec::new();
    let state = scheme.initial_state();
    scheme.inspect(&state, &mut limits);
    limits.iter().map(|limit| limit.step).fold(f64::INFINITY, f64::min)
}

/// Takes steps of central differences from the start.
fn swing<const D: usize>(scheme: &mut TotalLagrangian<D>, step: f64, steps: usize) -> Vec<f64> {
    let mut state = scheme.initial_state();
    let mut new = state.clone();
    let mut integrator = IntegratorKind::KickDriftKick.build(scheme).expect("it moves the scheme");
    for count in 0..steps {
        integrator
            .step(scheme, count as f64 * step, step, &state, &mut new)
            .expect("explicit methods always find a state");
        std::mem::swap(&mut state, &mut new);
    }
    state
}

/// Phase error after one period of a bar fixed at its left end, in its first mode
/// `sin(pi x/(2 L))` with the period `4 L sqrt(rho/E)`, in parts of the period.
fn phase_error(intervals: usize) -> f64 {
    let length = 2.0_f64;
    let period = 4.0 * length / (1e6 / DENSITY).sqrt();
    let cloud = Cloud::simplices([length], [intervals], 0.2);
    let shape =
        |x: &Vector<1>| Vector::from([1e-3 * (std::f64::consts::FRAC_PI_2 * x[0] / length).sin()]);
    let mut input = input(&cloud, HyperelasticLaw::neo_hookean, StressState::UniaxialStress, shape);
    input.prescribed.push(PrescribedVelocity {
        name: "clamp".into(),
        particles: vec![0],
        component: 0,
        value: Arc::new(0.0),
    });
    let mut scheme = build(input);
    let steps = 2000;
    let state = march(&mut scheme, period / f64::from(steps), steps as usize);
    let displacement =
        Observation::new(&mut scheme, period, &state).values("displacement", &[intervals as u32]);
    // What is left over the amplitude `v/omega` is the error of the phase in radians.
    let amplitude = 1e-3 * period / std::f64::consts::TAU;
    displacement[0] / amplitude / std::f64::consts::TAU
}

#[test]
fn a_bar_has_the_period_of_its_length() {
    let errors = [20, 40, 80].map(phase_error);
    // Clouds and supports are disordered anew for each size, so that errors scatter in their fall.
    for (error, bound) in errors.into_iter().zip([1e-2, 5e-3, 2.5e-3]) {
        assert!(error.abs() < bound, "{errors:?}");
    }
}

#[test]
fn every_described_field_has_values() {
    let cloud = Cloud::simplices([1.0, 1.0], [8, 8], 0.25);
    let turn = |x: &Vector<2>| Vector::from([-x[1], x[0]]);
    let mut input = input(&cloud, HyperelasticLaw::neo_hookean, StressState::PlaneStrain, turn);
    let counted = Counted::default();
    input.body_forces.push(counted.force());
    input.pressures.push(submersion(&cloud, 1e3));
    let mut scheme = build(input);
    let step = 0.5 * stable_step(&mut scheme);
    let state = swing(&mut scheme, step, 3);
    fields_are_complete(&mut scheme, &state, &counted);
}

/// A body that flies, turns and rings: with supports of different sizes nothing is lost.
#[test]
fn energy_and_momentum_of_a_free_body_are_kept() {
    let cloud = Cloud::simplices([1.0, 1.0], [8, 8], 0.25);
    let velocity = |x: &Vector<2>| {
        Vector::from([3.0 - 4.0 * x[1] + 2.0 * x[0], 1.0 + 4.0 * x[0] + (5.0 * x[1]).sin()])
    };
    let law = HyperelasticLaw::neo_hookean_logarithmic;
    let mut scheme = build(input(&cloud, law, StressState::PlaneStrain, velocity));
    let start = scheme.initial_state();
    let components = momentum_components(2).len();
    let (mut before, mut after) = (vec![0.0; components], vec![0.0; components]);
    scheme.momentum(&start, &mut before);
    let step = stable_step(&mut scheme);
    let errors: Vec<[f64; 2]> = [200, 400]
        .into_iter()
        .map(|steps| {
            let state = march(&mut scheme, 40.0 * step / steps as f64, steps);
            scheme.momentum(&state, &mut after);
            for axis in 0..2 {
                assert!((after[axis] / before[axis] - 1.0).abs() < 1e-12, "linear momentum");
            }
            let energy = total(&scheme, &state) / total(&scheme, &start) - 1.0;
            [energy, after[2] / before[2] - 1.0]
        })
        .collect();
    for (coarse, fine) in errors[0].iter().zip(&errors[1]) {
        // Both are products of unknowns, which a second-order method keeps to its own order.
        assert!(coarse.abs() < 2e-3 && fine.abs() < 0.3 * coarse.abs(), "{errors:?}");
    }
}

/// Works of body force, traction and moving boundary add up to the energy.
#[test]
fn the_ledger_accounts_for_all_energy() {
    let cloud = Cloud::simplices([1.0, 0.5], [8, 4], 0.15);
    let count = cloud.particles.len();
    let law = HyperelasticLaw::saint_venant_kirchhoff;
    let imbalance = |steps: usize| {
        let mut input = input(&cloud, law, StressState::PlaneStress, |_| Vector::zeros());
        let on = |column: usize| -> Vec<u32> {
            (0..count).filter(|a| a % 9 == column).map(|a| a as u32).collect()
        };
        input.body_forces.push(piola::boundaries::BodyForce {
            body: None,
            acceleration: [Arc::new(0.0), Arc::new(-9.81)],
        });
        let areas = on(8).iter().map(|&a| cloud.areas[a as usize].norm()).collect();
        input.tractions.push(Traction {
            name: "pull".into(),
            particles: on(8),
            areas,
            places: vec![],
            value: [varying(|_, t| 4e5 * t), Arc::new(0.0)],
        });
        input.pressures.push(submersion(&cloud, 2e6));
        for component in 0..2 {
            input.prescribed.push(PrescribedVelocity {
                name: "shaken".into(),
                particles: on(0),
                component,
                value: Arc::new(crate::support::Function {
                    value: |_: [f64; 3], t: f64| 0.2 * (300.0 * t).sin(),
                    rate: |_: [f64; 3], t: f64| 60.0 * (300.0 * t).cos(),
                }),
            });
        }
        let mut scheme = build(input);
        let state = march(&mut scheme, 0.05 / steps as f64, steps);
        let works = ["body_force", "traction", "pressure", "boundary_motion"]
            .map(|name| work(&scheme, &state, name));
        assert!(works.iter().all(|work| work.abs() > 1e-3), "{works:?}");
        (total(&scheme, &state) - works.iter().sum::<f64>()) / total(&scheme, &state)
    };
    let (coarse, fine) = (imbalance(500).abs(), imbalance(1000).abs());
    assert!(coarse < 1e-2 && fine < 0.3 * coarse, "{coarse:e} {fine:e}");
}

/// Just below the bound a body rings on, above it the motion grows without end.
#[test]
fn the_bound_on_the_step_is_that_of_central_differences() {
    let cloud = Cloud::simplices([1.0, 1.0], [10, 10], 0.2);
    let velocity = |x: &Vector<2>| Vector::from_fn(|i, _| 1e-3 * noise((1e6 * x[i]) as usize));
    let law = HyperelasticLaw::linear_elastic;
    let mut scheme = build(input(&cloud, law, StressState::PlaneStrain, velocity));
    let step = stable_step(&mut scheme);
    let start = total(&scheme, &scheme.initial_state());
    let growth = |factor: f64, scheme: &mut TotalLagrangian<2>| {
        let state = swing(scheme, factor * step, 1500);
        total(scheme, &state) / start
    };
    // Close to the bound the two energies beat, but the sum of the modes stays what it is.
    let (well_below, below) = (growth(0.5, &mut scheme), growth(0.99, &mut scheme));
    assert!((well_below - 1.0).abs() < 0.1, "{well_below}-fold at half of the bound");
    assert!(below < 30.0, "grows {below}-fold at the bound");
    let above = growth(1.05, &mut scheme);
    assert!(!(above < 1e6), "grows only {above}-fold above the bound");
}

/// Works that enter in kicks add up to the energy, to the order of the method.
#[test]
fn kicks_account_for_all_energy() {
    let cloud = Cloud::simplices([1.0, 0.5], [8, 4], 0.15);
    let law = HyperelasticLaw::saint_venant_kirchhoff;
    let imbalance = |steps: usize| {
        let mut input = input(&cloud, law, StressState::PlaneStress, |_| Vector::zeros());
        input.body_forces.push(piola::boundaries::BodyForce {
            body: None,
            acceleration: [Arc::new(30.0), Arc::new(-9.81)],
        });
        let right: Vec<u32> = (0..cloud.particles.len() as u32).filter(|a| a % 9 == 8).collect();
        input.tractions.push(Traction {
            name: "pull".into(),
            areas: right.iter().map(|&a| cloud.areas[a as usize].norm()).collect(),
            particles: right,
            places: vec![],
            value: [varying(|_, t| 4e5 * t), Arc::new(0.0)],
        });
        input.pressures.push(submersion(&cloud, 2e6));
        input.prescribed.push(PrescribedVelocity {
            name: "shaken".into(),
            particles: (0..cloud.particles.len() as u32).filter(|a| a % 9 == 0).collect(),
            component: 0,
            value: Arc::new(crate::support::Function {
                value: |_: [f64; 3], t: f64| 0.2 * (300.0 * t).sin(),
                rate: |_: [f64; 3], t: f64| 60.0 * (300.0 * t).cos(),
            }),
        });
        let mut scheme = build(input);
        let state = swing(&mut scheme, 0.05 / steps as f64, steps);
        let names = ["body_force", "traction", "pressure", "boundary_motion"];
        let works = names.map(|name| work(&scheme, &state, name));
        assert!(works.iter().all(|work| work.abs() > 1e-3), "{works:?}");
        // What is held follows its value to the second order: here to the chord of its curve.
        let moved = Observation::new(&mut scheme, 0.05, &state).values("displacement", &[0]);
        let expected = 0.2 / 300.0 * (1.0 - (300.0_f64 * 0.05).cos());
        assert!((moved[0] / expected - 1.0).abs() < 1e-3, "{} of {expected} m", moved[0]);
        (total(&scheme, &state) - works.iter().sum::<f64>()) / total(&scheme, &state)
    };
    let (coarse, fine) = (imbalance(500).abs(), imbalance(1000).abs());
    assert!(coarse < 1e-2 && fine < 0.3 * coarse, "{coarse:e} {fine:e}");
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let cloud = Cloud::simplices([1.0, 1.0], [40, 40], 0.2);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let velocity = |x: &Vector<2>| Vector::from([x[1], (4.0 * x[0]).sin()]);
            let law = HyperelasticLaw::neo_hookean;
            let mut scheme = build(input(&cloud, law, StressState::PlaneStrain, velocity));
            let step = 0.3 * stable_step(&mut scheme);
            let state = march(&mut scheme, step, 10);
            let mut energies = [0.0; 3];
            scheme.energies(&state, &mut energies);
            (state, energies)
        })
    };
    assert!(run(1) == run(3), "one thread and three give different bits");
}

#[test]
fn impossible_input_is_refused() {
    let cloud = Cloud::simplices([1.0, 1.0], [4, 4], 0.1);
    let good = || {
        let law = HyperelasticLaw::neo_hookean;
        input(&cloud, law, StressState::PlaneStrain, |_| Vector::zeros())
    };
    let refused = |change: &dyn Fn(&mut TotalLagrangianInput<2>)| {
        let mut input = good();
        change(&mut input);
        match TotalLagrangian::new(input) {
            Ok(_) => panic!("the input was taken"),
            Err(error) => error,
        }
    };
    let error = refused(&|input| input.settings.hourglass = -0.1);
    assert_eq!(
        error.to_string(),
        "the hourglass coefficient must be at least 0 and finite, got -0.1"
    );
    let error = refused(&|input| input.velocity[3][0] = f64::NAN);
    assert!(matches!(error, TotalLagrangianError::Input(InputError::Velocity { id: 3, .. })));
    let error = refused(&|input| input.mixtures[0].0[0].0.density = 0.0);
    assert!(matches!(error, TotalLagrangianError::Input(InputError::Mass { id: 0, .. })));
    let error = refused(&|input| input.mixture[7] = 2);
    assert!(matches!(
        error,
        TotalLagrangianError::Input(InputError::Index { got: 2, count: 1, .. })
    ));
    let error = refused(&|input| input.velocity.truncate(3));
    assert!(matches!(error, TotalLagrangianError::Input(InputError::Length { got: 3, .. })));
    let gradients = Gradients::PatchConsistent { areas: vec![Vector::zeros(); 25] };
    let error = refused(&|input| input.settings.gradients = gradients.clone());
    assert!(matches!(error, TotalLagrangianError::Operator(_)));
}
