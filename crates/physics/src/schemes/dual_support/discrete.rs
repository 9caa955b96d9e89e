//! The discrete energy with its exact derivatives.

use nalgebra::{SMatrix, SVector};
use piola_formulas::Scalar;

use super::Material;
use crate::geometry::Particles;
use crate::operators::{ReferenceGradient, Strained};
use crate::{Tensor, Vector};

/// Particles, gradients with hourglass energy, and materials: all that the energy of a set of displacements
/// depends on. Energies are generic over the number type, so that dual numbers give their derivatives.
#[derive(Clone, Debug)]
pub struct Discrete<const D: usize> {
    pub(super) particles: Particles<D>,
    /// Gradients with the hourglass energy.
    pub operator: ReferenceGradient<D>,
    /// One a body.
    pub(super) materials: Vec<Material<D>>,
}

impl<const D: usize> Discrete<D> {
    /// Number of particles.
    pub fn len(&self) -> usize {
        self.particles.len()
    }

    /// Whether there is no particle.
    pub fn is_empty(&self) -> bool {
        self.particles.is_empty()
    }

    /// Displacement gradient of particle a, theory (44), Dual-support (12) less the identity.
    #[inline]
    pub fn displacement_gradient<T: Scalar>(
        &self,
        displacement: &[SVector<T, D>],
        a: usize,
    ) -> SMatrix<T, D, D> {
        self.operator.gradient_at(displacement, a)
    }

    /// The material of particle a.
    #[inline]
    pub(super) fn material(&self, a: usize) -> &Material<D> {
        &self.materials[self.particles.body[a] as usize]
    }

    /// Mass of particle a in kg (per unit of the missing dimensions).
    #[inline]
    pub(super) fn mass(&self, a: usize) -> f64 {
        self.material(a).density * self.particles.volume[a]
    }

    /// Strain and hourglass energy of particle a in J, theory (47), Dual-support (21) and (38).
    pub fn energy_of<T: Scalar>(&self, displacement: &[SVector<T, D>], a: usize) -> [T; 2] {
        let gradient = self.displacement_gradient(displacement, a);
        let strain = self.material(a).law.energy(&gradient) * self.particles.volume[a];
        [strain, self.operator.hourglass_energy(displacement, &gradient, a)]
    }

    /// Strain and hourglass energy of all particles in J. Added up in their order, on one thread.
    pub fn total_energy<T: Scalar>(&self, displacement: &[SVector<T, D>]) -> [T; 2] {
        (0..self.len()).fold([T::zero(); 2], |[strain, hourglass], a| {
            let [s, h] = self.energy_of(displacement, a);
            [strain + s, hourglass + h]
        })
    }

    /// The pass over supports: gradients, with the stresses of the materials.
    pub(super) fn fill_strains(&self, displacement: &[Vector<D>], strained: &mut Strained<D>) {
        self.operator.strain(displacement, strained, |a, gradient: &Tensor<D>| {
            self.material(a).law.stress(gradient) * self.particles.volume[a]
        });
    }

    /// Internal forces on all particles in N, theory (49), Dual-support (28) with the sign of its (27) turned round.
    pub fn internal_forces(
        &self,
        displacement: &[Vector<D>],
        strained: &mut Strained<D>,
        force: &mut [Vector<D>],
    ) {
        self.fill_strains(displacement, strained);
        self.operator.forces(displacement, &strained.tension, force);
    }
}
