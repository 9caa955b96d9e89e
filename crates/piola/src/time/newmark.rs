//! Implicit steps of second order as an integrator.

use super::failure::Failure;
use super::integrator::{Integrator, took_few_iterations};
use crate::schemes::{Newmark, Scheme};

/// Goes from state to state by solving for the next one: Newmark's method and those that damp short
/// periods. No step is too large to be stable, only too large to be accurate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewmarkStepping {
    /// The name that it goes by in a case file.
    pub name: &'static str,
    /// Its weights.
    pub rule: Newmark,
}

impl Integrator for NewmarkStepping {
    fn name(&self) -> &'static str {
        self.name
    }

    /// About as many products as a step takes by conjugate gradients: for estimates only.
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
        let Some(scheme) = scheme.newmark() else { return Ok(()) };
        scheme.advance(&self.rule, time, step, old, new).map_err(Failure::NoSolution)
    }

    fn was_quick(&self, scheme: &dyn Scheme, state: &[f64]) -> bool {
        took_few_iterations(scheme, state)
    }
}
