//! The two compressible neo-Hookean laws of Dual-support.

use nalgebra::{Matrix3, SMatrix};

use super::kinematics::{Kinematics, trace};
use super::reduced::{larger, smaller};
use super::{HyperelasticResponse, LameConstants, MooneyRivlin};
use crate::{Number, tensor};

/// `psi = kappa/2 (J - 1)^2 + mu/2 (J^(-2/3) F : F - 3)`: theory (39), Dual-support (46) and (47).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeoHookean(pub LameConstants);

impl NeoHookean {
    /// The law is that of Mooney and Rivlin without its second term.
    #[inline]
    fn as_mooney_rivlin(&self) -> MooneyRivlin {
        MooneyRivlin { c10: 0.5 * self.0.mu, c01: 0.0, bulk_modulus: self.0.bulk_modulus() }
    }
}

impl HyperelasticResponse for NeoHookean {
    #[inline]
    fn energy<T: Number>(&self, a: &Matrix3<T>) -> T {
        self.as_mooney_rivlin().energy(a)
    }

    #[inline(always)]
    fn stress<T: Number>(&self, a: &Matrix3<T>) -> Matrix3<T> {
        self.as_mooney_rivlin().stress(a)
    }
}

/// `psi = mu/2 (F : F - 3) - mu ln J + lambda/2 (ln J)^2`: theory (40), Dual-support (50) and
/// (51), Elastodynamics (3.63).
///
/// Not convex in strong tension at a Poisson's ratio near 1/2: a bar
/// held sideways at 0.49 has a negative stiffness between stretches of 3.63 and 6.40.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeoHookeanLogarithmic(pub LameConstants);

impl NeoHookeanLogarithmic {
    /// Smallest and largest modulus of a wave along a principal direction of a displacement gradient
    /// of `D` dimensions, the others held, Pa.
    ///
    /// With `m = F^-T N` the acoustic tensor of direction N is
    /// `mu I + (mu + lambda - lambda ln J) m (x) m`, and `|m|` is one over the principal stretch.
    #[inline(always)]
    pub fn wave_moduli<T: Number, const D: usize>(&self, gradient: &SMatrix<T, D, D>) -> [T; 2] {
        let LameConstants { lambda, mu } = self.0;
        let deformation = gradient + SMatrix::identity();
        let strain = tensor::right_cauchy_green(&deformation);
        let factor = -(tensor::determinant(&deformation).ln() * lambda) + (mu + lambda);
        let along = tensor::extreme_eigenvalues(&strain).map(|square| factor / square + mu);
        // Across a direction there is nothing but shear.
        let across = if D > 1 { T::from(mu) } else { along[0] };
        let [one, other] = along;
        [smaller(smaller(one, other), across), larger(larger(one, other), across)]
    }
}

impl HyperelasticResponse for NeoHookeanLogarithmic {
    #[inline]
    fn energy<T: Number>(&self, a: &Matrix3<T>) -> T {
        let LameConstants { lambda, mu } = self.0;
        let kinematics = Kinematics::new(a);
        let log = kinematics.log_volume;
        // F : F - 3 = 2 tr E.
        (trace(&kinematics.strain) - log) * mu + log * log * (0.5 * lambda)
    }

    #[inline(always)]
    fn stress<T: Number>(&self, a: &Matrix3<T>) -> Matrix3<T> {
        let LameConstants { lambda, mu } = self.0;
        let kinematics = Kinematics::new(a);
        let volume = kinematics.log_volume * lambda - mu;
        let inverse = kinematics.inverse_transpose();
        tensor::of_entries(|i, j| kinematics.gradient[(i, j)] * mu + inverse[(i, j)] * volume)
    }
}
