//! The members of a sweep that a check looks at.

use super::sweeps::text_of;
use super::*;
use crate::case::document::{Node, Value};
use crate::case::model::{Expectation, Level, Members, Reduction, Sweep, SweepValue, Trend, When};
use crate::case::suggest::one_of;

impl Reader<'_, '_> {
    /// Reports keys that only checks of sweeps have.
    pub(super) fn only_for_sweeps(&mut self, record: &Record) {
        for key in ["member", "along", "order", "monotone", "ratio"] {
            if let Some(place) = record.key_place(key) {
                let message = format!("`{key}` needs a sweep");
                self.report(
                    Problem::new(place, message, "of which sweep?")
                        .help("name it with `sweep = \"NAME\"`"),
                );
            }
        }
    }

    /// The number of the sweep called `name`.
    pub(super) fn sweep_called(
        &mut self,
        name: &Located<String>,
        sweeps: &[Sweep],
    ) -> Option<Located<usize>> {
        let index = sweeps.iter().position(|sweep| *sweep.name == **name);
        let Some(index) = index else {
            let message = format!("there is no sweep `{}`", name.value);
            let names: Vec<&str> = sweeps.iter().map(|sweep| sweep.name.as_str()).collect();
            let help = match names.is_empty() {
                true => "the case has no `[[sweep]]` yet".to_owned(),
                false => suggestion(name, names),
            };
            return self.refuse(Problem::new(name.place, message, "unknown sweep").help(help));
        };
        Some(Located::new(index, name.place))
    }

    /// The setting of a check of a sweep, which is there at some settings only.
    pub(super) fn common_setting(
        &mut self,
        record: &Record,
        check: When,
        sweep: &Sweep,
    ) -> Option<When> {
        match (check, sweep.when) {
            (When::Always, when) | (when, When::Always) => Some(when),
            (check, when) if check == when => Some(when),
            _ => {
                let message = format!("there is no sweep `{}` at this setting", *sweep.name);
                let problem = Problem::new(record.value_place("when"), message, "never evaluated");
                self.refuse(problem.help("`when` of the sweep says the other setting"))
            }
        }
    }

    /// The members that a check looks at, and the key along which they follow each other.
    pub(super) fn members(
        &mut self,
        record: &Record,
        sweep: Located<usize>,
        sweeps: &[Sweep],
        trend: Option<&str>,
        when: When,
    ) -> Option<Members> {
        if let Some(place) = record.key_place("variant") {
            let message = "`variant` and `sweep` cannot be given both";
            let problem = Problem::new(place, message, "a second thing to run");
            self.report(problem.help("the sweep itself can start from a variant"));
        }
        let level = self.setting.level;
        let keys = sweeps[*sweep].keys(level);
        let key_called = |path: &str| keys.iter().position(|key| *key.path == path);
        let unknown_key = |path: &Located<String>| {
            let message = format!("the sweep does not vary `{}`", path.value);
            let help = suggestion(path, keys.iter().map(|key| key.path.as_str()));
            Problem::new(path.place, message, "no key of the sweep").help(help)
        };
        let mut fixed = vec![None; keys.len()];
        for (path, values) in record.keys("member") {
            let Some(key) = key_called(path) else { return self.refuse(unknown_key(path)) };
            let Some(node) = values.first() else { continue };
            fixed[key] = find(node, &keys[key].values);
            if fixed[key].is_none() && when.includes(level) {
                let texts = keys[key].values.iter().map(|value| value.text.as_str());
                let help = format!(
                    "its values are {}{}",
                    one_of(texts),
                    if level == Level::Coarse {
                        " in the coarse setting; `when = \"case\"` leaves it out"
                    } else {
                        ""
                    }
                );
                let message =
                    format!("`{}` is never {} in the sweep", path.value, text_of(&node.value));
                return self.refuse(Problem::new(node.place, message, "no such member").help(help));
            }
        }
        let along = match record.text("along") {
            None => None,
            Some(path) if trend.is_none() => {
                let message = "`along` has no meaning without `order`, `monotone` or `ratio`";
                return self.refuse(
                    Problem::new(path.place, message, "no meaning here").help("remove it"),
                );
            }
            Some(path) => match key_called(&path) {
                None => return self.refuse(unknown_key(&path)),
                Some(key) if fixed[key].is_some() => {
                    let message = format!("`member` leaves a single value of `{}`", path.value);
                    return self.refuse(Problem::new(
                        path.place,
                        message,
                        "no key left to compare along",
                    ));
                }
                key => key,
            },
        };
        let free: Vec<usize> = (0..keys.len()).filter(|key| fixed[*key].is_none()).collect();
        let along = match (trend, along, &free[..]) {
            (None, ..) => None,
            (Some(_), Some(along), _) => Some(along),
            (Some(_), None, [only]) => Some(*only),
            (Some(trend), None, free) => {
                let place = record.key_place(trend).unwrap_or(record.place);
                let problem = match free.is_empty() {
                    true => {
                        let message =
                            format!("`{trend}` needs several members, `member` leaves one");
                        Problem::new(place, message, "of a single member")
                    }
                    false => {
                        let message =
                            format!("`{trend}` needs a key along which members are compared");
                        let names = free.iter().map(|key| keys[*key].path.as_str());
                        Problem::new(place, message, "along which key?")
                            .help(format!("add `along`: {}", one_of(names)))
                    }
                };
                return self.refuse(problem);
            }
        };
        Some(Members { sweep, fixed, along })
    }

