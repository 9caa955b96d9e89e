//! How the tables of a case file are described: the single place that defines the keys.
//!
//! Checking, defaults, the JSON schema and the reference all follow these descriptions; the descriptions themselves
//! are in [`tables`](super::tables).

use crate::output::significant;

/// A table with a fixed set of keys.
#[derive(Debug)]
pub struct TableSpec {
    /// Its name in messages and the reference, for example `[time]` or `lattice`.
    pub title: &'static str,
    /// What it is for.
    pub meaning: &'static str,
    /// Its keys.
    pub keys: &'static [KeySpec],
}

/// A table whose key `kind` determines its other keys.
#[derive(Debug)]
pub struct TaggedSpec {
    /// Its name in messages and the reference.
    pub title: &'static str,
    /// What it is for.
    pub meaning: &'static str,
    /// Keys of every kind.
    pub common: &'static [KeySpec],
    /// The kinds.
    pub kinds: &'static [KindSpec],
}

/// One kind of a [`TaggedSpec`].
#[derive(Debug)]
pub struct KindSpec {
    /// Value of the key `kind`.
    pub name: &'static str,
    /// What it is.
    pub meaning: &'static str,
    /// The dimensions that it exists in.
    pub dimensions: &'static [usize],
    /// Keys that only this kind has.
    pub keys: &'static [KeySpec],
}

/// One key.
#[derive(Debug)]
pub struct KeySpec {
    /// Its name.
    pub name: &'static str,
    /// The form of its value.
    pub kind: Kind,
    /// SI unit, `1` for a pure number, empty if it is not a number.
    pub unit: &'static str,
    /// Whether it has to be there.
    pub presence: Presence,
    /// One line of explanation.
    pub meaning: &'static str,
}

