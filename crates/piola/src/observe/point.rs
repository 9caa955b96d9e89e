//! Fields at fixed points of space.

use piola_formulas::kernels::Kernel;

use crate::fields::FieldDescription;
use crate::schemes::Scheme;

/// Fields interpolated at a point: the mean over particles weighted by the kernel, which is exact
/// for constants. Not a number where no particle is near.
#[derive(Clone)]
pub struct Interpolated {
    /// The point in m.
    pub at: Vec<f64>,
    /// The fields, with all their components.
    pub fields: Vec<FieldDescription>,
    /// The kernel.
    pub kernel: Kernel,
    /// Its smoothing length in m.
    pub smoothing_length: f64,
    /// Periods of space in m by axis, infinite where it is open.
    pub periods: Vec<f64>,
    /// Indices in memory of the particles that count.
    pub particles: Vec<u32>,
}

impl Interpolated {
    pub(super) fn record(
        &self,
        scheme: &mut dyn Scheme,
        time: f64,
        state: &[f64],
        scratch: &mut Vec<f64>,
        row: &mut Vec<f64>,
    ) {
        let dimension = scheme.dimension();
        scratch.clear();
        scheme.sample(time, state, "position", &self.particles, scratch);
        let support = self.kernel.support_radius(self.smoothing_length);
        let (mut near, mut weights) = (Vec::new(), Vec::new());
        for (&particle, position) in self.particles.iter().zip(scratch.chunks_exact(dimension)) {
            let distance = self.distance(position);
            if distance < support {
                near.push(particle);
                let weight: f64 = self.kernel.value(dimension, distance, self.smoothing_length);
                weights.push(weight);
            }
        }
        let total: f64 = weights.iter().sum();
        for field in &self.fields {
            scratch.clear();
            scheme.sample(time, state, field.name, &near, scratch);
            let components = field.kind.components(dimension);
            row.extend((0..components).map(|component| {
                let values = scratch.iter().skip(component).step_by(components);
                values.zip(&weights).map(|(value, weight)| value * weight).sum::<f64>() / total
            }));
        }
    }

    fn distance(&self, position: &[f64]) -> f64 {
        let axes = position.iter().zip(&self.at).zip(&self.periods);
        let squares = axes.map(|((x, at), period)| {
            let distance = (x - at).abs();
            let other_way = if period.is_finite() { (period - distance).abs() } else { distance };
            distance.min(other_way).powi(2)
        });
        squares.sum::<f64>().sqrt()
    }
}
