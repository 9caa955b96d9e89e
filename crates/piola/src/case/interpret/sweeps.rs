//! Sweeps.

use super::*;
use crate::case::document::{Node, Value, write_value};
use crate::case::expression::{Expression, Scope};
use crate::case::model::{Level, RunTraits, Sweep, SweepKey, SweepValue, When};

/// Members that a sweep may have at most: each is checked when the case is read.
const MAX_MEMBERS: usize = 256;
/// Members that all sweeps of a case may have together.
const MAX_ALL_MEMBERS: usize = 1000;
/// Tables that a sweep cannot change, as they say what is run and checked.
const FRAME: [&str; 6] = ["variant", "sweep", "check", "coarse", "paper", "version"];

impl Reader<'_, '_> {
    pub(super) fn sweep(&mut self, record: &Record) -> Option<Sweep> {
        let variant = record.text("variant").map(|name| self.variant_called(name));
        let full = self.sweep_keys(record.keys("over"));
        if let Some((path, _)) = record.keys("over").get(2) {
            let message = "a sweep varies one or two keys, and this is the third";
            self.report(
                Problem::new(path.place, message, "one too many")
                    .help("make another sweep of it, or set several keys by one parameter"),
            );
        }
        let instead = self.sweep_keys(record.keys("coarse"));
        for key in &instead {
            if full.iter().all(|known| *known.path != *key.path) {
                let message = format!("the sweep does not vary `{}`", key.path.value);
                let known = full.iter().map(|key| key.path.as_str());
                let help = suggestion(&key.path, known);
                self.report(Problem::new(key.path.place, message, "not in `over`").help(help));
            }
        }
        let coarse = full.iter().map(|key| {
            let other = instead.iter().find(|other| *other.path == *key.path);
            other.unwrap_or(key).clone()
        });
        let sweep = Sweep {
            name: record.text("name")?,
            title: record.text("title").map(|title| title.value),
            variant: variant.flatten().flatten(),
            set: strings(record, "set"),
            coarse: coarse.collect(),
            full,
            when: when(record)?,
            traits: run_traits(record)?,
        };
        for level in Level::ALL {
            let count = sweep.count(level);
            if count > MAX_MEMBERS {
                let message =
                    format!("the sweep has {count} members, at most {MAX_MEMBERS} are allowed");
                return self.refuse(Problem::new(sweep.name.place, message, "too many members"));
            }
        }
        Some(sweep)
    }

    /// Keys with their values, which must differ.
    fn sweep_keys(&mut self, keys: &[(Located<String>, Vec<Node>)]) -> Vec<SweepKey> {
        let mut found: Vec<SweepKey> = Vec::new();
        for (path, values) in keys {
            let first = path.split('.').next().unwrap_or_default().trim();
            if FRAME.contains(&first) {
                let message = format!("a sweep cannot change `{first}`");
                self.report(
                    Problem::new(path.place, message, "not a key of a run")
                        .help("a variant can be what the members start from: `variant = \"NAME\"`"),
                );
            }
            if found.iter().any(|known| known.path.value == path.value) {
                let message = format!("the key `{}` appears twice", path.value);
                self.report(Problem::new(path.place, message, "the second time"));
                continue;
            }
            let mut kept: Vec<(Located<SweepValue>, &Value)> = Vec::new();
            for node in values.iter().take(MAX_MEMBERS + 1) {
                if kept.iter().any(|(_, known)| same(known, &node.value)) {
                    let message = format!("the value {} appears twice", text_of(&node.value));
                    self.report(Problem::new(node.place, message, "the second time"));
                    continue;
                }
                let value =
                    SweepValue { text: text_of(&node.value), number: self.number_of(&node.value) };
                kept.push((Located::new(value, node.place), &node.value));
            }
            let values = kept.into_iter().map(|(value, _)| value).collect();
            found.push(SweepKey { path: path.clone(), values });
        }
        found
    }

    /// A number, or the value of an expression of the parameters. Other texts have none.
    fn number_of(&self, value: &Value) -> Option<f64> {
        match value {
            Value::Integer(number) => Some(*number as f64),
            Value::Float(number) => Some(*number),
            Value::Text(text) => {
                let scope = Scope::of_parameters(&self.context.parameters);
                Expression::parse(text, &scope).ok()?.as_constant()
            }
            _ => None,
        }
    }

    pub(super) fn not_too_many_members(&mut self, sweeps: &[Sweep]) {
        for level in Level::ALL {
            let mut count = 0;
            for sweep in sweeps {
                count += sweep.count(level);
                if count > MAX_ALL_MEMBERS {
                    let message =
                        format!("the sweeps have more than {MAX_ALL_MEMBERS} members together");
                    self.report(Problem::new(sweep.name.place, message, "one too many"));
                    return;
                }
            }
        }
    }
}

/// At which setting a check or a sweep is meant.
pub(super) fn when(record: &Record) -> Option<When> {
    Some(match record.text("when")?.as_str() {
        "coarse" => When::At(Level::Coarse),
        "case" => When::At(Level::Case),
        "paper" => When::At(Level::Paper),
        _ => When::Always,
    })
}

/// What a variant or a sweep says of its runs.
pub(super) fn run_traits(record: &Record) -> Option<RunTraits> {
    Some(RunTraits { is_paper: record.boolean("paper")?, is_long: record.boolean("long")? })
}

/// Whether two values of a key mean the same: 1 and 1.0 do.
pub(super) fn same(one: &Value, other: &Value) -> bool {
    match (one, other) {
        (Value::Integer(one), Value::Float(other)) | (Value::Float(other), Value::Integer(one)) => {
            *one as f64 == *other
        }
        (Value::List(one), Value::List(other)) => {
            one.len() == other.len()
                && one.iter().zip(other).all(|(one, other)| same(&one.value, &other.value))
        }
        (Value::Float(one), Value::Float(other)) => one == other,
        _ => text_of(one) == text_of(other),
    }
}

/// A value as TOML, texts without quotes.
pub(super) fn text_of(value: &Value) -> String {
    match value {
        Value::Text(text) => text.clone(),
        _ => write_value(value),
    }
}
