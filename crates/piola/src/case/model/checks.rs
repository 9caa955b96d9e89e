//! Checks: quantities of a run and what is expected of them.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::case::source::Located;

/// One line of the table that `piola verify` prints.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// The variant that is run, `None` for the base case or for a sweep.
    pub variant: Option<Located<String>>,
    /// The members of a sweep that are run instead.
    pub members: Option<Members>,
    /// The quantity that is checked.
    pub quantity: Located<Quantity>,
    /// How its history becomes one number.
    pub reduce: Reduction,
    /// What the number should be.
    pub expectation: Expectation,
    /// What the expected value is worth as evidence.
    pub against: Option<Against>,
    /// Where the expected value comes from.
    pub source: String,
    /// Why the tolerance, or the bound, is what it is.
    pub reason: Option<String>,
    /// Why it is not met, if it is known not to be.
    pub unmet: Option<String>,
    /// At which setting it is evaluated.
    pub when: When,
}

/// What an expected value is worth as evidence that a result is right.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Against {
    /// A closed form or a series.
    Exact,
    /// Another method or another program.
    Independent,
    /// A number or a curve of the paper.
    Paper,
    /// Another run of piola: no evidence of correctness.
    Own,
    /// A balance, a symmetry, an outcome, a number of pieces.
    Invariant,
}

impl Against {
    /// All of them, the strongest first.
    pub const ALL: [Self; 5] =
        [Self::Exact, Self::Independent, Self::Paper, Self::Own, Self::Invariant];

    /// Its name in case files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Independent => "independent",
            Self::Paper => "paper",
            Self::Own => "own",
            Self::Invariant => "invariant",
        }
    }

    /// Whether the expected value comes from outside the program.
    pub fn is_outside(self) -> bool {
        matches!(self, Self::Exact | Self::Independent | Self::Paper)
    }
}

impl Check {
    /// The file with the reference curve.
    pub fn file(&self) -> Option<&Located<PathBuf>> {
        self.reduce.reference()
    }
}

/// Members of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct Members {
    /// Number of the sweep in the case.
    pub sweep: Located<usize>,
    /// For each key of the sweep the number of its value, `None` for all values.
    pub fixed: Vec<Option<usize>>,
    /// Number of the key along which a trend is evaluated.
    pub along: Option<usize>,
}

/// A column of the tables, or a number of the run as a whole.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// A column of a probe: `PROBE.FIELD` or `PROBE.FIELD.COMPONENT`.
    Probe {
        /// Name of the probe.
        probe: String,
        /// The rest of the column's name.
        column: String,
    },
    /// A column of the energy table: `energy.NAME`.
    Energy(String),
    /// A column of the momentum table: `momentum.NAME`.
    Momentum(String),
    /// A column of the table of steps: `step.NAME`.
    Step(String),
    /// A number of the run as a whole, without history: `run.NAME`.
    Run(String),
}

impl Quantity {
    /// As the case file writes it, which is also the column's name.
    pub fn name(&self) -> String {
        match self {
            Self::Probe { probe, column } => format!("{probe}.{column}"),
            Self::Energy(name) => format!("energy.{name}"),
            Self::Momentum(name) => format!("momentum.{name}"),
            Self::Step(name) => format!("step.{name}"),
            Self::Run(name) => format!("run.{name}"),
        }
    }
}

/// How the history of a quantity becomes one number; a reference curve is named by its file.
pub type Reduction = crate::observe::reduce::Reduction<Located<PathBuf>>;

/// What a number should be.
#[derive(Clone, Debug, PartialEq)]
pub enum Expectation {
    /// A value and how far off the result may be.
    Value {
        /// The value.
        expected: f64,
        /// Largest difference, as a fraction of `expected` unless `absolute`.
        tolerance: f64,
        /// Whether the tolerance has the unit of the quantity.
        absolute: bool,
    },
    /// Bounds, at least one of them.
    Bounds {
        /// Smallest value that passes.
        at_least: Option<f64>,
        /// Largest value that passes.
        at_most: Option<f64>,
    },
    /// Less than the same quantity of another variant (`None`: of the base case).
    LessThan(Option<Located<String>>),
    /// More than the same quantity of another variant (`None`: of the base case).
    MoreThan(Option<Located<String>>),
    /// The same as that of another variant, up to a difference.
    EqualTo {
        /// The variant, `None` for the base case.
        other: Option<Located<String>>,
        /// Largest difference, as a fraction of the other value unless `absolute`.
        tolerance: f64,
        /// Whether the tolerance has the unit of the quantity.
        absolute: bool,
    },
    /// The text of `run.outcome`.
    Outcome(String),
    /// A trend over the members of a sweep.
    Trend {
        /// The kind of trend.
        trend: Trend,
        /// The value that each should have: the error is evaluated instead of the quantity.
        expected: Option<f64>,
    },
}

impl Expectation {
    /// The variant that a result is compared with, within `Some`; the inner `None` is the base case.
    pub fn other(&self) -> Option<Option<&Located<String>>> {
        match self {
            Self::LessThan(other) | Self::MoreThan(other) | Self::EqualTo { other, .. } => {
                Some(other.as_ref())
            }
            _ => None,
        }
    }
}

/// A trend of the numbers along a key of a sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Trend {
    /// Bounds on the order of convergence in the value of the key.
    Order([f64; 2]),
    /// Each is above the previous one.
    Increasing,
    /// Each is below the previous one.
    Decreasing,
    /// Bounds on the ratio of each to the previous one.
    Ratio([f64; 2]),
}

/// How finely, and with which parameters, a case is run.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
#[serde(rename_all = "lowercase")]
pub enum Level {
    /// The overrides of `[coarse]`: seconds, for tests.
    Coarse,
    /// The case as it stands in its file.
    #[default]
    Case,
    /// The overrides of `[paper]`: particle numbers, steps and parameters of the publication.
    Paper,
}

impl Level {
    /// All of them, the quickest first.
    pub const ALL: [Self; 3] = [Self::Coarse, Self::Case, Self::Paper];

    /// Its name in case files and on the validation page.
    pub fn name(self) -> &'static str {
        match self {
            Self::Coarse => "coarse",
            Self::Case => "case",
            Self::Paper => "paper",
        }
    }

    /// The setting in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Coarse => "the coarse setting",
            Self::Case => "the case as it stands",
            Self::Paper => "the paper's setting",
        }
    }
}

/// The settings at which a check is evaluated, or a sweep exists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum When {
    /// At the coarse setting and in the case as it stands.
    Always,
    /// At one setting only.
    At(Level),
}

impl When {
    /// Whether it includes a setting.
    pub fn includes(self, level: Level) -> bool {
        match self {
            Self::Always => level != Level::Paper,
            Self::At(one) => one == level,
        }
    }
}
