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
            let (linear, quadratic) =
                (self.artificial_modulus(a), self.settings.artificial_viscosity[1]);
            let length = self.particles.spacing[a];
            let density = self.mixtures[self.mixture[a] as usize].density();
            let pressure = -linear * expansion + quadratic * density * (length * expansion).powi(2);
            cauchy -= Tensor::identity() * pressure;
        }
        cauchy * inverse.transpose() * tensor::determinant(&deformation)
    }

    /// `b_1 rho c l` of the artificial viscosity, Pa s, with the wave speed at rest and the spacing l.
    pub(super) fn artificial_modulus(&self, a: usize) -> f64 {
        let mixture = self.mixture[a] as usize;
        let impedance = (self.mixtures[mixture].density() * self.moduli_at_rest[mixture][1]).sqrt();
        self.settings.artificial_viscosity[0] * impedance * self.particles.spacing[a]
    }
}
