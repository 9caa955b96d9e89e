//! The upwind formulation: balances, invariances and exact solutions.

use std::f64::consts::PI;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::derivatives::Derivatives as _;
use crate::fields::{Counted, fields_are_complete};
use crate::support::{
    Choice, PLAIN, disturbed, energy, jittered, lattice, march, march_from, noise, place, places,
    rows, work,
};
use piola::neighbors::Domain;
use piola::schemes::upwind::{Initial, Settings, Upwind, UpwindInput};
use piola::schemes::{Health, Ledger, Scheme, boxed};
use piola::time::{Executor, IntegratorKind, Outcome, StepControl};
use piola::{Tensor, Vector};
use piola_formulas::volumetric::VolumetricLaw;

fn gamma() -> VolumetricLaw {
    VolumetricLaw::gamma_law_from_wave_speed(10.0, 1000.0, 7.0).expect("a sound material")
}

fn linear(modulus: f64) -> VolumetricLaw {
    VolumetricLaw::linear(modulus).expect("a sound material")
}

fn rates<S: Scheme>(scheme: &mut S, state: &[f64]) -> Vec<f64> {
    let mut rate = vec![0.0; state.len()];
    scheme.rates(0.0, state, &mut rate);
    rate
}

/// Kinetic plus strain energy of a state moved by `step` along `rate`.
fn energy_along<S: Scheme>(scheme: &S, state: &[f64], rate: &[f64], step: f64) -> f64 {
    let moved: Vec<f64> = state.iter().zip(rate).map(|(u, f)| u + step * f).collect();
    let mut energies = [0.0; 2];
    scheme.energies(&moved, &mut energies);
    energies.iter().sum()
}

/// The derivative of the energy along the rates is the sum of all powers of the ledger, with
/// every term on, at a random state. The derivative is a central difference: relative error 1e-9.
fn ledger_balances<const D: usize>(mut choice: Choice<D>) {
    choice.settings.tau_velocity = 0.7;
    choice.settings.tau_pressure = 0.4;
    choice.settings.reconstruction = true;
    choice.settings.wave_speed = piola::schemes::upwind::WaveSpeed::Stretch;
    choice.gravity = Vector::from_element(-9.81);
    let mut scheme = choice.fix(0, |x| x[0] < 1e-9).build(|_| Vector::zeros());
    let mut state = disturbed(&scheme, 0.05);
    scheme.constrain(0.0, &mut state);
    let rate = rates(&mut scheme, &state);
    let powers = Ledger::of(&scheme, &rate).work;
    let power: f64 = powers.iter().sum();
    let step = 1e-7;
    let slope = (energy_along(&scheme, &state, &rate, step)
        - energy_along(&scheme, &state, &rate, -step))
        / (2.0 * step);
    let size: f64 = powers.iter().map(|p| p.abs()).sum();
    assert!((slope - power).abs() < 1e-6 * size, "{D}D: {slope} against {power}, size {size}");
}

#[test]
fn energy_changes_by_the_powers_of_the_ledger() {
    ledger_balances(Choice::new(lattice([10.0], [40]), gamma()));
    ledger_balances(Choice::new(lattice([3.0, 5.0], [6, 8]), gamma()));
    ledger_balances(Choice::new(lattice([1.0, 2.0, 1.5], [4, 5, 4]), gamma()));
    let mut wide = Choice::new(lattice([3.0, 5.0], [6, 8]), gamma());
    wide.smoothing_ratio = 1.3;
    ledger_balances(wide);
}

/// Without reconstruction both dissipations take energy at any state that is not folded: on
/// lattices, narrow or wide, and on disordered particles, whose `N . C_ab` are positive as well.
fn upwinding_takes_energy<const D: usize>(mut choice: Choice<D>) {
    choice.settings.tau_velocity = 1.0;
    choice.settings.tau_pressure = 1.0;
    let mut scheme = choice.build(|_| Vector::zeros());
    let state = disturbed(&scheme, 0.03);
    let rate = rates(&mut scheme, &state);
    for mechanism in ["upwind_velocity", "upwind_pressure"] {
        let power = work(&scheme, &rate, mechanism);
        assert!(power < 0.0, "{D}D {mechanism}: {power}");
    }
}

