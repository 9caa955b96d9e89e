//! Motion in implicit steps, at sizes that explicit ones cannot have.

use std::sync::Arc;

use piola::Vector;
use piola::boundaries::{BodyForce, PrescribedVelocity, Traction};
use piola::schemes::total_lagrangian::{Motion, TotalLagrangian, TotalLagrangianInput};
use piola::schemes::{
    ImplicitRule, Ledger, Missed, Newmark, Observation, Scheme, momentum_components,
};
use piola::solve::{LinearMethod, Newton};
use piola::time::{Failure, IntegratorKind};
use piola_formulas::hyperelastic::{HyperelasticLaw, LameConstants};
use piola_formulas::volumetric::StressState;

use crate::clouds::Cloud;
use crate::runs::{self, DENSITY, stable_step, submersion, total};
use crate::support::{Function, place, varying, work};

const MIDPOINT: f64 = 1.0;

fn input<const D: usize>(
    cloud: &Cloud<D>,
    law: fn(LameConstants) -> HyperelasticLaw,
    method: LinearMethod,
    velocity: impl Fn(&Vector<D>) -> Vector<D>,
) -> TotalLagrangianInput<D> {
    let states =
        [StressState::UniaxialStrain, StressState::PlaneStrain, StressState::ThreeDimensional];
    let newton = Newton { tolerance: 1e-11, ..Newton::default() };
    let motion = Motion::Implicit(method, newton);
    TotalLagrangianInput { motion, ..runs::input(cloud, law, states[D - 1], velocity) }
}

/// Holds or moves the particles at x = 0.
fn prescribe<const D: usize>(
    input: &mut TotalLagrangianInput<D>,
    component: usize,
    value: Arc<dyn piola::boundaries::SpaceTime>,
) {
    let places = input.particles.position.iter().enumerate();
    let particles = places.filter(|(_, x)| x[0] < 1e-9).map(|(a, _)| a as u32).collect();
    input.prescribed.push(PrescribedVelocity { name: "left".into(), particles, component, value });
}

fn march<const D: usize>(
    scheme: &mut TotalLagrangian<D>,
    rule: Newmark,
    step: f64,
    steps: usize,
) -> Vec<f64> {
    let mut state = scheme.initial_state();
    let mut new = state.clone();
    let rule = ImplicitRule::Newmark(rule);
    let mut integrator =
        IntegratorKind::Newmark.build_with(rule, None, scheme).expect("it moves the scheme");
    for count in 0..steps {
        integrator.step(scheme, count as f64 * step, step, &state, &mut new).unwrap();
        std::mem::swap(&mut state, &mut new);
    }
    state
}

fn energies<const D: usize>(scheme: &TotalLagrangian<D>, state: &[f64]) -> [f64; 3] {
    let mut energies = [0.0; 3];
    scheme.energies(state, &mut energies);
    energies
}

/// A beam that bends far, loaded by weight, pull and the motion of its clamp.
fn loaded_beam() -> TotalLagrangianInput<2> {
    let cloud = Cloud::simplices([1.0, 0.25], [8, 2], 0.15);
    let law = HyperelasticLaw::neo_hookean_logarithmic;
    let mut input = input(&cloud, law, LinearMethod::Direct, |_| Vector::zeros());
    input
        .body_forces
        .push(BodyForce { body: None, acceleration: [varying(|_, t| 40.0 * t), Arc::new(-9.81)] });
    let right: Vec<u32> = (0..cloud.particles.len() as u32).filter(|a| a % 9 == 8).collect();
    input.tractions.push(Traction {
        name: "pull".into(),
        areas: right.iter().map(|&a| cloud.areas[a as usize].norm()).collect(),
        particles: right,
        places: Vec::new(),
        value: [varying(|_, t| 1e5 * t), Arc::new(0.0)],
    });
    input.pressures.push(submersion(&cloud, 1e5));
    prescribe(&mut input, 0, Arc::new(0.0));
    let shaken = Function {
        value: |_: [f64; 3], t: f64| 0.3 * (12.0 * t).sin(),
        rate: |_: [f64; 3], t: f64| 3.6 * (12.0 * t).cos(),
    };
    prescribe(&mut input, 1, Arc::new(shaken));
    input
}

