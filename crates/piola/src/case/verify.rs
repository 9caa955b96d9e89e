//! Evaluation of a case's checks.
//!
//! [`verify`] asks for a run of each variant that a check looks at, once, and compares. A check
//! that cannot be evaluated fails with a reason: nothing passes by being skipped.

use std::fmt;

use super::model::{Case, Check, Expectation, Quantity, Reduction, When};
use super::simulation::Finished;
use crate::observe::Series;
use crate::output::Curve;
use crate::time::Outcome;
pub use format::significant;

mod format;
#[cfg(test)]
mod tests;

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

/// A run that is over, as checks see it.
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

/// A run with the case that was run: the variant has parameters and checks of its own.
pub struct VariantRun<Run> {
    /// The case with the overrides of the variant and of the setting.
    pub case: Case,
    /// What came of it.
    pub run: Run,
}

/// Runs the variant of this name (`None`: the case itself), or says why it cannot.
pub type RunVariant<'a, Run> = dyn FnMut(Option<&str>) -> Result<VariantRun<Run>, String> + 'a;

/// One line of the table of `piola verify`.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckRow {
    /// The case's row of the reproduction list.
    pub id: Option<String>,
    /// The variant that was run, `None` for the case itself.
    pub variant: Option<String>,
    /// The quantity with its reduction: `top.displacement.y maximum`.
    pub quantity: String,
    /// What the run gave, `None` if there is no such thing.
    pub got: Option<Got>,
    /// What was expected: `0.2 m`, `at most 1e-9 J`, `less than damped (0.31 m)`.
    pub expected: String,
    /// How far off the result may be: `1 %`, `0.01 m`; empty for bounds and comparisons.
    pub tolerance: String,
    /// Where the expected value comes from.
    pub source: String,
    /// Whether the check passes.
    pub pass: bool,
    /// Why it could not be evaluated, or how the run failed; `None` if only the number is off.
    pub reason: Option<String>,
}

/// A result that a check looks at.
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

/// The variants that the checks of `case` look at in its setting, in the order in which they are
/// needed; `None` is the case itself.
pub fn needed_variants(case: &Case) -> Vec<Option<String>> {
    let mut needed = Vec::new();
    for check in applicable(case).map(|(_, check)| check) {
        let own = check.variant.as_ref();
        let other = match &check.expectation {
            Expectation::LessThan(other) | Expectation::MoreThan(other) => Some(other.as_ref()),
            _ => None,
        };
        for variant in [Some(own), other].into_iter().flatten() {
            let name = variant.map(|name| name.value.clone());
            if !needed.contains(&name) {
                needed.push(name);
            }
        }
    }
    needed
}

/// Evaluates the checks of `base` that apply in its setting, coarse or full, in their order.
///
/// `run` is called once for each variant of [`needed_variants`]. It applies the variant and the
/// setting, runs, and says why where it cannot.
///
/// Of a run that failed only `run.outcome` is looked at, unless the case says that it fails: then
/// the rest of its checks are evaluated on what it recorded. Of an interrupted one nothing is.
pub fn verify<Run: RunResults>(base: &Case, run: &mut RunVariant<'_, Run>) -> Vec<CheckRow> {
    let variants = needed_variants(base);
    let runs = variants.into_iter().map(|variant| {
        let result = run(variant.as_deref());
        (variant, result)
    });
    let runs = Runs(runs.collect());
    applicable(base).map(|(index, check)| runs.row(base, index, check)).collect()
}

/// The checks that apply in the setting of `case`, with their numbers.
fn applicable(case: &Case) -> impl Iterator<Item = (usize, &Check)> {
    case.checks.iter().enumerate().filter(|(_, check)| match check.when {
        When::Always => true,
        When::Coarse => case.is_coarse,
        When::Full => !case.is_coarse,
    })
}

/// A variant's name with what came of it.
type NamedRun<Run> = (Option<String>, Result<VariantRun<Run>, String>);

struct Runs<Run>(Vec<NamedRun<Run>>);

impl<Run: RunResults> Runs<Run> {
    fn find(&self, variant: Option<&str>) -> Result<&VariantRun<Run>, String> {
        match self.0.iter().find(|(name, _)| name.as_deref() == variant) {
            Some((_, Ok(run))) => Ok(run),
            Some((_, Err(reason))) => Err(reason.clone()),
            None => Err(format!("there is no run of {}", variant_text(variant))),
        }
    }

    fn row(&self, base: &Case, index: usize, check: &Check) -> CheckRow {
        let variant = check.variant.as_ref().map(|name| name.value.as_str());
        let found = self.find(variant);
        // A variant may change parameters that its expected values are computed from.
        let check = match found {
            Ok(run) => run.case.checks.get(index).unwrap_or(check),
            Err(_) => check,
        };
        let (expected, tolerance) = format::expectation(&check.expectation, "");
        let mut row = CheckRow {
            id: base.id.clone(),
            variant: variant.map(str::to_owned),
            quantity: label(check),
            got: None,
            expected,
            tolerance,
            source: check.source.clone(),
            pass: false,
            reason: None,
        };
        let verdict = found.and_then(|run| {
            let got = measure(run, check)?;
            let unit = match &got {
                Got::Number(_, unit) => unit,
                Got::Text(_) => "",
            };
            (row.expected, row.tolerance) = format::expectation(&check.expectation, unit);
            row.got = Some(got.clone());
            self.compare(&mut row, run, check, &got)
        });
        match verdict {
            Ok(pass) => row.pass = pass,
            Err(reason) => row.reason = Some(reason),
        }
        row
    }

