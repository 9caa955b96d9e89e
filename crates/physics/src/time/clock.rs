//! The moving parts of a run, apart from its state.

use serde::{Deserialize, Serialize};

use super::step::ChosenStep;
use super::summary::{Retry, Timing};
use crate::schemes::{Health, Watch};

/// Where a run stands.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Clock {
    pub time: f64,
    pub step: u64,
    /// The last step.
    pub chosen: ChosenStep,
    pub health: Health,
}

/// What adds up over a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Tally {
    pub worst: Health,
    /// Evaluations of the rates times particles.
    pub evaluations: u64,
    pub first_step: f64,
    pub step_range: [f64; 2],
    /// Largest speed and largest wave speed at the start in m/s.
    pub start_speeds: [f64; 2],
    /// The last step as it was chosen, before it was shortened for any reason, in s.
    pub wanted: f64,
    /// What every step is multiplied by.
    pub factor: f64,
    pub retries: Vec<Retry>,
    /// What the run has been warned of, and whether the scheme was who warned.
    pub warnings: Vec<String>,
    pub warned: bool,
    pub watches: Watches,
}

/// Stop watches of the loop.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Watches {
    pub step: Watch,
    pub inspect: Watch,
    pub observe: Watch,
    pub checkpoint: Watch,
}

impl Clock {
    /// The start of a run.
    pub const START: Self = Self {
        time: 0.0,
        step: 0,
        chosen: ChosenStep { step: 0.0, limiter: "start", particle: 0 },
        health: Health::NEUTRAL,
    };
}

impl Tally {
    /// Of a run that has not begun.
    pub const START: Self = Self {
        worst: Health::NEUTRAL,
        evaluations: 0,
        first_step: f64::NAN,
        step_range: [f64::INFINITY, 0.0],
        start_speeds: [0.0, 0.0],
        wanted: f64::INFINITY,
        factor: 1.0,
        retries: Vec::new(),
        warnings: Vec::new(),
        warned: false,
        watches: Watches {
            step: Watch::ZERO,
            inspect: Watch::ZERO,
            observe: Watch::ZERO,
            checkpoint: Watch::ZERO,
        },
    };
}

impl Watches {
    /// As they stand.
    pub fn timings(&self) -> Vec<Timing> {
        let Self { step, inspect, observe, checkpoint } = self;
        let named = [
            ("step", step),
            ("inspect", inspect),
            ("observe", observe),
            ("checkpoint", checkpoint),
        ];
        let timing = |(stage, watch): (_, &Watch)| Timing {
            stage,
            seconds: watch.total.as_secs_f64(),
            calls: watch.calls,
        };
        named.map(timing).into()
    }
}
