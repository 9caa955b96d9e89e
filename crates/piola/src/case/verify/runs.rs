//! The rows of checks, from the runs that they are about.

use super::{
    CheckRow, Got, NotRun, RunResults, TrendData, TrendPoint, VariantRun, applicable, format,
    own_runs, trends,
};
use crate::case::model::{
    Case, Check, Expectation, Level, Quantity, Reduction, Sweep, Trend, coordinates,
};
use crate::observe::Series;
use crate::output::Curve;
use crate::time::Outcome;

/// A variant's name with what came of it.
type NamedRun<Run> = (Option<String>, Result<VariantRun<Run>, NotRun>);

/// The runs of a case, with the case itself.
pub(super) struct Runs<'a, Run> {
    base: &'a Case,
    list: Vec<NamedRun<Run>>,
}

impl<'a, Run: RunResults> Runs<'a, Run> {
    pub(super) fn new(base: &'a Case, list: Vec<NamedRun<Run>>) -> Self {
        Self { base, list }
    }

    /// The rows of one check: one for each member of a sweep, or one for each line of members of
    /// which it says how they follow each other.
    pub(super) fn rows(&self, index: usize, check: &Check) -> Vec<CheckRow> {
        match (&check.members, &check.expectation) {
            (Some(members), Expectation::Trend { trend, .. }) => {
                let sweep = &self.base.sweeps[*members.sweep];
                let lines = members.lines(sweep, self.base.level);
                let along = members.along.unwrap_or_default();
                let rows = lines.iter().map(|line| {
                    let line = Line { sweep, along, members: line };
                    self.trend_row(index, check, &line, *trend)
                });
                rows.collect()
            }
            _ => {
                let names = own_runs(self.base, check);
                names.iter().map(|name| self.row(index, check, name.as_deref())).collect()
            }
        }
    }

    fn find(&self, variant: Option<&str>) -> Result<&VariantRun<Run>, String> {
        match self.list.iter().find(|(name, _)| name.as_deref() == variant) {
            Some((_, Ok(run))) => Ok(run),
            Some((_, Err(missing))) => Err(missing.reason.clone()),
            None => Err(format!("there is no run of {}", variant_text(variant))),
        }
    }

    /// Whether a run behind `row` failed, and a check of its outcome says that this is known.
    pub(super) fn is_known_to_fail(&self, row: &CheckRow) -> bool {
        let mut runs = row.runs.iter().filter_map(|name| self.find(name.as_deref()).ok());
        runs.any(|run| {
            run.run.ending().message.is_some()
                && of_outcome(run).any(|(_, check)| check.unmet.is_some())
        })
    }

    /// The case with the overrides of a variant, whether it was run or not.
    fn case_of(&self, variant: Option<&str>) -> Option<&Case> {
        let (_, found) = self.list.iter().find(|(name, _)| name.as_deref() == variant)?;
        match found {
            Ok(run) => Some(&run.case),
            Err(missing) => missing.case.as_deref(),
        }
    }

    /// A row of which nothing is known yet, of the runs `runs`.
    fn blank(
        &self,
        index: usize,
        check: &Check,
        run: Option<String>,
        runs: Vec<Option<String>>,
    ) -> CheckRow {
        let traits = runs.iter().map(|name| self.base.traits_of(name.as_deref()));
        let is_paper = traits.clone().all(|traits| traits.is_paper);
        let is_long = traits.clone().any(|traits| traits.is_long);
        let (expected, tolerance) = format::expectation(&check.expectation, "");
        CheckRow {
            check: index,
            id: self.base.id.clone(),
            run,
            quantity: label(check),
            got: None,
            expected,
            tolerance,
            deviation: String::new(),
            against: check.against,
            source: check.source.clone(),
            bound: check.reason.clone(),
            level: if is_paper { Level::Paper } else { self.base.level },
            runs,
            is_long,
            pass: false,
            unmet: None,
            reason: None,
            trend: None,
        }
    }

