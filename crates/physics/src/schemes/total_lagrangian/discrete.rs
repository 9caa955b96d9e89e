//! The discrete energy with its exact derivatives.

use std::sync::Arc;

use nalgebra::{SMatrix, SVector};
use piola_formulas::Scalar;

use super::check::check_coefficient;
use super::{Gradients, Material, Mixture, Settings, Solid, TotalLagrangianError};
use crate::geometry::Particles;
use crate::operators::{
    Cover, DirectedSupport, DualGradient, Image, Mirror, PlaneData, ReferenceGradient, Strained,
};
use crate::parallel::Team;
use crate::schemes::input::check_lengths;
use crate::{Tensor, Vector};

/// A solid with gradients and their hourglass energy: all that the energy of a set of displacements
/// depends on. Energies are generic over the number type, so that dual numbers give their derivatives.
#[derive(Clone, Debug)]
pub struct Discrete<const D: usize> {
    /// Particles and materials.
    pub solid: Arc<Solid<D>>,
    /// Gradients with the hourglass energy.
    pub operator: Arc<ReferenceGradient<D>>,
    /// Planes beyond which the body has images, each with a particle that lies on it.
    pub(super) planes: Vec<(Mirror, usize)>,
}

impl<const D: usize> Discrete<D> {
    /// Builds coefficients for particles on their supports, of bodies of one material each.
    ///
    /// # Errors
    /// [`TotalLagrangianError`] for arrays that do not fit together, particles without a gradient, and
    /// areas that do not fit.
    pub fn new(
        particles: Particles<D>,
        support: DirectedSupport<D>,
        settings: &Settings<D>,
        materials: Vec<Material<D>>,
    ) -> Result<Self, TotalLagrangianError> {
        let solid = Arc::new(Solid::of_bodies(particles, &materials)?);
        Self::on(solid, (&[], Vec::new()), &support, settings)
    }

    /// Builds coefficients for a solid on the supports of its particles, among which are images beyond
    /// planes.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub(super) fn on(
        solid: Arc<Solid<D>>,
        (images, planes): (&[Image<D>], Vec<(Mirror, usize)>),
        support: &DirectedSupport<D>,
        settings: &Settings<D>,
    ) -> Result<Self, TotalLagrangianError> {
        let (particles, count) = (&solid.particles, solid.len());
        check_coefficient("the hourglass coefficient", settings.hourglass)?;
        let slots = count + images.len();
        check_lengths(slots, &[("the neighbour list", support.list.len())])?;
        let DirectedSupport { kernel, ref radius, domain, .. } = *support;
        let cover = Cover { particles, group: &[], images, kernel, radius, domain };
        let mut gradient = DualGradient::of(&cover, support)?;
        if let Gradients::PatchConsistent { areas } = &settings.gradients {
            check_lengths(count, &[("the list of boundary areas", areas.len())])?;
            gradient = gradient.patch_consistent(particles, support, areas)?;
        }
        let shears: Vec<f64> = solid.mixtures.iter().map(Mixture::shear_modulus).collect();
        let hourglass = |a: usize| {
            let shear = shears[solid.mixture[a] as usize];
            settings.hourglass * shear * particles.volume[a]
        };
        let hourglass = (0..count).map(hourglass).collect();
        let operator = ReferenceGradient::new((particles, images), support, &gradient, hourglass);
        Ok(Self { solid, operator: Arc::new(operator), planes })
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.solid.len()
    }

    /// Whether there is no particle.
    pub fn is_empty(&self) -> bool {
        self.solid.is_empty()
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

    /// Strain and hourglass energy of particle a in J, theory (47), Dual-support (21) and (38).
    pub fn energy_of<T: Scalar>(&self, displacement: &[SVector<T, D>], a: usize) -> [T; 2] {
        let gradient = self.displacement_gradient(displacement, a);
        let strain = self.solid.mixture(a).energy(&gradient) * self.solid.particles.volume[a];
        [strain, self.operator.hourglass_energy(displacement, &gradient, a)]
    }

    /// Strain and hourglass energy of all particles in J. Added up in their order, on one thread.
    pub fn total_energy<T: Scalar>(&self, displacement: &[SVector<T, D>]) -> [T; 2] {
        (0..self.len()).fold([T::zero(); 2], |[strain, hourglass], a| {
            let [s, h] = self.energy_of(displacement, a);
            [strain + s, hourglass + h]
        })
    }

    /// The components across planes of a field on them.
    pub(super) fn plane_data(&self, field: &[Vector<D>]) -> PlaneData<D> {
        let mut data = [[0.0; 2]; D];
        for (mirror, particle) in &self.planes {
            data[mirror.axis][usize::from(mirror.is_upper)] = field[*particle][mirror.axis];
        }
        data
    }

    /// Writes the values of images behind those of particles.
    pub(super) fn continue_field(&self, field: &mut [Vector<D>]) {
        let data = self.plane_data(field);
        self.operator.continue_field(&data, field);
    }

    /// Writes the values of images behind those of particles, and behind both the copies of a team.
    pub(super) fn continue_on(&self, team: &Team, has_images: bool, field: &mut [Vector<D>]) {
        // Planes know their data by a particle, which another rank may have.
        if has_images {
            team.refresh(field, self.operator.owned(), 1);
            self.continue_field(field);
        }
        team.refresh(field, self.operator.owned(), 1);
    }

    /// What acts on images, as forces on the particles that they mirror and on the planes.
    pub(super) fn fold(&self, force: &mut [Vector<D>]) {
        for (mirror, particle) in &self.planes {
            force[*particle][mirror.axis] += self.plane_force(mirror, force);
        }
        self.operator.fold(force);
    }

    /// The force on a plane, across it, of what acts on images beyond it, N.
    pub(super) fn plane_force(&self, mirror: &Mirror, force: &[Vector<D>]) -> f64 {
        let mut along = [[0.0; 2]; D];
        along[mirror.axis][usize::from(mirror.is_upper)] = 1.0;
        -self.operator.plane_power(&Team::default(), force, &along)
    }

    /// Writes stress times volume in J of particles from `first` on at their displacement gradients.
    pub(super) fn tensions(
        &self,
        first: usize,
        gradients: &[Tensor<D>],
        tensions: &mut [Tensor<D>],
    ) {
        self.solid.stresses(first, gradients, tensions);
        let volumes = &self.solid.particles.volume[first..];
        tensions.iter_mut().zip(volumes).for_each(|(tension, volume)| *tension *= *volume);
    }

    /// Internal forces on all particles in N, theory (49), Dual-support (28) with the sign of its (27) turned
    /// round. Where there are images their displacements stand behind those of particles, and `force` has
    /// a place for each of them too.
    pub fn internal_forces(
        &self,
        displacement: &[Vector<D>],
        strained: &mut Strained<D>,
        force: &mut [Vector<D>],
    ) {
        let tensions = |first: usize, gradients: &[_], tensions: &mut [_]| {
            self.tensions(first, gradients, tensions);
        };
        self.operator.strain(displacement, strained, tensions);
        self.operator.forces(displacement, &strained.tension, force);
        self.fold(force);
    }
}
