//! Stresses that depend on the rate of the deformation.

use piola_formulas::viscous::Viscous;

use super::{Dissipation, Solid};
use crate::Tensor;

impl Dissipation {
    /// The viscosities at particle `a`.
    pub(super) fn at<const D: usize>(&self, solid: &Solid<D>, a: usize) -> Viscous<f64> {
        Viscous {
            viscosity: self.viscosity,
            linear: self.artificial_modulus(solid, a),
            quadratic: self.quadratic_modulus(solid, a),
        }
    }

    /// By how much the viscosity that a wave meets at particle `a` exceeds the reference viscosity, at a
    /// displacement gradient and, where there is a quadratic part, its rate.
    pub(super) fn thickening<const D: usize>(
        &self,
        solid: &Solid<D>,
        a: usize,
        gradient: &Tensor<D>,
        rate: Option<&Tensor<D>>,
    ) -> f64 {
        self.at(solid, a).of_waves(gradient, rate) / self.reference(solid, a)
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
