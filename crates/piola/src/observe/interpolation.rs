//! Fields at fixed points in space.

use nalgebra::{DMatrix, DVector};
use piola_formulas::kernels::Kernel;

use crate::fields::FieldDescription;
use crate::schemes::Observation;

/// What the coefficients of a linear fit may add up to, signs apart: beyond it the fit amplifies noise,
/// as where it reaches out of the particles, and the mean is taken.
const LARGEST_AMPLIFICATION: f64 = 3.0;

/// Fields interpolated at points: the value there of the linear function that best fits the surrounding particles,
/// weighted by the kernel, theory (54). It is exact for linear fields, even at the edge of a body. Where the
/// particles do not determine it, the mean is used, which is exact for constants; NaN where no particle is near.
#[derive(Clone)]
pub struct Interpolated {
    /// The points in m.
    pub places: Vec<Vec<f64>>,
    /// The fields, with all their components.
    pub fields: Vec<FieldDescription>,
    /// The kernel.
    pub kernel: Kernel,
    /// Its smoothing length in m at each point.
    pub smoothing_lengths: Vec<f64>,
    /// Periods of space in m by axis, infinite where it is open.
    pub periods: Vec<f64>,
    /// Indices in memory of the particles that count.
    pub particles: Vec<u32>,
}

/// The particles around the places: those of a place stand together.
#[derive(Default)]
struct Around {
    particles: Vec<u32>,
    coefficients: Vec<f64>,
    /// How many each place has.
    counts: Vec<usize>,
}

impl Interpolated {
    /// Renumbers its particles; those without a number no longer count.
    pub fn renumber(&mut self, index: &dyn Fn(u32) -> Option<u32>) {
        self.particles = self.particles.iter().filter_map(|&a| index(a)).collect();
    }

    /// Appends to `rows` for each place all components of all fields. `scratch` is overwritten.
    pub(super) fn record(
        &self,
        now: &mut Observation,
        scratch: &mut Vec<f64>,
        rows: &mut Vec<f64>,
    ) {
        let dimension = now.scheme().dimension();
        let particles = now.present(&self.particles);
        *scratch = now.values("position", &particles);
        let mut around = Around::default();
        for at in self.places.iter().zip(&self.smoothing_lengths) {
            self.look_around(at, (&particles, scratch), &mut around);
        }
        let width: usize = self.fields.iter().map(|field| field.kind.components(dimension)).sum();
        let start = rows.len();
        rows.resize(start + width * self.places.len(), 0.0);
        let mut column = start;
        for field in &self.fields {
            scratch.clear();
            now.read(field, &around.particles, scratch);
            let components = field.kind.components(dimension);
            for component in 0..components {
                let mut values = scratch.iter().skip(component).step_by(components);
                let mut coefficients = around.coefficients.iter();
                for (number, &count) in around.counts.iter().enumerate() {
                    let pairs = values.by_ref().zip(coefficients.by_ref()).take(count);
                    let sum: f64 = pairs.map(|(value, coefficient)| value * coefficient).sum();
                    rows[column + number * width] = if count == 0 { f64::NAN } else { sum };
                }
                column += 1;
            }
        }
    }

    /// Adds the particles around `place`, with their coefficients.
    fn look_around(
        &self,
        (place, &smoothing_length): (&Vec<f64>, &f64),
        (particles, positions): (&[u32], &[f64]),
        around: &mut Around,
    ) {
        let dimension = place.len();
        let support = self.kernel.support_radius(smoothing_length);
        let (mut offsets, mut weights) = (Vec::new(), Vec::new());
        for (&particle, position) in particles.iter().zip(positions.chunks_exact(dimension)) {
            let offset = DVector::from_iterator(dimension, way(place, position, &self.periods));
            let distance = offset.norm();
            if distance < support {
                let weight: f64 = self.kernel.value(dimension, distance, smoothing_length);
                around.particles.push(particle);
                offsets.push(offset);
                weights.push(weight);
            }
        }
        around.counts.push(weights.len());
        around.coefficients.extend(fit(&offsets, weights));
    }
}