/// With every load on, in large strain, each rule meets central differences at small steps, to the
/// second order; works and impulses account for energy and momentum as well.
#[test]
fn rules_meet_central_differences_to_the_second_order() {
    let end = 0.2;
    let mut explicit =
        TotalLagrangian::new(TotalLagrangianInput { motion: Motion::Explicit, ..loaded_beam() })
            .unwrap();
    let steps = (end / (0.01 * stable_step(&mut explicit))).ceil() as usize;
    let mut reference = explicit.initial_state();
    let mut new = reference.clone();
    let mut integrator =
        IntegratorKind::KickDriftKick.build(&mut explicit).expect("it moves the scheme");
    let step = end / steps as f64;
    for count in 0..steps {
        integrator.step(&mut explicit, count as f64 * step, step, &reference, &mut new).unwrap();
        std::mem::swap(&mut reference, &mut new);
    }
    let tip = |scheme: &mut TotalLagrangian<2>, state: &[f64]| {
        let both = ["displacement", "velocity"];
        both.map(|field| Observation::new(scheme, end, state).values(field, &[8])).concat()
    };
    let wanted = tip(&mut explicit, &reference);
    assert!(wanted[1].abs() > 0.05, "bends by {} m", wanted[1]);

    let rules = [
        Newmark::AVERAGE_ACCELERATION,
        Newmark::hilber_hughes_taylor(0.1),
        Newmark::generalised_alpha(0.7),
        Newmark::generalised_alpha(MIDPOINT),
    ];
    for rule in rules {
        let errors = [400, 800].map(|steps| {
            let mut scheme = TotalLagrangian::new(loaded_beam()).unwrap();
            let state = march(&mut scheme, rule, end / f64::from(steps), steps as usize);
            let got = tip(&mut scheme, &state);
            let off = |(got, wanted): (&f64, &f64)| (got - wanted).abs();
            let place = got[..2].iter().zip(&wanted).map(off).fold(0.0, f64::max);
            let speed = got[2..].iter().zip(&wanted[2..]).map(off).fold(0.0, f64::max);
            let names = ["body_force", "traction", "pressure", "boundary_motion"];
            let works = names.map(|name| work(&scheme, &state, name));
            assert!(works.iter().all(|work| work.abs() > 1e-2), "{works:?}");
            let energy = total(&scheme, &state) - works.iter().sum::<f64>();
            let mut momentum = [0.0; 3];
            scheme.momentum(&state, &mut momentum);
            let ways = Ledger::of(&scheme, &state).impulses.chunks_exact(3);
            let lost: Vec<f64> =
                (0..3).map(|i| momentum[i] - ways.clone().map(|way| way[i]).sum::<f64>()).collect();
            let lost = lost.iter().zip(&momentum).map(|(l, m)| (l / m).abs()).fold(0.0, f64::max);
            [place / wanted[1].abs(), speed, (energy / works[3]).abs(), lost]
        });
        println!("{rule:?}: {errors:?}");
        for (coarse, fine) in errors[0].iter().zip(&errors[1]) {
            assert!(*coarse < 0.05 && *fine < 0.4 * coarse, "{rule:?}: {errors:?}");
        }
    }
}

/// Far beyond the explicit bound a linear body keeps its energy to the tolerance of the solver.
#[test]
fn a_linear_body_keeps_its_energy_at_any_step() {
    let cloud = Cloud::block([1.0, 0.4, 0.4], [6, 3, 3], 0.15);
    let law = HyperelasticLaw::linear_elastic;
    for method in [LinearMethod::Direct, LinearMethod::Krylov] {
        let kick =
            |x: &Vector<3>| Vector::from([0.0, 0.1 * x[0] * x[0], 0.02 * (9.0 * x[1]).sin()]);
        let mut input = input(&cloud, law, method, kick);
        (0..3).for_each(|component| prescribe(&mut input, component, Arc::new(0.0)));
        let mut scheme = TotalLagrangian::new(input).unwrap();
        let step = 30.0 * stable_step(&mut scheme);
        let start = total(&scheme, &scheme.initial_state());
        let kept = march(&mut scheme, Newmark::AVERAGE_ACCELERATION, step, 60);
        assert!((total(&scheme, &kept) / start - 1.0).abs() < 1e-8, "{method:?}");
        let [kinetic, strain, _] = energies(&scheme, &kept);
        assert!(strain > 0.01 * start && kinetic > 0.01 * start, "{kinetic} {strain} of {start}");
        // One that damps takes what is short: here most of it, as the steps are long.
        let damped = march(&mut scheme, Newmark::generalised_alpha(0.3), step, 60);
        assert!(total(&scheme, &damped) < 0.9 * start);
    }
}

