//! What a scheme tells the rest of the program about its fields, and one instant of them.
//!
//! Output, pictures, probes and checkpoints walk these descriptions; none of them knows a scheme.

mod columns;
mod selector;

pub use columns::{column, width};
pub(crate) use columns::{columns, take_column, take_column_mut};
pub use selector::{Component, FieldSelector, component_name};

/// What stands in a field for particles that do not have it, as those of another system: not a number, and
/// other bits than any number that a computation fails with.
pub const ABSENT: f64 = f64::from_bits(0x7ff8_0000_0a85_e270);

/// Whether a value is [`ABSENT`].
pub fn is_absent(value: f64) -> bool {
    value.to_bits() == ABSENT.to_bits()
}

/// How the components of a field are laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldKind {
    /// One number a particle.
    Scalar,
    /// `D` numbers a particle: x, y, z.
    Vector,
    /// `D * D` numbers a particle, row by row.
    Tensor,
    /// Six numbers a particle in any dimension: xx, yy, zz, yz, xz, xy.
    Symmetric,
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
    /// Where its values come from.
    pub life: Life,
    /// Its place in the table of its formulation, by which it is read.
    pub number: usize,
}

/// Where the values of a field come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Life {
    /// A column of the state that integrators advance.
    Evolved,
    /// A column of the state that only the next step needs, and that is not shown.
    Kept,
    /// Made of the state, after this many stages of observation.
    Derived(usize),
    /// The same in all states.
    Constant,
}

impl Life {
    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Evolved => "evolved",
            Self::Kept => "kept",
            Self::Derived(_) => "derived",
            Self::Constant => "constant",
        }
    }
}

impl FieldDescription {
    /// A field that does not change, the first of its table.
    pub const fn new(
        name: &'static str,
        unit: &'static str,
        kind: FieldKind,
        meaning: &'static str,
    ) -> Self {
        Self { name, unit, kind, meaning, life: Life::Constant, number: 0 }
    }

    /// A table of fields with their numbers.
    pub(crate) const fn numbered<const N: usize>(mut fields: [Self; N]) -> [Self; N] {
        let mut number = 0;
        while number < N {
            fields[number].number = number;
            number += 1;
        }
        fields
    }

    /// A table of two, one behind the other, of which the first is not empty.
    pub(crate) const fn joined<const N: usize>(one: &[Self], other: &[Self]) -> [Self; N] {
        let mut all = [one[0]; N];
        let mut number = 0;
        while number < N {
            let behind = number >= one.len();
            all[number] = if behind { other[number - one.len()] } else { one[number] };
            number += 1;
        }
        Self::numbered(all)
    }
}

impl FieldKind {
    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Scalar => "scalar",
            Self::Vector => "vector",
            Self::Tensor => "tensor",
            Self::Symmetric => "symmetric tensor",
        }
    }

    /// The shape of an array of a field: one number, D, D x D or 6 for each particle.
    pub fn shape(self, particles: usize, dimension: usize) -> Vec<usize> {
        match self {
            Self::Scalar => vec![particles],
            Self::Vector => vec![particles, dimension],
            Self::Tensor => vec![particles, dimension, dimension],
            Self::Symmetric => vec![particles, 6],
        }
    }

    /// Number of components a particle in `dimension` dimensions.
    pub fn components(self, dimension: usize) -> usize {
        match self {
            Self::Scalar => 1,
            Self::Vector => dimension,
            Self::Tensor => dimension * dimension,
            Self::Symmetric => 6,
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
    /// Width of each particle over the spacing of its body.
    pub widths: Vec<f64>,
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
