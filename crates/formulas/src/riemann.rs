//! Upwind dissipation between two particles from an acoustic Riemann solver.
//!
//! The stabilised fluxes of Upwind (3.35) to (3.38), with the density that (3.38) lacks: for the
//! unknowns `(rho0 v, J)` the solver gives `S_v = 1/2 rho0 c n (x) n` and
//! `S_p = 1/(2 rho0 c) n (x) n` (corrected). Areas are the antisymmetric averages of (3.41) and
//! (3.42, sign corrected), so that what a particle receives its neighbour loses.

use nalgebra::{SMatrix, SVector};

use crate::Number;
use crate::pairs::{Components, Record, dot};

/// The interface between particles a and b.
///
/// `n = (x_b - x_a) / |x_b - x_a|` is its current normal, Upwind (6.15), and
/// `N = (X_b - X_a) / |X_b - X_a|` its reference normal.
#[derive(Clone, Copy, Debug)]
pub struct Interface<T, const D: usize> {
    /// Current separation `x_b - x_a` in m.
    current: SVector<T, D>,
    /// Reference separation `X_b - X_a` in m.
    reference: SVector<T, D>,
    /// Impedance `z = rho0 c` in kg/(m^2 s).
    impedance: T,
    /// `1 / (2 z |X_ab| |x_ab|^2)`: turns the unnormalised `x_ab (x) x_ab` and `X_ab` of the fluxes
    /// into `n (x) n` and `N`, and divides by the impedance, all with one root and one division.
    scale: T,
}

impl<T: Number, const D: usize> Interface<T, D> {
    /// The interface of a pair with current separation `x_b - x_a` and reference separation
    /// `X_b - X_a`, both in m, and impedance `z = rho0 c` in kg/(m^2 s).
    #[inline(always)]
    pub fn new(current: SVector<T, D>, reference: SVector<T, D>, impedance: T) -> Self {
        let square = dot(&current, &current);
        let distance = dot(&reference, &reference).sqrt();
        let scale = (square * impedance * (distance * 2.0)).recip();
        Self { current, reference, impedance, scale }
    }

    /// Dissipative force on a in N, `1/2 z (n . dv) n (N . C)`, theory (12), Upwind (3.40a)
    /// corrected.
    ///
    /// `jump` dv = v_f+ - v_f- in m/s; `area` the antisymmetric `C_ab = V_a G_ab - V_b G_ba` in
    /// m^(D-1).
    #[inline(always)]
    pub fn force(&self, jump: &SVector<T, D>, area: &SVector<T, D>) -> SVector<T, D> {
        let normal_area = dot(&self.reference, area);
        let flux = self.scale * self.impedance * self.impedance * dot(&self.current, jump);
        let size = flux * normal_area;
        let mut force = self.current;
        for i in 0..D {
            force[i] *= size;
        }
        force
    }

    /// Dissipative volume rate of a in m^D/s, `-(dp / 2z) (n . H^Ave N) (n . C^H)`,
    /// theory (13), Upwind (3.40b) corrected, for `P = -p H`.
    ///
    /// `jump` dp = p_f+ - p_f- in Pa; `cofactors` H_a and H_b, of which H^Ave is the average;
    /// `areas` V_a G_ab and V_b G_ba in m^(D-1), which give the antisymmetric
    /// `C^H_ab = V_a H_a G_ab - V_b H_b G_ba`.
    #[inline(always)]
    pub fn volume_rate(
        &self,
        jump: T,
        cofactors: [&SMatrix<T, D, D>; 2],
        areas: [&SVector<T, D>; 2],
    ) -> T {
        // What a cofactor maps is needed along x_ab only: two products with its transpose do.
        let mine = transposed_product(cofactors[0], &self.current);
        let theirs = transposed_product(cofactors[1], &self.current);
        let mut both = mine;
        for i in 0..D {
            both[i] += theirs[i];
        }
        let area = dot(&mine, areas[0]) - dot(&theirs, areas[1]);
        -(jump * self.scale * 0.5 * dot(&both, &self.reference) * area)
    }
}

/// Reference speed of the shock for the dissipation, `c / sqrt(lambda_min)`, Upwind (3.57), from
/// the smallest eigenvalue of the right Cauchy-Green tensor.
#[inline]
pub fn stretched_wave_speed<T: Number>(speed: T, smallest_eigenvalue: T) -> T {
    smallest_eigenvalue.sqrt().recip() * speed
}

/// Fastest wave measured on the reference configuration in m/s, for the time step.
///
/// `sqrt(psi'' / rho0) J / sqrt(lambda_min)`: the wave along the direction that is compressed
/// most, theory (16). Upwind (3.57) lacks the factor J. `acoustic` is `sqrt(psi''(J) / rho0)`.
#[inline]
pub fn referential_wave_speed<T: Number>(acoustic: T, determinant: T, smallest_eigenvalue: T) -> T {
    acoustic * determinant / smallest_eigenvalue.sqrt()
}

/// `H^T x`.
#[inline(always)]
fn transposed_product<T: Number, const D: usize>(
    matrix: &SMatrix<T, D, D>,
    vector: &SVector<T, D>,
) -> SVector<T, D> {
    let mut product = Components::<D>::zero();
    for j in 0..D {
        let mut sum = matrix[(0, j)] * vector[0];
        for i in 1..D {
            sum += matrix[(i, j)] * vector[i];
        }
        product[j] = sum;
    }
    product
}