    fn row(&self, index: usize, check: &Check, variant: Option<&str>) -> CheckRow {
        let found = self.find(variant);
        // A variant may change parameters that its expected values are computed from.
        let own = self.case_of(variant).and_then(|case| case.checks.get(index));
        let check = own.unwrap_or(check);
        let run = variant.map(|name| match self.base.member_label(name) {
            Some(values) => format!("{name} ({values})"),
            None => name.to_owned(),
        });
        let mut names = vec![variant.map(str::to_owned)];
        if let Some(other) = check.expectation.other() {
            names.push(other.map(|name| name.value.clone()));
        }
        let mut row = self.blank(index, check, run, names);
        let verdict = found.and_then(|run| {
            let unit = unit_of(run, check);
            (row.expected, row.tolerance) = format::expectation(&check.expectation, &unit);
            let got = measure(run, check)?;
            row.got = Some(got.clone());
            self.compare(&mut row, run, check, &got)
        });
        match verdict {
            Ok(pass) => row.pass = pass,
            Err(reason) => row.reason = Some(reason),
        }
        row
    }

    fn trend_row(&self, index: usize, check: &Check, line: &Line, trend: Trend) -> CheckRow {
        let names = line.members.iter().map(|member| Some(line.sweep.member(*member)));
        let run = Some(line.label(self.base.level));
        let mut row = self.blank(index, check, run, names.collect());
        let keys = line.sweep.keys(self.base.level);
        row.expected = format!("{} along {}", row.expected, keys[line.along].path.value);
        let verdict = self.trend_data(index, line).and_then(|data| {
            let judged = trends::judge(trend, &data);
            row.trend = Some(data);
            judged
        });
        match verdict {
            Ok(verdict) => {
                row.pass = verdict.pass;
                row.got = Some(verdict.got);
                row.reason = verdict.reason;
            }
            Err(reason) => row.reason = Some(reason),
        }
        row
    }

    /// What the members of a line gave, each by the check with its own parameters.
    fn trend_data(&self, index: usize, line: &Line) -> Result<TrendData, String> {
        let level = self.base.level;
        let key = &line.sweep.keys(level)[line.along];
        let mut data = TrendData {
            key: key.path.value.clone(),
            unit: String::new(),
            of_error: false,
            points: Vec::new(),
        };
        for &member in line.members {
            let name = line.sweep.member(member);
            let explain =
                |reason| format!("{name} ({}): {reason}", line.sweep.label(member, level));
            let run = self.find(Some(&name)).map_err(explain)?;
            let check = run.case.checks.get(index).ok_or_else(|| explain("no check".to_owned()))?;
            let (value, unit) = match measure(run, check).map_err(explain)? {
                Got::Number(value, unit) if value.is_finite() => (value, unit),
                got => return Err(explain(format!("the result is {got}, not a finite number"))),
            };
            let expected = match &check.expectation {
                Expectation::Trend { expected, .. } => *expected,
                _ => None,
            };
            let is_error = check.reduce.reference().is_some();
            let error = expected.map(|expected| (value - expected).abs());
            let number = coordinates(line.sweep.keys(level), member)[line.along];
            // The value of a key may depend on parameters, which are those of the member.
            let own = run.case.sweeps.iter().find(|sweep| *sweep.name == *line.sweep.name);
            let own = own.and_then(|sweep| sweep.keys(level).get(line.along)?.values.get(number));
            data.unit = unit;
            data.of_error = expected.is_some() || is_error;
            data.points.push(TrendPoint {
                member: name,
                text: key.values[number].text.clone(),
                key: own.and_then(|value| value.number),
                value,
                error: error.or(is_error.then_some(value.abs())),
            });
        }
        Ok(data)
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
            Got::Number(value, _) => Err(format!("the result is {value}, not a finite number")),
            Got::Text(_) => Err("the quantity is text, and a number is expected".to_owned()),
        };
        match &check.expectation {
            Expectation::Outcome(expected) => {
                let Got::Text(text) = got else {
                    return Err("the quantity is a number, and text is expected".to_owned());
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
                Ok(is_within(row, number, *expected, (*tolerance, *absolute), got))
            }
            Expectation::EqualTo { other, tolerance, absolute } => {
                let expected = self.other(row, check, "equal to", other.as_deref())?;
                Ok(is_within(row, number?, expected, (*tolerance, *absolute), got))
            }
            Expectation::Bounds { at_least, at_most } => {
                let number = number?;
                Ok(at_least.is_none_or(|least| number >= least)
                    && at_most.is_none_or(|most| number <= most))
            }
            Expectation::Trend { .. } => Err("a single run has no trend".to_owned()),
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
            got => Err(explain(format!("the result is {got}, not a finite number"))),
        }
    }
}

