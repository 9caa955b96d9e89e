//! What operators make of fields that are known: sums of their coefficients, written out.

use piola::geometry::Particles;
use piola::operators::{GradientOperator, Support};
use piola::{Tensor, Vector};

/// Derivatives of fields by the coefficients of an operator.
pub trait Derivatives<const D: usize> {
    /// The sum over the neighbours of each particle of a term of both and `G_ab`.
    fn apply<T: std::iter::Sum<T>>(
        &self,
        support: &Support<D>,
        term: impl Fn(usize, usize, Vector<D>) -> T,
    ) -> Vec<T>;

    /// Gradient of a scalar field at every particle.
    fn gradient(&self, support: &Support<D>, field: &[f64]) -> Vec<Vector<D>> {
        self.apply(support, |a, b, g| g * (field[b] - field[a]))
    }

    /// Gradient of a vector field at every particle: `T_ij = d f_i / d X_j`.
    fn vector_gradient(&self, support: &Support<D>, field: &[Vector<D>]) -> Vec<Tensor<D>> {
        self.apply(support, |a, b, g| (field[b] - field[a]) * g.transpose())
    }

    /// Divergence of a vector field at every particle.
    fn divergence(&self, support: &Support<D>, field: &[Vector<D>]) -> Vec<f64> {
        self.apply(support, |a, b, g| (field[b] - field[a]).dot(&g))
    }
}

impl<const D: usize> Derivatives<D> for GradientOperator<D> {
    fn apply<T: std::iter::Sum<T>>(
        &self,
        support: &Support<D>,
        term: impl Fn(usize, usize, Vector<D>) -> T,
    ) -> Vec<T> {
        let value = |a: usize| {
            let row = support.list.row(a).iter().zip(self.forward(support.list.range(a)));
            row.map(|(&b, g)| term(a, b as usize, Vector::from(*g))).sum()
        };
        (0..support.list.len()).map(value).collect()
    }
}

/// Interpolation coefficients `w_b W_b(X_a)` of every pair, with the particle's own.
///
/// `f(X_a) = sum_b w_b f_b W_b(X_a)`, b = a included: theory (1), Upwind (2.4), and with
/// `normalised` the corrected kernel of Upwind (2.39), which is exact for constants.
#[derive(Clone, Debug)]
pub struct Interpolation {
    own: Vec<f64>,
    coefficients: Vec<f64>,
}

impl Interpolation {
    /// Builds the coefficients with kernel weights `particles.weight`.
    pub fn new<const D: usize>(
        particles: &Particles<D>,
        support: &Support<D>,
        normalised: bool,
    ) -> Self {
        let mut own = Vec::with_capacity(particles.len());
        let mut coefficients = Vec::with_capacity(support.list.pairs());
        for a in 0..particles.len() {
            let h = support.smoothing_length[a];
            let start = coefficients.len();
            let mut centre = particles.weight[a] * support.kernel.value(D, 0.0, h);
            for &b in support.list.row(a) {
                let distance = support.separation(&particles.position, a, b).norm();
                let value = support.kernel.value(D, distance, h);
                coefficients.push(particles.weight[b as usize] * value);
            }
            if normalised {
                let row = &mut coefficients[start..];
                let sum = centre + row.iter().sum::<f64>();
                centre /= sum;
                row.iter_mut().for_each(|coefficient| *coefficient /= sum);
            }
            own.push(centre);
        }
        Self { own, coefficients }
    }

    /// The interpolated field at every particle.
    pub fn apply<const D: usize>(&self, support: &Support<D>, field: &[f64]) -> Vec<f64> {
        let value = |a: usize| {
            let row = support.list.row(a).iter().zip(&self.coefficients[support.list.range(a)]);
            self.own[a] * field[a]
                + row.map(|(&b, coefficient)| coefficient * field[b as usize]).sum::<f64>()
        };
        (0..field.len()).map(value).collect()
    }
}
