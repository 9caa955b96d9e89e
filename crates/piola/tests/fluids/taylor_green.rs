//! The decay of Taylor-Green vortices, CTVF section 4.1.

use std::f64::consts::PI;

use piola::Vector;
use piola::schemes::transport_velocity::{Corrections, Fluid, Settings, TransportVelocity};
use piola::schemes::{Health, Observation, Scheme};
use piola::time::IntegratorKind;

use super::support::{SETTINGS, fluid_in_box, unit_box};

/// CTVF (63) to (65) at a place and time.
fn exact(x: &Vector<2>, reynolds: f64, t: f64) -> (Vector<2>, f64) {
    let (decay, k) = ((-8.0 * PI * PI / reynolds * t).exp(), 2.0 * PI);
    let velocity =
        Vector::<2>::new(-(k * x[0]).cos() * (k * x[1]).sin(), (k * x[0]).sin() * (k * x[1]).cos());
    let pressure = -0.25 * ((2.0 * k * x[0]).cos() + (2.0 * k * x[1]).cos());
    (velocity * decay, pressure * decay * decay)
}

pub fn vortices(side: usize, reynolds: f64, settings: Settings, seed: u64) -> TransportVelocity<2> {
    let fluid = Fluid { density: 1.0, wave_speed: 10.0, viscosity: 1.0 / reynolds };
    let particles = unit_box(side, 0.1, seed);
    fluid_in_box(particles, settings, fluid, 1.0, |x| exact(x, reynolds, 0.0))
}

/// Steps to `end` with a CFL number of 0.25.
fn run(scheme: &mut dyn Scheme, end: f64) -> Vec<f64> {
    let mut state = scheme.initial_state();
    let mut new = state.clone();
    let mut integrator = IntegratorKind::KickDriftKick.build(scheme).expect("it moves the scheme");
    let (mut limits, mut time) = (Vec::new(), 0.0);
    while time < end * (1.0 - 1e-12) {
        let health: Health = scheme.inspect(&state, &mut limits);
        assert_eq!(health.first_not_finite, None, "at {time}");
        let step = limits.iter().map(|limit| 0.25 * limit.step).fold(end - time, f64::min);
        integrator
            .step(scheme, time, step, &state, &mut new)
            .expect("explicit methods always find a state");
        std::mem::swap(&mut state, &mut new);
        time += step;
    }
    state
}

fn all(scheme: &mut dyn Scheme, state: &[f64], field: &str) -> Vec<f64> {
    let particles: Vec<u32> = (0..scheme.particle_count() as u32).collect();
    Observation::new(scheme, 0.0, state).values(field, &particles)
}

/// L1 errors of speed, CTVF (66) with absolute values, and of pressure about its mean.
fn errors(scheme: &mut dyn Scheme, state: &[f64], reynolds: f64, t: f64) -> [f64; 2] {
    let position = all(scheme, state, "position");
    let velocity = all(scheme, state, "velocity");
    let pressure = all(scheme, state, "pressure");
    let mean = pressure.iter().sum::<f64>() / pressure.len() as f64;
    let mut sums = [0.0; 4];
    for a in 0..pressure.len() {
        let x = Vector::<2>::new(position[2 * a], position[2 * a + 1]);
        let (u, p) = exact(&x, reynolds, t);
        let speed = velocity[2 * a].hypot(velocity[2 * a + 1]);
        sums[0] += (speed - u.norm()).abs();
        sums[1] += u.norm();
        sums[2] += (pressure[a] - mean - p).abs();
        sums[3] += p.abs();
    }
    [sums[0] / sums[1], sums[2] / sums[3]]
}

#[test]
fn corrections_keep_the_error_of_the_speed_small() {
    // After 0.2 s with 25 particles a side: below 3 %, and less than half of that of the baseline with
    // uhat in the divergence.
    let error = |corrections| {
        let settings = Settings { corrections, ..SETTINGS };
        let mut scheme = vortices(25, 1000.0, settings, 1);
        let state = run(&mut scheme, 0.2);
        errors(&mut scheme, &state, 1000.0, 0.2)[0]
    };
    let (full, baseline) = (error(Corrections::FULL), error(Corrections::TRANSPORT_DIVERGENCE));
    assert!(full < 0.03 && full < 0.5 * baseline, "{full} against {baseline}");
}

#[test]
fn a_uniform_stream_is_slowed_by_no_correction_but_the_printed_ones() {
    // Particles on a disordered lattice, which shifting makes even again, in a stream without a gradient.
    let stream = Vector::<2>::new(1.0, -0.5);
    let fluid = Fluid { density: 1.0, wave_speed: 10.0, viscosity: 0.01 };
    let velocities = |corrections| {
        let settings = Settings { corrections, ..SETTINGS };
        let mut scheme =
            fluid_in_box(unit_box(25, 0.2, 1), settings, fluid, 1.0, |_| (stream, 0.0));
        let state = scheme.initial_state();
        let shifted = all(&mut scheme, &state, "transport_velocity");
        assert!(shifted.chunks_exact(2).any(|u| (u[0] - stream.x).abs() > 0.05));
        let state = run(&mut scheme, 0.1);
        all(&mut scheme, &state, "velocity")
    };
    for corrections in [Corrections::FULL, Corrections::NONE] {
        let velocities = velocities(corrections);
        assert!(velocities.chunks_exact(2).all(|u| u == stream.as_slice()));
    }
    // It is a drag on all of them, theory (22).
    let along = |u: &[f64]| (u[0] * stream.x + u[1] * stream.y) / stream.norm_squared();
    let paper: Vec<f64> = velocities(Corrections::PAPER).chunks_exact(2).map(along).collect();
    assert!(paper.iter().sum::<f64>() / (paper.len() as f64) < 0.995, "{paper:?}");
}