#[test]
fn both_dissipations_take_energy() {
    for smoothing_ratio in [0.7, 1.2] {
        for jitter in [0.0, 0.2] {
            let wide = |mut choice: Choice<2>| {
                choice.smoothing_ratio = smoothing_ratio;
                choice
            };
            upwinding_takes_energy(wide(Choice::new(
                jittered([3.0, 5.0], [6, 10], jitter),
                gamma(),
            )));
        }
    }
    upwinding_takes_energy(Choice::new(jittered([10.0], [40], 0.2), gamma()));
    upwinding_takes_energy(Choice::new(lattice([1.0, 2.0, 1.5], [4, 8, 6]), gamma()));
}

/// The bound of the dissipation is stable where it rules, and not by far too small: waves and
/// noise die out at the bound, and noise grows at twice and a half of it.
#[test]
fn the_step_limit_of_the_dissipation_is_stable_and_not_wasteful() {
    let grown = |factor: f64| {
        let mut choice = Choice::new(lattice([1.0, 1.0], [12, 12]), linear(1e5));
        choice.settings.tau_velocity = 1.0;
        choice.settings.tau_pressure = 1.0;
        let mut scheme = choice.build(|_| Vector::<2>::zeros());
        let state = disturbed(&scheme, 1e-6);
        let mut limits = Vec::new();
        scheme.inspect(&state, &mut limits);
        let limit = limits.iter().min_by(|a, b| a.step.total_cmp(&b.step)).expect("two limits");
        assert_eq!(limit.name, "upwind dissipation");
        let start = energy(&scheme, &state);
        let end = march_from(&mut scheme, state, factor * limit.step, 100, |_, _| {});
        energy(&scheme, &end) / start
    };
    assert!(grown(1.0) < 0.5, "{}", grown(1.0));
    assert!(!(grown(2.5) < 1e6), "{}", grown(2.5));
}

/// Without walls and loads linear momentum is kept to round-off, with all terms on.
fn momentum_is_kept<const D: usize>(mut choice: Choice<D>) {
    choice.settings.tau_velocity = 0.7;
    choice.settings.tau_pressure = 0.4;
    choice.settings.reconstruction = true;
    let volume = choice.particles.volume.clone();
    let mut scheme = choice.build(|_| Vector::zeros());
    let state = disturbed(&scheme, 0.1);
    let rate = rows(&places(&scheme), &rates(&mut scheme, &state));
    let length = scheme.width();
    for component in 0..D {
        let force = |a: usize| volume[a] * rate[a * length + component];
        let total: f64 = (0..volume.len()).map(force).sum();
        let size: f64 = (0..volume.len()).map(|a| force(a).abs()).sum();
        assert!(total.abs() < 1e-13 * size, "{D}D component {component}: {total} of {size}");
    }
}

#[test]
fn linear_momentum_is_kept_to_round_off() {
    momentum_is_kept(Choice::new(lattice([10.0], [40]), gamma()));
    momentum_is_kept(Choice::new(lattice([3.0, 5.0], [6, 8]), gamma()));
    momentum_is_kept(Choice::new(lattice([1.0, 2.0, 1.5], [4, 5, 4]), gamma()));
}

/// A rigid rotation with its velocity: no force, no volume change, no dissipation; F follows.
#[test]
fn a_rigid_rotation_gives_no_force_and_no_volume_rate() {
    let mut choice = Choice::new(lattice([1.0, 2.0, 1.5], [4, 5, 4]), gamma());
    choice.settings.tau_velocity = 0.7;
    choice.settings.tau_pressure = 0.4;
    let positions = choice.particles.position.clone();
    let mut scheme = choice.build(|_| Vector::zeros());
    let rotation = *nalgebra::Rotation3::from_euler_angles(0.3, -1.1, 0.7).matrix();
    let spin = Vector::<3>::new(0.4, -0.2, 0.9);
    let mut state = scheme.initial_state();
    let length = scheme.width();
    let places = places(&scheme);
    let mut all = rows(&places, &state);
    for (row, reference) in all.chunks_exact_mut(length).zip(&positions) {
        let position = rotation * reference;
        row[..3].copy_from_slice(spin.cross(&position).as_slice());
        row[4..7].copy_from_slice(position.as_slice());
        row[7..].copy_from_slice(rotation.transpose().as_slice());
    }
    places.iter().zip(all).for_each(|(&place, number)| state[place] = number);
    let rate = rows(&places, &rates(&mut scheme, &state));
    for row in rate.chunks_exact(length).take(positions.len()) {
        assert!(row[..4].iter().all(|value| value.abs() < 1e-10), "{:?}", &row[..4]);
        let expected: Tensor<3> = (spin.cross_matrix() * rotation).transpose();
        let error = expected.iter().zip(&row[7..]).map(|(e, r)| (e - r).abs());
        assert!(error.fold(0.0, f64::max) < 1e-12);
    }
}

