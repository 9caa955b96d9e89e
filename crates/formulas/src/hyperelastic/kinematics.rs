//! What the laws make of a displacement gradient.

use nalgebra::Matrix3;

use crate::{Number, tensor};

/// Measures of a deformation `F = I + A` that keep the digits of small strains.
pub(super) struct Kinematics<T> {
    /// Deformation gradient F.
    pub gradient: Matrix3<T>,
    /// Green-Lagrange strain `E = (A + A^T + A^T A)/2`, Elastodynamics (3.20) with the factor on
    /// its last term that is lost there.
    pub strain: Matrix3<T>,
    /// `J - 1`.
    pub volume_strain: T,
    /// `ln J`, NaN for `J < 0`.
    pub log_volume: T,
}

impl<T: Number> Kinematics<T> {
    #[inline(always)]
    pub fn new(a: &Matrix3<T>) -> Self {
        let square = tensor::transposed_product(a, a);
        let strain = tensor::of_entries(|i, j| (a[(i, j)] + a[(j, i)] + square[(i, j)]) * 0.5);
        // det(I + A) = 1 + tr A + tr(cof A) + det A.
        let volume_strain = trace(a) + trace(&tensor::cofactor(a)) + tensor::determinant(a);
        Self {
            gradient: a + Matrix3::identity(),
            strain,
            volume_strain,
            log_volume: volume_strain.ln_1p(),
        }
    }

    /// `F^-T = cof(F)/J`.
    #[inline(always)]
    pub fn inverse_transpose(&self) -> Matrix3<T> {
        let factor = (self.volume_strain + 1.0).recip();
        scaled(&tensor::cofactor(&self.gradient), factor)
    }

    /// `J^exponent`.
    #[inline(always)]
    pub fn volume_power(&self, exponent: f64) -> T {
        (self.log_volume * exponent).exp()
    }

    /// `J^exponent - 1`.
    #[inline(always)]
    pub fn volume_power_less_one(&self, exponent: f64) -> T {
        (self.log_volume * exponent).exp_m1()
    }
}

#[inline(always)]
pub(super) fn trace<T: Number>(a: &Matrix3<T>) -> T {
    a[(0, 0)] + a[(1, 1)] + a[(2, 2)]
}

/// `a : a`.
#[inline(always)]
pub(super) fn square<T: Number>(a: &Matrix3<T>) -> T {
    a.iter().fold(T::zero(), |sum, &entry| sum + entry * entry)
}

#[inline(always)]
pub(super) fn scaled<T: Number>(a: &Matrix3<T>, factor: T) -> Matrix3<T> {
    tensor::of_entries(|i, j| a[(i, j)] * factor)
}