/// Whether a key has to be there.
#[derive(Clone, Copy, Debug)]
pub enum Presence {
    /// It must.
    Required,
    /// It need not, and has no effect then.
    Optional,
    /// This TOML value is taken instead.
    Default(&'static str),
    /// Something that depends on other keys is taken instead, described in words.
    Derived(&'static str),
}

/// The form of a value.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// Any text.
    Text,
    /// A file, relative to the folder of the case file.
    File,
    /// `true` or `false`.
    Boolean,
    /// A whole number.
    Integer(Interval),
    /// A number, or text with an expression of the parameters.
    Number(Interval),
    /// A number as above or text with a meaning of its own.
    NumberOrText,
    /// A number or an expression of some variables and the parameters.
    Expression(Variables),
    /// One of some names.
    Name(Choices),
    /// Some numbers.
    Numbers(Length, Interval),
    /// One number for all axes, or a list with one for each.
    NumberOrPerAxis(Interval),
    /// A list of expressions, one for each axis.
    Expressions(Variables),
    /// A table with any of the keys `x`, `y`, `z`.
    PerAxis(&'static Kind),
    /// A list.
    List(&'static Kind),
    /// A table.
    Table(&'static TableSpec),
    /// A table with a `kind`.
    Tagged(&'static TaggedSpec),
    /// Names with numbers or expressions.
    Parameters,
    /// Paths of keys of the case file, each with a list of values.
    KeysWithValues,
    /// Paths of keys of the case file, each with one value.
    KeysWithValue,
}

/// The variables that an expression may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variables {
    /// As many of `x`, `y`, `z` as the case has dimensions.
    Position,
    /// Those, or arrays with a value for each particle in place of expressions.
    AtStart,
    /// `x`, `y`, `z` and `t`.
    PositionAndTime,
}

/// How many numbers a list has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Length {
    /// As many as the case has dimensions.
    Dimension,
    /// Two.
    Pair,
    /// Two, the first below the second.
    Ends,
    /// Any number, at least one.
    Any,
}

/// The names that a value may have.
#[derive(Clone, Copy, Debug)]
pub enum Choices {
    /// These.
    Fixed(&'static [Choice]),
    /// Those of a registry.
    Registry(fn() -> Vec<Choice>),
}

impl Choices {
    /// The names with their explanations.
    pub fn list(&self) -> Vec<Choice> {
        match self {
            Self::Fixed(list) => list.to_vec(),
            Self::Registry(list) => list(),
        }
    }
}

/// A name with its explanation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Choice {
    /// The name.
    pub name: &'static str,
    /// What it means.
    pub meaning: &'static str,
}

/// Bounds of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub lower: f64,
    /// Upper end.
    pub upper: f64,
    /// Whether the lower end belongs to it.
    pub has_lower: bool,
    /// Whether the upper end belongs to it.
    pub has_upper: bool,
}

impl Interval {
    /// Any finite number.
    pub const ANY: Self =
        Self { lower: f64::NEG_INFINITY, upper: f64::INFINITY, has_lower: false, has_upper: false };
    /// Above 0.
    pub const POSITIVE: Self = Self { lower: 0.0, ..Self::ANY };
    /// At least 0.
    pub const NOT_NEGATIVE: Self = Self { has_lower: true, ..Self::POSITIVE };

    /// Above `lower`.
    pub const fn above(lower: f64) -> Self {
        Self { lower, ..Self::ANY }
    }

    /// At least `lower`.
    pub const fn at_least(lower: f64) -> Self {
        Self { lower, has_lower: true, ..Self::ANY }
    }

    /// From `lower` to `upper`, both included.
    pub const fn between(lower: f64, upper: f64) -> Self {
        Self { lower, upper, has_lower: true, has_upper: true }
    }

    /// Whether `value` lies in it. NaN does not.
    pub fn contains(&self, value: f64) -> bool {
        (value > self.lower || self.has_lower && value == self.lower)
            && (value < self.upper || self.has_upper && value == self.upper)
    }

    /// In words: `above 0`, `at least 1`, `from 0 to 1`. `None` for any number.
    pub fn describe(&self) -> Option<String> {
        if self.lower == self.upper {
            return Some(short(self.lower));
        }
        if self.has_lower && self.has_upper {
            return Some(format!("from {} to {}", short(self.lower), short(self.upper)));
        }
        let lower = match (self.lower.is_finite(), self.has_lower) {
            (false, _) => None,
            (true, true) => Some(format!("at least {}", short(self.lower))),
            (true, false) => Some(format!("above {}", short(self.lower))),
        };
        let upper = match (self.upper.is_finite(), self.has_upper) {
            (false, _) => None,
            (true, true) => Some(format!("at most {}", short(self.upper))),
            (true, false) => Some(format!("below {}", short(self.upper))),
        };
        match (lower, upper) {
            (Some(lower), Some(upper)) => Some(format!("{lower} and {upper}")),
            (lower, upper) => lower.or(upper),
        }
    }
}

/// A bound as people write it: `0.5`, `1/3`, `1e-13`.
fn short(bound: f64) -> String {
    let text = significant(bound, 12);
    let denominator = (1.0 / bound).round();
    match text.parse() == Ok(bound) {
        true => text,
        false if denominator > 0.0 && bound == 1.0 / denominator => format!("1/{denominator}"),
        false => bound.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_short() {
        let words = |interval: Interval| interval.describe().unwrap_or_default();
        assert_eq!(words(Interval::between(0.0, 1.0 / 3.0)), "from 0 to 1/3");
        assert_eq!(words(Interval::between(1e-13, 0.01)), "from 1e-13 to 0.01");
        assert_eq!(words(Interval::between(1.0, 1e8)), "from 1 to 100000000");
        assert_eq!(words(Interval::between(2.0, 2.0)), "2");
        // Nothing is lost of others.
        assert_eq!(words(Interval::at_least(0.1 + 0.2)), "at least 0.30000000000000004");
        assert_eq!(
            words(Interval { upper: 2.0 / 3.0, ..Interval::ANY }),
            format!("below {}", 2.0 / 3.0)
        );
        assert_eq!(words(Interval::ANY), "");
    }
}
