//! Loads, moving boundaries, prestress and periodic boxes of the upwind formulation, each against
//! an exact solution, and the ledger of their work.

use std::f64::consts::PI;
use std::sync::Arc;

use crate::support::{
    Choice, Function, PLAIN, disturbed, energy, imbalance, lattice, march, march_from, noise,
    place, places, rows, varying, work,
};
use piola::Vector;
use piola::geometry::Particles;
use piola::neighbors::Domain;
use piola::schemes::Scheme;
use piola::schemes::upwind::{BodyForce, Initial, Material, Settings, Upwind, UpwindInput};
use piola_formulas::volumetric::{VolumetricLaw, VolumetricResponse};

fn linear(modulus: f64) -> VolumetricLaw {
    VolumetricLaw::linear(modulus).expect("a sound material")
}

fn gamma(wave_speed: f64) -> VolumetricLaw {
    VolumetricLaw::gamma_law_from_wave_speed(wave_speed, 1000.0, 7.0).expect("a sound material")
}

fn upwinded() -> Settings {
    Settings { tau_velocity: 0.5, tau_pressure: 0.5, reconstruction: true, ..PLAIN }
}

/// A bar of 20 intervals whose right end shakes with `sin(w t)` while its left end is held.
fn shaken() -> Upwind<1> {
    let omega = 40.0;
    let shake = Function {
        value: move |_, t: f64| (omega * t).sin(),
        rate: move |_, t: f64| omega * (omega * t).cos(),
    };
    let mut choice = Choice::new(lattice([1.0], [20]), gamma(10.0))
        .fix(0, |x| x[0] < 1e-9)
        .prescribe(0, Arc::new(shake), |x| x[0] > 1.0 - 1e-9);
    choice.settings = upwinded();
    choice.build(|_| Vector::<1>::zeros())
}

/// The end goes where the trapezoidal sum of its velocity says, however coarse the step.
#[test]
fn a_prescribed_velocity_moves_by_its_trapezoidal_sum() {
    let mut scheme = shaken();
    let (step, places) = (2e-3, places(&scheme));
    let (mut expected, mut speed) = (1.0, 0.0);
    let start = scheme.initial_state();
    march_from(&mut scheme, start, step, 100, |time, state| {
        let new = (40.0 * time).sin();
        expected += 0.5 * step * (speed + new);
        speed = new;
        let row = rows(&places[20 * 4..], state);
        assert!((row[0] - new).abs() < 1e-14); // the two clocks differ by a rounding
        assert!((row[2] - expected).abs() < 1e-14, "{} {expected}", row[2]);
        assert_eq!((state[places[0]], state[places[2]]), (0.0, 0.0));
    });
}

/// Of two conditions for one component of a particle the later one holds, whatever the order of
/// the particles in them.
#[test]
fn the_later_of_two_conditions_holds() {
    let mut scheme = Choice::new(lattice([1.0], [4]), gamma(10.0))
        .prescribe(0, Arc::new(1.0), |_| true)
        .prescribe(0, Arc::new(2.0), |x| x[0] > 0.4 && x[0] < 0.8)
        .build(|_| Vector::<1>::zeros());
    let state = march(&mut scheme, 1e-3, 1);
    let velocities = &state[place(&scheme, "velocity", 0, 0)..][..5];
    assert_eq!(velocities, [1.0, 1.0, 2.0, 2.0, 1.0]);
}

/// The end is pushed in by a tenth within 100 transit times, softly: the work is the strain
/// energy of the homogeneous bar. Vibrations keep the square of (transit/duration)^2, 1e-8.
#[test]
fn slow_compression_stores_its_work_as_strain_energy() {
    let duration = 10.0; // s, with 0.1 s a transit
    let push = Function {
        value: move |_, t: f64| -0.1 / duration * (1.0 - (2.0 * PI * t / duration).cos()),
        rate: move |_, t: f64| -0.2 * PI / (duration * duration) * (2.0 * PI * t / duration).sin(),
    };
    let law = gamma(10.0);
    let mut choice = Choice::new(lattice([1.0], [20]), law).fix(0, |x| x[0] < 1e-9).prescribe(
        0,
        Arc::new(push),
        |x| x[0] > 1.0 - 1e-9,
    );
    choice.settings = upwinded();
    let mut scheme = choice.build(|_| Vector::<1>::zeros());
    let state = march(&mut scheme, 2e-3, 5000);
    assert!((state[place(&scheme, "position", 20, 0)] - 0.9).abs() < 1e-12);
    let stored: f64 = law.energy(0.9);
    let done = work(&scheme, &state, "boundary_motion");
    assert!((done / stored - 1.0).abs() < 1e-6, "{done} {stored}");
    assert!(imbalance(&scheme, 0.0, &state).abs() < 1e-6 * stored);
}

