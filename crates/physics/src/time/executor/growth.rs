//! Runs that another one of the same case takes over, as their reserve of particles was too small.

use super::{Executor, Previous};
use crate::schemes::Scheme;
use crate::time::checkpoint::{Checkpoint, Misfit};
use crate::time::failure::Failure;
use crate::time::history::History;
use crate::time::summary::Outcome;

impl Executor {
    /// Whether the run cannot go on because particles were to be born and too few were in reserve: then another one of the
    /// same case that has more of them can [take over](Self::take_over).
    pub fn has_none_in_reserve(&self) -> bool {
        matches!(self.outcome, Some(Outcome::Failed(Failure::NoneInReserve { .. })))
    }

    /// Ends this run, as another one of the same case goes on with this many `more` particles in reserve than the case asks
    /// for: from the state before the last step, if that lacked particles. [`Self::serve`] tells the other ranks. Returns
    /// whether the other run can go on: not where a rank is lost.
    pub fn leave(&mut self, more: usize) -> bool {
        let Previous { clock, wanted, factor, evaluations, .. } = self.previous;
        if self.has_none_in_reserve() && self.run.clock.step > clock.step {
            self.is_here = true;
            if self.step_back().is_none() {
                let tally = &mut self.run.tally;
                (tally.wanted, tally.factor) = (wanted, factor);
                tally.evaluations = evaluations;
                self.run.history.take_back();
            }
        }
        self.bring();
        let is_lost = matches!(&self.outcome, Some(Outcome::Failed(failure)) if failure.is_loss());
        (self.phases, self.costs) = (self.phases(), self.costs());
        self.has_left = true;
        // Should no other run go on, this one shows its last state.
        self.scheme.find_neighbors(&self.run.state);
        self.scheme.inspect(&self.run.state, &mut Vec::new());
        if let Some(device) = &mut self.device {
            device.end_for_another(more);
        }
        self.device = None;
        !is_lost
    }

    /// What another run of the same case goes on from, whose `scheme` has more particles in reserve, after this one has been
    /// [left](Self::leave).
    pub fn handed_over(&mut self, scheme: &dyn Scheme) -> Checkpoint {
        let mut checkpoint = self.checkpoint();
        let history = checkpoint.history.iter_mut().flat_map(History::states);
        for state in history.chain([&mut checkpoint.state]) {
            *state = scheme.taken_over(self.scheme.as_ref(), state);
        }
        checkpoint
    }

    /// Goes on with what [`Self::handed_over`] gave, as if this had been the run all the time.
    ///
    /// # Errors
    /// As [`Self::resume`].
    pub fn take_over(&mut self, before: &Self, checkpoint: Checkpoint) -> Result<(), Misfit> {
        self.resume(checkpoint)?;
        self.run.resumed = before.run.resumed;
        (self.phases, self.costs) = (before.phases.clone(), before.costs.clone());
        Ok(())
    }
}
