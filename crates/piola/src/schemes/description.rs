//! What a formulation is called and what it shows, known before one is built.

use super::{dual_support, elastodynamics, interpolation, transport_velocity, upwind};
use crate::fields::{FieldDescription, Life};

/// The figure of formulations that solve for a state: how many iterations the last step took.
pub const NEWTON_ITERATIONS: &str = "newton_iterations";

/// The names of a formulation and of all that it shows, in the order in which it shows them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SchemeDescription {
    /// Name in a case file.
    pub name: &'static str,
    /// The columns of its state and all that an [`Observation`](super::Observation) can show.
    pub fields: &'static [FieldDescription],
    /// The energies of [`Scheme::energies`](super::Scheme::energies).
    pub energies: &'static [&'static str],
    /// The mechanisms that give or take energy, in the order of the state's tail. Work done on the
    /// body is positive; what a dissipative mechanism takes is negative.
    pub mechanisms: &'static [&'static str],
    /// The ways in which momentum enters from outside, in the order of the state's tail.
    pub impulses: &'static [&'static str],
    /// Names and units of figures of its own, which the table of steps records.
    pub figures: &'static [(&'static str, &'static str)],
}

impl SchemeDescription {
    /// All formulations.
    pub const ALL: [&'static Self; 5] = [
        &upwind::DESCRIPTION,
        &transport_velocity::DESCRIPTION,
        &dual_support::DESCRIPTION,
        &elastodynamics::DESCRIPTION,
        &interpolation::DESCRIPTION,
    ];

    /// The fields that are shown: all but those that only the next step needs.
    pub fn shown(&self) -> impl Iterator<Item = &'static FieldDescription> + use<> {
        self.fields.iter().filter(|field| field.life != Life::Kept)
    }

    /// The field of a name.
    pub fn field(&self, name: &str) -> Option<&'static FieldDescription> {
        self.fields.iter().find(|field| field.name == name)
    }

    /// The formulation of a name.
    pub fn of(name: &str) -> Option<&'static Self> {
        Self::ALL.into_iter().find(|scheme| scheme.name == name)
    }
}
