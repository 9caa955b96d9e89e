//! One look over the particles of an elastic solid: are they sound, and how stiff have they become.

use piola_formulas::tensor;

use super::{Health, Particle};
use crate::{Tensor, Vector, parallel};

/// The share of the stable step at which a mode takes three steps a period, `2 sin(pi/3)/2`: there the
/// quadratic part of a law drives the mode by itself, theory (67).
pub(crate) const RESONANCE: f64 = 0.866_025_403_784_438_6;

/// The largest ratio of a step to the one before of an undamped body, whose bound goes up and down
/// with the vibrations of its stiffest particle: steps that go with them drive them.
pub(crate) const MOST_GROWTH: f64 = 1.01;

/// What the look needs to know of a particle.
pub(crate) struct Deformed<const D: usize> {
    /// Displacement gradient.
    pub gradient: Tensor<D>,
    /// Smallest and largest modulus of a wave, Pa.
    pub moduli: [f64; 2],
    /// The same at rest.
    pub at_rest: [f64; 2],
    /// Density in kg/m^3.
    pub density: f64,
}

/// Figures of some particles.
#[derive(Clone, Copy)]
pub(crate) struct Figures {
    pub health: Health,
    /// Largest modulus of a wave over that at rest.
    pub stiffening: f64,
    /// Index in memory of the particle that has it.
    pub stiffest: usize,
    /// Smallest modulus of a wave over that at rest.
    pub convexity: f64,
    /// Index in memory of the particle that has it.
    pub least_convex: usize,
}

impl Figures {
    const NEUTRAL: Self = Self {
        health: Health::NEUTRAL,
        stiffening: 0.0,
        stiffest: 0,
        convexity: f64::INFINITY,
        least_convex: 0,
    };

    fn of<const D: usize>(a: usize, velocity: &Vector<D>, deformed: &Deformed<D>) -> Self {
        let Deformed { gradient, moduli: [least, largest], at_rest, density } = deformed;
        Self {
            health: Health {
                largest_speed: velocity.norm(),
                largest_speed_particle: a,
                largest_wave_speed: (largest.max(0.0) / density).sqrt(),
                smallest_ratio: tensor::determinant(&(gradient + Tensor::identity())),
                smallest_ratio_particle: a,
                ..Health::NEUTRAL
            },
            stiffening: (largest / at_rest[1]).max(0.0),
            stiffest: a,
            convexity: least / at_rest[0],
            least_convex: a,
        }
    }

    fn worse(self, other: Self) -> Self {
        let other_is_less = other.convexity < self.convexity;
        let other_is_stiffer = other.stiffening > self.stiffening;
        Self {
            health: self.health.worse(other.health),
            stiffening: self.stiffening.max(other.stiffening),
            stiffest: if other_is_stiffer { other.stiffest } else { self.stiffest },
            convexity: self.convexity.min(other.convexity),
            least_convex: if other_is_less { other.least_convex } else { self.least_convex },
        }
    }

    /// The particle that has lost its convexity, if there is one.
    pub fn not_convex(&self) -> Option<usize> {
        (self.convexity < 0.0).then_some(self.least_convex)
    }
}

/// The figures of all particles, whose velocities are the first of `columns`, which are all of the state.
pub(crate) fn look<const D: usize>(
    columns: [&[Vector<D>]; 3],
    deformed: impl Fn(usize) -> Deformed<D> + Sync,
) -> Figures {
    let figures = |a: usize| {
        if columns.iter().any(|column| column[a].iter().any(|value| !value.is_finite())) {
            let health = Health { first_not_finite: Some(a), ..Health::NEUTRAL };
            return Figures { health, ..Figures::NEUTRAL };
        }
        Figures::of(a, &columns[0][a], &deformed(a))
    };
    parallel::join(columns[0].len(), Figures::NEUTRAL, figures, Figures::worse)
}

/// What the user should know of a particle of which the material has lost its convexity.
pub(crate) fn convexity_is_lost<const D: usize>(
    particle: &Particle,
    gradient: &Tensor<D>,
    advice: &str,
) -> String {
    let strain = tensor::right_cauchy_green(&(gradient + Tensor::identity()));
    let stretches =
        [tensor::smallest_eigenvalue(&strain), tensor::largest_eigenvalue(&strain)].map(f64::sqrt);
    format!(
        "the material of particle {} at {:?} m has lost its convexity, at principal stretches from \
         {:.3} to {:.3}: no waves travel there, strains gather in single layers of particles, and what \
         follows depends on the lattice; {advice}",
        particle.id, particle.reference, stretches[0], stretches[1]
    )
}
