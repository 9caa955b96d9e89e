//! A run that has ended.

use std::path::PathBuf;

use super::model;
use crate::observe::{Series, Tables};
use crate::solve::Costs;
use crate::time::{IntegratorKind, Summary};

/// A run that has ended, successfully or not.
#[derive(Clone, Debug)]
pub struct Finished {
    /// How it ended, with its figures.
    pub summary: Summary,
    /// What was recorded.
    pub tables: Tables,
    /// Files written, in the order of writing.
    pub files: Vec<PathBuf>,
    /// What has been chosen for the user.
    pub notes: Vec<String>,
    /// What the user should know about the case.
    pub warnings: Vec<String>,
    /// Number of particles.
    pub particles: usize,
    /// Cost of linear equations since the run started or was resumed; `None` if there were none.
    pub linear: Option<Costs>,
    /// Number of its own steps that each system has taken, by name; empty for a single system.
    pub own_steps: Vec<(String, u64)>,
}

/// A share of the largest energy that does not balance, above which the user is told.
const UNBALANCED: f64 = 0.01;

/// What the user should know if energy is not accounted for: by theory (18) what the balance is off
/// by is the error of the integrator, which is damping where it is made to damp.
pub(super) fn unbalanced(tables: &Tables, time: &model::Time) -> Option<String> {
    let off = tables.energy.values("balance")?.last()?.abs();
    let largest = |name: &str| -> f64 {
        let values = tables.energy.values(name).unwrap_or_default();
        values.iter().fold(0.0, |most, value| most.max(value.abs()))
    };
    let share = off / largest("total");
    let is_static =
        IntegratorKind::from_name(&time.integrator).is_some_and(IntegratorKind::is_static);
    let advice = match time.rule.is_some_and(|rule| rule.damps()) {
        _ if is_static => {
            "the load steps are too large, or one of them passed a limit point; lower \
             `time.step` and compare"
        }
        true => {
            "the integrator damps periods that are short compared with its steps; if that is \
             more than intended, lower `time.step`, or reduce its damping"
        }
        false => {
            "the steps are too large for this motion; lower `time.cfl`, or `time.step` where it is \
             given, and compare"
        }
    };
    let message =
        || format!("{:.1} % of the largest energy is not accounted for: {advice}", 100.0 * share);
    (share > UNBALANCED).then(message)
}

/// Number of particles that were removed, by schemes that do so.
pub(super) fn removed(tables: &Tables) -> f64 {
    tables.steps.values("removed").and_then(|values| values.last().copied()).unwrap_or(0.0)
}

/// The names behind `run.`, numbers and texts of a run as a whole.
pub(super) const RUN_QUANTITIES: [&str; 12] = [
    "first_step",
    "smallest_step",
    "largest_step",
    "steps",
    "particles",
    "time",
    "smallest_ratio",
    "ratio_mismatch",
    "largest_speed",
    "retries",
    "removed",
    "outcome",
];

impl Finished {
    /// The quantity that checks call `name`: a column of a table, or `run.NAME`.
    pub fn quantity(&self, name: &str) -> Option<Series> {
        let number = |value: f64, unit| Some(Series::Number { value, unit });
        let summary = &self.summary;
        match name.strip_prefix("run.") {
            None => self.tables.curve(name),
            Some("first_step") => number(summary.first_step, "s"),
            Some("smallest_step") => number(summary.step_range[0], "s"),
            Some("largest_step") => number(summary.step_range[1], "s"),
            Some("steps") => number(summary.steps as f64, "1"),
            Some("particles") => number(self.particles as f64, "1"),
            Some("time") => number(summary.time, "s"),
            Some("smallest_ratio") => number(summary.worst.smallest_ratio, "1"),
            Some("ratio_mismatch") => number(summary.worst.ratio_mismatch, "1"),
            Some("largest_speed") => number(summary.worst.largest_speed, "m/s"),
            Some("retries") => number(summary.retries.len() as f64, "1"),
            Some("removed") => number(removed(&self.tables), "1"),
            Some("outcome") => Some(Series::Text(summary.outcome.summary())),
            Some(_) => None,
        }
    }
}
