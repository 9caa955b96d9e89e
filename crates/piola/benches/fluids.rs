//! Particle steps a second of the transport-velocity formulation:
//! `cargo bench -p piola --bench fluids`.
//!
//! Taylor-Green vortices in periodic boxes with all corrections and SPST, one step at a time, best
//! of several stretches of thirty steps with the lists that they renew. Arguments that are numbers
//! replace the sizes; `2d` and `3d` leave the other dimension out, `serial` the run on two threads,
//! and `full` that without corrections.

#[allow(dead_code, reason = "shared with another bench, which uses more of it")]
#[path = "upwind/clock.rs"]
mod clock;

use std::f64::consts::PI;

use piola::Vector;
use piola::geometry::{Faces, Particles};
use piola::neighbors::Domain;
use piola::schemes::transport_velocity::{
    AtSurface, Corrections, DensityRule, Fluid, PressureRule, Settings, Shifting,
    TransportVelocity, TransportVelocityInput,
};
use piola::schemes::{Initial, Scheme};
use piola::time::IntegratorKind;
use piola_formulas::kernels::Kernel;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// About `count` particles in the unit box, each coordinate displaced by up to a tenth of the
/// spacing.
fn particles<const D: usize>(count: usize) -> Particles<D> {
    let side = (count as f64).powf(1.0 / D as f64).round() as usize;
    let spacing = 1.0 / side as f64;
    let mut source = Pcg64::seed_from_u64(1);
    let mut particles = Particles::default();
    for number in 0..side.pow(D as u32) {
        particles.position.push(Vector::from_fn(|axis, _| {
            let index = number / side.pow(axis as u32) % side;
            (index as f64 + 0.5 + source.random_range(-0.1..0.1)) * spacing
        }));
        particles.volume.push(spacing.powi(D as i32));
        particles.weight.push(spacing.powi(D as i32));
        particles.spacing.push(spacing);
        particles.body.push(0);
        particles.id.push(number as u32);
    }
    particles
}

fn vortices<const D: usize>(
    particles: Particles<D>,
    corrections: Corrections,
    kernel: Kernel,
    h: f64,
) -> TransportVelocity<D> {
    let velocity = particles.position.iter().map(|x| {
        let k = 2.0 * PI;
        Vector::from_fn(|axis, _| match axis {
            0 => -(k * x[0]).cos() * (k * x[1]).sin(),
            1 => (k * x[0]).sin() * (k * x[1]).cos(),
            _ => 0.0,
        })
    });
    TransportVelocity::new(TransportVelocityInput {
        smoothing_length: h * particles.spacing[0],
        faces: vec![Faces::default(); particles.len()],
        domain: Domain::new([Some([0.0, 1.0]); D]).expect("the bounds are in order"),
        kernel,
        settings: Settings {
            density: DensityRule::Continuity,
            pressure: PressureRule::Edac { alpha: 0.5 },
            corrections,
            shifting: Shifting::Sun { factor: 1.0 },
            artificial_viscosity: 0.0,
            free_surface: false,
            at_surface: AtSurface::Held,
            density_drift: 0.02,
        },
        fluid: Fluid { density: 1.0, wave_speed: 10.0, viscosity: 0.01 },
        solids: None,
        initial: Initial { velocity: velocity.collect(), pressure: vec![0.0; particles.len()] },
        walls: Vec::new(),
        motion: Vec::new(),
        sliding: Vec::new(),
        body_forces: Vec::new(),
        particles,
    })
    .expect("the fluid can be built")
}

/// Steps a stretch.
const STEPS: u32 = 30;

fn measure<const D: usize>(count: usize, name: &str, kernel: Kernel, h: f64) -> f64 {
    let corrections = Corrections::from_name(name).expect("a name from the list");
    let mut scheme = vortices(particles::<D>(count), corrections, kernel, h);
    let mut state = scheme.initial_state();
    let mut new = state.clone();
    let mut integrator = IntegratorKind::KickDriftKick.build(state.len());
    let step = 0.25 * h / (count as f64).powf(1.0 / D as f64) / 11.0;
    let mut limits = Vec::new();
    let least = clock::best_time(|| {
        for _ in 0..STEPS {
            scheme.inspect(&state, &mut limits);
            integrator
                .step(&mut scheme, 0.0, step, &state, &mut new)
                .expect("explicit methods always find a state");
            std::mem::swap(&mut state, &mut new);
        }
    }) / f64::from(STEPS);
    let particles = scheme.particle_count();
    let mut neighbors = Vec::new();
    let all: Vec<u32> = (0..particles as u32).collect();
    scheme.sample(0.0, &state, "neighbors", &all, &mut neighbors);
    let speed = particles as f64 / least;
    println!(
        "| {D} | {threads} | {particles} | {mean:.1} | {kernel} | {name} | {millions:.2} | {ns:.0} |",
        threads = rayon::current_num_threads(),
        mean = neighbors.iter().sum::<f64>() / particles as f64,
        kernel = kernel.name(),
        millions = speed / 1e6,
        ns = 1e9 / speed,
    );
    speed
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let has = |word: &str| arguments.iter().any(|argument| argument == word);
    let given: Vec<usize> = arguments
        .iter()
        .filter_map(|argument| argument.parse::<f64>().ok())
        .map(|size| size as usize)
        .collect();
    let sizes = if given.is_empty() { vec![10_000, 100_000, 1_000_000] } else { given };
    println!(
        "| D | threads | particles | neighbours | kernel | corrections | M steps/s | ns/particle |"
    );
    println!("|--:|--:|--:|--:|:--|:--|--:|--:|");
    let threads: &[usize] = if has("serial") { &[1] } else { &[1, 2] };
    for &threads in threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads can be started").install(|| {
            for &size in &sizes {
                for name in ["full", "none"] {
                    if name == "none" && has("full") {
                        continue;
                    }
                    if !has("3d") {
                        measure::<2>(size, name, Kernel::QuinticSpline, 1.0);
                    }
                    if !has("2d") {
                        measure::<3>(size, name, Kernel::WendlandC2, 1.25);
                    }
                }
            }
        });
    }
}
