//! Clouds of particles to measure with.

use std::sync::Arc;

use piola::Vector;
use piola::boundaries::SpaceTime;
use piola::geometry::Particles;
use piola::neighbors::Domain;
use piola::operators::{Correction, Support};
use piola::schemes::Scheme;
use piola::schemes::upwind::{
    BodyForce, Initial, Material, Settings, Upwind, UpwindInput, WaveSpeed,
};
use piola_formulas::kernels::Kernel;
use piola_formulas::volumetric::VolumetricLaw;

/// What is switched on in the formulation.
#[derive(Clone, Copy)]
pub struct Switches {
    pub name: &'static str,
    velocity: bool,
    pressure: bool,
    reconstruction: bool,
    wave_speed: WaveSpeed,
    periodic: bool,
}

impl Switches {
    /// No dissipation, in a cloud with a boundary.
    const NONE: Self = Self {
        name: "none",
        velocity: false,
        pressure: false,
        reconstruction: false,
        wave_speed: WaveSpeed::Constant,
        periodic: false,
    };
    const BOTH: Self = Self { name: "v, p", velocity: true, pressure: true, ..Self::NONE };
    const RECONSTRUCTED: Self = Self { name: "v, p, rec.", reconstruction: true, ..Self::BOTH };

    /// Those measured at every size.
    pub const MAIN: [Self; 4] = [
        Self::NONE,
        Self { name: "v", velocity: true, ..Self::NONE },
        Self::BOTH,
        Self::RECONSTRUCTED,
    ];

    /// Those measured at the first size, too.
    pub const OTHERS: [Self; 5] = [
        Self { name: "p", pressure: true, ..Self::NONE },
        Self { name: "v, rec.", pressure: false, ..Self::RECONSTRUCTED },
        Self { name: "p, rec.", velocity: false, ..Self::RECONSTRUCTED },
        Self { name: "v, p, stretch", wave_speed: WaveSpeed::Stretch, ..Self::BOTH },
        Self { name: "v, p, periodic", periodic: true, ..Self::BOTH },
    ];
}

/// Smoothing length over spacing: inside a cloud about 29 neighbours in 2D and 70 in 3D, less at its
/// boundary.
const fn smoothing_ratio(dimension: usize) -> f64 {
    if dimension == 2 { 1.54 } else { 1.25 }
}

/// A lattice of about `size` particles in a unit box, each moved at random by up to a tenth of the
/// spacing in every direction, in rows along x.
fn cloud<const D: usize>(size: usize) -> Particles<D> {
    let side = (size as f64).powf(1.0 / D as f64).round() as usize;
    let spacing = 1.0 / side as f64;
    let place = |number: usize| {
        Vector::from_fn(|axis, _| {
            let index = number / side.pow(axis as u32) % side;
            spacing * (index as f64 + 0.5 + 0.1 * noise(D * number + axis))
        })
    };
    let count = side.pow(D as u32);
    let cell = spacing.powi(D as i32);
    Particles {
        position: (0..count).map(place).collect(),
        volume: vec![cell; count],
        weight: vec![cell; count],
        spacing: vec![spacing; count],
        body: vec![0; count],
        id: (0..count as u32).collect(),
        ..Particles::default()
    }
}

/// The formulation on a cloud of about `size` particles, and the mean number of neighbours.
pub fn build<const D: usize>(size: usize, switches: Switches) -> (Upwind<D>, f64) {
    let particles = cloud::<D>(size);
    let domain = match switches.periodic {
        true => Domain::new([Some([0.0, 1.0]); D]).expect("the unit box is sound"),
        false => Domain::open(),
    };
    let support = Support::new(&particles, Kernel::CubicSpline, smoothing_ratio(D), domain)
        .expect("the cloud has a support");
    let neighbors = support.list.statistics().mean;
    let initial = Initial {
        velocity: vec![Vector::zeros(); particles.len()],
        pressure: vec![0.0; particles.len()],
    };
    let law = VolumetricLaw::gamma_law_from_wave_speed(10.0, 1000.0, 7.0);
    let gravity: [Arc<dyn SpaceTime>; D] = std::array::from_fn(|_| Arc::new(-9.81) as _);
    let scheme = Upwind::new(UpwindInput {
        particles,
        support,
        settings: Settings {
            correction: Correction::Gradient,
            tau_velocity: if switches.velocity { 0.5 } else { 0.0 },
            tau_pressure: if switches.pressure { 0.5 } else { 0.0 },
            reconstruction: switches.reconstruction,
            wave_speed: switches.wave_speed,
        },
        materials: vec![Material { density: 1000.0, law: law.expect("the law is sound") }],
        initial,
        body_forces: vec![BodyForce { body: None, acceleration: gravity }],
        tractions: Vec::new(),
        prescribed: Vec::new(),
        implicit: None,
    });
    (scheme.expect("the scheme can be built"), neighbors)
}

/// The initial state with every unknown disturbed by up to a thousandth of the size of its field.
pub fn disturbed<const D: usize>(scheme: &Upwind<D>) -> Vec<f64> {
    let mut state = scheme.initial_state();
    let rows = scheme.particle_count() * scheme.width();
    for (index, value) in state[..rows].iter_mut().enumerate() {
        *value += 1e-3 * noise(index);
    }
    state
}

/// A number in (-1, 1) for each index.
fn noise(index: usize) -> f64 {
    let mut x = (index as u64).wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((x ^ (x >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}
