//! What a formulation is called and what it shows, known before one is built.

use super::{Accounts, Scheme, interpolation, total_lagrangian, transport_velocity, upwind};
use crate::fields::{FieldDescription, Life};

/// The figure of formulations that solve for a state: how many iterations the last step took.
pub const NEWTON_ITERATIONS: &str = "newton_iterations";

/// What a formulation can offer to the methods that move it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Capability {
    /// Rates of its whole state: [`Scheme::has_rates`].
    Rates,
    /// Velocities and places in turn: [`Scheme::split`] or [`Scheme::partitioned`].
    Kicks,
    /// Implicit steps of masses and accelerations: [`Scheme::newmark`].
    Newmark,
    /// Implicit steps of a state and its rates: [`Scheme::theta`].
    Theta,
    /// Equilibria: [`Scheme::equilibrium`].
    Statics,
}

impl Capability {
    /// Whether `scheme` offers it as it is built.
    pub fn is_offered_by(self, scheme: &mut dyn Scheme) -> bool {
        match self {
            Self::Rates => scheme.has_rates(),
            // Where there is nothing to move, that is done.
            Self::Kicks => {
                scheme.initial_state().is_empty()
                    || scheme.split().is_some()
                    || scheme.partitioned().is_some()
            }
            Self::Newmark => scheme.newmark().is_some(),
            Self::Theta => scheme.theta().is_some(),
            Self::Statics => scheme.equilibrium().is_some(),
        }
    }
}

/// The names of a formulation and of all that it shows, in the order in which it shows them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SchemeDescription {
    /// Name in a case file.
    pub name: &'static str,
    /// The matter that it is of, in the plural, where a formulation has systems of several kinds.
    pub matter: Option<&'static str>,
    /// What it offers where it is built for that.
    pub offers: &'static [Capability],
    /// The columns of its state and all that an [`Observation`](super::Observation) can show.
    pub fields: &'static [FieldDescription],
    /// The energies of [`Scheme::energies`](super::Scheme::energies).
    pub energies: &'static [&'static str],
    /// What changes energy and momentum.
    pub ledger: Accounts,
    /// Names and units of figures of its own, which the table of steps records.
    pub figures: &'static [(&'static str, &'static str)],
}

impl SchemeDescription {
    /// All formulations.
    pub const ALL: [&'static Self; 7] = [
        &upwind::DESCRIPTION,
        &transport_velocity::FLUIDS,
        &transport_velocity::SOLIDS,
        &total_lagrangian::TOTAL_LAGRANGIAN,
        &total_lagrangian::DUAL_SUPPORT,
        &total_lagrangian::ELASTODYNAMICS,
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

    /// The formulation of a name, for some matter where it has systems of several kinds.
    pub fn of(name: &str, matter: &str) -> Option<&'static Self> {
        let fits =
            |scheme: &&Self| scheme.name == name && scheme.matter.is_none_or(|own| own == matter);
        Self::ALL.into_iter().find(fits)
    }
}
