//! Particle steps a second of the transport-velocity formulation:
//! `cargo bench -p piola --bench fluids`.
//!
//! Taylor-Green vortices in periodic boxes with all corrections and SPST, one step at a time, best
//! of several stretches of thirty steps with the lists that they renew. Arguments that are numbers
//! replace the sizes; `2d` and `3d` leave the other dimension out, `serial` the run on two threads,
//! and the names of corrections those not named.

#[allow(dead_code, reason = "shared with another bench, which uses more of it")]
#[path = "upwind/clock.rs"]
mod clock;

#[path = "shared/steps.rs"]
mod steps;

use std::f64::consts::PI;

use piola::Vector;
use piola::geometry::{Faces, Particles};
use piola::neighbors::Domain;
use piola::schemes::Initial;
use piola::schemes::transport_velocity::{
    Corrections, Fluid, Settings, TransportVelocity, TransportVelocityInput,
};
use piola_formulas::kernels::Kernel;

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
    let input = TransportVelocityInput {
        smoothing_length: h * particles.spacing[0],
        faces: vec![Faces::default(); particles.len()],
        domain: Domain::new([Some([0.0, 1.0]); D]).expect("the bounds are in order"),
        kernel,
        settings: Settings { corrections, ..Settings::FLUID },
        initial: Initial { velocity: velocity.collect(), pressure: vec![0.0; particles.len()] },
        walls: Vec::new(),
        motion: Vec::new(),
        sliding: Vec::new(),
        body_forces: Vec::new(),
        open: Default::default(),
        damping: None,
        particles,
    };
    let fluid = Fluid { density: 1.0, wave_speed: 10.0, viscosity: 0.01 };
    TransportVelocity::new(input, fluid).expect("the fluid can be built")
}

fn measure<const D: usize>(count: usize, name: &str, kernel: Kernel, h: f64) {
    let corrections = Corrections::from_name(name).expect("a name from the list");
    let scheme = vortices(steps::lattice::<D>(count, 0.1), corrections, kernel, h);
    let step = 0.25 * h / (count as f64).powf(1.0 / D as f64) / 11.0;
    steps::measure(scheme, step, kernel, name);
}

fn main() {
    let arguments = steps::Arguments::new();
    let sizes = arguments.sizes(&[10_000, 100_000, 1_000_000]);
    arguments.for_each(&sizes, &["full", "none"], |dimension, size, name| match dimension {
        2 => measure::<2>(size, name, Kernel::QuinticSpline, 1.0),
        _ => measure::<3>(size, name, Kernel::WendlandC2, 1.25),
    });
}
