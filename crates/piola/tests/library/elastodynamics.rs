//! Explicit steps of total Lagrangian solids: stable steps, conservation, exact boundaries.
#![allow(clippy::unwrap_used, reason = "a panic is how a test fails, in its helpers too")]

use std::sync::Arc;

use crate::fields::{Counted, fields_are_complete};
use crate::support::lattice;
use piola::boundaries::{PrescribedVelocity, SpaceTime, Traction};
use piola::neighbors::Domain;
use piola::operators::{Continuation, Mirror};
use piola::schemes::total_lagrangian::{
    Configuration, Dissipation, Form, Material, Settings, TotalLagrangian, TotalLagrangianInput,
    Tractions,
};
use piola::schemes::{Ledger, Observation, Scheme};
use piola::time::IntegratorKind;
use piola::{Tensor, Vector};
use piola_formulas::hyperelastic::{HyperelasticLaw, LameConstants, Reduced};
use piola_formulas::kernels::Kernel;
use piola_formulas::volumetric::StressState;

/// So weak that it sets no step.
const WEAK: Dissipation =
    Dissipation { viscosity: 1e5, artificial_viscosity: [0.0; 2], damping: 1.0 };

fn plain<const D: usize>() -> Settings<D> {
    Settings { hourglass: 0.05, tractions: Tractions::Layers, ..Settings::default() }
}

const DENSITY: f64 = 8000.0;

const DISSIPATION: Dissipation =
    Dissipation { viscosity: 2e7, artificial_viscosity: [0.1, 1.0], damping: 50.0 };

fn material<const D: usize>(law: fn(LameConstants) -> HyperelasticLaw) -> Material<D> {
    let constants = LameConstants::from_young(200e9, 0.3).unwrap();
    let state = match D {
        1 => StressState::UniaxialStrain,
        2 => StressState::PlaneStrain,
        _ => StressState::ThreeDimensional,
    };
    Material { density: DENSITY, law: Reduced::new(law(constants), state).unwrap() }
}

fn input<const D: usize>(
    intervals: [usize; D],
    law: fn(LameConstants) -> HyperelasticLaw,
    (kernel, cover): (Kernel, f64),
    settings: Settings<D>,
) -> TotalLagrangianInput<D> {
    let particles = lattice(intervals.map(|n| n as f64), intervals);
    let radius = vec![cover; particles.len()];
    let bodies = TotalLagrangianInput::of_bodies(particles, &[material(law)], (kernel, radius));
    TotalLagrangianInput { settings, ..bodies }
}

fn strong<const D: usize>() -> Settings<D> {
    Settings { form: Form::Strong, ..Settings::default() }
}

fn march(scheme: &mut dyn Scheme, step: f64, steps: usize) -> Vec<f64> {
    let mut integrator = IntegratorKind::KickDriftKick.build(scheme).expect("it moves the scheme");
    let mut state = scheme.initial_state();
    let mut new = state.clone();
    for number in 0..steps {
        integrator.step(scheme, number as f64 * step, step, &state, &mut new).unwrap();
        std::mem::swap(&mut state, &mut new);
    }
    state
}

fn stable_step(scheme: &mut dyn Scheme) -> f64 {
    let mut limits = Vec::new();
    scheme.inspect(&scheme.initial_state(), &mut limits);
    limits[0].step
}

fn total(scheme: &dyn Scheme, state: &[f64]) -> f64 {
    let mut energies = [0.0; 3];
    scheme.energies(state, &mut energies);
    energies.iter().sum()
}