/// Energy less all work is what the integrator adds, with a moving lid, gravity that varies, both
/// dissipations and a large amplitude. It is of second order, and of third as long as the fastest
/// modes rule, whose energy is quadratic: their growth by `(w dt)^4` a step.
#[test]
fn the_balance_is_of_second_order_or_better_in_the_step() {
    let error = |steps: usize| {
        let mut choice = Choice::new(lattice([1.0, 1.0], [8, 8]), gamma(10.0));
        choice.settings = Settings { reconstruction: false, ..upwinded() };
        choice.body_forces.push(BodyForce {
            body: None,
            acceleration: [
                varying(|x, t| 20.0 * (5.0 * t).sin() * x[1]),
                varying(|_, t| -9.81 * t),
            ],
        });
        let lid = Function {
            value: |_, t: f64| -0.5 * (8.0 * t).sin(),
            rate: |_, t: f64| -4.0 * (8.0 * t).cos(),
        };
        let mut scheme = choice
            .fix(1, |x| x[1] < 1e-9)
            .prescribe(1, Arc::new(lid), |x| x[1] > 1.0 - 1e-9)
            .build(|x| Vector::<2>::new(0.3 * (PI * x[0]).sin(), 0.0));
        let start = energy(&scheme, &scheme.initial_state());
        let state = march(&mut scheme, 0.2 / steps as f64, steps);
        imbalance(&scheme, start, &state)
    };
    let [coarse, middle, fine] = [100, 200, 400].map(error);
    for ratio in [coarse / middle, middle / fine] {
        assert!((4.0..8.5).contains(&ratio), "{coarse} {middle} {fine}");
    }
}

/// A bar under a sudden end traction: the tip moves out at `sigma/(rho c)` until the wave is back
/// at `2 L/c`, at twice the static stretch, and in again. Central differences spread a front over
/// `(x dx^2)^(1/3)`, here 0.06 L after it is back; where the exact tip turns, the found one is
/// rounded by about half of that times the slope: 3 % of the peak.
#[test]
fn a_step_traction_reaches_twice_the_static_stretch() {
    let (modulus, sigma) = (1e6, 1e3);
    let mut choice = Choice::new(lattice([1.0], [100]), linear(modulus)).fix(0, |x| x[0] < 1e-9);
    choice = choice.load([Arc::new(sigma)], |x| x[0] > 1.0 - 1e-9, |_| 1.0);
    let mut scheme = choice.build(|_| Vector::<1>::zeros());
    let speed = (modulus / 1000.0_f64).sqrt();
    let tip = place(&scheme, "position", 100, 0);
    let (transit, twice) = (1.0 / speed, 2.0 * sigma / modulus);
    let (mut worst, mut peak) = (0.0_f64, (0.0, 0.0));
    let start = scheme.initial_state();
    let state = march_from(&mut scheme, start, transit / 1000.0, 4000, |time, state| {
        let phase = time / (2.0 * transit);
        let exact = twice * (1.0 - (1.0 - phase).abs());
        let found = state[tip] - 1.0;
        worst = worst.max((found - exact).abs() / twice);
        if found > peak.1 {
            peak = (time, found);
        }
    });
    assert!(worst < 0.03, "{worst}");
    assert!((peak.1 / twice - 1.0).abs() < 0.01, "{}", peak.1 / twice);
    assert!((peak.0 / transit - 2.0).abs() < 0.05, "{}", peak.0 / transit);
    // Force times way, by the same sums as the way itself, whose rounding is that of x near 1 m.
    let done = work(&scheme, &state, "traction");
    assert!((done - sigma * (state[tip] - 1.0)).abs() < 1e-10 * sigma * twice);
    // The modes of a front of 2 % of the bar grow by (w dt)^4 / 4 in each of 4000 steps of 0.1.
    let growth = imbalance(&scheme, 0.0, &state) / (sigma * twice);
    assert!((0.0..0.02 * 0.1_f64.powi(4) / 4.0 * 4000.0).contains(&growth), "{growth}");
}

