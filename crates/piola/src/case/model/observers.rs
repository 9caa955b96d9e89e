//! Probes, output, pictures and plots.

use super::Region;
use crate::case::expression::Expression;
use crate::case::source::Located;
use crate::fields::{FieldDescription, FieldSelector};

/// Something recorded against time in the tables.
#[derive(Clone, Debug)]
pub struct Probe {
    /// Unique name, the first part of its columns.
    pub name: Located<String>,
    /// Number of the body it looks at, `None` for all.
    pub body: Option<Located<usize>>,
    /// What is recorded.
    pub kind: ProbeKind,
}

/// The kinds of probe.
#[derive(Clone, Debug)]
pub enum ProbeKind {
    /// The particle that is nearest to a point in the reference state.
    Particle {
        /// The point in m.
        at: Located<Vec<f64>>,
        /// The fields that are recorded, with all their components.
        fields: Vec<Located<FieldDescription>>,
    },
    /// The largest or smallest value over a selection.
    Extremum {
        /// A single number of each particle.
        field: Located<FieldSelector>,
        /// Which one.
        of: Extremum,
        /// The particles.
        region: Located<Region>,
    },
    /// The sum over a selection.
    Sum {
        /// A field, with all its components.
        field: Located<FieldDescription>,
        /// The particles.
        region: Located<Region>,
    },
    /// Fields interpolated at a fixed point.
    Point {
        /// The point in m.
        at: Located<Vec<f64>>,
        /// The fields that are recorded, with all their components.
        fields: Vec<Located<FieldDescription>>,
    },
    /// The difference of a field from what it should be.
    Error {
        /// A single number of each particle.
        field: Located<FieldSelector>,
        /// What it should be, of the current position and time.
        exact: Expression,
        /// Whether the means of both are taken away first.
        without_mean: bool,
        /// The particles.
        region: Located<Region>,
    },
}

/// Largest or smallest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extremum {
    /// The largest value.
    Largest,
    /// The smallest value.
    Smallest,
}

/// What is written and when.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Seconds between particle files.
    pub every: Located<f64>,
    /// Seconds between rows of the tables.
    pub table_every: Located<f64>,
    /// Fields in the particle files.
    pub fields: Vec<FieldDescription>,
    /// How the particle files are packed.
    pub compression: Compression,
    /// Whether the run ends with a report.
    pub report: bool,
}

/// How particle files are packed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compression {
    /// Not at all.
    None,
    /// With zlib.
    Zlib,
}

/// A picture of the particles coloured by a field.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// A single number of each particle.
    pub field: Located<FieldSelector>,
    /// Times in s, at least one.
    pub times: Vec<Located<f64>>,
    /// Ends of the colour bar, `None` for those of the data.
    pub range: Option<[f64; 2]>,
}

/// Curves of columns of the tables against time.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// Unique name of the file.
    pub name: Located<String>,
    /// At least one column of the tables.
    pub curves: Vec<Located<super::Quantity>>,
}
