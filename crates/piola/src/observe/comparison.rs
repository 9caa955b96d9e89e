//! A field compared with its expected values.

use std::sync::Arc;

use crate::boundaries::SpaceTime;
use crate::fields::FieldSelector;
use crate::schemes::Observation;

/// The relative difference `sum |f - e| / sum |e|` of fields f from functions e of the position of each particle and
/// time, CTVF (66) with absolute values; or the root of the same ratio of squares, which with volumes is Dual-support
/// (56).
#[derive(Clone)]
pub struct Deviation {
    /// Numbers of each particle, with their expected values.
    pub parts: Vec<(FieldSelector, Arc<dyn SpaceTime>)>,
    /// Whether the means of both are subtracted first, as for a pressure without a reference value.
    pub without_mean: bool,
    /// What is summed.
    pub norm: Norm,
    /// Indices in memory of the particles, at least one.
    pub particles: Vec<u32>,
}

/// What a [`Deviation`] sums over its particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Norm {
    /// Absolute values.
    Absolute,
    /// Squares, with the root of the sum.
    Square,
    /// Squares times reference volumes, with the root of the sum.
    Volume,
}

impl Deviation {
    pub(super) fn record(&self, now: &mut Observation, scratch: &mut Vec<f64>) -> f64 {
        let time = now.time();
        let particles = now.present(&self.particles);
        let weights = match self.norm {
            Norm::Volume => now.values("volume", &particles),
            _ => vec![1.0; particles.len()],
        };
        let positions = now.values("position", &particles);
        let dimension = positions.len() / particles.len().max(1);
        let size = |value: f64| match self.norm {
            Norm::Absolute => value.abs(),
            _ => value * value,
        };
        let (mut difference, mut whole) = (0.0, 0.0);
        for (selector, exact) in &self.parts {
            let exact = positions.chunks_exact(dimension.max(1)).map(|position| {
                let mut place = [0.0; 3];
                place[..dimension].copy_from_slice(position);
                exact.value(place, time)
            });
            let exact: Vec<f64> = exact.collect();
            scratch.clear();
            now.read(&selector.field, &particles, scratch);
            let components = selector.field.kind.components(dimension);
            let found = scratch.chunks_exact(components).map(|value| selector.value(value));
            let mean = |sum: f64| if self.without_mean { sum / exact.len() as f64 } else { 0.0 };
            let offset = mean(found.clone().sum()) - mean(exact.iter().sum());
            let all = found.zip(&exact).zip(&weights);
            difference += all.map(|((f, e), w)| w * size(f - offset - e)).sum::<f64>();
            whole += exact.iter().zip(&weights).map(|(e, w)| w * size(*e)).sum::<f64>();
        }
        let ratio = difference / whole;
        if self.norm == Norm::Absolute { ratio } else { ratio.sqrt() }
    }
}
