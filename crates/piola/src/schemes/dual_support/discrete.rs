//! The discrete energy with its exact derivatives.

use nalgebra::{SMatrix, SVector};
use num_dual::Dual64;
use piola_formulas::Scalar;

use super::Material;
use crate::geometry::Particles;
use crate::operators::{DirectedSupport, DualGradient, dual_row};
use crate::{Vector, parallel};

/// Particles, supports, coefficients and materials: all that the energy of a set of displacements
/// depends on. Its bodies are generic over the number type, so that dual numbers give derivatives
/// of energies and forces through them.
#[derive(Clone, Debug)]
pub struct Discrete<const D: usize> {
    pub(super) particles: Particles<D>,
    pub(super) support: DirectedSupport<D>,
    pub(super) gradient: DualGradient<D>,
    /// One a body.
    pub(super) materials: Vec<Material<D>>,
    /// `c_ab = hourglass_a s_ab/tr L_a` with this one a particle, J.
    pub(super) hourglass: Vec<f64>,
}

/// What a particle's support says of it.
#[derive(Clone, Copy, Debug)]
pub struct Side<T, const D: usize> {
    /// Displacement gradient A = F - I.
    pub gradient: SMatrix<T, D, D>,
    /// Derivative of the particle's energy with respect to A, J: theory (48).
    pub tension: SMatrix<T, D, D>,
    /// Force on the particle from its own support in N.
    pub pull: SVector<T, D>,
}

impl<T: Scalar, const D: usize> Side<T, D> {
    pub(super) fn zero() -> Self {
        let (gradient, pull) = (SMatrix::zeros(), SVector::zeros());
        Self { gradient, tension: gradient, pull }
    }
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

    /// Displacement gradient of particle a, theory (44), Dual-support (12) less the identity.
    #[inline]
    pub fn displacement_gradient<T: Scalar>(
        &self,
        displacement: &[SVector<T, D>],
        a: usize,
    ) -> SMatrix<T, D, D> {
        let mut gradient = SMatrix::zeros();
        let list = &self.support.list;
        for (&b, g) in list.row(a).iter().zip(self.gradient.coefficients(list.range(a))) {
            add_product(&mut gradient, &(displacement[b as usize] - displacement[a]), g);
        }
        gradient
    }

    /// Strain and hourglass energy of particle a in J, theory (47), Dual-support (21) and (38).
    pub fn energy_of<T: Scalar>(&self, displacement: &[SVector<T, D>], a: usize) -> [T; 2] {
        let gradient = self.displacement_gradient(displacement, a);
        let strain = self.material(a).law.energy(&gradient) * self.particles.volume[a];
        let mut hourglass = T::zero();
        let list = &self.support.list;
        let row = list.row(a).iter().zip(self.gradient.weights(list.range(a)));
        for (&b, weight) in row {
            let deviation = self.deviation(displacement, &gradient, a, b);
            let square = deviation.iter().fold(T::zero(), |sum, &entry| sum + entry * entry);
            hourglass += square * *weight;
        }
        [strain, hourglass * self.hourglass[a]]
    }

    /// Strain and hourglass energy of all particles in J. Added up in their order, on one thread.
    pub fn total_energy<T: Scalar>(&self, displacement: &[SVector<T, D>]) -> [T; 2] {
        (0..self.len()).fold([T::zero(); 2], |[strain, hourglass], a| {
            let [s, h] = self.energy_of(displacement, a);
            [strain + s, hourglass + h]
        })
    }

    /// `A_a X_ab - u_ab`: how far b is from where a linear field around a would have it.
    #[inline]
    fn deviation<T: Scalar>(
        &self,
        displacement: &[SVector<T, D>],
        gradient: &SMatrix<T, D, D>,
        a: usize,
        b: u32,
    ) -> SVector<T, D> {
        let separation = self.support.separation(&self.particles.position, a, b);
        let mut deviation = displacement[a] - displacement[b as usize];
        for i in 0..D {
            for j in 0..D {
                deviation[i] += gradient[(i, j)] * separation[j];
            }
        }
        deviation
    }

    /// The pass over supports: gradient, tension and pull of particle a.
    ///
    /// Its energy changes by `sum_b t_ab . (du_b - du_a)`, `t_ab = T_a G_ab - 2 c_ab e_ab`, where
    /// `T_a = V_a P_a + 2 sum_b c_ab e_ab (x) X_ab` and e the deviation: theory (48). With plain
    /// gradients the sum in T vanishes; with corrected ones it does not.
    pub fn side<T: Scalar>(&self, displacement: &[SVector<T, D>], a: usize) -> Side<T, D> {
        self.side_of(displacement, a, |gradient| self.material(a).law.stress(gradient))
    }

