//! Implicit steps of first-order systems as an integrator.

use super::failure::Failure;
use super::integrator::{Integrator, took_few_iterations};
use crate::schemes::{Scheme, Theta};

/// Goes from state to state by solving for the next one: backward Euler, Crank-Nicolson, what is
/// between them, and the implicit midpoint rule. No step is too large to be stable, only too large
/// to be accurate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThetaStepping {
    /// The name that it goes by in a case file.
    pub name: &'static str,
    /// Which of them.
    pub rule: Theta,
}

impl Integrator for ThetaStepping {
    fn name(&self) -> &'static str {
        self.name
    }

    /// About as many products as a step takes iteratively: for estimates only.
    fn evaluations(&self) -> u64 {
        100
    }

    /// A scheme that does not take such steps stays where it is; the reader of cases refuses the
    /// pairing.
    fn step(
        &mut self,
        scheme: &mut dyn Scheme,
        time: f64,
        step: f64,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<(), Failure> {
        new.copy_from_slice(old);
        let Some(scheme) = scheme.theta() else { return Ok(()) };
        scheme.advance(&self.rule, time, step, old, new).map_err(Failure::NoSolution)
    }

    fn was_quick(&self, scheme: &dyn Scheme, state: &[f64]) -> bool {
        took_few_iterations(scheme, state)
    }
}