/// The midpoint rule keeps linear and angular momentum of a body that flies, turns and strains.
#[test]
fn the_midpoint_rule_keeps_momentum_at_large_steps() {
    let cloud = Cloud::simplices([1.0, 0.5], [8, 4], 0.2);
    let velocity = |x: &Vector<2>| Vector::from([2.0 - 8.0 * x[1] + 2.0 * x[0], 1.0 + 8.0 * x[0]]);
    let law = HyperelasticLaw::neo_hookean_logarithmic;
    let mut scheme =
        TotalLagrangian::new(input(&cloud, law, LinearMethod::Direct, velocity)).unwrap();
    let components = momentum_components(2).len();
    let (mut before, mut after) = (vec![0.0; components], vec![0.0; components]);
    let start = scheme.initial_state();
    scheme.momentum(&start, &mut before);
    let step = 5.0 * stable_step(&mut scheme);
    let state = march(&mut scheme, Newmark::generalised_alpha(MIDPOINT), step, 100);
    scheme.momentum(&state, &mut after);
    for (before, after) in before.iter().zip(&after) {
        assert!((after / before - 1.0).abs() < 1e-8, "{before} {after}");
    }
    // It has turned, and rings.
    let moved = place(&scheme, "displacement", 0, 0);
    assert!((state[moved] - start[moved]).abs() > 0.1 && energies(&scheme, &state)[1] > 1.0);
    // The energy is not kept exactly, but it does not run away either.
    let energy = total(&scheme, &state) / total(&scheme, &start);
    assert!((energy - 1.0).abs() < 0.02, "{energy}");
}

/// A block that is pulled along by one face: its mass times the acceleration is what that takes.
#[test]
fn reactions_are_those_of_the_mass() {
    let cloud = Cloud::block([0.5, 0.5], [4, 4], 0.1);
    let law = HyperelasticLaw::saint_venant_kirchhoff;
    let mut input = input(&cloud, law, LinearMethod::Direct, |_| Vector::zeros());
    let slow = 1e-3;
    let pull =
        Function { value: move |_: [f64; 3], t: f64| slow * t, rate: move |_: [f64; 3], _| slow };
    prescribe(&mut input, 0, Arc::new(pull));
    let mut scheme = TotalLagrangian::new(input).unwrap();
    // Steps longer than any period, damped: what rings at the start is gone.
    let (step, steps) = (200.0 * stable_step(&mut scheme), 60);
    let state = march(&mut scheme, Newmark::generalised_alpha(0.0), step, steps);
    let all: Vec<u32> = (0..cloud.particles.len() as u32).collect();
    let held = Observation::new(&mut scheme, step * steps as f64, &state).values("reaction", &all);
    let force: f64 = held.chunks_exact(2).map(|row| row[0]).sum();
    let expected = slow * DENSITY * 0.25;
    assert!((force / expected - 1.0).abs() < 1e-6, "{force} of {expected} N");
}

/// A step that turns particles inside out ends with what and where, and nothing is taken over.
#[test]
fn a_step_without_an_end_is_named() {
    let cloud = Cloud::block([1.0, 1.0], [6, 6], 0.1);
    let crushed = |x: &Vector<2>| Vector::from([-400.0 * x[0], 0.0]);
    let law = HyperelasticLaw::saint_venant_kirchhoff;
    let mut scheme =
        TotalLagrangian::new(input(&cloud, law, LinearMethod::Direct, crushed)).unwrap();
    let state = scheme.initial_state();
    let mut new = state.clone();
    let mut integrator = IntegratorKind::Newmark.build(&mut scheme).expect("it moves the scheme");
    let failed = integrator.step(&mut scheme, 0.0, 0.01, &state, &mut new).unwrap_err();
    let Failure::NoSolution(missed) = &failed else { panic!("{failed}") };
    assert_ne!(missed.kind, Missed::Unstable);
    assert_eq!((missed.reached, missed.time), (0.0, 0.01));
    let text = failed.to_string();
    assert!(text.contains("particle") && text.contains("t = 0.010000 s"), "{text}");
    assert!(text.contains("time.step"), "{text}");
    // A smaller step from the same state goes well.
    integrator.step(&mut scheme, 0.0, 1e-4, &state, &mut new).unwrap();
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let cloud = Cloud::simplices([1.0, 1.0], [20, 20], 0.2);
            let velocity = |x: &Vector<2>| Vector::from([x[1], (4.0 * x[0]).sin()]);
            let law = HyperelasticLaw::neo_hookean;
            [LinearMethod::Direct, LinearMethod::Krylov].map(|method| {
                let mut scheme =
                    TotalLagrangian::new(input(&cloud, law, method, velocity)).unwrap();
                let step = 10.0 * stable_step(&mut scheme);
                march(&mut scheme, Newmark::hilber_hughes_taylor(0.05), step, 3)
            })
        })
    };
    assert!(run(1) == run(3), "one thread and three give different bits");
}