/// Angular momentum about any point changes by external torque only: none here. The dissipation
/// keeps it too, since its forces act along the line between two particles.
#[test]
fn angular_momentum_is_kept_with_and_without_dissipation() {
    angular_momentum_is_kept(PLAIN);
    let dissipating = Settings { tau_velocity: 0.7, tau_pressure: 0.4, ..PLAIN };
    angular_momentum_is_kept(dissipating);
    angular_momentum_is_kept(Settings { reconstruction: true, ..dissipating });
}

fn angular_momentum_is_kept(settings: Settings) {
    let mut choice = Choice::new(lattice([3.0, 5.0], [6, 8]), gamma());
    choice.settings = settings;
    let (positions, volume) = (choice.particles.position.clone(), choice.particles.volume.clone());
    let mut scheme = choice.build(|_| Vector::zeros());
    // A smooth motion with F consistent with x; J is arbitrary, so that pressures are not small.
    let length = scheme.width();
    let mut state = scheme.initial_state();
    let places = places(&scheme);
    for (row, (a, x)) in places.chunks_exact(length).zip(positions.iter().enumerate()) {
        state[row[0]] += noise(3 * a);
        state[row[1]] += noise(5 * a);
        state[row[2]] += 0.1 * noise(a);
        state[row[3]] += 0.1 * x[0] * x[1];
        state[row[4]] += 0.05 * x[0] * x[0];
    }
    let field: Vec<Vector<2>> = (0..positions.len())
        .map(|a| Vector::<2>::new(state[places[a * length + 3]], state[places[a * length + 4]]))
        .collect();
    let list = piola::operators::Support::new(
        &lattice([3.0, 5.0], [6, 8]),
        piola_formulas::kernels::Kernel::CubicSpline,
        0.7,
        piola::neighbors::Domain::open(),
    )
    .expect("the support exists");
    let operator = piola::operators::GradientOperator::new(
        &lattice([3.0, 5.0], [6, 8]),
        &list,
        PLAIN.correction,
    )
    .expect("the operator exists");
    for (a, gradient) in operator.vector_gradient(&list, &field).iter().enumerate() {
        let own = &places[a * length + 5..][..4];
        own.iter().zip(&gradient.transpose()).for_each(|(&place, f)| state[place] = *f);
    }
    let rate = rows(&places, &rates(&mut scheme, &state));
    let torque = |a: usize| {
        let (x, f) = (&field[a], &rate[a * length..][..2]);
        volume[a] * (x[0] * f[1] - x[1] * f[0])
    };
    let total: f64 = (0..volume.len()).map(torque).sum();
    let size: f64 = (0..volume.len()).map(|a| torque(a).abs()).sum();
    assert!(total.abs() < 1e-12 * size, "{total} of {size}");
}

fn executor<S: Scheme + 'static>(mut scheme: S, control: StepControl, end: f64) -> Executor {
    let integrator = IntegratorKind::TvdRk2.build(&mut scheme).expect("it has rates");
    Executor::new(boxed(scheme), integrator, control, end)
}

/// U1: a bar with one mode follows u(L, t) = sin(w t) / w, w = pi c / 2L.
#[test]
fn a_bar_vibrates_at_its_natural_frequency() {
    let choice = Choice::new(lattice([10.0], [40]), linear(1e6)).fix(0, |x| x[0] < 1e-9);
    let mut choice = choice;
    choice.smoothing_ratio = 1.0;
    let mut scheme = choice.build(|x| Vector::<1>::new((PI * x[0] / 20.0).sin()));
    let omega = PI * 1000.0_f64.sqrt() / 20.0;
    let (mut largest, end) = (0.0_f64, place(&scheme, "position", 40, 0));
    let start = scheme.initial_state();
    march_from(&mut scheme, start, 1e-3, 6325, |time, state| {
        let tip = state[end] - 10.0;
        largest = largest.max((tip - (omega * time).sin() / omega).abs() * omega);
    });
    // Five periods: the phase error of 0.13 % of a period shows as 2 pi 0.0013 at most.
    assert!(largest < 2.0 * PI * 0.0016, "{largest}");
}

