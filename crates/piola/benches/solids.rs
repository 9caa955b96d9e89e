//! Particle steps a second of elastic and elastic-plastic solids in the transport-velocity formulation:
//! `cargo bench -p piola --bench solids`.
//!
//! A free block of rubber, or of a metal that flows, in a smooth motion; with SPST, the search for free
//! surfaces and the look over the state before each step, best of several stretches of thirty steps.
//! Arguments that are numbers replace the sizes; `2d` and `3d` leave the other dimension out, `serial`
//! the run on two threads, and the names of settings those not named.

#[allow(dead_code, reason = "shared with another bench, which uses more of it")]
#[path = "upwind/clock.rs"]
mod clock;

use piola::Vector;
use piola::geometry::{Faces, Particles};
use piola::neighbors::Domain;
use piola::schemes::transport_velocity::{
    AtSurface, Contact, Corrections, DensityRule, Fluid, Heat, PressureRule, Settings, Shifting,
    Solid, SolidsInput, TransportVelocity, TransportVelocityInput,
};
use piola::schemes::{Initial, Scheme};
use piola::time::IntegratorKind;
use piola_formulas::hypoelastic::{EquationOfState, PressureLaw, Strength};
use piola_formulas::kernels::Kernel;

/// What a run is of.
#[derive(Clone, Copy)]
struct Setting {
    name: &'static str,
    corrections: Corrections,
    corrected_gradients: bool,
    yield_stress: Option<f64>,
}

const FULL: Setting = Setting {
    name: "full",
    corrections: Corrections::FULL,
    corrected_gradients: false,
    yield_stress: None,
};

const SETTINGS: [Setting; 4] = [
    FULL,
    Setting { name: "none", corrections: Corrections::NONE, ..FULL },
    Setting { name: "corrected", corrected_gradients: true, ..FULL },
    Setting { name: "plastic", yield_stress: Some(1e3), ..FULL },
];

const DENSITY: f64 = 1000.0;
const WAVE_SPEED: f64 = 60.0;

/// About `count` particles in the unit box.
fn particles<const D: usize>(count: usize) -> Particles<D> {
    let side = (count as f64).powf(1.0 / D as f64).round() as usize;
    let spacing = 1.0 / side as f64;
    let mut particles = Particles::default();
    for number in 0..side.pow(D as u32) {
        particles.position.push(Vector::from_fn(|axis, _| {
            (number / side.pow(axis as u32) % side) as f64 * spacing + 0.5 * spacing
        }));
        particles.volume.push(spacing.powi(D as i32));
        particles.weight.push(spacing.powi(D as i32));
        particles.spacing.push(spacing);
        particles.body.push(0);
        particles.id.push(number as u32);
    }
    particles
}

fn block<const D: usize>(
    particles: Particles<D>,
    setting: &Setting,
    kernel: Kernel,
    h: f64,
) -> TransportVelocity<D> {
    let velocity = particles.position.iter().map(|x| {
        Vector::from_fn(|axis, _| 0.01 * WAVE_SPEED * (6.0 * x[(axis + 1) % D] + axis as f64).sin())
    });
    let material = Solid {
        state: EquationOfState {
            density: DENSITY,
            wave_speed: WAVE_SPEED,
            law: PressureLaw::Linear,
        },
        shear_modulus: 0.2 * DENSITY * WAVE_SPEED * WAVE_SPEED,
        strength: match setting.yield_stress {
            Some(yield_stress) => Strength::Linear { yield_stress, hardening: 0.0 },
            None => Strength::Elastic,
        },
        heat: Heat::NONE,
    };
    TransportVelocity::new(TransportVelocityInput {
        smoothing_length: h * particles.spacing[0],
        faces: vec![Faces::default(); particles.len()],
        domain: Domain::new([None; D]).expect("an open domain"),
        kernel,
        settings: Settings {
            density: DensityRule::Continuity,
            pressure: PressureRule::StateEquation,
            corrections: setting.corrections,
            shifting: Shifting::Sun { factor: 1.0 },
            artificial_viscosity: 1.0,
            free_surface: true,
            at_surface: AtSurface::Along,
            density_drift: f64::INFINITY,
        },
        fluid: Fluid::of_solids(&[material]),
        solids: Some(SolidsInput {
            materials: vec![material],
            contact: Contact::Repulsive,
            corrected: setting.corrected_gradients,
            held: Vec::new(),
        }),
        initial: Initial { velocity: velocity.collect(), pressure: vec![0.0; particles.len()] },
        walls: Vec::new(),
        motion: Vec::new(),
        sliding: Vec::new(),
        body_forces: Vec::new(),
        particles,
    })
    .expect("the block can be built")
}

/// Steps a stretch.
const STEPS: u32 = 30;

fn measure<const D: usize>(count: usize, setting: &Setting, kernel: Kernel, h: f64) {
    let particles = particles::<D>(count);
    let step = 0.25 * h * particles.spacing[0] / (1.2 * WAVE_SPEED);
    let mut scheme = block(particles, setting, kernel, h);
    let mut state = scheme.initial_state();
    let mut new = state.clone();
    let mut integrator = IntegratorKind::KickDriftKick.build(state.len());
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
        name = setting.name,
        millions = speed / 1e6,
        ns = 1e9 / speed,
    );
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let has = |word: &str| arguments.iter().any(|argument| argument == word);
    let given: Vec<usize> = arguments
        .iter()
        .filter_map(|argument| argument.parse::<f64>().ok())
        .map(|size| size as usize)
        .collect();
    let sizes = if given.is_empty() { vec![10_000, 100_000] } else { given };
    println!(
        "| D | threads | particles | neighbours | kernel | setting | M steps/s | ns/particle |"
    );
    println!("|--:|--:|--:|--:|:--|:--|--:|--:|");
    let names = SETTINGS.iter().any(|setting| has(setting.name));
    let threads: &[usize] = if has("serial") { &[1] } else { &[1, 2] };
    for &threads in threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads can be started").install(|| {
            for &size in &sizes {
                for setting in SETTINGS.iter().filter(|setting| !names || has(setting.name)) {
                    if !has("3d") {
                        measure::<2>(size, setting, Kernel::QuinticSpline, 1.0);
                    }
                    if !has("2d") {
                        measure::<3>(size, setting, Kernel::WendlandC2, 1.25);
                    }
                }
            }
        });
    }
}