/// Whatever the state, momentum changes by the loads alone, and a load on a prescribed component
/// is borne by the boundary.
#[test]
fn momentum_changes_by_the_loads_alone() {
    let mut choice = Choice::new(lattice([3.0, 5.0], [6, 8]), gamma(10.0));
    choice.settings = upwinded();
    choice.smoothing_ratio = 1.2;
    choice.gravity = Vector::<2>::new(1.0, -9.81);
    let top = |x: &Vector<2>| x[1] > 5.0 - 1e-9;
    choice = choice.load([Arc::new(-3e3), varying(|_, t| 2e3 * t)], top, |_| 0.5);
    let volume = choice.particles.volume.clone();
    let held = choice.particles.position.iter().position(top).expect("a top");
    choice = choice.prescribe(0, Arc::new(0.0), |x| top(x) && x[0] < 1e-9);
    let mut scheme = choice.build(|_| Vector::zeros());
    let state = disturbed(&scheme, 0.05);
    let mut rate = vec![0.0; state.len()];
    scheme.rates(0.7, &state, &mut rate);
    let (rate, length) = (rows(&places(&scheme), &rate), scheme.width());
    assert_eq!(rate[held * length], 0.0);
    let forces = |k: usize| -> Vec<f64> {
        (0..volume.len()).map(|a| 1000.0 * volume[a] * rate[a * length + k]).collect()
    };
    let (across, along) = (forces(0), forces(1));
    let size: f64 = along.iter().map(|f| f.abs()).sum();
    let expected = 7.0 * 0.5 * 2e3 * 0.7 - 9.81 * 15.0 * 1000.0;
    assert!((along.iter().sum::<f64>() - expected).abs() < 1e-13 * size);
    let loads = -7.0 * 0.5 * 3e3 + 15.0 * 1000.0;
    let borne = loads - across.iter().sum::<f64>();
    assert!(borne.abs() > 1e-3 * size, "the boundary bears a part: {borne}");
}

/// A free body under an acceleration that varies in time moves as a whole: velocities are the
/// trapezoidal sums, and nothing is strained.
#[test]
fn a_uniform_body_force_moves_a_free_body_as_a_whole() {
    let mut choice = Choice::new(lattice([1.0, 2.0], [5, 8]), gamma(10.0));
    choice.settings = upwinded();
    let pull = |t: f64| [30.0 * (20.0 * t).cos(), -9.81 * t];
    let acceleration = std::array::from_fn(|k| varying(move |_, t| pull(t)[k]));
    choice.body_forces.push(BodyForce { body: None, acceleration });
    let mut scheme = choice.build(|_| Vector::<2>::new(1.0, 2.0));
    let (step, length) = (2e-3, scheme.width());
    let (mut expected, mut old) = ([1.0, 2.0], pull(0.0));
    let (places, start) = (places(&scheme), scheme.initial_state());
    let begin = energy(&scheme, &start);
    let state = march_from(&mut scheme, start, step, 200, |time, state| {
        let new = pull(time);
        (0..2).for_each(|k| expected[k] += 0.5 * step * (old[k] + new[k]));
        old = new;
        for row in rows(&places, state).chunks_exact(length) {
            assert!((row[0] - expected[0]).abs() + (row[1] - expected[1]).abs() < 1e-11);
            assert!((row[2] - 1.0).abs() < 1e-12, "{}", row[2]);
        }
    });
    let kinetic = 1000.0 * (expected[0].powi(2) + expected[1].powi(2)); // half of 2 m^2
    assert!((energy(&scheme, &state) - kinetic).abs() < 1e-10 * kinetic);
    let done = work(&scheme, &state, "body_force");
    assert!((begin + done - kinetic).abs() < 1e-3 * kinetic, "{done} {kinetic} {begin}");
}

