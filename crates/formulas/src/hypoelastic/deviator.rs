//! The deviatoric stress and its objective rate.

use nalgebra::Matrix3;

use crate::Number;

/// Symmetric part of a velocity gradient without its trace, in 1/s.
#[inline]
fn deviatoric_rate<T: Number>(gradient: &Matrix3<T>) -> Matrix3<T> {
    let mean = (gradient[(0, 0)] + gradient[(1, 1)] + gradient[(2, 2)]) * (1.0 / 3.0);
    Matrix3::from_fn(|i, j| {
        let rate = (gradient[(i, j)] + gradient[(j, i)]) * 0.5;
        if i == j { rate - mean } else { rate }
    })
}

/// Spin `(L - L^T)/2` of a velocity gradient `L_ij = d u_i / d x_j`, CTVF (6).
#[inline]
fn spin<T: Number>(gradient: &Matrix3<T>) -> Matrix3<T> {
    Matrix3::from_fn(|i, j| (gradient[(i, j)] - gradient[(j, i)]) * 0.5)
}

/// Rate of the deviatoric stress in Pa/s by Hooke's law in the rate of Jaumann, CTVF (4),
/// theory (68): `2 G dev d + Omega s - s Omega`, for a shear modulus in Pa, a deviatoric stress in
/// Pa and a velocity gradient in 1/s.
#[inline]
pub fn jaumann_rate<T: Number>(
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
#[inline]
pub fn advance<T: Number>(
    shear_modulus: f64,
    deviator: &Matrix3<T>,
    gradient: &Matrix3<T>,
    step: T,
) -> Matrix3<T> {
    let half = deviatoric_rate(gradient) * (step * shear_modulus);
    let a = spin(gradient) * (step * 0.5);
    // Cayley: (I - A)^-1 (I + A) = I + 2 (A + A A)/(1 + |a|^2), with the axial vector a of A, of
    // which A A = a a^T - |a|^2 I.
    let axis = [a[(2, 1)], a[(0, 2)], a[(1, 0)]];
    let square = axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2];
    let factor = T::from(2.0) / (square + 1.0);
    let rotation = Matrix3::from_fn(|i, j| {
        let unit = if i == j { -(factor * square) + 1.0 } else { T::zero() };
        unit + factor * (a[(i, j)] + axis[i] * axis[j])
    });
    rotated(&rotation, &(deviator + half)) + half
}

/// `R s R^T` of a symmetric tensor. Written out: products of small matrices are calls of the library.
#[inline]
fn rotated<T: Number>(rotation: &Matrix3<T>, tensor: &Matrix3<T>) -> Matrix3<T> {
    let dot = |a: [T; 3], b: [T; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let row = |matrix: &Matrix3<T>, i: usize| [matrix[(i, 0)], matrix[(i, 1)], matrix[(i, 2)]];
    let turned = Matrix3::from_fn(|i, j| dot(row(rotation, i), row(tensor, j)));
    Matrix3::from_fn(|i, j| dot(row(&turned, i), row(rotation, j)))
}

/// Equivalent stress of von Mises `sqrt(3/2 s : s)` in Pa, all three normal components included.
/// CTVF (68) is that of plane stress.
#[inline]
pub fn von_mises<T: Number>(deviator: &Matrix3<T>) -> T {
    von_mises_squared(deviator).sqrt()
}

/// The square of [`von_mises`] in Pa^2.
#[inline]
fn von_mises_squared<T: Number>(deviator: &Matrix3<T>) -> T {
    deviator.iter().fold(T::zero(), |sum, s| sum + *s * *s) * 1.5
}

/// Specific energy of shear `s : s / (4 G rho)` in J/kg, of a shear modulus in Pa and a density in kg/m^3.
#[inline]
pub fn shear_energy<T: Number>(deviator: &Matrix3<T>, shear_modulus: T, density: T) -> T {
    von_mises_squared(deviator) / (shear_modulus * density * 6.0)
}
