//! SPH interpolation at the particles, plain or Shepard-normalised.

use super::support::Support;
use crate::geometry::Particles;
use crate::parallel;

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
        let mut values = vec![0.0; field.len()];
        parallel::for_each_chunk(&mut values, |first, rows| {
            for (offset, value) in rows.iter_mut().enumerate() {
                let a = first + offset;
                let row = support.list.row(a).iter().zip(&self.coefficients[support.list.range(a)]);
                *value = self.own[a] * field[a]
                    + row.map(|(&b, coefficient)| coefficient * field[b as usize]).sum::<f64>();
            }
        });
        values
    }
}
