//! The deviatoric stress and its objective rate.

use nalgebra::Matrix3;

use crate::Scalar;

/// Symmetric part of a velocity gradient without its trace, in 1/s.
#[inline]
fn deviatoric_rate<T: Scalar>(gradient: &Matrix3<T>) -> Matrix3<T> {
    let mean = (gradient[(0, 0)] + gradient[(1, 1)] + gradient[(2, 2)]) * (1.0 / 3.0);
    Matrix3::from_fn(|i, j| {
        let rate = (gradient[(i, j)] + gradient[(j, i)]) * 0.5;
        if i == j { rate - mean } else { rate }
    })
}

/// Spin `(L - L^T)/2` of a velocity gradient `L_ij = d u_i / d x_j`, CTVF (6).
#[inline]
fn spin<T: Scalar>(gradient: &Matrix3<T>) -> Matrix3<T> {
    Matrix3::from_fn(|i, j| (gradient[(i, j)] - gradient[(j, i)]) * 0.5)
}

/// Rate of the deviatoric stress in Pa/s by Hooke's law in the rate of Jaumann, CTVF (4),
/// theory (68): `2 G dev d + Omega s - s Omega`, for a shear modulus in Pa, a deviatoric stress in
/// Pa and a velocity gradient in 1/s.
#[inline]
pub fn jaumann_rate<T: Scalar>(
    shear_modulus: f64,
    deviator: &Matrix3<T>,
    gradient: &Matrix3<T>,
) -> Matrix3<T> {
    let spin = spin(gradient);
    deviatoric_rate(gradient) * T::from(2.0 * shear_modulus) + spin * deviator - deviator * spin
}

/// The deviatoric stress after a `step` in s with the velocity gradient half way, theory (69).
///
/// CTVF (58) adds the rate at the start of the step times its length, by which the size of a
/// stress grows in pure rotation. Here half of the strain is added before and half after an exact
/// rotation: of second order, and the invariants of the stress stay in rotation.
pub fn advance(
    shear_modulus: f64,
    deviator: &Matrix3<f64>,
    gradient: &Matrix3<f64>,
    step: f64,
) -> Matrix3<f64> {
    let half = deviatoric_rate(gradient) * (shear_modulus * step);
    let a = spin(gradient) * (0.5 * step);
    // Cayley: (I - A)^-1 (I + A) = I + 2 (A + A A)/(1 + |a|^2), with the axial vector a of A.
    let square = 0.5 * a.norm_squared();
    let rotation = Matrix3::identity() + (a + a * a) * (2.0 / (1.0 + square));
    rotation * (deviator + half) * rotation.transpose() + half
}

/// Equivalent stress of von Mises `sqrt(3/2 s : s)` in Pa, all three normal components included.
/// CTVF (68) is that of plane stress.
#[inline]
pub fn von_mises<T: Scalar>(deviator: &Matrix3<T>) -> T {
    let square = deviator.iter().fold(T::zero(), |sum, s| sum + *s * *s);
    (square * 1.5).sqrt()
}