/// `dt c/dx` of the symbols of the kernels on an endless row, to a part in a thousand: the numbers have up to 6 in ten thousand
/// of rounding, and Lanczos' eigenvalues lie up to a part in a thousand below the largest one, which allows half of that in a
/// step. For that the step is made for eigenvalues 1.002 times as large as what is found.
#[test]
fn the_stable_step_is_that_of_the_kernels_symbol() {
    let known = [
        (Kernel::ModifiedMollifier, 5.5, 3.974),
        (Kernel::ModifiedMollifier, 3.5, 2.528),
        (Kernel::ModifiedMollifier, 2.5, 1.970),
        (Kernel::Mollifier, 5.5, 7.74),
        (Kernel::Lucy, 5.5, 5.692),
        (Kernel::CubicSpline, 2.0, 2.000),
        (Kernel::CubicSpline, 2.4, 2.269),
        (Kernel::CubicSpline, 2.6, 2.478),
        (Kernel::CubicSpline, 4.0, 3.864),
        (Kernel::QuinticSpline, 3.0, 2.355),
        (Kernel::QuinticSpline, 3.6, 2.818),
        (Kernel::Gaussian, 3.0, 2.364),
    ];
    let constants = LameConstants::from_young(200e9, 0.3).unwrap();
    let speed = ((constants.lambda + 2.0 * constants.mu) / DENSITY).sqrt();
    for (kernel, cover, expected) in known {
        let made = input([200], HyperelasticLaw::linear_elastic, (kernel, cover), strong());
        let mut scheme = TotalLagrangian::new(made).unwrap();
        let got = stable_step(&mut scheme) * speed * 1.002_f64.sqrt();
        assert!((got / expected - 1.0).abs() < 1e-3, "{kernel:?} {cover}: {got}, not {expected}");
    }
}

/// A turning, trembling body in two and three dimensions: energy, momentum and threads.
#[test]
fn a_free_body_keeps_energy_and_momentum_on_any_number_of_threads() {
    fn check<const D: usize>(intervals: [usize; D]) {
        let run = |threads: usize| {
            let cover = (Kernel::ModifiedMollifier, 2.5);
            let mut made =
                input(intervals, HyperelasticLaw::neo_hookean_logarithmic, cover, plain());
            made.velocity = (made.particles.position.iter())
                .map(|x| {
                    Vector::from_fn(|i, _| match i {
                        0 => -60.0 * x[1] + 20.0 * x[0],
                        1 => 60.0 * x[0],
                        _ => 5.0 * (x[0] * x[1]).sin(),
                    })
                })
                .collect();
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let mut scheme = TotalLagrangian::new(made).unwrap();
                let start = scheme.initial_state();
                let step = 0.5 * stable_step(&mut scheme);
                let end = march(&mut scheme, step, 300);
                let mut momentum = [[0.0; 6]; 2];
                scheme.momentum(
                    &start,
                    &mut momentum[0][..piola::schemes::momentum_components(D).len()],
                );
                scheme.momentum(
                    &end,
                    &mut momentum[1][..piola::schemes::momentum_components(D).len()],
                );
                let energy = [total(&scheme, &start), total(&scheme, &end)];
                (end, energy, momentum)
            })
        };
        let (end, [before, after], momentum) = run(1);
        assert!((after / before - 1.0).abs() < 2e-3, "{before} {after}");
        let size = momentum[0].iter().fold(0.0_f64, |size, p| size.max(p.abs()));
        for (before, after) in momentum[0].iter().zip(&momentum[1]) {
            assert!((before - after).abs() < 1e-10 * size, "{before} {after}");
        }
        assert_eq!(end, run(3).0);
    }
    check([9, 6]);
    check([4, 4, 3]);
}

/// A pressure that rises and falls, Pa.
struct Load;

impl SpaceTime for Load {
    fn value(&self, _x: [f64; 3], t: f64) -> f64 {
        2e8 * (100.0 * t).sin().powi(2)
    }

    fn rate(&self, _x: [f64; 3], t: f64) -> f64 {
        2e10 * (200.0 * t).sin()
    }

    fn is_steady(&self) -> bool {
        false
    }
}

