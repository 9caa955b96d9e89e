//! A solid at rest: its particles and what they are made of.

use std::ops::Range;

use super::material::{Material, Mixture};
use crate::Tensor;
use crate::geometry::Particles;
use crate::schemes::InputError;
use crate::schemes::input::{check_index, check_lengths, check_materials, check_particles};

/// The particles of a solid in its reference configuration, with their materials and masses.
#[derive(Clone, Debug)]
pub struct Solid<const D: usize> {
    /// The particles.
    pub particles: Particles<D>,
    /// What particles are made of.
    pub mixtures: Vec<Mixture<D>>,
    /// Which mixture each particle is made of.
    pub mixture: Vec<u32>,
    /// Mass of each particle in kg (per unit of the missing dimensions).
    pub mass: Vec<f64>,
    /// Moduli of the slowest and the fastest wave at rest of each mixture, Pa.
    pub(super) moduli_at_rest: Vec<[f64; 2]>,
}

impl<const D: usize> Solid<D> {
    /// Particles with a mixture each.
    ///
    /// # Errors
    /// [`InputError`] for arrays that do not fit together.
    pub fn new(
        particles: Particles<D>,
        mixtures: Vec<Mixture<D>>,
        mixture: Vec<u32>,
    ) -> Result<Self, InputError> {
        check_particles(&particles)?;
        check_lengths(particles.len(), &[("the list of mixtures", mixture.len())])?;
        let known =
            |&number: &u32| check_index(|| "the mixture".into(), number as usize, mixtures.len());
        mixture.iter().try_for_each(known)?;
        let mass = mixture.iter().zip(&particles.volume);
        let mass = mass.map(|(&number, volume)| mixtures[number as usize].density() * volume);
        let at_rest = |mixture: &Mixture<D>| mixture.wave_moduli(&Tensor::zeros());
        let moduli_at_rest = mixtures.iter().map(at_rest).collect();
        Ok(Self { mass: mass.collect(), particles, mixtures, mixture, moduli_at_rest })
    }

    /// Particles of bodies of one material each.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn of_bodies(
        particles: Particles<D>,
        materials: &[Material<D>],
    ) -> Result<Self, InputError> {
        check_materials(&particles, materials.len())?;
        let mixtures = Mixture::of_each(materials);
        let mixture = particles.body.clone();
        Self::new(particles, mixtures, mixture)
    }

    /// The particles that follow each other in memory.
    pub fn part(&self, own: Range<usize>) -> Self {
        Self {
            particles: self.particles.part(own.clone()),
            mixtures: self.mixtures.clone(),
            mixture: self.mixture[own.clone()].to_vec(),
            mass: self.mass[own].to_vec(),
            moduli_at_rest: self.moduli_at_rest.clone(),
        }
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.particles.len()
    }

    /// Whether there is no particle.
    pub fn is_empty(&self) -> bool {
        self.particles.is_empty()
    }

    /// What particle a is made of.
    #[inline]
    pub fn mixture(&self, a: usize) -> &Mixture<D> {
        &self.mixtures[self.mixture[a] as usize]
    }

    /// Those of some particles that follow each other and are made of one mixture, with it.
    pub(super) fn runs(
        &self,
        own: Range<usize>,
    ) -> impl Iterator<Item = (&Mixture<D>, Range<usize>)> {
        let runs = self.mixture[own.clone()].chunk_by(|one, other| one == other);
        runs.scan(own.start, |end, run| {
            let begin = std::mem::replace(end, *end + run.len());
            Some((&self.mixtures[run[0] as usize], begin..*end))
        })
    }

    /// Writes the stresses in Pa of particles from `first` on at their displacement gradients.
    pub fn stresses(&self, first: usize, gradients: &[Tensor<D>], stresses: &mut [Tensor<D>]) {
        for (mixture, own) in self.runs(first..first + gradients.len()) {
            let own = own.start - first..own.end - first;
            mixture.stresses(&gradients[own.clone()], &mut stresses[own]);
        }
    }

    /// Whether the material of every particle is one of small strains.
    pub fn is_linear(&self) -> bool {
        self.mixtures.iter().all(Mixture::is_linear)
    }

    /// Moduli of the slowest and the fastest wave at rest at particle a, Pa.
    #[inline]
    pub(super) fn moduli_at_rest(&self, a: usize) -> [f64; 2] {
        self.moduli_at_rest[self.mixture[a] as usize]
    }

    /// Bytes of all arrays.
    pub fn memory(&self) -> usize {
        self.particles.memory()
            + size_of_val(self.mixture.as_slice())
            + size_of_val(self.mass.as_slice())
    }
}
