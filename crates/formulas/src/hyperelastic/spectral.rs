//! Powers of the right Cauchy-Green tensor that stay differentiable where stretches coincide.

use nalgebra::Matrix3;

use crate::Number;
use crate::frame::by_rotations;

/// `C = I + 2 E` in the principal frame of its real part.
///
/// In that frame the real part is diagonal, and off-diagonal entries of dual numbers are
/// infinitesimal. Perturbation theory to second order is then exact for numbers that carry first
/// and second derivatives, and its divided differences exist for equal eigenvalues too.
pub(super) struct Spectral<T> {
    rotation: Matrix3<T>,
    /// `2 E` in the rotated frame.
    excess: Matrix3<T>,
}

impl<T: Number> Spectral<T> {
    pub fn new(strain: &Matrix3<T>) -> Self {
        let rotation = by_rotations(&strain.map(T::re)).map(T::lift);
        let excess = rotation.tr_mul(&(strain * rotation)).map(|entry| entry * 2.0);
        Self { rotation, excess }
    }

    /// `ln` of the three eigenvalues of C, to second order but for the coupling of frames.
    fn logarithm(&self, k: usize) -> T {
        self.excess[(k, k)].ln_1p()
    }

    /// `tr(C^exponent) - 3`, exact with its first and second derivatives.
    pub fn trace_power_less_three(&self, exponent: f64) -> T {
        let diagonal = |k: usize| (self.logarithm(k) * exponent).exp_m1();
        let mut sum = diagonal(0) + diagonal(1) + diagonal(2);
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            let slope = self.divided_difference(i, j, exponent - 1.0) * exponent;
            sum += self.excess[(i, j)] * self.excess[(i, j)] * T::lift(slope);
        }
        sum
    }

    /// `C^exponent`, exact with its first derivatives.
    pub fn power(&self, exponent: f64) -> Matrix3<T> {
        let rotated = Matrix3::from_fn(|i, j| match i == j {
            true => (self.logarithm(i) * exponent).exp(),
            false => self.excess[(i, j)] * T::lift(self.divided_difference(i, j, exponent)),
        });
        self.rotation * rotated * self.rotation.transpose()
    }

    /// `(a^q - b^q)/(a - b)` of two eigenvalues, `q a^(q-1)` where they are equal.
    fn divided_difference(&self, i: usize, j: usize, q: f64) -> T::Real {
        let (first, second) = (self.excess[(i, i)].re(), self.excess[(j, j)].re());
        let (a, b) = (first + 1.0, second + 1.0);
        let relative = (first - second) / b;
        T::Real::choose(
            relative.abs().at_most(T::Real::from(0.0)),
            || a.powf(q - 1.0) * q,
            || b.powf(q - 1.0) * (relative.ln_1p() * q).exp_m1() / relative,
        )
    }
}
