//! Checks.

use super::members::is_error;
use super::observers::line_of;
use super::sweeps::when;
use super::*;
use crate::case::model::{
    Against, Check, Expectation, Level, Probe, Quantity, Reduction, Sweep, Trend, When, member_of,
};
use crate::case::suggest::one_of;

/// The ways to say what is expected, each with the keys that belong to it.
const WAYS: [&[&str]; 8] = [
    &["expected"],
    &["at_least", "at_most"],
    &["less_than"],
    &["more_than"],
    &["equal_to"],
    &["order"],
    &["monotone"],
    &["ratio"],
];
/// Those of them that say how the members of a sweep follow each other.
const TRENDS: [&str; 3] = ["order", "monotone", "ratio"];
/// The reductions that a profile has.
const ALONG_LINES: [&str; 11] = [
    "maximum",
    "minimum",
    "final",
    "initial",
    "at",
    "mean",
    "range",
    "extremum",
    "zero_place",
    "curve",
    "curve_rms",
];

/// What a check may refer to, as far as it could be read.
#[derive(Clone, Copy)]
pub(super) struct Known<'a> {
    /// The probes of the case.
    pub probes: Option<&'a [Probe]>,
    /// The sweeps of the case.
    pub sweeps: Option<&'a [Sweep]>,
    /// The time at which the run ends.
    pub end: Option<f64>,
}

/// What an expected value is worth, by its name.
fn against(name: &str) -> Option<Against> {
    Against::ALL.into_iter().find(|known| known.name() == name)
}

impl Reader<'_, '_> {
    pub(super) fn check(&mut self, record: &Record, known: Known<'_>) -> Option<Check> {
        let variant = record.text("variant").map(|name| self.variant_called(name));
        let quantity = record.text("quantity").and_then(|text| self.quantity(&text, known.probes));
        let mut when = when(record)?;
        let trend = TRENDS.into_iter().find(|key| record.has(key));
        let members = match record.text("sweep") {
            None if record.has("sweep") => return None,
            None => {
                self.only_for_sweeps(record);
                None
            }
            Some(name) => {
                let sweep = self.sweep_called(&name, known.sweeps?)?;
                when = self.common_setting(record, when, &known.sweeps?[*sweep])?;
                Some(self.members(record, sweep, known.sweeps?, trend, when)?)
            }
        };
        // The end of another variant or setting may be another one.
        let of_this_run = match (&members, &variant) {
            (Some(members), _) => {
                let own = self.setting.variant.and_then(member_of);
                let sweep = &known.sweeps?[*members.sweep];
                own.is_some_and(|(name, index)| {
                    name == *sweep.name && members.includes(sweep, index, self.setting.level)
                })
            }
            (None, Some(Some(Some(name)))) => self.setting.variant == Some(name.as_str()),
            _ => self.setting.variant.is_none(),
        };
        let at_this_setting = match when {
            When::Always => self.setting.level == Level::Case,
            When::At(level) => self.setting.level == level,
        };
        // `at` is a place where the quantity is one of a line, which only the probes tell.
        let end = known.end.filter(|_| of_this_run && at_this_setting && known.probes.is_some());
        if let Some(Quantity::Run(name)) = quantity.as_deref() {
            for key in ["window", "smooth"] {
                self.meaningless(record, key, &format!("for `run.{name}`, which has no history"));
            }
        }
        let line = quantity.as_ref().zip(known.probes);
        let line = line.and_then(|(quantity, probes)| line_of(quantity, probes));
        let reduce = match line {
            Some(line) => self.along_line(record, line),
            None => self.over_time(record, end),
        };
        let is_outcome = quantity.as_deref() == Some(&Quantity::Run("outcome".to_owned()));
        let expectation = self.expectation(record, is_outcome);
        if let (Some(members), Some(reduce), Some(expectation)) = (&members, &reduce, &expectation)
            && when.includes(self.setting.level)
        {
            let is_error = is_error(reduce, expectation);
            self.enough_members(record, members, known.sweeps?, trend, is_error)?;
        }
        Some(Check {
            variant: variant??,
            members,
            quantity: quantity?,
            reduce: reduce?,
            expectation: expectation?,
            against: record.text("against").and_then(|name| against(&name)),
            source: record.text("source")?.value,
            reason: record.text("reason").map(|reason| reason.value),
            unmet: record.text("unmet").map(|why| why.value),
            when,
        })
    }

    /// A variant by its name, `Some(None)` for the base case, `None` for an unknown one.
    pub(super) fn variant_called(
        &mut self,
        name: Located<String>,
    ) -> Option<Option<Located<String>>> {
        if *name == "base" {
            return Some(None);
        }
        if self.names.variants.contains(&name.value) {
            return Some(Some(name));
        }
        let message = format!("there is no variant `{}`", name.value);
        let names = self.names.variants.iter().map(String::as_str).chain(["base"]);
        let help = suggestion(&name.value, names);
        self.refuse(Problem::new(name.place, message, "unknown variant").help(help))
    }