    /// Whether `got` is as expected, or why that cannot be said.
    fn compare(
        &self,
        row: &mut CheckRow,
        run: &VariantRun<Run>,
        check: &Check,
        got: &Got,
    ) -> Result<bool, String> {
        let number = match got {
            Got::Number(value, _) if value.is_finite() => Ok(*value),
            Got::Number(value, _) => Err(format!("the result is {value}, no finite number")),
            Got::Text(_) => Err("the quantity is a text, and a number is expected".to_owned()),
        };
        match &check.expectation {
            Expectation::Outcome(expected) => {
                let Got::Text(text) = got else {
                    return Err("the quantity is a number, and a text is expected".to_owned());
                };
                let pass = text == expected;
                if !pass {
                    row.reason = run.run.ending().message;
                }
                Ok(pass)
            }
            Expectation::Value { expected, tolerance, absolute } => {
                let number = number?;
                if !absolute && *expected == 0.0 {
                    return Err("a tolerance relative to 0 allows nothing: set `absolute = true`"
                        .to_owned());
                }
                let allowed = if *absolute { *tolerance } else { tolerance * expected.abs() };
                Ok((number - expected).abs() <= allowed)
            }
            Expectation::Bounds { at_least, at_most } => {
                let number = number?;
                Ok(at_least.is_none_or(|least| number >= least)
                    && at_most.is_none_or(|most| number <= most))
            }
            Expectation::LessThan(other) => {
                Ok(number? < self.other(row, check, "less than", other.as_deref())?)
            }
            Expectation::MoreThan(other) => {
                Ok(number? > self.other(row, check, "more than", other.as_deref())?)
            }
        }
    }

    /// The same quantity of another variant, which is shown in the row.
    fn other(
        &self,
        row: &mut CheckRow,
        check: &Check,
        relation: &str,
        variant: Option<&String>,
    ) -> Result<f64, String> {
        let variant = variant.map(String::as_str);
        let explain = |reason| format!("{}: {reason}", variant_text(variant));
        let run = self.find(variant).map_err(explain)?;
        match measure(run, check).map_err(explain)? {
            Got::Number(value, unit) if value.is_finite() => {
                let name = variant.unwrap_or("base");
                row.expected = format!("{relation} {name} ({})", format::with_unit(value, &unit));
                Ok(value)
            }
            got => Err(explain(format!("the result is {got}, no finite number"))),
        }
    }
}

/// What the run gives for `check`.
fn measure<Run: RunResults>(run: &VariantRun<Run>, check: &Check) -> Result<Got, String> {
    let name = check.quantity.name();
    let about_outcome = matches!(&check.quantity.value, Quantity::Run(name) if name == "outcome");
    if !about_outcome && !is_as_announced(run) {
        return Err(match run.run.ending().message {
            Some(message) => format!("the run failed: {message}"),
            None => "the run was interrupted".to_owned(),
        });
    }
    match run.run.quantity(&name) {
        None => Err(format!("the run has no quantity `{name}`")),
        Some(Series::Text(text)) => Ok(Got::Text(text)),
        Some(Series::Number { value, unit }) => Ok(Got::Number(value, unit.to_owned())),
        Some(Series::Curve { time, values, unit }) => {
            let reduction = check
                .reduce
                .try_map(|file| Curve::read_csv(file))
                .map_err(|error| format!("the reference curve cannot be used: {error}"))?;
            let value = reduction.apply(&time, &values).map_err(|error| error.to_string())?;
            Ok(Got::Number(value, reduction.unit(&unit).to_owned()))
        }
    }
}

/// Whether the run is complete, or failed in the way that a check of the same variant expects.
fn is_as_announced<Run: RunResults>(run: &VariantRun<Run>) -> bool {
    let ending = run.run.ending();
    if ending.summary == Outcome::Completed.summary() {
        return true;
    }
    // An interrupted run has shown nothing.
    if ending.message.is_none() {
        return false;
    }
    let summary = ending.summary;
    applicable(&run.case).any(|(_, check)| {
        let own = check.variant.as_ref().map(|name| &name.value) == run.case.variant.as_ref();
        own && check.expectation == Expectation::Outcome(summary.clone())
    })
}

/// The quantity with its reduction. The numbers of a run have no history.
fn label(check: &Check) -> String {
    match (&check.quantity.value, &check.reduce) {
        (Quantity::Run(_), _) => check.quantity.name(),
        (quantity, reduce) => format!("{} {}", quantity.name(), Reduction::label(reduce)),
    }
}

fn variant_text(variant: Option<&str>) -> String {
    match variant {
        Some(name) => format!("the variant `{name}`"),
        None => "the case itself".to_owned(),
    }
}