/// In a periodic bar a wave is an exact mode of the narrow stencil, of w = c sin(k dx) / dx. Its
/// energy grows by the factor 1 + (w dt)^4 / 4 a step, which is all that the integrator does wrong.
#[test]
fn energy_grows_as_the_integrator_predicts() {
    let mut particles = lattice([10.0], [40]);
    particles.reorder(&(0..40).collect::<Vec<u32>>());
    particles.volume.fill(0.25);
    let mut choice = Choice::new(particles, linear(1e6));
    choice.domain = Domain::new([Some([0.0, 10.0])]).expect("a sound box");
    let wave_number = 2.0 * PI * 3.0 / 10.0;
    let mut scheme = choice.build(|x| Vector::<1>::new((wave_number * x[0]).sin()));
    let start = energy(&scheme, &scheme.initial_state());
    let (step, steps) = (2e-3, 2000);
    let last = march(&mut scheme, step, steps);
    let growth = energy(&scheme, &last) / start - 1.0;
    let omega = 1000.0_f64.sqrt() * (wave_number * 0.25).sin() / 0.25;
    let expected = (1.0 + (omega * step).powi(4) / 4.0).powi(steps as i32) - 1.0;
    assert!((growth / expected - 1.0).abs() < 1e-6, "{growth} against {expected}");
}

/// A run ends at its end, counts its steps, and names the limit.
#[test]
fn the_executor_ends_where_it_should() {
    let choice = Choice::new(lattice([10.0], [40]), linear(1e6)).fix(0, |x| x[0] < 1e-9);
    let scheme = choice.build(|x| Vector::<1>::new((PI * x[0] / 20.0).sin()));
    let mut run = executor(scheme, StepControl::Cfl(0.3), 0.5);
    let summary = run.run(&AtomicBool::new(false), &mut |_| {}).expect("no observer, no fault");
    assert_eq!(summary.outcome, Outcome::Completed);
    assert_eq!(summary.time, 0.5);
    // dt = 0.3 * 0.25 / 31.6 at rest, and within 5 % of it at strains of 3 %.
    assert!((summary.first_step - 0.3 * 0.25 / 1000.0_f64.sqrt()).abs() < 1e-15);
    assert!((200..=230).contains(&summary.steps), "{}", summary.steps);
}

/// U8 at 8 m/s, about the wave speed: the linear law collapses, and the run says where.
#[test]
fn a_collapse_names_particle_and_time() {
    let mut choice =
        Choice::new(lattice([3.0, 5.0], [14, 14]), linear(1e5 / 1.4)).fix(1, |x| x[1] < 1e-9);
    choice.settings.tau_velocity = 0.5;
    let scheme = choice.build(|_| Vector::<2>::new(0.0, -8.0));
    let mut run = executor(scheme, StepControl::Cfl(0.3), 3.0);
    let summary = run.run(&AtomicBool::new(false), &mut |_| {}).expect("no observer, no fault");
    let Outcome::Failed(failure) = &summary.outcome else { panic!("{:?}", summary.outcome) };
    let text = failure.to_string();
    assert!(text.contains("particle") && text.contains("t = "), "{text}");
    assert!(summary.time > 0.0 && summary.time < 3.0);
}

/// A column that hits the floor stays symmetric about its middle. Mirrored sums run in another
/// order, so that it does up to round-off only, which 300 steps of a smooth motion barely grow.
#[test]
fn a_symmetric_impact_stays_symmetric() {
    let (n, m) = (12, 20);
    let mut choice = Choice::new(lattice([3.0, 5.0], [n, m]), gamma()).fix(1, |x| x[1] < 1e-9);
    choice.settings.tau_velocity = 0.5;
    choice.settings.tau_pressure = 0.1;
    choice.settings.reconstruction = true;
    let mut scheme = choice.build(|_| Vector::<2>::new(0.0, -1.0));
    let last = march(&mut scheme, 2e-3, 300);
    let last = rows(&places(&scheme), &last);
    let row = |i: usize, j: usize| &last[9 * (i + (n + 1) * j)..][..9];
    for j in 0..=m {
        for i in 0..=n {
            let (left, right) = (row(i, j), row(n - i, j));
            let odd = (left[0] + right[0]).abs() + (left[3] + right[3] - 3.0).abs();
            let even = (left[1] - right[1]).abs() + (left[2] - right[2]).abs();
            assert!(odd + even < 1e-12, "{i} {j}: {odd} {even}");
        }
    }
    // It has moved: the toe slides out by more than the rounding of anything.
    assert!(row(n, 0)[3] > 3.05, "{}", row(n, 0)[3]);
}

