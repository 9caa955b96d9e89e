//! What a scheme tells the rest of the program about its fields, and one instant of them.
//!
//! Output, pictures, probes and checkpoints walk these descriptions; none of them knows a scheme.

mod selector;

pub use selector::{Component, FieldSelector, component_name};

/// How the components of a field are laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldKind {
    /// One number a particle.
    Scalar,
    /// `D` numbers a particle: x, y, z.
    Vector,
    /// `D * D` numbers a particle, row by row.
    Tensor,
}

/// The name, unit and layout of one field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FieldDescription {
    /// Name in case files, tables and particle files, for example `velocity`.
    pub name: &'static str,
    /// SI unit, for example `m/s`; `1` for a pure number.
    pub unit: &'static str,
    /// Layout of its components.
    pub kind: FieldKind,
    /// One line of explanation for the generated reference.
    pub meaning: &'static str,
}

impl FieldDescription {
    /// A field, all of it.
    pub const fn new(
        name: &'static str,
        unit: &'static str,
        kind: FieldKind,
        meaning: &'static str,
    ) -> Self {
        Self { name, unit, kind, meaning }
    }
}

impl FieldKind {
    /// Number of components a particle in `dimension` dimensions.
    pub fn components(self, dimension: usize) -> usize {
        match self {
            Self::Scalar => 1,
            Self::Vector => dimension,
            Self::Tensor => dimension * dimension,
        }
    }
}

/// The values of one field for all particles.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldValues {
    /// What the numbers are.
    pub description: FieldDescription,
    /// `particles * components` numbers, particle by particle.
    pub values: Vec<f64>,
}

/// All that is written of one instant: positions, ids and fields, particle by particle in the
/// order of memory (`ids` gives the original numbering).
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    /// 1, 2 or 3.
    pub dimension: usize,
    /// Simulated time in s.
    pub time: f64,
    /// Steps taken so far.
    pub step: u64,
    /// Current positions in m, `particles * dimension` numbers.
    pub positions: Vec<f64>,
    /// Number of each particle in the order in which the geometry made it.
    pub ids: Vec<u32>,
    /// Number of the body of each particle.
    pub bodies: Vec<u32>,
    /// The fields, without positions.
    pub fields: Vec<FieldValues>,
}

impl Snapshot {
    /// Number of particles.
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// Whether there is no particle.
    pub fn is_empty(&self) -> bool {
        self.ids.is_empty()
    }

    /// The field called `name`.
    pub fn field(&self, name: &str) -> Option<&FieldValues> {
        self.fields.iter().find(|field| field.description.name == name)
    }
}
