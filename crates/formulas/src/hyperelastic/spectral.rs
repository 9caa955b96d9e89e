//! Powers of the right Cauchy-Green tensor that stay differentiable where stretches coincide.

use nalgebra::Matrix3;

use crate::Number;
use crate::frame::by_rotations;

/// `C = I + 2 E` in the principal frame of its real part.
///
/// In that frame the real part is diagonal, and off-diagonal entries of dual numbers are
/// infinitesimal. Perturbation theory to second order is then exact for numbers that carry first
/// and second derivatives, and its divided differences exist for equal eigenvalues too.
pub(super) struct Spectral<T: Number> {
    rotation: Matrix3<T>,
    /// `2 E` in the rotated frame.
    excess: Matrix3<T>,
    /// `ln` of the three eigenvalues of C, to second order but for the coupling of frames.
    logarithms: [T; 3],
    /// `(a - b)/b` of the two eigenvalues other than the k-th, and `ln(a/b)`.
    ratios: [[T::Real; 2]; 3],
}

/// The axes of pairs of eigenvalues, the k-th of them without the k-th axis.
const PAIRS: [(usize, usize); 3] = [(1, 2), (0, 2), (0, 1)];

impl<T: Number> Spectral<T> {
    pub fn new(strain: &Matrix3<T>) -> Self {
        let rotation = by_rotations(&strain.map(T::re)).map(T::lift);
        let excess = rotation.tr_mul(&(strain * rotation)).map(|entry| entry * 2.0);
        let ratios = PAIRS.map(|(i, j)| {
            let (first, second) = (excess[(i, i)].re(), excess[(j, j)].re());
            let relative = (first - second) / (second + 1.0);
            [relative, relative.ln_1p()]
        });
        let logarithms = [0, 1, 2].map(|k| excess[(k, k)].ln_1p());
        Self { rotation, excess, logarithms, ratios }
    }

    /// `tr(C^exponent) - 3`, exact with its first and second derivatives.
    pub fn trace_power_less_three(&self, exponent: f64) -> T {
        let [a, b, c] = self.logarithms.map(|logarithm| (logarithm * exponent).exp_m1());
        let mut sum = a + b + c;
        for (k, (i, j)) in PAIRS.into_iter().enumerate() {
            let slope = self.divided_difference(k, exponent - 1.0) * exponent;
            sum += self.excess[(i, j)] * self.excess[(i, j)] * T::lift(slope);
        }
        sum
    }

    /// `C^exponent`, exact with its first derivatives.
    pub fn power(&self, exponent: f64) -> Matrix3<T> {
        let powers = self.logarithms.map(|logarithm| (logarithm * exponent).exp());
        let mut rotated = Matrix3::from_diagonal(&powers.into());
        for (k, (i, j)) in PAIRS.into_iter().enumerate() {
            let slope = T::lift(self.divided_difference(k, exponent));
            rotated[(i, j)] = self.excess[(i, j)] * slope;
            rotated[(j, i)] = self.excess[(j, i)] * slope;
        }
        self.rotation * rotated * self.rotation.transpose()
    }

    /// `(a^q - b^q)/(a - b)` of the eigenvalues of a pair, `q a^(q-1)` where they are equal.
    fn divided_difference(&self, pair: usize, q: f64) -> T::Real {
        let [relative, logarithm] = self.ratios[pair];
        let factor = T::Real::choose(
            relative.abs().at_most(T::Real::from(0.0)),
            || T::Real::from(q),
            || (logarithm * q).exp_m1() / relative,
        );
        (self.logarithms[PAIRS[pair].1].re() * (q - 1.0)).exp() * factor
    }
}