/// Two bodies in one place do not see each other: each does to the bit what it does alone, with
/// its own material and the force that is meant for it.
#[test]
fn bodies_are_on_their_own() {
    let materials = [(1000.0, gamma(10.0)), (500.0, linear(2e5))];
    let force = |body: Option<u32>, g: f64| BodyForce::<2> {
        body,
        acceleration: [Arc::new(0.0), varying(move |x, t| g * (x[0] + t))],
    };
    let zeros = |count: usize| Initial {
        velocity: (0..count).map(|a| Vector::<2>::new(noise(a), 0.0)).collect(),
        pressure: vec![0.0; count],
    };
    let choose = |particles: Particles<2>| {
        let mut choice = Choice::new(particles, gamma(10.0));
        choice.settings = upwinded();
        choice
    };
    let one = lattice([1.0, 1.0], [6, 6]);
    let count = one.len();
    let mut both = one.clone();
    both.position.extend(one.position.iter().map(|x| x + Vector::<2>::new(0.03, 0.04)));
    both.volume.extend_from_slice(&one.volume);
    both.weight.extend_from_slice(&one.weight);
    both.spacing.extend_from_slice(&one.spacing);
    both.body.extend(vec![1; count]);
    both.id.extend(count as u32..2 * count as u32);

    let mut choice = choose(both);
    choice.body_forces = vec![force(None, 1.0), force(Some(1), 30.0)];
    let mut input = choice.input(zeros(2 * count));
    input.materials = materials.map(|(density, law)| Material { density, law }).to_vec();
    let run = |input: UpwindInput<2>| {
        let mut scheme = Upwind::new(input).expect("a scheme");
        let state = march(&mut scheme, 1e-3, 50);
        rows(&places(&scheme), &state)
    };
    let together = run(input);

    for (body, forces) in
        [vec![force(None, 1.0)], vec![force(None, 1.0), force(None, 30.0)]].into_iter().enumerate()
    {
        let mut alone = one.clone();
        let shift = Vector::<2>::new(0.03, 0.04) * body as f64;
        alone.position.iter_mut().for_each(|x| *x += shift);
        let mut choice = choose(alone);
        choice.body_forces = forces;
        let mut initial = zeros(2 * count);
        initial.velocity.drain(..body * count);
        initial.velocity.truncate(count);
        initial.pressure.truncate(count);
        let mut input = choice.input(initial);
        let (density, law) = materials[body];
        input.materials = vec![Material { density, law }];
        assert_eq!(run(input), together[9 * count * body..9 * count * (body + 1)]);
    }
}

const GRAVITY: f64 = 9.81;
const DEPTH: f64 = 2.0;

/// A column of water of depth 2 m between slip walls, under a prestress.
fn column(n: usize, settings: Settings, pressure: impl Fn(f64) -> f64) -> Upwind<2> {
    let mut choice = Choice::new(lattice([1.0, DEPTH], [n, 2 * n]), gamma(50.0));
    choice.settings = settings;
    choice.gravity = Vector::<2>::new(0.0, -GRAVITY);
    choice
        .fix(1, |x| x[1] < 1e-9)
        .fix(0, |x| x[0] < 1e-9 || x[0] > 1.0 - 1e-9)
        .build_stressed(|_| Vector::zeros(), |x| pressure(x[1]))
}

/// A linear prestress has an exact gradient, up to the free surface, the walls and their corners;
/// what does not balance is the denser reference, rho/J0: the acceleration is `g (J0 - 1)`.
#[test]
fn linear_prestress_balances_gravity_but_for_the_density() {
    let pressure = |y: f64| 1000.0 * GRAVITY * (DEPTH - y);
    let mut scheme = column(5, upwinded(), pressure);
    let state = scheme.initial_state();
    let mut rate = vec![0.0; state.len()];
    scheme.rates(0.0, &state, &mut rate);
    let rate = rows(&places(&scheme), &rate);
    for (a, row) in rate.chunks_exact(scheme.width()).take(66).enumerate() {
        let y = scheme.particle(a).reference[1];
        let ratio = gamma(50.0).volume_ratio_at_pressure(pressure(y)).expect("a ratio");
        let expected = if y < 1e-9 { 0.0 } else { GRAVITY * (ratio - 1.0) };
        assert!((row[1] - expected).abs() < 1e-11, "{a} {y}: {} {expected}", row[1]);
        assert!(row[0].abs() < 1e-11 && row[2].abs() < 1e-11, "{row:?}");
    }
}

