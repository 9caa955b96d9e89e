//! Probes, output, pictures and plots.

use super::Region;
use crate::case::source::Located;
use crate::fields::{FieldDescription, FieldKind};

/// A field or one component of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FieldSelector {
    /// The field.
    pub field: FieldDescription,
    /// What of it.
    pub component: Component,
}

impl FieldSelector {
    /// The selected number out of the components of one particle, laid out as in
    /// [`FieldValues`](crate::fields::FieldValues). Not a number if there are too few components,
    /// or if the whole of a vector or tensor is selected.
    pub fn value(&self, components: &[f64]) -> f64 {
        match (self.component, self.field.kind) {
            (Component::Whole, FieldKind::Scalar) => components.first().copied(),
            (Component::Whole, _) => None,
            (Component::Entry(number), _) => components.get(number).copied(),
            (Component::Magnitude, _) => {
                Some(components.iter().map(|value| value * value).sum::<f64>().sqrt())
            }
        }
        .unwrap_or(f64::NAN)
    }

    /// As a case file writes it: `velocity.x`, `velocity.magnitude`, `deformation_gradient.xy`.
    pub fn name(&self, dimension: usize) -> String {
        match self.component {
            Component::Whole => self.field.name.to_owned(),
            Component::Magnitude => format!("{}.magnitude", self.field.name),
            Component::Entry(number) => {
                format!(
                    "{}.{}",
                    self.field.name,
                    component_name(self.field.kind, number, dimension)
                )
            }
        }
    }
}

/// The name of component `number` of a field in `dimension` dimensions: `x`, or `xy` of a tensor.
pub fn component_name(kind: FieldKind, number: usize, dimension: usize) -> String {
    const AXES: [&str; 3] = ["x", "y", "z"];
    match kind {
        FieldKind::Scalar => String::new(),
        FieldKind::Vector => AXES[number.min(2)].to_owned(),
        FieldKind::Tensor => {
            let row = number / dimension.max(1);
            let column = number % dimension.max(1);
            format!("{}{}", AXES[row.min(2)], AXES[column.min(2)])
        }
    }
}

/// What of a field is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Component {
    /// The field itself: the number of a scalar, all components of a vector or tensor.
    Whole,
    /// One component, counted as in [`FieldValues`](crate::fields::FieldValues).
    Entry(usize),
    /// The Euclidean or Frobenius norm.
    Magnitude,
}

/// Something recorded against time in the tables.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe {
    /// Unique name, the first part of its columns.
    pub name: Located<String>,
    /// Number of the body it looks at, `None` for all.
    pub body: Option<Located<usize>>,
    /// What is recorded.
    pub kind: ProbeKind,
}

/// The kinds of probe.
#[derive(Clone, Debug, PartialEq)]
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