    /// Reports a trend that its members cannot show.
    pub(super) fn enough_members(
        &mut self,
        record: &Record,
        members: &Members,
        sweeps: &[Sweep],
        trend: Option<&str>,
        is_error: bool,
    ) -> Option<()> {
        let (Some(trend), Some(along)) = (trend, members.along) else { return Some(()) };
        let place = record.key_place(trend).unwrap_or(record.place);
        let key = &sweeps[*members.sweep].keys(self.setting.level)[along];
        let needed = if trend == "order" && !is_error { 3 } else { 2 };
        if key.values.len() < needed {
            let got = key.values.len();
            let path = &key.path.value;
            let message = format!("`{trend}` needs {needed} values of `{path}` or more, got {got}");
            let problem = Problem::new(place, message, "too few members");
            return self.refuse(match needed {
                3 => {
                    problem.help("give `expected`, so that two members have errors, or more values")
                }
                _ => problem.help("give more values, in `coarse` too if it is there"),
            });
        }
        let bad = key.values.iter().find(|value| !value.number.is_some_and(|number| number > 0.0));
        if let (Some(bad), "order") = (bad, trend) {
            let message = format!(
                "`order` needs numbers above 0 as values of `{}`, got {}",
                key.path.value, bad.text
            );
            return self.refuse(
                Problem::new(place, message, "this key has no convergence order")
                    .help("`monotone` and `ratio` take members as they follow each other"),
            );
        }
        Some(())
    }
}

/// Whether what is reduced is an error itself, or becomes one by an expected value.
pub(super) fn is_error(reduce: &Reduction, expectation: &Expectation) -> bool {
    let with_expected =
        matches!(expectation, Expectation::Trend { trend: Trend::Order(_), expected: Some(_) });
    with_expected || reduce.reference().is_some()
}

/// The number of the value that `node` means.
fn find(node: &Node, values: &[Located<SweepValue>]) -> Option<usize> {
    let text = text_of(&node.value);
    values.iter().position(|value| value.text == text || is_number(&node.value, value))
}

/// 0.5 and 5e-1 are the same value.
fn is_number(value: &Value, known: &SweepValue) -> bool {
    let Ok(known) = known.text.parse::<f64>() else { return false };
    match value {
        Value::Integer(number) => *number as f64 == known,
        Value::Float(number) => *number == known,
        _ => false,
    }
}
