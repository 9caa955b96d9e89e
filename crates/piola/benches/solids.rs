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

#[path = "shared/steps.rs"]
mod steps;

use piola::Vector;
use piola::geometry::{Faces, Particles};
use piola::neighbors::Domain;
use piola::schemes::Initial;
use piola::schemes::transport_velocity::{
    AtSurface, Contact, Corrections, Heat, Hypoelastic, PressureRule, Settings, Solid, SolidsInput,
    TransportVelocity, TransportVelocityInput,
};
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

fn block<const D: usize>(
    particles: Particles<D>,
    setting: &Setting,
    kernel: Kernel,
    h: f64,
) -> TransportVelocity<D, Hypoelastic<D>> {
    let velocity = particles.position.iter().map(|x| {
        Vector::from_fn(|axis, _| 0.01 * WAVE_SPEED * (6.0 * x[(axis + 1) % D] + axis as f64).sin())
    });
    let material = Solid {
        state: EquationOfState {
            density: DENSITY,
            wave_speed: WAVE_SPEED,
            law: PressureLaw::Linear,
            spall_strength: f64::INFINITY,
        },
        shear_modulus: 0.2 * DENSITY * WAVE_SPEED * WAVE_SPEED,
        strength: match setting.yield_stress {
            Some(yield_stress) => Strength::Linear { yield_stress, hardening: 0.0 },
            None => Strength::Elastic,
        },
        heat: Heat::NONE,
    };
    let input = TransportVelocityInput {
        smoothing_length: h * particles.spacing[0],
        faces: vec![Faces::default(); particles.len()],
        domain: Domain::new([None; D]).expect("an open domain"),
        kernel,
        settings: Settings {
            pressure: PressureRule::StateEquation,
            corrections: setting.corrections,
            artificial_viscosity: 1.0,
            free_surface: true,
            at_surface: AtSurface::Along,
            ..Settings::FLUID
        },
        initial: Initial { velocity: velocity.collect(), pressure: vec![0.0; particles.len()] },
        walls: Vec::new(),
        motion: Vec::new(),
        sliding: Vec::new(),
        body_forces: Vec::new(),
        open: Default::default(),
        damping: None,
        particles,
    };
    let solids = SolidsInput {
        materials: vec![material],
        contact: Contact::Repulsive,
        self_contact: None,
        corrected: setting.corrected_gradients,
        held: Vec::new(),
    };
    TransportVelocity::new(input, solids).expect("the block can be built")
}

fn measure<const D: usize>(count: usize, setting: &Setting, kernel: Kernel, h: f64) {
    let particles = steps::lattice::<D>(count, 0.0);
    let step = 0.25 * h * particles.spacing[0] / (1.2 * WAVE_SPEED);
    steps::measure(block(particles, setting, kernel, h), step, kernel, setting.name);
}

fn main() {
    let arguments = steps::Arguments::new();
    let sizes = arguments.sizes(&[10_000, 100_000]);
    arguments.for_each(&sizes, &SETTINGS.map(|setting| setting.name), |dimension, size, name| {
        for setting in SETTINGS.iter().filter(|setting| setting.name == name) {
            match dimension {
                2 => measure::<2>(size, setting, Kernel::QuinticSpline, 1.0),
                _ => measure::<3>(size, setting, Kernel::WendlandC2, 1.25),
            }
        }
    });
}