    fn reduction(&mut self, record: &Record, end: Option<f64>) -> Option<Reduction> {
        let name = record.text("reduce")?;
        let only_for = |names: &[&str]| !names.contains(&name.as_str());
        for (key, names) in [
            ("at", &["at"][..]),
            ("number", &["extremum", "extremum_time", "zero_time", "zero_place"]),
            ("reference", &["curve", "curve_rms"]),
        ] {
            if only_for(names) {
                self.meaningless(record, key, &format!("with the reduction `{}`", name.value));
            } else if !record.has(key) && key != "number" {
                let message = format!("the reduction `{}` needs the key `{key}`", name.value);
                self.report(Problem::new(name.place, message, format!("`{key}` is missing")));
            }
        }
        let number = record.whole("number")?.value;
        let reduction = match name.as_str() {
            "at" => Reduction::At(self.at(record.number("at")?, end)?),
            "extremum" => Reduction::Extremum(number),
            "extremum_time" => Reduction::ExtremumTime(number),
            "zero_time" => Reduction::ZeroTime(number),
            "zero_place" => Reduction::ZeroPlace(number),
            "curve" => Reduction::Curve(self.file(record, "reference")?),
            "curve_rms" => Reduction::CurveRms(self.file(record, "reference")?),
            plain => Reduction::plain(plain)?,
        };
        let reduction = match record.has("smooth") {
            true => Reduction::Smoothed(*record.number("smooth")?, Box::new(reduction)),
            false => reduction,
        };
        match record.has("window") {
            true => Some(Reduction::Within(self.window(record, end)?, Box::new(reduction))),
            false => Some(reduction),
        }
    }

    /// A reduction of a history against time.
    fn over_time(&mut self, record: &Record, end: Option<f64>) -> Option<Reduction> {
        let name = record.text("reduce")?;
        if name.as_str() == "zero_place" {
            let message = "the reduction `zero_place` is for a line, and this is a history";
            let problem = Problem::new(name.place, message, "no place here");
            return self.refuse(problem.help("against time it is `zero_time`"));
        }
        self.reduction(record, end)
    }

    /// A reduction of a profile: one that has a meaning for values at places.
    fn along_line(&mut self, record: &Record, line: &Probe) -> Option<Reduction> {
        let name = record.text("reduce")?;
        for key in ["window", "smooth"] {
            self.meaningless(record, key, &format!("along the line `{}`", *line.name));
        }
        if ALONG_LINES.contains(&name.as_str()) {
            let reduction = match self.reduction(record, None)? {
                Reduction::Within(_, reduction) => *reduction,
                reduction => reduction,
            };
            let length = line.kind.length().unwrap_or_default();
            if let Reduction::At(place) = reduction
                && !(place <= length)
            {
                let message = format!("the line is {length} m long, and ends before {place} m");
                let place = record.value_place("at");
                return self.refuse(Problem::new(place, message, "after the end"));
            }
            return Some(reduction);
        }
        let message = format!(
            "the reduction `{}` has no meaning along the line `{}`",
            name.value, *line.name
        );
        let help = format!("expected {}", one_of(ALONG_LINES));
        self.refuse(Problem::new(name.place, message, "no meaning here").help(help))
    }

    /// Two times in order, of a run that ends at `end`.
    fn window(&mut self, record: &Record, end: Option<f64>) -> Option<[f64; 2]> {
        let given = record.numbers("window")?;
        let [first, last] = given.value[..] else {
            let message = format!("expected two times, got {}", given.value.len());
            return self.refuse(Problem::new(given.place, message, "not two"));
        };
        if !(first < last) {
            let message = format!("the window ends at {last} s, not after its start at {first} s");
            return self.refuse(Problem::new(given.place, message, "not in order"));
        }
        self.at(Located::new(last, given.place), end)?;
        Some([first, last])
    }

    fn at(&mut self, time: Located<f64>, end: Option<f64>) -> Option<f64> {
        match end.filter(|end| time.value > *end) {
            None => Some(time.value),
            Some(_) if self.setting.is_changed => {
                self.late.checks.push(time.value);
                Some(time.value)
            }
            Some(end) => {
                let message = format!("the run ends at {end} s, before the time {}", time.value);
                self.refuse(Problem::new(time.place, message, "after the end"))
            }
        }
    }