/// The load of an end is its stress, a held end stays, and all energy is the load's.
#[test]
fn ends_of_a_row_are_met_exactly() {
    for law in [HyperelasticLaw::linear_elastic, HyperelasticLaw::neo_hookean_logarithmic] {
        let mut made = input([120], law, (Kernel::ModifiedMollifier, 5.5), strong());
        made.tractions = vec![Traction {
            name: "load".into(),
            particles: vec![0],
            areas: vec![1.0],
            places: vec![],
            value: [Arc::new(Load)],
        }];
        made.prescribed = vec![PrescribedVelocity {
            name: "held".into(),
            particles: vec![120],
            component: 0,
            value: Arc::new(0.0),
        }];
        let mut scheme = TotalLagrangian::new(made).unwrap();
        let step = 0.5 * stable_step(&mut scheme);
        let steps = 400;
        let end = march(&mut scheme, step, steps);
        let time = step * steps as f64;
        let stress = Observation::new(&mut scheme, time, &end).values("stress", &[0]);
        assert_eq!(stress, [-Load.value([0.0; 3], time)]);
        let held = Observation::new(&mut scheme, time, &end).values("displacement", &[120]);
        assert_eq!(held, [0.0]);
        let work: f64 = Ledger::of(&scheme, &end).work.iter().sum();
        let energy = total(&scheme, &end);
        assert!((work / energy - 1.0).abs() < 2e-3, "{work} {energy}");
    }
}

/// Between rollers a homogeneous stretch has no forces but on the planes, whatever the law.
#[test]
fn rollers_hold_a_homogeneous_stretch() {
    let cover = (Kernel::ModifiedMollifier, 2.5);
    let mut made = input([6, 4], HyperelasticLaw::neo_hookean_logarithmic, cover, plain());
    let planes = [(0, 0.0, false), (0, 6.0, true), (1, 0.0, false), (1, 4.0, true)];
    let positions = made.particles.position.clone();
    for (axis, place, is_upper) in planes {
        let on: Vec<u32> = (0..positions.len() as u32)
            .filter(|&a| (positions[a as usize][axis] - place).abs() < 1e-9)
            .collect();
        let mirror = Mirror { axis, place, is_upper, continuation: Continuation::Odd };
        made.mirrors.push((mirror, on[0]));
        made.prescribed.push(PrescribedVelocity {
            name: "roller".into(),
            particles: on,
            component: axis,
            value: Arc::new(0.0),
        });
    }
    made.displacement = positions.iter().map(|x| Vector::from([0.5 * x[0], -0.2 * x[1]])).collect();
    let mut scheme = TotalLagrangian::new(made).unwrap();
    let state = scheme.initial_state();
    let all: Vec<u32> = (0..positions.len() as u32).collect();
    let gradient = Observation::new(&mut scheme, 0.0, &state).values("deformation_gradient", &all);
    let acceleration = Observation::new(&mut scheme, 0.0, &state).values("acceleration", &all);
    for gradient in gradient.chunks_exact(4) {
        let gradient = Tensor::<2>::from_row_slice(gradient);
        assert!((gradient - Tensor::<2>::new(1.5, 0.0, 0.0, 0.8)).amax() < 1e-12);
    }
    // Of 1e7 m/s2 and more that the stress over a spacing would make.
    assert!(acceleration.iter().all(|a| a.abs() < 1e-5), "{acceleration:?}");
}

