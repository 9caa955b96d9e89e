//! Evaluation of a case's checks.
//!
//! [`verify`] requests one run of each variant that a check refers to, and compares. A check that cannot be evaluated
//! fails with a reason: nothing passes by being skipped.

use std::fmt;
use std::rc::Rc;

use super::finished::Finished;
use super::model::{Against, Case, Check, Level};
use crate::observe::Series;
use crate::time::Outcome;
use runs::Runs;

mod format;
mod runs;
#[cfg(test)]
mod tests;
pub mod trends;

/// Results that several variants share, because they are the same case in the end.
impl<Run: RunResults> RunResults for Rc<Run> {
    fn ending(&self) -> Ending {
        self.as_ref().ending()
    }

    fn quantity(&self, name: &str) -> Option<Series> {
        self.as_ref().quantity(name)
    }
}

/// How a run ended, in words: all that the record of a run keeps of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ending {
    /// [`Outcome::summary`]: `completed`, `interrupted` or `failed: KIND`.
    pub summary: String,
    /// The message of a failure.
    pub message: Option<String>,
}

impl From<&Outcome> for Ending {
    fn from(outcome: &Outcome) -> Self {
        let message = match outcome {
            Outcome::Failed(failure) => Some(failure.to_string()),
            _ => None,
        };
        Self { summary: outcome.summary(), message }
    }
}

/// A run that has ended, as checks see it.
pub trait RunResults {
    /// How it ended.
    fn ending(&self) -> Ending;

    /// The quantity called `name`: a column of its tables or a number of the run as a whole.
    fn quantity(&self, name: &str) -> Option<Series>;
}

impl RunResults for Finished {
    fn ending(&self) -> Ending {
        Ending::from(&self.summary.outcome)
    }

    fn quantity(&self, name: &str) -> Option<Series> {
        Finished::quantity(self, name)
    }
}

/// A run with its case: the variant has parameters and checks of its own.
pub struct VariantRun<Run> {
    /// The case with the overrides of the variant and of the setting.
    pub case: Case,
    /// Its results.
    pub run: Run,
}

/// Why a variant was not run.
#[derive(Clone, Debug)]
pub struct NotRun {
    /// The case with its overrides, if it can be read: its checks are described by its own parameters.
    pub case: Option<Box<Case>>,
    /// Why.
    pub reason: String,
}

impl From<String> for NotRun {
    fn from(reason: String) -> Self {
        Self { case: None, reason }
    }
}

/// Runs the variant or member of a sweep of this name (`None`: the case itself), or returns the reason why it cannot.
pub type RunVariant<'a, Run> = dyn FnMut(Option<&str>) -> Result<VariantRun<Run>, NotRun> + 'a;

/// One line of the table of `piola verify`.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckRow {
    /// Number of the check in the case, from 0. A check of a sweep may have several rows.
    pub check: usize,
    /// The case's row of the reproduction list.
    pub id: Option<String>,
    /// What was run, `None` for the case itself: the name of a variant, or a sweep and the values that distinguish
    /// its members.
    pub run: Option<String>,
    /// The quantity with its reduction: `top.displacement.y maximum`.
    pub quantity: String,
    /// The result of the run, `None` if there is none.
    pub got: Option<Got>,
    /// What was expected: `0.2 m`, `at most 1e-9 J`, `less than damped (0.31 m)`.
    pub expected: String,
    /// How far off the result may be: `1 %`, `0.01 m`; empty for bounds and comparisons.
    pub tolerance: String,
    /// How far off it is, in the terms of the tolerance; empty for bounds and comparisons.
    pub deviation: String,
    /// What the expected value is worth as evidence.
    pub against: Option<Against>,
    /// Where the expected value comes from.
    pub source: String,
    /// Why the tolerance, or the bound, is what it is.
    pub bound: Option<String>,
    /// The setting that it was run at: the paper's if the run has the publication's numbers, for whatever reason.
    pub level: Level,
    /// The runs that it uses, `None` for the case itself.
    pub runs: Vec<Option<String>>,
    /// Whether one of them takes long.
    pub is_long: bool,
    /// Whether the check passes.
    pub pass: bool,
    /// Why it is not met, as stated in the case; `None` if it passes, or should pass.
    pub unmet: Option<String>,
    /// Why it could not be evaluated, or how the run failed; `None` if only the number is off.
    pub reason: Option<String>,
    /// For checks of trends, the results of the members of the sweep.
    pub trend: Option<TrendData>,
}

