//! Statics as an integrator: each step is one of the loads.

use super::failure::Failure;
use super::integrator::Integrator;
use crate::schemes::Scheme;

/// Goes from equilibrium to equilibrium. The time is the load factor, so that output, probes,
/// checkpoints and retries with smaller steps are those of any run.
#[derive(Clone, Copy, Debug, Default)]
pub struct LoadStepping;

impl Integrator for LoadStepping {
    fn name(&self) -> &'static str {
        "static"
    }

    /// About as many products as a step takes by conjugate gradients: for estimates only.
    fn evaluations(&self) -> u64 {
        300
    }

    /// A scheme without equilibria stays where it is; the reader of cases refuses the pairing.
    fn step(
        &mut self,
        scheme: &mut dyn Scheme,
        time: f64,
        step: f64,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<(), Failure> {
        new.copy_from_slice(old);
        let Some(scheme) = scheme.equilibrium() else { return Ok(()) };
        scheme.equilibrate(time, time + step, old, new).map_err(Failure::NoSolution)
    }
}