/// A homogeneous stress is in equilibrium with the load on its face, at all particles: the traction
/// on an edge gives the traction.
#[test]
fn a_face_takes_its_traction_as_a_stress() {
    fn check<const D: usize>(intervals: [usize; D]) {
        let cover = (Kernel::ModifiedMollifier, 2.5);
        let mut made = input(intervals, HyperelasticLaw::linear_elastic, cover, plain());
        let (traction, positions) = (2e8, made.particles.position.clone());
        let length = intervals[0] as f64;
        let all = || 0..positions.len() as u32;
        let on = |axis: usize, place: f64| -> Vec<u32> {
            all().filter(|&a| (positions[a as usize][axis] - place).abs() < 1e-9).collect()
        };
        for axis in 0..D {
            let particles = on(axis, 0.0);
            let continuation = Continuation::Odd;
            made.mirrors
                .push((Mirror { axis, place: 0.0, is_upper: false, continuation }, particles[0]));
            made.prescribed.push(PrescribedVelocity {
                name: "roller".into(),
                particles,
                component: axis,
                value: Arc::new(0.0),
            });
        }
        let particles = on(0, length);
        // Of a cell that is half at each edge of the face.
        let is_at_edge = |a: u32, axis: usize| {
            let place = positions[a as usize][axis];
            place < 1e-9 || place > intervals[axis] as f64 - 1e-9
        };
        let half = |a: u32, axis: usize| if is_at_edge(a, axis) { 0.5 } else { 1.0 };
        let area = |&a: &u32| (1..D).map(|axis| half(a, axis)).product::<f64>();
        made.tractions = vec![Traction {
            name: "pull".into(),
            areas: particles.iter().map(area).collect(),
            particles,
            places: vec![],
            value: std::array::from_fn(|i| -> Arc<dyn SpaceTime> {
                Arc::new(if i == 0 { traction } else { 0.0 })
            }),
        }];
        let (young, nu) = (200e9, 0.3);
        let (along, across) = match D {
            2 => ((1.0 - nu * nu) / young, -nu * (1.0 + nu) / young),
            _ => (1.0 / young, -nu / young),
        };
        let strain = |i: usize| traction * if i == 0 { along } else { across };
        let displaced = |x: &Vector<D>| Vector::from_fn(|i, _| strain(i) * x[i]);
        made.displacement = positions.iter().map(displaced).collect();
        let mut scheme = TotalLagrangian::new(made).unwrap();
        let state = scheme.initial_state();
        let all: Vec<u32> = all().collect();
        let stress = Observation::new(&mut scheme, 0.0, &state).values("stress", &all);
        let acceleration = Observation::new(&mut scheme, 0.0, &state).values("acceleration", &all);
        for stress in stress.chunks_exact(D * D) {
            assert!((stress[0] / traction - 1.0).abs() < 1e-9);
        }
        // Of the traction over a spacing and the density.
        let largest = acceleration.iter().fold(0.0_f64, |most, a| most.max(a.abs()));
        assert!(largest < 1e-3 * traction / DENSITY, "{largest} of {}", traction / DENSITY);
    }
    check([16, 7]);
    check([14, 5, 5]);
}

/// What viscosity and damping take is missing from the energy, and the bound on the step holds.
#[test]
fn dissipation_is_in_the_ledger() {
    let settings = Settings { dissipation: DISSIPATION, ..plain() };
    let cover = (Kernel::ModifiedMollifier, 2.5);
    let mut made = input([12, 6], HyperelasticLaw::neo_hookean_logarithmic, cover, settings);
    made.velocity =
        made.particles.position.iter().map(|x| Vector::from([30.0 * x[0].sin(), 0.0])).collect();
    let mut scheme = TotalLagrangian::new(made).unwrap();
    let start = scheme.initial_state();
    let before = total(&scheme, &start);
    let step = stable_step(&mut scheme);
    let loss = |scheme: &mut TotalLagrangian<2>, step: f64, steps: usize| {
        let end = march(scheme, step, steps);
        let work: f64 = Ledger::of(scheme, &end).work.iter().sum();
        (total(scheme, &end) - before, work)
    };
    let mut errors = Vec::new();
    for parts in [4, 8, 16] {
        let (change, work) = loss(&mut scheme, step / f64::from(parts), 40 * parts as usize);
        assert!(change < -0.05 * before, "{change}");
        errors.push((change - work).abs() / before);
    }
    // Rates are those of velocities half a step back.
    assert!(errors[2] < 0.6 * errors[1] && errors[1] < 0.6 * errors[0], "{errors:?}");
    let (change, _) = loss(&mut scheme, 0.98 * step, 1000);
    assert!(change < 0.0, "stable: {change}");
}

