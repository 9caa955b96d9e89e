//! Numbers and expectations as text for people.

use crate::case::model::{Expectation, Trend};
use crate::output::{DIGITS, significant};

/// `value` with `unit`, which is left out for pure numbers.
pub(super) fn with_unit(value: f64, unit: &str) -> String {
    match unit {
        "" | "1" => significant(value, DIGITS),
        unit => format!("{} {unit}", significant(value, DIGITS)),
    }
}

/// The expected value and the tolerance of a result in `unit`.
pub(super) fn expectation(expectation: &Expectation, unit: &str) -> (String, String) {
    match expectation {
        Expectation::Value { expected, tolerance, absolute } => {
            (with_unit(*expected, unit), tolerance_text(*tolerance, *absolute, unit))
        }
        Expectation::EqualTo { other, tolerance, absolute } => {
            (comparison("equal to", other.as_deref()), tolerance_text(*tolerance, *absolute, unit))
        }
        Expectation::Bounds { at_least, at_most } => {
            let bounds = [("at least", at_least), ("at most", at_most)];
            let bounds = bounds.into_iter().filter_map(|(relation, bound)| {
                bound.map(|bound| format!("{relation} {}", with_unit(bound, unit)))
            });
            (bounds.collect::<Vec<_>>().join(", "), String::new())
        }
        Expectation::LessThan(other) => (comparison("less than", other.as_deref()), String::new()),
        Expectation::MoreThan(other) => (comparison("more than", other.as_deref()), String::new()),
        Expectation::Outcome(text) => (text.clone(), String::new()),
        Expectation::Trend { trend, .. } => (trend_text(trend), String::new()),
    }
}

fn tolerance_text(tolerance: f64, absolute: bool, unit: &str) -> String {
    match absolute {
        true => with_unit(tolerance, unit),
        false => format!("{} %", significant(100.0 * tolerance, DIGITS)),
    }
}

fn trend_text(trend: &Trend) -> String {
    let bounds = |[lower, upper]: &[f64; 2]| {
        [lower, upper].map(|bound| significant(*bound, DIGITS)).join(" to ")
    };
    match trend {
        Trend::Order(ends) => format!("order {}", bounds(ends)),
        Trend::Ratio(ends) => format!("ratios {}", bounds(ends)),
        Trend::Increasing => "increasing".to_owned(),
        Trend::Decreasing => "decreasing".to_owned(),
    }
}

/// How far `got` is off `expected`: a share like the tolerance, or in `unit` if it is `absolute`.
pub(super) fn deviation(got: f64, expected: f64, absolute: bool, unit: &str) -> String {
    let digits = 3;
    // Round-off differs from machine to machine.
    let difference = got - expected;
    let is_round_off = difference.abs() <= 1e-11 * expected.abs();
    match (if is_round_off { 0.0 } else { difference }, unit) {
        (difference, "" | "1") if absolute => significant(difference, digits),
        (difference, unit) if absolute => format!("{} {unit}", significant(difference, digits)),
        (difference, _) => {
            format!("{} %", significant(100.0 * difference / expected.abs(), digits))
        }
    }
}

/// Numbers of one unit as a list: `0.31, 0.28 m`.
pub(super) fn list(values: &[f64], unit: &str) -> String {
    let texts: Vec<String> = values.iter().map(|value| significant(*value, DIGITS)).collect();
    match unit {
        "" | "1" => texts.join(", "),
        unit => format!("{} {unit}", texts.join(", ")),
    }
}

fn comparison(relation: &str, variant: Option<&String>) -> String {
    format!("{relation} {}", variant.map_or("base", |name| name))
}
