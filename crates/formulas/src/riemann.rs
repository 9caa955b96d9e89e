//! Upwind dissipation between two particles from an acoustic Riemann solver.
//!
//! The stabilised fluxes of Upwind (3.35) to (3.38), with the density that (3.38) lacks: for the
//! unknowns `(rho0 v, J)` the solver gives `S_v = 1/2 rho0 c n (x) n` and
//! `S_p = 1/(2 rho0 c) n (x) n` (corrected). Areas are the antisymmetric averages of (3.41) and
//! (3.42, sign corrected), so that what a particle receives its neighbour loses.

use nalgebra::{SMatrix, SVector};

use crate::Scalar;

/// The interface between particles a and b.
///
/// `n = (x_b - x_a) / |x_b - x_a|` is its current normal, Upwind (6.15), and
/// `N = (X_b - X_a) / |X_b - X_a|` its reference normal.
#[derive(Clone, Copy, Debug)]
pub struct Interface<T, const D: usize> {
    current: SVector<T, D>,
    reference: SVector<f64, D>,
    /// `1 / (|X_ab| |x_ab|^2)`: turns the unnormalised `x_ab (x) x_ab` and `X_ab` of the fluxes
    /// into `n (x) n` and `N` with one root and one division.
    scale: T,
}

impl<T: Scalar, const D: usize> Interface<T, D> {
    /// The interface of a pair with current separation `x_b - x_a` and reference separation
    /// `X_b - X_a`, both in m.
    #[inline]
    pub fn new(current: SVector<T, D>, reference: SVector<f64, D>) -> Self {
        let square = dot(&current, &current);
        let scale = (square * reference.norm_squared().sqrt()).recip();
        Self { current, reference, scale }
    }

    /// Dissipative force on a in N, `1/2 z (n . dv) n (N . C)`, theory (12), Upwind (3.40a)
    /// corrected.
    ///
    /// `impedance` z = rho0 c in kg/(m^2 s); `jump` dv = v_f+ - v_f- in m/s; `area` the
    /// antisymmetric `C_ab = V_a G_ab - V_b G_ba` in m^(D-1).
    #[inline]
    pub fn force(
        &self,
        impedance: T,
        jump: &SVector<T, D>,
        area: &SVector<f64, D>,
    ) -> SVector<T, D> {
        let normal_area = self.reference.dot(area);
        let size = impedance * dot(&self.current, jump) * self.scale * T::from(0.5 * normal_area);
        self.current.map(|component| component * size)
    }

    /// Dissipative volume rate of a in m^D/s, `-(dp / 2z) (n . H^Ave N) (n . C^H)`,
    /// theory (13), Upwind (3.40b) corrected, for `P = -p H`.
    ///
    /// `jump` dp = p_f+ - p_f- in Pa; `cofactor` the average of the two cofactors; `area` the
    /// antisymmetric `C^H_ab = V_a H_a G_ab - V_b H_b G_ba` in m^(D-1).
    #[inline]
    pub fn volume_rate(
        &self,
        impedance: T,
        jump: T,
        cofactor: &SMatrix<T, D, D>,
        area: &SVector<T, D>,
    ) -> T {
        let mut mapped = SVector::<T, D>::from_element(T::from(0.0));
        for i in 0..D {
            for j in 0..D {
                mapped[i] += cofactor[(i, j)] * T::from(self.reference[j]);
            }
        }
        let projected = dot(&self.current, &mapped) * dot(&self.current, area);
        -(jump * projected * self.scale) / (impedance * T::from(2.0))
    }
}

/// Reference speed of the shock for the dissipation, `c / sqrt(lambda_min)`, Upwind (3.57), from
/// the smallest eigenvalue of the right Cauchy-Green tensor.
#[inline]
pub fn stretched_wave_speed<T: Scalar>(speed: f64, smallest_eigenvalue: T) -> T {
    smallest_eigenvalue.sqrt().recip() * T::from(speed)
}

/// Fastest wave measured on the reference configuration in m/s, for the time step.
///
/// `sqrt(psi'' / rho0) J / sqrt(lambda_min)`: the wave along the direction that is compressed
/// most, theory (16). Upwind (3.57) lacks the factor J. `acoustic` is `sqrt(psi''(J) / rho0)`.
#[inline]
pub fn referential_wave_speed<T: Scalar>(acoustic: T, determinant: T, smallest_eigenvalue: T) -> T {
    acoustic * determinant / smallest_eigenvalue.sqrt()
}

#[inline]
fn dot<T: Scalar, const D: usize>(a: &SVector<T, D>, b: &SVector<T, D>) -> T {
    let mut sum = T::from(0.0);
    for i in 0..D {
        sum += a[i] * b[i];
    }
    sum
}