#[test]
fn every_described_field_has_values() {
    let viscous = Settings { dissipation: WEAK, ..plain() };
    for settings in [plain(), viscous, strong()] {
        let cover = (Kernel::ModifiedMollifier, 2.5);
        let mut made = input([5, 8], HyperelasticLaw::neo_hookean_logarithmic, cover, settings);
        let counted = Counted::default();
        made.body_forces.push(counted.force());
        made.velocity.iter_mut().enumerate().for_each(|(a, v)| v[0] = a as f64);
        let mut scheme = TotalLagrangian::new(made).unwrap();
        let step = 0.5 * stable_step(&mut scheme);
        let state = march(&mut scheme, step, 3);
        fields_are_complete(&mut scheme, &state, &counted);
    }
}

/// On one thread, which is the one that counts.
#[test]
fn steps_after_the_first_allocate_nothing() {
    fn check<const D: usize>(made: TotalLagrangianInput<D>) {
        let mut scheme = TotalLagrangian::new(made).unwrap();
        let mut integrator =
            IntegratorKind::KickDriftKick.build(&mut scheme).expect("it moves the scheme");
        let state = scheme.initial_state();
        let (mut new, mut limits) = (state.clone(), Vec::with_capacity(4));
        let step = 0.1 * stable_step(&mut scheme);
        let mut advance = || {
            scheme.inspect(&state, &mut limits);
            integrator.step(&mut scheme, 0.0, step, &state, &mut new).unwrap();
        };
        advance();
        assert_eq!(allocation_counter::measure(|| (0..2).for_each(|_| advance())).count_total, 0);
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    pool.install(|| {
        let viscous = Settings { dissipation: WEAK, ..plain() };
        let law = HyperelasticLaw::neo_hookean_logarithmic;
        // Sums over more particles than a chunk holds keep a number for each chunk.
        check(input([28, 28], law, (Kernel::ModifiedMollifier, 2.5), viscous));
        check(input([900], law, (Kernel::ModifiedMollifier, 5.5), strong()));
    });
}

#[test]
fn what_cannot_be_built_says_why() {
    let cover = (Kernel::ModifiedMollifier, 2.5);
    let law = HyperelasticLaw::linear_elastic;
    let refused = |made: TotalLagrangianInput<2>| {
        TotalLagrangian::new(made).err().map(|error| error.to_string()).unwrap_or_default()
    };
    let mut two = input([4, 4], law, cover, strong());
    two.group[24] = 1;
    assert!(refused(two).contains("strong form is for one row or box"));
    let mut gap = input([8, 8], law, cover, strong());
    gap.particles.position[40] += Vector::from([0.1, 0.0]);
    assert!(refused(gap).contains("surround it evenly"));
    let mut part = input([4, 4], law, cover, strong());
    part.prescribed = vec![PrescribedVelocity {
        name: "held".into(),
        particles: vec![0, 1, 2],
        component: 0,
        value: Arc::new(0.0),
    }];
    assert!(refused(part).contains("on a part of an edge"));
    let updated = Settings { configuration: Configuration::Updated, ..plain() };
    assert!(refused(input([4, 4], law, cover, updated)).contains("updated"));
    let viscosity = Dissipation { viscosity: -1.0, ..Dissipation::default() };
    let negative = Settings { dissipation: viscosity, ..plain() };
    assert!(refused(input([4, 4], law, cover, negative)).contains("viscosity must be at least 0"));
    let mut periodic = input([4, 4], law, cover, plain());
    periodic.domain = Domain::new([Some([0.0, 5.0]), None]).unwrap();
    let mirror = Mirror { axis: 0, place: 0.0, is_upper: false, continuation: Continuation::Odd };
    periodic.mirrors = vec![(mirror, 0)];
    assert!(refused(periodic).contains("is periodic along x"));
    let mut short = input([4, 4], law, cover, plain());
    short.displacement.pop();
    assert!(refused(short).contains("the initial displacement has 24 entries"));
}