/// The pressure of a compressible column at rest: `dp/dy = -rho g (1 + p/kappa)^(1/7)`.
fn at_rest(y: f64) -> f64 {
    let kappa = 1000.0 * 2500.0 / 7.0;
    let power = 6.0 / 7.0;
    let s = 1.0 + power * 1000.0 * GRAVITY / kappa * (DEPTH - y);
    kappa * (s.powf(1.0 / power) - 1.0)
}

/// With the pressure of the continuum what is left is the half cell under the free surface, which
/// sees the pressure gradient of a quarter spacing below: an acceleration of order `g^2 dx/c^2`
/// for the time `dx/c` that a wave takes to even it out, so speeds of `g^2 dx^2/c^3`.
#[test]
fn a_column_at_rest_stays_at_rest() {
    let speed = |n: usize, settings: Settings| {
        let mut scheme = column(n, settings, at_rest);
        let (mut largest, start) = (0.0_f64, scheme.initial_state());
        let places = places(&scheme);
        // Five transit times in steps of a fifth of dx/c.
        march_from(&mut scheme, start, 0.2 / (50.0 * n as f64), 50 * n, |_, state| {
            largest = largest.max(column_speed(&rows(&places, state)));
        });
        largest
    };
    for settings in [PLAIN, upwinded()] {
        let [coarse, fine] = [10, 20].map(|n| speed(n, settings));
        let bound = GRAVITY.powi(2) * 0.1_f64.powi(2) / 50.0_f64.powi(3);
        assert!(coarse < bound, "{coarse} above {bound}");
        // Without upwinding the waves stay and add up by chance.
        assert!((3.0..4.5).contains(&(coarse / fine)), "{coarse} {fine}");
    }
}

/// The largest speed of some rows.
fn column_speed(rows: &[f64]) -> f64 {
    rows.chunks_exact(9).map(|row| row[0].hypot(row[1])).fold(0.0, f64::max)
}

/// The unit square, periodic both ways, with n particles each way.
fn periodic(n: usize) -> Choice<2> {
    let length = 1.0 - 1.0 / n as f64;
    let mut particles = lattice([length, length], [n - 1, n - 1]);
    particles.volume.fill(1.0 / (n * n) as f64);
    let mut choice = Choice::new(particles, gamma(10.0));
    choice.domain = Domain::new([Some([0.0, 1.0]); 2]).expect("a sound box");
    choice.smoothing_ratio = 1.2;
    choice.settings = upwinded();
    choice
}

/// Everything drifts through the box three times and nothing notices.
#[test]
fn a_uniform_drift_through_a_periodic_box_changes_nothing() {
    let mut scheme = periodic(8).build(|_| Vector::<2>::new(3.0, -6.0));
    let start = scheme.initial_state();
    let state = march(&mut scheme, 2e-3, 500);
    let [start, state] = [start, state].map(|state| rows(&places(&scheme), &state));
    for (row, before) in state.chunks_exact(9).zip(start.chunks_exact(9)) {
        assert!(
            (row[3] - before[3] - 3.0).abs() < 1e-10 && (row[4] - before[4] + 6.0).abs() < 1e-10
        );
        assert!((row[0] - 3.0).abs() < 1e-10 && (row[2] - 1.0).abs() < 1e-12, "{row:?}");
    }
}

/// The box has no place of its own: a start shifted by whole cells gives a shifted result.
#[test]
fn a_periodic_box_has_no_preferred_place() {
    let n = 12;
    let solve = |shift: usize| {
        let moved = shift as f64 / n as f64;
        let mut scheme = periodic(n).build(|x| {
            let (x, y) = (2.0 * PI * (x[0] - moved), 2.0 * PI * (x[1] - 2.0 * moved));
            Vector::<2>::new(x.sin() + 0.4 * (y + x).cos(), 0.7 * y.cos() * x.sin())
        });
        let state = march(&mut scheme, 1e-3, 100);
        rows(&places(&scheme), &state)
    };
    let (here, there) = (solve(0), solve(5));
    for i in 0..n {
        for j in 0..n {
            let row = &here[9 * (i + n * j)..][..9];
            let other = &there[9 * ((i + 5) % n + n * ((j + 10) % n))..][..9];
            for k in [0, 1, 2, 5, 6, 7, 8] {
                assert!((row[k] - other[k]).abs() < 1e-11, "{i} {j} {k}: {} {}", row[k], other[k]);
            }
        }
    }
}
