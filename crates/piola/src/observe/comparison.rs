//! A field against what it should be.

use std::sync::Arc;

use crate::boundaries::SpaceTime;
use crate::fields::FieldSelector;
use crate::schemes::Scheme;

/// The relative difference `sum |f - e| / sum |e|` of a field f from a function e of the place of
/// each particle and time, CTVF (66) with absolute values; or the root of that of squares, as
/// Dual-support (56).
#[derive(Clone)]
pub struct Deviation {
    /// One number of each particle.
    pub field: FieldSelector,
    /// What it should be.
    pub exact: Arc<dyn SpaceTime>,
    /// Whether the means of both are taken away first, as of a pressure without a zero.
    pub without_mean: bool,
    /// Whether squares are summed, and the root taken.
    pub of_squares: bool,
    /// Indices in memory of the particles, at least one.
    pub particles: Vec<u32>,
}

impl Deviation {
    pub(super) fn record(
        &self,
        scheme: &mut dyn Scheme,
        time: f64,
        state: &[f64],
        scratch: &mut Vec<f64>,
    ) -> f64 {
        let dimension = scheme.dimension();
        scratch.clear();
        scheme.sample(time, state, "position", &self.particles, scratch);
        let exact: Vec<f64> = scratch
            .chunks_exact(dimension)
            .map(|position| {
                let mut place = [0.0; 3];
                place[..dimension].copy_from_slice(position);
                self.exact.value(place, time)
            })
            .collect();
        scratch.clear();
        scheme.sample(time, state, self.field.field.name, &self.particles, scratch);
        let components = self.field.field.kind.components(dimension);
        let found = scratch.chunks_exact(components).map(|value| self.field.value(value));
        let mean = |sum: f64| if self.without_mean { sum / exact.len() as f64 } else { 0.0 };
        let offset = mean(found.clone().sum()) - mean(exact.iter().sum());
        let size = |value: f64| if self.of_squares { value * value } else { value.abs() };
        let difference: f64 = found.zip(&exact).map(|(f, e)| size(f - offset - e)).sum();
        let ratio = difference / exact.iter().map(|e| size(*e)).sum::<f64>();
        if self.of_squares { ratio.sqrt() } else { ratio }
    }
}
