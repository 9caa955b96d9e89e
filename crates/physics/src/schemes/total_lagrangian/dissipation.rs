//! Stresses that depend on the rate of the deformation.

use piola_formulas::tensor;

use super::{Dissipation, Solid};
use crate::Tensor;

impl Dissipation {
    /// The first Piola-Kirchhoff stress in Pa of viscosity at particle `a`, theory (65) and (66), at a
    /// displacement gradient and its rate: `J (2 eta d - q I) F^-T` with the rate of deformation d. Zero
    /// for a rotation.
    pub(super) fn stress<const D: usize>(
        &self,
        solid: &Solid<D>,
        a: usize,
        gradient: &Tensor<D>,
        gradient_rate: &Tensor<D>,
    ) -> Tensor<D> {
        let deformation = gradient + Tensor::identity();
        let Some(inverse) = tensor::inverse(&deformation) else { return Tensor::zeros() };
        let spatial = gradient_rate * inverse;
        let rate = (spatial + spatial.transpose()) * 0.5;
        let mut cauchy = rate * (2.0 * self.viscosity);
        let expansion = rate.trace();
        if expansion < 0.0 {
            let linear = self.artificial_modulus(solid, a);
            let quadratic = self.quadratic_modulus(solid, a);
            let pressure = -linear * expansion + quadratic * expansion.powi(2);
            cauchy -= Tensor::identity() * pressure;
        }
        cauchy * inverse.transpose() * tensor::determinant(&deformation)
    }

    /// By how much the viscosity that a wave meets at particle `a` exceeds the reference viscosity, at a
    /// displacement gradient and, where there is a quadratic part, its rate.
    ///
    /// Rates `a (x) N` have `d = sym(a (x) m)` with `m = F^-T N`, so that the power of (65) and (66),
    /// `J (2 eta d : d + b (tr d)^2)`, is at most `J |m|^2 (2 eta + b) |a|^2`, for a and m along the
    /// direction of the smallest stretch l, where `|m| = 1/l`. The slope of the quadratic part is
    /// `b = 2 b_2 rho l^2 |tr d|`.
    pub(super) fn thickening<const D: usize>(
        &self,
        solid: &Solid<D>,
        a: usize,
        gradient: &Tensor<D>,
        rate: Option<&Tensor<D>>,
    ) -> f64 {
        let deformation = gradient + Tensor::identity();
        let shortest = tensor::smallest_eigenvalue(&tensor::right_cauchy_green(&deformation));
        let mut viscosity = 2.0 * self.viscosity + self.artificial_modulus(solid, a);
        if let (Some(rate), Some(inverse)) = (rate, tensor::inverse(&deformation)) {
            let expansion = (rate * inverse).trace();
            viscosity += 2.0 * self.quadratic_modulus(solid, a) * (-expansion).max(0.0);
        }
        let growth = tensor::determinant(&deformation).abs() / shortest;
        growth * viscosity / self.reference(solid, a)
    }

    /// What [`Self::thickening`] is counted from, Pa s: the sum of all viscosities at rest, the quadratic
    /// one as large as if the spacing closed at half the wave speed.
    pub(super) fn reference<const D: usize>(&self, solid: &Solid<D>, a: usize) -> f64 {
        let [_, quadratic] = self.artificial_viscosity;
        let impedance = impedance(solid, a) * solid.particles.spacing[a];
        2.0 * self.viscosity + self.artificial_modulus(solid, a) + quadratic * impedance
    }

    /// `b_1 rho c l` of the artificial viscosity, Pa s, with the wave speed at rest and the spacing l.
    fn artificial_modulus<const D: usize>(&self, solid: &Solid<D>, a: usize) -> f64 {
        self.artificial_viscosity[0] * impedance(solid, a) * solid.particles.spacing[a]
    }

    /// `b_2 rho l^2` of the artificial viscosity, Pa s^2.
    fn quadratic_modulus<const D: usize>(&self, solid: &Solid<D>, a: usize) -> f64 {
        let density = solid.mixture(a).density();
        self.artificial_viscosity[1] * density * solid.particles.spacing[a].powi(2)
    }
}

/// `rho c` of the fastest wave at rest, Pa s/m.
fn impedance<const D: usize>(solid: &Solid<D>, a: usize) -> f64 {
    (solid.mixture(a).density() * solid.moduli_at_rest(a)[1]).sqrt()
}