    fn expectation(&mut self, record: &Record, is_outcome: bool) -> Option<Expectation> {
        let used = |keys: &&[&str]| keys.iter().any(|key| record.has(key));
        let mut ways: Vec<&[&str]> = WAYS.into_iter().filter(used).collect();
        // A trend may be that of the error to an expected value.
        if ways.iter().any(|way| TRENDS.contains(&way[0])) {
            ways.retain(|way| way[0] != "expected");
        }
        let Some(way) = ways.first() else {
            let message = "the check gives no expected value";
            return self.refuse(Problem::new(record.place, message, "nothing expected").help(
                "give `expected` and `tolerance`, `at_least`, `at_most`, `less_than`, `more_than` or \
                 `equal_to`, or of a sweep `order`, `monotone` or `ratio`",
            ));
        };
        if let Some(second) = ways.get(1) {
            let message = "the check gives the expected value in two ways";
            let problem = Problem::new(first_place(record, second), message, "the second way");
            return self.refuse(problem.help("make two checks of it"));
        }
        if !["expected", "equal_to"].contains(&way[0]) || is_outcome {
            for key in ["tolerance", "absolute"] {
                self.meaningless(record, key, "here");
            }
        }
        match way[0] {
            "expected" if is_outcome => self.outcome(record),
            _ if is_outcome => {
                let message = "`run.outcome` is text, which can be compared with `expected` only";
                self.refuse(Problem::new(first_place(record, way), message, "needs a number"))
            }
            "expected" => self.expected(record),
            "at_least" => {
                let bound = |key| record.number(key).map(|number| number.value);
                Some(Expectation::Bounds { at_least: bound("at_least"), at_most: bound("at_most") })
            }
            "less_than" => self.other(record, "less_than").map(Expectation::LessThan),
            "equal_to" => {
                let other = self.other(record, "equal_to")?;
                let (tolerance, absolute) = self.tolerance(record, "equal_to")?;
                Some(Expectation::EqualTo { other, tolerance: tolerance.value, absolute })
            }
            "order" | "monotone" | "ratio" => self.trend(record, way[0]),
            _ => self.other(record, "more_than").map(Expectation::MoreThan),
        }
    }

    fn outcome(&mut self, record: &Record) -> Option<Expectation> {
        if let Some(text) = record.text("expected") {
            return Some(Expectation::Outcome(text.value));
        }
        let message = "the outcome of a run is text, for example \"completed\"";
        self.refuse(Problem::new(record.value_place("expected"), message, "expected text"))
    }

    fn trend(&mut self, record: &Record, key: &str) -> Option<Expectation> {
        let trend = match key {
            "order" => Trend::Order(record.ends("order")?.value),
            "ratio" => Trend::Ratio(record.ends("ratio")?.value),
            _ => match record.text("monotone")?.as_str() {
                "increasing" => Trend::Increasing,
                _ => Trend::Decreasing,
            },
        };
        let expected = match record.has("expected") {
            true => Some(self.expected_number(record)?),
            false => None,
        };
        Some(Expectation::Trend { trend, expected })
    }

    fn expected_number(&mut self, record: &Record) -> Option<f64> {
        match record.text("expected") {
            Some(text) => self.context.constant(&text, record.value_place("expected")),
            None => record.number("expected").map(|number| number.value),
        }
    }

    fn expected(&mut self, record: &Record) -> Option<Expectation> {
        let expected = self.expected_number(record);
        let (tolerance, absolute) = self.tolerance(record, "expected")?;
        let expected = expected?;
        if expected == 0.0 && !absolute {
            let message = "a tolerance relative to 0 is 0: `tolerance` must be absolute here";
            let problem = Problem::new(tolerance.place, message, "relative to 0");
            return self.refuse(problem.help("add `absolute = true`"));
        }
        Some(Expectation::Value { expected, tolerance: tolerance.value, absolute })
    }

    /// The tolerance that belongs to the value of `key`, and whether it is absolute.
    fn tolerance(&mut self, record: &Record, key: &str) -> Option<(Located<f64>, bool)> {
        if !record.has("tolerance") {
            let message = format!("`{key}` needs `tolerance` beside it");
            let place = record.value_place(key);
            let problem = Problem::new(place, message, "`tolerance` is missing");
            return self
                .refuse(problem.help("0.01 is one per cent; or `absolute = true` with a value"));
        }
        Some((record.number("tolerance")?, record.boolean("absolute")?))
    }

    /// The variant that a result is compared with, which must be another one.
    fn other(&mut self, record: &Record, key: &str) -> Option<Option<Located<String>>> {
        let name = record.text(key)?;
        let own = record.text("variant")?;
        if name.value == own.value && !record.has("sweep") {
            let message = format!("`{key}` compares the variant `{}` with itself", own.value);
            return self.refuse(Problem::new(name.place, message, "the same variant"));
        }
        self.variant_called(name)
    }
}
