//! Probes, output, pictures and plots.

use super::Region;
use crate::case::expression::Expression;
use crate::case::source::Located;
use crate::fields::{FieldDescription, FieldSelector};
use crate::observe::Norm;

/// Something recorded against time, or along a line.
#[derive(Clone, Debug)]
pub struct Probe {
    /// Unique name, the first part of its columns.
    pub name: Located<String>,
    /// Number of the body it observes, `None` for all.
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
        /// A point in m; the fields of the particle there are subtracted.
        relative_to: Option<Located<Vec<f64>>>,
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
        /// Corners in m of a box; particles that are outside it at the time do not count.
        inside: Option<[Vec<f64>; 2]>,
    },
    /// The sum over a selection.
    Sum {
        /// A field, with all its components.
        field: Located<FieldDescription>,
        /// The particles.
        region: Located<Region>,
    },
    /// The mean over a selection.
    Mean {
        /// A field, with all its components.
        field: Located<FieldDescription>,
        /// The particles.
        region: Located<Region>,
    },
    /// The resultant of forces on a selection, and their moment.
    Force {
        /// The field of the forces.
        field: Located<FieldDescription>,
        /// The point that the moment is about, in m.
        about: Vec<f64>,
        /// The particles.
        region: Located<Region>,
    },
    /// The pressure on a patch of a wall.
    Sensor {
        /// The middle of the patch in m.
        at: Located<Vec<f64>>,
        /// The unit normal of the wall there, towards the fluid.
        normal: Vec<f64>,
        /// Its radius in m.
        radius: f64,
    },
    /// The largest hole between particles.
    Void,
    /// How far a fluid reaches along a line.
    Gauge {
        /// Where the line starts, in m.
        from: Located<Vec<f64>>,
        /// Where it ends, in m.
        to: Located<Vec<f64>>,
    },
    /// The flow through a plane.
    Flux {
        /// A point of the plane in m.
        point: Vec<f64>,
        /// Its unit normal.
        normal: Vec<f64>,
        /// Corners in m of a box outside of which nothing counts.
        inside: Option<[Vec<f64>; 2]>,
    },
    /// What has entered and left through the open boundary whose buffer is the body.
    Opening,
    /// Fields interpolated at a fixed point.
    Point {
        /// The point in m.
        at: Located<Vec<f64>>,
        /// A point in m; the values of the fields there are subtracted.
        relative_to: Option<Located<Vec<f64>>>,
        /// The fields that are recorded, with all their components.
        fields: Vec<Located<FieldDescription>>,
    },
    /// Fields interpolated at points along a straight line.
    Line {
        /// Where it starts, in m.
        from: Located<Vec<f64>>,
        /// Where it ends, in m.
        to: Located<Vec<f64>>,
        /// Number of equidistant points.
        points: usize,
        /// The fields that are recorded, with all their components.
        fields: Vec<Located<FieldDescription>>,
        /// Times in s, `None` for those of the particle files.
        times: Option<Vec<f64>>,
        /// How long before each of these times profiles are means of, in s.
        mean_over: Option<f64>,
    },
    /// The Taylor test of the tangent of an implicit step.
    Tangent {
        /// Length of the step in s.
        step: f64,
    },
    /// The difference of a field from its expected value.
    Error {
        /// Numbers of each particle with their expected values, expressions of the current position and time.
        parts: Vec<(FieldSelector, Expression)>,
        /// Whether the means of both are subtracted first.
        without_mean: bool,
        /// What is summed.
        norm: Norm,
        /// The particles.
        region: Located<Region>,
    },
}

impl ProbeKind {
    /// The length of a line or a gauge in m; of other probes none.
    pub fn length(&self) -> Option<f64> {
        let (Self::Line { from, to, .. } | Self::Gauge { from, to }) = self else { return None };
        let squares = from.iter().zip(&to.value).map(|(from, to)| (to - from).powi(2));
        Some(squares.sum::<f64>().sqrt())
    }
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
    /// How the particle files are compressed.
    pub compression: Compression,
    /// Whether the run ends with a report.
    pub report: bool,
}

/// How particle files are compressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compression {
    /// Not at all.
    None,
    /// With zlib.
    Zlib,
}

/// A picture of the particles coloured by a field. In 3D without walls of ghost particles.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// A single number of each particle.
    pub field: Located<FieldSelector>,
    /// Times in s; empty if all of them are after the end of the run.
    pub times: Vec<Located<f64>>,
    /// Ends of the colour bar, `None` for those of the data.
    pub range: Option<[f64; 2]>,
    /// Corners of the part that is shown in m, `None` for all.
    pub part: Option<[Vec<f64>; 2]>,
}

/// Curves of columns of the tables.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// Unique name of the file.
    pub name: Located<String>,
    /// At least one column of the tables; all against time or all along lines.
    pub curves: Vec<Located<super::Quantity>>,
    /// Whether it is a map of one column of a line over position and time.
    pub over_time: bool,
}
