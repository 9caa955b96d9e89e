//! Stress linear in a strain.

use nalgebra::Matrix3;

use super::kinematics::{Kinematics, scaled, square, trace};
use super::{HyperelasticResponse, LameConstants};
use crate::{Number, tensor};

/// Hooke's law, `psi = lambda/2 (tr eps)^2 + mu eps : eps` with the small strain
/// `eps = (F + F^T)/2 - I`: theory (37), Dual-support (44), Elastodynamics (3.54).
///
/// Not objective: a rotation strains it. Its tangent is that of Dual-support (45) with the
/// misprinted rows 4 and 6 set right.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearElastic(pub LameConstants);

/// St. Venant and Kirchhoff's law, `psi = lambda/2 (tr E)^2 + mu E : E` with the strain of Green
/// and Lagrange: theory (38), Elastodynamics (3.50).
///
/// Objective, but it softens in compression: a bar loses its stiffness at a stretch of
/// `1/sqrt(3)` and its resistance to being turned inside out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SaintVenantKirchhoff(pub LameConstants);

#[inline]
fn quadratic<T: Number>(constants: &LameConstants, strain: &Matrix3<T>) -> T {
    let trace = trace(strain);
    trace * trace * (0.5 * constants.lambda) + square(strain) * constants.mu
}

/// `lambda (tr strain) I + 2 mu strain`.
#[inline(always)]
fn derivative<T: Number>(constants: &LameConstants, strain: &Matrix3<T>) -> Matrix3<T> {
    let pressure = scaled(&Matrix3::identity(), trace(strain) * constants.lambda);
    tensor::of_entries(|i, j| pressure[(i, j)] + strain[(i, j)] * (2.0 * constants.mu))
}

#[inline(always)]
fn small_strain<T: Number>(a: &Matrix3<T>) -> Matrix3<T> {
    tensor::of_entries(|i, j| (a[(i, j)] + a[(j, i)]) * 0.5)
}

impl HyperelasticResponse for LinearElastic {
    #[inline]
    fn energy<T: Number>(&self, a: &Matrix3<T>) -> T {
        quadratic(&self.0, &small_strain(a))
    }

    #[inline(always)]
    fn stress<T: Number>(&self, a: &Matrix3<T>) -> Matrix3<T> {
        derivative(&self.0, &small_strain(a))
    }
}

impl HyperelasticResponse for SaintVenantKirchhoff {
    #[inline]
    fn energy<T: Number>(&self, a: &Matrix3<T>) -> T {
        quadratic(&self.0, &Kinematics::new(a).strain)
    }

    #[inline(always)]
    fn stress<T: Number>(&self, a: &Matrix3<T>) -> Matrix3<T> {
        let Kinematics { gradient, strain, .. } = Kinematics::new(a);
        tensor::product(&gradient, &derivative(&self.0, &strain))
    }
}
