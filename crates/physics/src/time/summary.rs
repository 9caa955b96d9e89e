//! What is known of a run while it goes and when it has ended.

use serde::{Deserialize, Serialize};

use super::failure::Failure;
use super::history::Trace;
use crate::schemes::{Health, Phase, RankCosts};

/// Where a run stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Simulated time in s.
    pub time: f64,
    /// Where it ends in s.
    pub end: f64,
    /// Steps taken.
    pub step: u64,
    /// Size of the last step in s.
    pub step_size: f64,
    /// What limited it.
    pub limiter: &'static str,
    /// Evaluations of the rates times particles so far.
    pub evaluations: u64,
    /// How often the run went back to try smaller steps.
    pub retries: usize,
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// At its end.
    Completed,
    /// On request, after a whole step.
    Interrupted,
    /// With a failure; the last good state has been shown to all observers.
    Failed(Failure),
}

impl Outcome {
    /// One line for tables and checks: `completed`, `interrupted` or `failed: KIND`.
    pub fn summary(&self) -> String {
        match self {
            Self::Completed => "completed".into(),
            Self::Interrupted => "interrupted".into(),
            Self::Failed(failure) => format!("failed: {}", failure.kind()),
        }
    }
}

/// Wall time of one stage of the loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timing {
    /// Its name.
    pub stage: &'static str,
    /// Wall time in s.
    pub seconds: f64,
    /// How often it ran.
    pub calls: u64,
}

/// A failure after which the run went back and on with smaller steps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Retry {
    /// What had gone wrong, in one word.
    pub kind: String,
    /// What had gone wrong, as a sentence.
    pub failure: String,
    /// Steps taken when it did.
    pub step: u64,
    /// Simulated time then in s.
    pub time: f64,
    /// Simulated time in s of the state that the run went back to.
    pub back_to: f64,
    /// What every step has been multiplied by since.
    pub factor: f64,
}

/// What is known at the end of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// How it ended.
    pub outcome: Outcome,
    /// Simulated time reached in s.
    pub time: f64,
    /// Steps taken.
    pub steps: u64,
    /// The step that the first state allows, before it is shortened to meet an output, in s.
    pub first_step: f64,
    /// Smallest and largest step taken in s.
    pub step_range: [f64; 2],
    /// The worst health figures of the run.
    pub worst: Health,
    /// Evaluations of the rates times particles.
    pub evaluations: u64,
    /// Wall time by stage, with that of the runs that this one continues.
    pub timings: Vec<Timing>,
    /// The stages of a step, with the wall time that each took since the run started, or went on.
    pub phases: Vec<Phase>,
    /// What has taken the time of each rank, where there are several.
    pub ranks: Vec<RankCosts>,
    /// How often it went back, and why.
    pub retries: Vec<Retry>,
    /// The neighbourhood of the first bad particle over the last steps, if the run failed at one.
    pub trace: Option<Trace>,
    /// Simulated time in s and number of steps at which the run was resumed, if it was.
    pub resumed: Option<(f64, u64)>,
    /// Faults that the run survived, for example of a checkpoint that could not be written.
    pub warnings: Vec<String>,
}
