//! The decay of Taylor-Green vortices, CTVF section 4.1.

use std::f64::consts::PI;

use piola::Vector;
use piola::schemes::transport_velocity::{Fluid, Settings, TransportVelocity};
use piola::schemes::{Health, Ledger, Scheme};
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
    let mut integrator = IntegratorKind::KickDriftKick.build(state.len());
    let (mut limits, mut time) = (Vec::new(), 0.0);
    while time < end * (1.0 - 1e-12) {
        let health: Health = scheme.inspect(&state, &mut limits);
        assert_eq!(health.first_not_finite, None, "at {time}");
        let step = limits.iter().map(|limit| 0.25 * limit.step).fold(end - time, f64::min);
        integrator.step(scheme, time, step, &state, &mut new);
        std::mem::swap(&mut state, &mut new);
        time += step;
    }
    state
}

fn all(scheme: &mut dyn Scheme, state: &[f64], field: &str) -> Vec<f64> {
    let particles: Vec<u32> = (0..scheme.particle_count() as u32).collect();
    let mut values = Vec::new();
    scheme.sample(0.0, state, field, &particles, &mut values);
    values
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
#[ignore = "an experiment"]
fn experiment() {
    let number = |name: &str, default: f64| {
        std::env::var(name).ok().and_then(|value| value.parse().ok()).unwrap_or(default)
    };
    let (side, reynolds, end) = (number("SIDE", 50.0), number("RE", 100.0), number("END", 2.0));
    let corrections = std::env::var("CORRECTIONS").unwrap_or("full".into());
    let settings = Settings {
        corrections: piola::schemes::transport_velocity::Corrections::from_name(&corrections)
            .unwrap(),
        shifting: match std::env::var("SHIFT").as_deref() {
            Ok("none") => piola::schemes::transport_velocity::Shifting::None,
            Ok("ipst") => piola::schemes::transport_velocity::Shifting::Iterative {
                tolerance: 1e-3,
                most_passes: 5,
            },
            _ => {
                piola::schemes::transport_velocity::Shifting::Sun { factor: number("FACTOR", 1.0) }
            }
        },
        ..SETTINGS
    };
    for seed in 1..=number("SEEDS", 1.0) as u64 {
        let mut scheme = vortices(side as usize, reynolds, settings, seed);
        let start = std::time::Instant::now();
        let state = run(&mut scheme, end);
        for (name, work) in scheme.mechanisms().iter().zip(Ledger::of(&scheme, &state).work) {
            print!("{name} {:.5} ", work / 0.25);
        }
        let errors = errors(&mut scheme, &state, reynolds, end);
        println!(
            "{side} {reynolds} {corrections} seed {seed}: {errors:?} builds {} {:?}",
            scheme.list_builds(),
            start.elapsed()
        );
    }
}
