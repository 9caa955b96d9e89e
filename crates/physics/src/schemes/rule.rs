//! The rules of implicit steps, of whichever kind of formulation.

use super::{Capability, Newmark, Theta};

/// How an implicit step is made from old and new values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ImplicitRule {
    /// Of systems of second order, `M a = f(u, t)`, whose scheme is a
    /// [`NewmarkScheme`](super::NewmarkScheme).
    Newmark(Newmark),
    /// Of systems of first order, `du/dt = f(u, t)`, whose scheme is a
    /// [`ThetaScheme`](super::ThetaScheme).
    Theta(Theta),
}

impl ImplicitRule {
    /// What it needs of a scheme.
    pub fn needs(&self) -> Capability {
        match self {
            Self::Newmark(_) => Capability::Newmark,
            Self::Theta(_) => Capability::Theta,
        }
    }

    /// Whether it takes energy from periods that are short against its steps.
    pub fn damps(&self) -> bool {
        match self {
            Self::Newmark(rule) => rule.damps(),
            Self::Theta(rule) => rule.damps(),
        }
    }

    /// Order of its errors in the length of a step.
    pub fn order(&self) -> i32 {
        match self {
            Self::Newmark(rule) => rule.order(),
            Self::Theta(rule) => rule.order(),
        }
    }
}
