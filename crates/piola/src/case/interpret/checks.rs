//! Checks.

use super::*;
use crate::case::model::{Check, Expectation, Probe, Quantity, Reduction, When};

/// The four ways to say what is expected, each with the keys that belong to it.
const WAYS: [&[&str]; 4] =
    [&["expected"], &["at_least", "at_most"], &["less_than"], &["more_than"]];

impl Reader<'_, '_> {
    pub(super) fn check(
        &mut self,
        record: &Record,
        probes: Option<&[Probe]>,
        end: Option<f64>,
    ) -> Option<Check> {
        let variant = record.text("variant").map(|name| self.variant_called(name));
        let quantity = record.text("quantity").and_then(|text| self.quantity(&text, probes));
        let when = match record.text("when")?.as_str() {
            "coarse" => When::Coarse,
            "full" => When::Full,
            _ => When::Always,
        };
        // The end of another variant or setting may be another one.
        let of_this_run = match &variant {
            Some(Some(Some(name))) => self.setting.variant == Some(name.as_str()),
            _ => self.setting.variant.is_none(),
        };
        let at_this_setting = match when {
            When::Coarse => self.setting.coarse,
            When::Always | When::Full => !self.setting.coarse,
        };
        let end = end.filter(|_| of_this_run && at_this_setting);
        let reduce = self.reduction(record, end);
        let is_outcome = quantity.as_deref() == Some(&Quantity::Run("outcome".to_owned()));
        let expectation = self.expectation(record, is_outcome);
        Some(Check {
            variant: variant??,
            quantity: quantity?,
            reduce: reduce?,
            expectation: expectation?,
            source: record.text("source")?.value,
            when,
        })
    }

    /// A variant by its name, `Some(None)` for the base case, `None` for an unknown one.
    fn variant_called(&mut self, name: Located<String>) -> Option<Option<Located<String>>> {
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
            ("number", &["extremum", "extremum_time", "zero_time"]),
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
        Some(match name.as_str() {
            "maximum" => Reduction::Maximum,
            "minimum" => Reduction::Minimum,
            "initial" => Reduction::Initial,
            "at" => Reduction::At(self.at(record.number("at")?, end)?),
            "mean" => Reduction::Mean,
            "range" => Reduction::Range,
            "period" => Reduction::Period,
            "extremum" => Reduction::Extremum(number),
            "extremum_time" => Reduction::ExtremumTime(number),
            "zero_time" => Reduction::ZeroTime(number),
            "largest_rise" => Reduction::LargestRise,
            "growth" => Reduction::Growth,
            "curve" => Reduction::Curve(self.file(record, "reference")?),
            "curve_rms" => Reduction::CurveRms(self.file(record, "reference")?),
            "final" => Reduction::Final,
            _ => return None,
        })
    }

    fn at(&mut self, time: Located<f64>, end: Option<f64>) -> Option<f64> {
        match end.filter(|end| time.value > *end) {
            None => Some(time.value),
            Some(end) => {
                let message = format!("the run ends at {end} s, before the time {}", time.value);
                self.refuse(Problem::new(time.place, message, "after the end"))
            }
        }
    }

    fn expectation(&mut self, record: &Record, is_outcome: bool) -> Option<Expectation> {
        let used = |keys: &&[&str]| keys.iter().any(|key| record.has(key));
        let ways: Vec<&[&str]> = WAYS.into_iter().filter(used).collect();
        let Some(way) = ways.first() else {
            let message = "the check says nothing of what is expected";
            return self.refuse(Problem::new(record.place, message, "nothing expected").help(
                "give `expected` and `tolerance`, `at_least`, `at_most`, `less_than` or `more_than`",
            ));
        };
        if let Some(second) = ways.get(1) {
            let message = "the check says in two ways what is expected";
            let problem = Problem::new(first_place(record, second), message, "the second way");
            return self.refuse(problem.help("make two checks of it"));
        }
        if way[0] != "expected" || is_outcome {
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

    fn expected(&mut self, record: &Record) -> Option<Expectation> {
        let place = record.value_place("expected");
        let expected = match record.text("expected") {
            Some(text) => self.context.constant(&text, place),
            None => record.number("expected").map(|number| number.value),
        };
        if !record.has("tolerance") {
            let message = "`expected` needs `tolerance` beside it";
            let problem = Problem::new(place, message, "`tolerance` is missing");
            return self
                .refuse(problem.help("0.01 is one per cent; or `absolute = true` with a value"));
        }
        let (expected, tolerance) = (expected?, record.number("tolerance")?);
        let absolute = record.boolean("absolute")?;
        if expected == 0.0 && !absolute {
            let message = "a share of 0 is 0: `tolerance` must be absolute here";
            let problem = Problem::new(tolerance.place, message, "relative to 0");
            return self.refuse(problem.help("add `absolute = true`"));
        }
        Some(Expectation::Value { expected, tolerance: tolerance.value, absolute })
    }

    /// The variant that a result is compared with, which must be another one.
    fn other(&mut self, record: &Record, key: &str) -> Option<Option<Located<String>>> {
        let name = record.text(key)?;
        let own = record.text("variant")?;
        if name.value == own.value {
            let message = format!("`{key}` compares the variant `{}` with itself", own.value);
            return self.refuse(Problem::new(name.place, message, "the same variant"));
        }
        self.variant_called(name)
    }
}
