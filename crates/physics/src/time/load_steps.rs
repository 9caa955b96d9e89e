//! Statics as an integrator: each step is one of the loads.

use super::failure::Failure;
use super::integrator::{Integrator, Unserved};
use crate::schemes::Scheme;

/// Goes from equilibrium to equilibrium. The time is the load factor, so that output, probes,
/// checkpoints and retries with smaller steps are those of any run.
#[derive(Clone, Copy, Debug, Default)]
pub struct LoadStepping {
    /// Whether the time is the length of the path instead, so that loads may fall.
    pub by_arc_length: bool,
}

impl Integrator for LoadStepping {
    fn name(&self) -> &'static str {
        if self.by_arc_length { "arc_length" } else { "static" }
    }

    /// About as many products as a step takes by conjugate gradients: for estimates only.
    fn evaluations(&self, _scheme: &mut dyn Scheme) -> u64 {
        300
    }

    fn is_timed_by_steps(&self) -> bool {
        false
    }

    fn renewed(&self, _scheme: &mut dyn Scheme) -> Option<Box<dyn Integrator>> {
        Some(Box::new(*self))
    }

    fn step(
        &mut self,
        scheme: &mut dyn Scheme,
        time: f64,
        step: f64,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<(), Failure> {
        new.copy_from_slice(old);
        let found = match scheme.equilibrium() {
            Some(scheme) if self.by_arc_length => scheme.follow(time, time + step, old, new),
            Some(scheme) => scheme.equilibrate(time, time + step, old, new),
            None => return Err(Unserved::new(self.name(), scheme).into()),
        };
        found.map_err(Failure::NoSolution)
    }
}