/// The way from one place to the nearest image of another.
pub(super) fn way<'a>(
    from: &'a [f64],
    to: &'a [f64],
    periods: &'a [f64],
) -> impl Iterator<Item = f64> + Clone + 'a {
    from.iter().zip(to).zip(periods).map(|((from, to), period)| {
        let way = to - from;
        if period.is_finite() { way - period * (way / period).round() } else { way }
    })
}

/// The coefficients of the values of particles at `offsets` in the value at the origin, theory (54).
fn fit(offsets: &[DVector<f64>], mut weights: Vec<f64>) -> Vec<f64> {
    let total: f64 = weights.iter().sum();
    weights.iter_mut().for_each(|weight| *weight /= total);
    let Some(dimension) = offsets.first().map(|offset| offset.len()) else { return weights };
    let mut mean = DVector::zeros(dimension);
    for (offset, weight) in offsets.iter().zip(&weights) {
        mean += offset * *weight;
    }
    let mut spread = DMatrix::zeros(dimension, dimension);
    for (offset, weight) in offsets.iter().zip(&weights) {
        let from_mean = offset - &mean;
        spread += &from_mean * from_mean.transpose() * *weight;
    }
    let Some(spread) = spread.cholesky() else { return weights };
    let slope = spread.solve(&mean);
    let linear: Vec<f64> = offsets
        .iter()
        .zip(&weights)
        .map(|(offset, weight)| weight * (1.0 - (offset - &mean).dot(&slope)))
        .collect();
    let amplification: f64 = linear.iter().map(|coefficient| coefficient.abs()).sum();
    if amplification <= LARGEST_AMPLIFICATION { linear } else { weights }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A lattice around the origin, cut at x = `edge`, with coefficients for a kernel of radius 3.
    fn half_plane(edge: f64) -> (Vec<DVector<f64>>, Vec<f64>) {
        let lattice = (-3..=3).flat_map(|i| (-3..=3).map(move |j| (f64::from(i), f64::from(j))));
        let jitter = |i: f64, j: f64| 0.2 * (3.0 * i + 7.0 * j).sin();
        let offsets: Vec<DVector<f64>> = lattice
            .map(|(i, j)| DVector::from_vec(vec![i + jitter(i, j), j + jitter(j, i)]))
            .filter(|offset| offset[0] > edge && offset.norm() < 3.0)
            .collect();
        let weights = offsets.iter().map(|offset| (3.0 - offset.norm()).powi(3)).collect();
        let coefficients = fit(&offsets, weights);
        (offsets, coefficients)
    }

    #[test]
    fn a_linear_field_is_met_inside_and_at_an_edge() {
        for edge in [-9.0, -0.5, 0.0] {
            let (offsets, coefficients) = half_plane(edge);
            let field = |offset: &DVector<f64>| 2.0 + 3.0 * offset[0] - 5.0 * offset[1];
            let value: f64 = offsets.iter().map(field).zip(&coefficients).map(|(f, c)| f * c).sum();
            assert!((value - 2.0).abs() < 1e-12, "edge {edge}: {value}");
        }
    }

    #[test]
    fn far_outside_of_the_particles_the_mean_is_taken() {
        let (_, coefficients) = half_plane(1.5);
        assert!(coefficients.iter().all(|coefficient| *coefficient > 0.0));
        assert!((coefficients.iter().sum::<f64>() - 1.0).abs() < 1e-14);
    }

    #[test]
    fn particles_in_a_row_leave_the_mean() {
        let offsets: Vec<DVector<f64>> =
            [-1.0, 0.5, 1.0].map(|x| DVector::from_vec(vec![x, 0.3])).to_vec();
        let coefficients = fit(&offsets, vec![1.0, 2.0, 1.0]);
        assert_eq!(coefficients, [0.25, 0.5, 0.25]);
        assert!(fit(&[], Vec::new()).is_empty());
    }
}
