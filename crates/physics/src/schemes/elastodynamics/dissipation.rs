//! Stresses that depend on the rate of the deformation.

use piola_formulas::tensor;

use super::Elastodynamics;
use crate::Tensor;

impl<const D: usize> Elastodynamics<D> {
    /// The first Piola-Kirchhoff stress in Pa of viscosity at particle `a`, theory (65) and (66):
    /// `J (2 eta d - q I) F^-T` with the rate of deformation d. Zero for a rotation.
    pub(super) fn viscous_stress(&self, a: usize) -> Tensor<D> {
        let deformation = self.gradient[a] + Tensor::identity();
        let Some(inverse) = tensor::inverse(&deformation) else { return Tensor::zeros() };
        let spatial = self.gradient_rate[a] * inverse;
        let rate = (spatial + spatial.transpose()) * 0.5;
        let mut cauchy = rate * (2.0 * self.settings.viscosity);
        let expansion = rate.trace();
        if expansion < 0.0 {
            let linear = self.artificial_modulus(a);
            let pressure = -linear * expansion + self.quadratic_modulus(a) * expansion.powi(2);
            cauchy -= Tensor::identity() * pressure;
        }
        cauchy * inverse.transpose() * tensor::determinant(&deformation)
    }

    /// `b_1 rho c l` of the artificial viscosity, Pa s, with the wave speed at rest and the spacing l.
    pub(super) fn artificial_modulus(&self, a: usize) -> f64 {
        self.settings.artificial_viscosity[0] * self.impedance(a) * self.particles.spacing[a]
    }

    /// `b_2 rho l^2` of the artificial viscosity, Pa s^2.
    pub(super) fn quadratic_modulus(&self, a: usize) -> f64 {
        let density = self.mixtures[self.mixture[a] as usize].density();
        self.settings.artificial_viscosity[1] * density * self.particles.spacing[a].powi(2)
    }

    /// `rho c` of the fastest wave at rest, Pa s/m.
    pub(super) fn impedance(&self, a: usize) -> f64 {
        let mixture = self.mixture[a] as usize;
        (self.mixtures[mixture].density() * self.moduli_at_rest[mixture][1]).sqrt()
    }
}
