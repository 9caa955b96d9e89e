//! A run between two steps, and what a step makes of it.

use std::sync::Arc;

use super::clock::{Clock, Tally};
use super::executor::Executor;
use super::failure::Failure;
use super::history::{History, Mark};
use super::step::{ChosenStep, StepControl};
use super::summary::Retry;

/// A run between two steps.
pub(super) struct Run {
    pub clock: Clock,
    pub tally: Tally,
    /// Written to only while nothing else holds it; else a copy takes its place.
    pub state: Arc<Vec<f64>>,
    /// When each observer is due next.
    pub due: Vec<Option<f64>>,
    pub history: History,
    pub resumed: Option<(f64, u64)>,
}

impl Run {
    /// A run at an instant, which it cannot go back beyond.
    pub fn at(clock: Clock, tally: Tally, state: Vec<f64>, due: Vec<Option<f64>>) -> Self {
        let history = History::new(Mark::of(&clock, &tally, &due, &state));
        Self { clock, tally, state: Arc::new(state), due, history, resumed: None }
    }

    /// Halves the steps from here on, after one that did not end anywhere.
    pub fn shorten(&mut self, failure: &Failure) {
        let Clock { step, time, .. } = self.clock;
        self.tally.factor *= Executor::RETRY_FACTOR;
        let factor = self.tally.factor;
        let kind = failure.kind().to_owned();
        let failure = failure.to_string();
        self.tally.retries.push(Retry { kind, failure, step, time, back_to: time, factor });
    }

    /// Lets the next step be longer, or shorter, by what is known of the step `met`, which is
    /// `chosen` or was shortened to meet a due time: by how much longer it could be, or whether it was found quickly.
    pub fn lengthen(
        &mut self,
        growth: Option<f64>,
        was_quick: bool,
        chosen: ChosenStep,
        met: ChosenStep,
    ) {
        let factor = self.tally.factor;
        let next = match growth {
            Some(growth) => {
                let wanted = factor * growth * met.step / chosen.step;
                // What is good enough for a short step says little of one that was to be longer.
                if met.step < chosen.step && growth > 1.0 { wanted.max(factor) } else { wanted }
            }
            None if was_quick => factor * Executor::GROWTH_FACTOR,
            None => factor,
        };
        self.tally.factor = next.min(1.0);
    }

    /// Moves the clock on by the step `met`, which ends at `soonest` if it was shortened to.
    pub fn advance(&mut self, control: StepControl, met: ChosenStep, soonest: f64) {
        let Self { clock, tally, history, .. } = self;
        history.step(clock.time, met.step);
        clock.step += 1;
        clock.time = match control {
            StepControl::Fixed(step) => clock.step as f64 * step,
            _ if met.step == soonest - clock.time => soonest,
            _ => clock.time + met.step,
        };
        clock.chosen = met;
        let [smallest, largest] = tally.step_range;
        tally.step_range = [smallest.min(met.step), largest.max(met.step)];
    }
}