/// Whether `number` is as near to `expected` as it should be; the difference is shown in the row.
fn is_within(
    row: &mut CheckRow,
    number: f64,
    expected: f64,
    (tolerance, absolute): (f64, bool),
    got: &Got,
) -> bool {
    let allowed = if absolute { tolerance } else { tolerance * expected.abs() };
    let unit = match got {
        Got::Number(_, unit) => unit,
        Got::Text(_) => "",
    };
    row.deviation = format::deviation(number, expected, absolute, unit);
    (number - expected).abs() <= allowed
}

/// Members of a sweep along one of its keys.
struct Line<'a> {
    sweep: &'a Sweep,
    along: usize,
    members: &'a [usize],
}

impl Line<'_> {
    /// The sweep, and the value of the other key if there is one.
    fn label(&self, level: Level) -> String {
        let keys = self.sweep.keys(level);
        let numbers = coordinates(keys, self.members.first().copied().unwrap_or_default());
        let others = keys.iter().zip(numbers).enumerate();
        let others: Vec<String> = others
            .filter(|(key, _)| *key != self.along)
            .map(|(_, (key, number))| format!("{}={}", key.path.value, key.values[number].text))
            .collect();
        match others.is_empty() {
            true => format!("sweep {}", self.sweep.name.value),
            false => format!("sweep {} ({})", self.sweep.name.value, others.join(", ")),
        }
    }
}

/// The unit of what the run gives for `check`, also where it gives nothing, such as the time of a zero that is not
/// reached.
fn unit_of<Run: RunResults>(run: &VariantRun<Run>, check: &Check) -> String {
    match run.run.quantity(&check.quantity.name()) {
        Some(Series::Number { unit, .. }) => unit.to_owned(),
        Some(Series::Curve { unit, .. }) => check.reduce.unit(&unit),
        Some(Series::Text(_)) | None => String::new(),
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
        Some(Series::Curve { abscissa, values, unit, .. }) => {
            let reduction = check
                .reduce
                .try_map(|file| Curve::read_csv(file))
                .map_err(|error| format!("the reference curve cannot be used: {error}"))?;
            let value = reduction.apply(&abscissa, &values).map_err(|error| error.to_string())?;
            Ok(Got::Number(value, reduction.unit(&unit)))
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
    of_outcome(run).any(|(outcome, _)| *outcome == ending.summary)
}

/// What checks expect of the outcome of a run, with the checks.
fn of_outcome<Run>(run: &VariantRun<Run>) -> impl Iterator<Item = (&String, &Check)> {
    applicable(&run.case).filter_map(|(_, check)| match &check.expectation {
        Expectation::Outcome(outcome) => Some((outcome, check))
            .filter(|_| own_runs(&run.case, check).contains(&run.case.variant)),
        _ => None,
    })
}

/// The quantity with its reduction. The numbers of a run have no history.
fn label(check: &Check) -> String {
    let quantity = match (&check.quantity.value, &check.reduce) {
        (Quantity::Run(_), _) => check.quantity.name(),
        (quantity, reduce) => format!("{} {}", quantity.name(), Reduction::label(reduce)),
    };
    match &check.expectation {
        Expectation::Trend { expected: Some(_), .. } => format!("error of {quantity}"),
        _ => quantity,
    }
}

fn variant_text(variant: Option<&str>) -> String {
    match variant {
        Some(name) => format!("the variant `{name}`"),
        None => "the case itself".to_owned(),
    }
}
