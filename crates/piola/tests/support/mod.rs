//! Particles and schemes that several tests build.
#![allow(dead_code, reason = "each test binary uses a part of it")]

use std::sync::Arc;

use piola::Vector;
use piola::boundaries::{PrescribedVelocity, SpaceTime};
use piola::geometry::Particles;
use piola::neighbors::Domain;
use piola::operators::{Correction, Support};
use piola::schemes::upwind::{
    BodyForce, Initial, Material, Settings, Upwind, UpwindInput, WaveSpeed,
};
use piola_formulas::kernels::Kernel;
use piola_formulas::volumetric::VolumetricLaw;

/// A box lattice with particles on its faces: whole cells as weights, and half a cell in volume
/// for each face a particle lies on.
pub fn lattice<const D: usize>(lengths: [f64; D], intervals: [usize; D]) -> Particles<D> {
    let mut particles = Particles::default();
    let count: usize = intervals.iter().map(|n| n + 1).product();
    for number in 0..count {
        let (mut rest, mut position, mut volume, mut weight) = (number, Vector::zeros(), 1.0, 1.0);
        for axis in 0..D {
            let (index, n) = (rest % (intervals[axis] + 1), intervals[axis]);
            rest /= n + 1;
            let cell = lengths[axis] / n as f64;
            position[axis] = lengths[axis] * index as f64 / n as f64;
            weight *= cell;
            volume *= if index == 0 || index == n { 0.5 * cell } else { cell };
        }
        particles.position.push(position);
        particles.volume.push(volume);
        particles.weight.push(weight);
        let largest = (0..D).map(|k| lengths[k] / intervals[k] as f64).fold(0.0, f64::max);
        particles.spacing.push(largest);
        particles.body.push(0);
        particles.id.push(number as u32);
    }
    particles
}

/// Settings without stabilisation.
pub const PLAIN: Settings = Settings {
    correction: Correction::Gradient,
    tau_velocity: 0.0,
    tau_pressure: 0.0,
    reconstruction: false,
    wave_speed: WaveSpeed::Constant,
};

/// What a test chooses of a scheme.
pub struct Choice<const D: usize> {
    pub particles: Particles<D>,
    pub smoothing_ratio: f64,
    pub settings: Settings,
    pub law: VolumetricLaw,
    pub density: f64,
    pub gravity: Vector<D>,
    pub prescribed: Vec<PrescribedVelocity>,
    pub domain: Domain<D>,
}

impl<const D: usize> Choice<D> {
    pub fn new(particles: Particles<D>, law: VolumetricLaw) -> Self {
        Self {
            particles,
            smoothing_ratio: 0.7,
            settings: PLAIN,
            law,
            density: 1000.0,
            gravity: Vector::zeros(),
            prescribed: Vec::new(),
            domain: Domain::open(),
        }
    }

    /// Prescribes a zero velocity component of all particles that `on` selects.
    pub fn fix(mut self, component: usize, on: impl Fn(&Vector<D>) -> bool) -> Self {
        let positions = self.particles.position.iter().enumerate();
        let particles = positions.filter(|(_, x)| on(x)).map(|(a, _)| a as u32).collect();
        let value: Arc<dyn SpaceTime> = Arc::new(0.0);
        let name = format!("fixed {component}");
        self.prescribed.push(PrescribedVelocity { name, particles, component, value });
        self
    }

    pub fn build(self, velocity: impl Fn(&Vector<D>) -> Vector<D>) -> Upwind<D> {
        self.build_stressed(velocity, |_| 0.0)
    }

    pub fn build_stressed(
        self,
        velocity: impl Fn(&Vector<D>) -> Vector<D>,
        pressure: impl Fn(&Vector<D>) -> f64,
    ) -> Upwind<D> {
        let positions = &self.particles.position;
        let initial = Initial {
            velocity: positions.iter().map(velocity).collect(),
            pressure: positions.iter().map(pressure).collect(),
        };
        let support =
            Support::new(&self.particles, Kernel::CubicSpline, self.smoothing_ratio, self.domain)
                .expect("the support of a lattice exists");
        let gravity = self.gravity;
        Upwind::new(UpwindInput {
            particles: self.particles,
            support,
            settings: self.settings,
            materials: vec![Material { density: self.density, law: self.law }],
            initial,
            body_forces: vec![BodyForce {
                body: None,
                acceleration: std::array::from_fn(|k| Arc::new(gravity[k]) as Arc<dyn SpaceTime>),
            }],
            tractions: Vec::new(),
            prescribed: self.prescribed,
        })
        .expect("the scheme can be built")
    }
}

/// A seeded number in (-1, 1) for each index: a hash, so that tests need no generator.
pub fn noise(index: usize) -> f64 {
    let mut x = (index as u64).wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((x ^ (x >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// A state with every unknown of every particle disturbed by up to `size`.
pub fn disturbed<S: piola::schemes::Scheme>(scheme: &S, size: f64) -> Vec<f64> {
    let mut state = scheme.initial_state();
    let rows = scheme.particle_count() * scheme.row_length();
    for (index, value) in state[..rows].iter_mut().enumerate() {
        *value += size * noise(index);
    }
    state
}

/// A box lattice whose particles are displaced by up to `jitter` spacings along each axis.
pub fn jittered<const D: usize>(
    lengths: [f64; D],
    intervals: [usize; D],
    jitter: f64,
) -> Particles<D> {
    let mut particles = lattice(lengths, intervals);
    for (a, position) in particles.position.iter_mut().enumerate() {
        for axis in 0..D {
            let spacing = lengths[axis] / intervals[axis] as f64;
            position[axis] += jitter * spacing * noise(a * D + axis);
        }
    }
    particles
}
