//! Pistons that make waves.

use std::sync::Arc;

use super::*;
use crate::boundaries::{Sea, Water, WaveMaker};

/// Height over depth above which a wave breaks.
const BREAKS: f64 = 0.78;

impl Reader<'_, '_> {
    /// The waves that a boundary makes, with the direction in which they go.
    pub(super) fn wave_maker(
        &mut self,
        record: &Record,
    ) -> Option<Located<(Arc<WaveMaker>, Vec<f64>)>> {
        let number = |key: &str| record.number(key).map(|it| it.value);
        let water = Water { depth: number("depth")?, gravity: number("gravity")? };
        let height_key = if record.kind == "spectrum" { "significant_height" } else { "height" };
        let height = record.number(height_key)?;
        if height.value > BREAKS * water.depth {
            let message = format!(
                "waves of {} m break on {} m of water: the height is at most {BREAKS} of the depth",
                height.value, water.depth
            );
            let problem = Problem::new(height.place, message, "too high");
            return self.refuse(problem.help("lower it, or make the water deeper"));
        }
        let ramp = |period: f64| number("ramp").unwrap_or(2.0 * period);
        let maker = match record.kind {
            "regular" => {
                let period = number("period")?;
                WaveMaker::regular(height.value, period, water, ramp(period))
            }
            "solitary" => WaveMaker::solitary(height.value, water),
            _ => {
                let sea = Sea {
                    significant_height: height.value,
                    peak_period: number("peak_period")?,
                    gamma: number("gamma")?,
                    components: record.whole::<u32>("components")?.value,
                    seed: record.whole::<u64>("seed")?.value,
                };
                WaveMaker::sea(&sea, water, ramp(sea.peak_period))
            }
        };
        let direction = match record.has("direction") {
            true => self.unit(record, "direction")?,
            false => (0..self.dimension).map(|axis| if axis == 0 { 1.0 } else { 0.0 }).collect(),
        };
        Some(Located::new((Arc::new(maker), direction), record.place))
    }
}
