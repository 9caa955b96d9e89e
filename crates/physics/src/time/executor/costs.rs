//! What a run has taken.

use super::Executor;
use crate::schemes::{Phase, RankCosts};

impl Executor {
    /// How many steps of its own each system of the run has taken, by name; nothing where there is one system.
    pub fn own_steps(&mut self) -> Vec<(String, u64)> {
        self.bring();
        self.scheme.own_steps(&self.run.state)
    }

    /// Evaluations of single particles in a step like the last one of the integrator.
    pub fn evaluations_in_step(&self) -> u64 {
        evaluated(&self.evaluations, self.integrator.steps_in_last())
    }

    /// As [`Self::evaluations_in_step`], of one system whose stages are all that a step evaluates: nothing of several
    /// systems, and where equations are solved.
    pub fn counted_evaluations(&self) -> Option<u64> {
        let is_counted = self.integrator.is_timed_by_steps() && self.scheme.parts().is_empty();
        is_counted.then(|| self.evaluations_in_step())
    }

    /// What has taken the time of each rank in this run and in those that it has taken over from.
    pub(super) fn costs(&self) -> Vec<RankCosts> {
        if self.has_left {
            return self.costs.clone();
        }
        let now = self.device.as_ref().and_then(|device| device.costs().ok());
        let mut costs = now.unwrap_or_default();
        for (costs, before) in costs.iter_mut().zip(&self.costs) {
            costs.computed += before.computed;
            costs.waited += before.waited;
            costs.messages += before.messages;
            costs.bytes += before.bytes;
        }
        costs
    }

    /// The parts of steps with what they have taken in this run and in those that it has taken over from.
    pub(super) fn phases(&self) -> Vec<Phase> {
        if self.has_left {
            return self.phases.clone();
        }
        let phases = match &self.device {
            Some(device) => device.phases(),
            None => self.scheme.phases(),
        };
        let mut phases: Vec<Phase> = phases.into_iter().cloned().collect();
        let stages = phases.iter_mut().flat_map(|phase| &mut phase.stages);
        let before = self.phases.iter().flat_map(|phase| &phase.stages);
        for ((_, watch), (_, before)) in stages.zip(before) {
            watch.total += before.total;
            watch.calls += before.calls;
        }
        phases
    }
}

/// Evaluations of single particles in a step of the run: those in one of the steps of each system, and how many of these
/// it takes.
pub(super) fn evaluated(by_system: &[u64], steps: &[u64]) -> u64 {
    let steps = |system: usize| steps.get(system).copied().unwrap_or(1);
    by_system.iter().enumerate().map(|(system, of_one)| of_one * steps(system)).sum()
}