    /// [`Self::side`] with the stress of `stress`, which the tangent replaces by a linear one.
    #[inline]
    pub(super) fn side_of<T: Scalar>(
        &self,
        displacement: &[SVector<T, D>],
        a: usize,
        stress: impl Fn(&SMatrix<T, D, D>) -> SMatrix<T, D, D>,
    ) -> Side<T, D> {
        let gradient = self.displacement_gradient(displacement, a);
        let volume = self.particles.volume[a];
        let mut tension = stress(&gradient).map(|entry| entry * volume);
        let list = &self.support.list;
        let mut pull = SVector::<T, D>::zeros();
        if self.hourglass[a] != 0.0 {
            for (&b, weight) in list.row(a).iter().zip(self.gradient.weights(list.range(a))) {
                let coefficient = 2.0 * self.hourglass[a] * weight;
                let deviation = self.deviation(displacement, &gradient, a, b);
                let deviation = deviation.map(|entry| entry * coefficient);
                let separation = self.support.separation(&self.particles.position, a, b);
                add_product(&mut tension, &deviation, &separation.into());
                pull -= deviation;
            }
        }
        let sum: Vector<D> =
            self.gradient.coefficients(list.range(a)).iter().map(|g| Vector::from(*g)).sum();
        Side { gradient, pull: pull + applied(&tension, &sum.into()), tension }
    }

    /// The pass over dual supports: force on particle a in N, theory (49), Dual-support (28) with
    /// the sign of its (27) turned round.
    pub fn force<T: Scalar>(
        &self,
        displacement: &[SVector<T, D>],
        sides: &[Side<T, D>],
        a: usize,
    ) -> SVector<T, D> {
        let mut force = sides[a].pull;
        for (&b, &entry) in dual_row(&self.support, a) {
            let side = &sides[b as usize];
            force -= applied(&side.tension, self.gradient.coefficient(entry));
            let hourglass = self.hourglass[b as usize];
            if hourglass != 0.0 {
                let deviation = self.deviation(displacement, &side.gradient, b as usize, a as u32);
                let coefficient = 2.0 * hourglass * self.gradient.weight(entry);
                force += deviation.map(|entry| entry * coefficient);
            }
        }
        force
    }

    /// Forces on all particles in N into `force`, with the sides that they are made of.
    pub fn forces<T: Scalar + Send + Sync>(
        &self,
        displacement: &[SVector<T, D>],
        sides: &mut [Side<T, D>],
        force: &mut [SVector<T, D>],
    ) {
        self.fill_sides(displacement, sides);
        self.fill_forces(displacement, sides, force);
    }

    /// The sides of all particles.
    pub fn fill_sides<T: Scalar + Send + Sync>(
        &self,
        displacement: &[SVector<T, D>],
        sides: &mut [Side<T, D>],
    ) {
        parallel::for_each_chunk(sides, |first, sides| {
            for (offset, side) in sides.iter_mut().enumerate() {
                *side = self.side(displacement, first + offset);
            }
        });
    }

    /// Forces on all particles in N with these sides.
    pub fn fill_forces<T: Scalar + Send + Sync>(
        &self,
        displacement: &[SVector<T, D>],
        sides: &[Side<T, D>],
        force: &mut [SVector<T, D>],
    ) {
        parallel::for_each_chunk(force, |first, force| {
            for (offset, force) in force.iter_mut().enumerate() {
                *force = self.force(displacement, sides, first + offset);
            }
        });
    }

    /// The tangent stiffness times `direction`, `d2E/du2 direction`, in N for a direction in m:
    /// Dual-support (29) and (40), both with the factors that they lack. By dual numbers through
    /// the forces, so exact and symmetric for any material.
    pub fn stiffness_product(
        &self,
        displacement: &[Vector<D>],
        direction: &[Vector<D>],
    ) -> Vec<Vector<D>> {
        let seeded: Vec<SVector<Dual64, D>> = displacement
            .iter()
            .zip(direction)
            .map(|(u, d)| SVector::from_fn(|i, _| Dual64::new(u[i], d[i])))
            .collect();
        let mut sides = vec![Side::zero(); self.len()];
        let mut force = vec![SVector::zeros(); self.len()];
        self.forces(&seeded, &mut sides, &mut force);
        force.iter().map(|force| force.map(|entry| -entry.eps)).collect()
    }
}

/// `tensor += vector (x) row`.
#[inline]
fn add_product<T: Scalar, const D: usize>(
    tensor: &mut SMatrix<T, D, D>,
    vector: &SVector<T, D>,
    row: &[f64; D],
) {
    for j in 0..D {
        for i in 0..D {
            tensor[(i, j)] += vector[i] * row[j];
        }
    }
}

/// `tensor vector`.
#[inline]
fn applied<T: Scalar, const D: usize>(
    tensor: &SMatrix<T, D, D>,
    vector: &[f64; D],
) -> SVector<T, D> {
    let mut result = SVector::zeros();
    for j in 0..D {
        for i in 0..D {
            result[i] += tensor[(i, j)] * vector[j];
        }
    }
    result
}
