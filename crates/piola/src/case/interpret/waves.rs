//! Pistons that make waves.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use super::*;
use crate::boundaries::{Sea, Water, WaveMaker};

/// Height over depth above which a wave breaks.
const BREAKS: f64 = 0.78;

/// Height over length and `tanh(k d)` above which it breaks, Miche's.
const STEEP: f64 = 0.142;

/// `H L^2 / d^3` above which the second crest of a wave of second order is no wave any more: `8 pi^2 / 3`.
const LONG: f64 = 8.0 * PI * PI / 3.0;

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
                let kd = water.kd(TAU / period);
                let length = TAU * water.depth / kd;
                let ursell = height.value * (length / water.depth).powi(2) / water.depth;
                let fault = if ursell > LONG {
                    Some(("too long for waves of second order", "shorten the period"))
                } else if height.value > STEEP * length * kd.tanh() {
                    Some(("so steep that they break", "lengthen the period"))
                } else {
                    None
                };
                if let Some((what, help)) = fault {
                    let message = format!(
                        "waves of {} m with a period of {period} s are {length:.3e} m long on {} m of water, {what}",
                        height.value, water.depth
                    );
                    let problem = Problem::new(height.place, message, "no such waves");
                    return self.refuse(problem.help(format!("lower the height, or {help}")));
                }
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
        if !maker.is_finite() {
            let message = "the motion of the piston is not a number with these heights and periods";
            let problem = Problem::new(record.place, message, "not finite");
            return self.refuse(problem.help("correct the period, the depth or the gravity"));
        }
        let direction = match record.has("direction") {
            true => self.unit(record, "direction")?,
            false => (0..self.dimension).map(|axis| if axis == 0 { 1.0 } else { 0.0 }).collect(),
        };
        Some(Located::new((Arc::new(maker), direction), record.place))
    }
}
