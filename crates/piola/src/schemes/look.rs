//! One look over a state: is it sound, how fast is it, and what is largest of that which bounds the step.

use piola_formulas::tensor;

use super::{Health, Particle};
use crate::{Tensor, Vector, parallel};

/// The share of the stable step at which a mode takes three steps a period, `2 sin(pi/3)/2`: there the
/// quadratic part of a law drives the mode by itself, theory (67).
pub(crate) const RESONANCE: f64 = 0.866_025_403_784_438_6;

/// The largest ratio of a step to the one before of an undamped body, whose bound goes up and down
/// with the vibrations of its stiffest particle: steps that go with them drive them.
pub(crate) const MOST_GROWTH: f64 = 1.01;

/// What one particle contributes.
pub(crate) struct Seen<const D: usize, const N: usize> {
    pub velocity: Vector<D>,
    /// Largest speed of a wave in m/s.
    pub wave_speed: f64,
    /// Smallest volume ratio.
    pub ratio: f64,
    /// Difference of an evolved volume ratio and the determinant.
    pub mismatch: f64,
    /// Figures of the formulation, of which the largest count.
    pub figures: [f64; N],
}

/// The largest of a figure over particles, and who has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Most {
    pub value: f64,
    /// Index in memory; the first of those that have it.
    pub particle: usize,
}

impl Most {
    /// Nothing that is seen is less.
    pub const fn at_least(value: f64) -> Self {
        Self { value, particle: 0 }
    }

    /// The larger of the two; what is not a number is not seen.
    pub fn or(self, other: Self) -> Self {
        if other.value > self.value { other } else { self }
    }
}

/// What has been seen of some particles: squared speed, wave speed, the negative volume ratio and the
/// mismatch, and the figures of the formulation.
#[derive(Clone, Copy)]
struct Sight<const N: usize> {
    first_not_finite: Option<usize>,
    common: [Most; 4],
    own: [Most; N],
}

impl<const N: usize> Sight<N> {
    fn worse(self, other: Self) -> Self {
        Self {
            first_not_finite: self.first_not_finite.or(other.first_not_finite),
            common: std::array::from_fn(|k| self.common[k].or(other.common[k])),
            own: std::array::from_fn(|k| self.own[k].or(other.own[k])),
        }
    }
}

/// The health of `count` particles, and the largest of their figures, which are no less than `least`.
/// `see` has what a particle contributes; nothing if a value is not finite.
pub(crate) fn look<const D: usize, const N: usize>(
    count: usize,
    least: [f64; N],
    see: impl Fn(usize) -> Option<Seen<D, N>> + Sync,
) -> (Health, [Most; N]) {
    let common = [0.0, 0.0, f64::NEG_INFINITY, 0.0].map(Most::at_least);
    let neutral = Sight { first_not_finite: None, common, own: least.map(Most::at_least) };
    let of = |particle: usize| {
        let Some(seen) = see(particle) else {
            return Sight { first_not_finite: Some(particle), ..neutral };
        };
        let Seen { velocity, wave_speed, ratio, mismatch, figures } = seen;
        let common = [velocity.norm_squared(), wave_speed, -ratio, mismatch];
        let most = |value| Most { value, particle };
        Sight { first_not_finite: None, common: common.map(most), own: figures.map(most) }
    };
    let worst = parallel::join(count, neutral, of, Sight::worse);
    let [speed, wave_speed, ratio, mismatch] = worst.common;
    let health = Health {
        largest_speed: speed.value.sqrt(),
        largest_speed_particle: speed.particle,
        largest_wave_speed: wave_speed.value,
        smallest_ratio: -ratio.value,
        smallest_ratio_particle: ratio.particle,
        ratio_mismatch: mismatch.value,
        first_not_finite: worst.first_not_finite,
        first_escaped: None,
    };
    (health, worst.own)
}

/// What the look needs to know of a particle of an elastic solid.
pub(crate) struct Deformed<const D: usize> {
    /// Displacement gradient.
    pub gradient: Tensor<D>,
    /// Smallest and largest modulus of a wave, Pa.
    pub moduli: [f64; 2],
    /// The same at rest.
    pub at_rest: [f64; 2],
    /// Density in kg/m^3.
    pub density: f64,
    /// By how much viscosity exceeds that at rest.
    pub thickening: f64,
}

/// The health of an elastic solid, whose velocities are the first of `columns`, which are all of the
/// state; the largest modulus of a wave over that at rest, and the largest thickening; and the particle
/// whose material has lost its convexity most, if there is one.
pub(crate) fn look_at_solid<const D: usize>(
    columns: [&[Vector<D>]; 3],
    deformed: impl Fn(usize) -> Deformed<D> + Sync,
) -> (Health, [Most; 2], Option<usize>) {
    let least = [0.0, 0.0, f64::NEG_INFINITY];
    let (health, [stiffening, thickening, softening]) = look(columns[0].len(), least, |a| {
        let is_finite = |column: &&[Vector<D>]| column[a].iter().all(|value| value.is_finite());
        columns.iter().all(is_finite).then(|| {
            let Deformed { gradient, moduli, at_rest, density, thickening } = deformed(a);
            Seen {
                velocity: columns[0][a],
                wave_speed: (moduli[1].max(0.0) / density).sqrt(),
                ratio: tensor::determinant(&(gradient + Tensor::identity())),
                mismatch: 0.0,
                figures: [moduli[1] / at_rest[1], thickening, -moduli[0] / at_rest[0]],
            }
        })
    });
    let soft = (softening.value > 0.0).then_some(softening.particle);
    (health, [stiffening, thickening], soft)
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