/// The results of the members along a key of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct TrendData {
    /// Path of the key.
    pub key: String,
    /// Unit of the quantity.
    pub unit: String,
    /// Whether errors are evaluated instead of the quantity itself.
    pub of_error: bool,
    /// The members in their order.
    pub points: Vec<TrendPoint>,
}

/// The result of one member of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct TrendPoint {
    /// Name of the member.
    pub member: String,
    /// The value of the key as the case writes it.
    pub text: String,
    /// The value of the key, if it is a number.
    pub key: Option<f64>,
    /// The quantity.
    pub value: f64,
    /// Its distance from the expected value, if that is known.
    pub error: Option<f64>,
}

/// A result that a check evaluates.
#[derive(Clone, Debug, PartialEq)]
pub enum Got {
    /// A number with its unit.
    Number(f64, String),
    /// The outcome of the run.
    Text(String),
}

impl fmt::Display for Got {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(value, unit) => out.write_str(&format::with_unit(*value, unit)),
            Self::Text(text) => out.write_str(text),
        }
    }
}

/// The variants and members of sweeps that the checks of `case` refer to in its setting, in the order in which they
/// are needed; `None` is the case itself.
pub fn needed_variants(case: &Case) -> Vec<Option<String>> {
    let mut needed = Vec::new();
    for name in applicable(case).flat_map(|(_, check)| all_runs(case, check)) {
        if !needed.contains(&name) {
            needed.push(name);
        }
    }
    needed
}

/// The runs that a check looks at, with those that it compares with.
fn all_runs(case: &Case, check: &Check) -> Vec<Option<String>> {
    let mut names = own_runs(case, check);
    if let Some(other) = check.expectation.other() {
        names.push(other.map(|name| name.value.clone()));
    }
    names
}

/// The runs that a check is about, without those that it compares with.
fn own_runs(case: &Case, check: &Check) -> Vec<Option<String>> {
    match &check.members {
        None => vec![check.variant.as_ref().map(|name| name.value.clone())],
        Some(members) => {
            let sweep = &case.sweeps[*members.sweep];
            let indices = members.indices(sweep, case.level).into_iter();
            indices.map(|index| Some(sweep.member(index))).collect()
        }
    }
}

/// Evaluates the checks of `base` that apply in its setting, in their order.
///
/// `run` is called once for each variant of [`needed_variants`]. It applies the variant and the setting and runs the
/// case, or returns the reason why it cannot.
///
/// For a run that failed only `run.outcome` is evaluated, unless the case says that it fails: then the remaining
/// checks are evaluated on what it recorded. For an interrupted one nothing is evaluated.
pub fn verify<Run: RunResults>(base: &Case, run: &mut RunVariant<'_, Run>) -> Vec<CheckRow> {
    let variants = needed_variants(base);
    let runs = variants.into_iter().map(|variant| {
        let result = run(variant.as_deref());
        (variant, result)
    });
    let runs = Runs::new(base, runs.collect());
    let rows = applicable(base).flat_map(|(index, check)| {
        let mut rows = runs.rows(index, check);
        if let Some(why) = &check.unmet {
            excuse(&runs, &mut rows, why);
        }
        rows
    });
    rows.collect()
}

/// Gives the rows of a check that is known not to be met the reason; where all are met, there is
/// nothing to excuse, and the mark is the fault.
fn excuse<Run: RunResults>(runs: &Runs<'_, Run>, rows: &mut [CheckRow], why: &str) {
    if rows.iter().all(|row| row.pass) {
        for row in rows {
            row.pass = false;
            row.reason = Some("it is met, but marked as not met: remove `unmet`".to_owned());
        }
        return;
    }
    // What could not be evaluated is no known result, unless it is known why.
    let is_known = |row: &CheckRow| row.got.is_some() || runs.is_known_to_fail(row);
    for row in rows.iter_mut().filter(|row| !row.pass && is_known(row)) {
        row.unmet = Some(why.to_owned());
    }
}

/// The checks that apply in the setting of `case`, with their numbers.
fn applicable(case: &Case) -> impl Iterator<Item = (usize, &Check)> {
    case.checks.iter().enumerate().filter(|(_, check)| check.when.includes(case.level))
}