/// Results are the same to the bit for any number of threads.
#[test]
fn threads_do_not_change_a_bit() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("a pool starts").install(|| {
            let mut choice = Choice::new(lattice([3.0, 5.0], [60, 60]), gamma());
            choice.settings.tau_velocity = 0.5;
            choice.settings.tau_pressure = 0.2;
            choice.settings.reconstruction = true;
            let mut scheme = choice.fix(1, |x| x[1] < 1e-9).build(|_| Vector::<2>::new(0.0, -1.0));
            march(&mut scheme, 1e-3, 20)
        })
    };
    let one = run(1);
    assert_eq!(one, run(2));
    assert_eq!(one, run(5));
}

/// A state with a value that is not finite, and one turned inside out, are found and named.
#[test]
fn inspection_finds_the_broken_particle() {
    let mut scheme =
        Choice::new(lattice([3.0, 5.0], [6, 8]), gamma()).build(|_| Vector::<2>::zeros());
    let mut limits = Vec::new();
    let [broken, turned] = [("velocity", 17, 1), ("volume_ratio", 23, 0)]
        .map(|(field, particle, component)| place(&scheme, field, particle, component));
    let mut inspect = |state: &[f64]| -> Health { scheme.inspect(state, &mut limits) };
    let sound = disturbed(
        &Choice::new(lattice([3.0, 5.0], [6, 8]), gamma()).build(|_| Vector::<2>::zeros()),
        0.0,
    );
    assert_eq!(inspect(&sound).first_not_finite, None);
    let mut state = sound.clone();
    state[broken] = f64::NAN;
    assert_eq!(inspect(&state).first_not_finite, Some(17));
    let mut state = sound.clone();
    state[turned] = -0.25;
    let health = inspect(&state);
    assert_eq!((health.smallest_ratio, health.smallest_ratio_particle), (-0.25, 23));
}

#[test]
fn every_described_field_has_values() {
    let counted = Counted::default();
    let mut choice = Choice::new(lattice([3.0, 5.0], [6, 8]), gamma());
    choice.body_forces.push(counted.force());
    let mut scheme = choice.build(|_| Vector::<2>::zeros());
    let state = disturbed(&scheme, 0.01);
    fields_are_complete(&mut scheme, &state, &counted);
}

/// Parts that do not fit together, and particles that cannot move, are refused by name.
#[test]
fn input_that_cannot_be_computed_with_is_refused() {
    let refuse = |spoil: &dyn Fn(&mut UpwindInput<2>), expected: &str| {
        let choice = Choice::new(lattice([3.0, 5.0], [6, 10]), gamma())
            .fix(0, |x| x[0] < 1e-9)
            .load([Arc::new(0.0), Arc::new(1.0)], |x| x[1] > 4.9, |_| 0.5);
        let count = choice.particles.len();
        let zeros = Initial { velocity: vec![Vector::zeros(); count], pressure: vec![0.0; count] };
        let mut input = choice.input(zeros);
        assert_eq!(count, 77);
        spoil(&mut input);
        let error = Upwind::new(input).map(|_| ()).expect_err(expected).to_string();
        assert!(error.contains(expected), "`{error}` lacks `{expected}`");
    };
    refuse(&|i| i.initial.velocity.truncate(76), "the initial velocity has 76 entries");
    refuse(&|i| i.initial.pressure.push(0.0), "the initial pressure has 78 entries");
    refuse(&|i| i.particles.weight.clear(), "the list of weights has 0 entries");
    refuse(&|i| i.particles.body[70] = 1, "the material of body 1 does not exist");
    refuse(&|i| i.tractions[0].areas.truncate(3), "the list of areas of `load` has 3 entries");
    refuse(&|i| i.tractions[0].particles[2] = 77, "`load`: particle 77 does not exist");
    refuse(&|i| i.prescribed[0].particles[1] = 99, "particle 99 does not exist");
    refuse(&|i| i.prescribed[0].component = 2, "component 2 does not exist");
    refuse(&|i| i.particles.volume[5] = 0.0, "particle 5 at (2.5, 0) has a mass of 0 kg");
    refuse(&|i| i.materials[0].density = f64::NAN, "particle 0 at (0, 0) has a mass of NaN");
    refuse(&|i| i.initial.velocity[3][1] = f64::NAN, "velocity of particle 3 at");
    refuse(&|i| i.initial.pressure[4] = -1e9, "initial pressure -1000000000 Pa of particle 4");
    refuse(&|i| i.particles.position[8] = i.particles.position[1], "particles 1 and 8 lie");
}
