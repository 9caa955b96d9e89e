//! Moments of a run that are kept: checkpoints, and marks to go back to.

use std::sync::Arc;

use super::{Executor, Previous};
use crate::schemes::{Phase, RankCosts, Scheme};
use crate::time::checkpoint::{Checkpoint, Checkpoints, Misfit};
use crate::time::failure::Failure;
use crate::time::history::History;
use crate::time::observer::ObserveError;
use crate::time::run::Run;
use crate::time::summary::{Outcome, Retry};

impl Executor {
    /// Takes checkpoints when they are due from now on.
    pub fn keep(&mut self, mut checkpoints: Checkpoints) {
        checkpoints.start(&self.run.clock);
        self.checkpoints = Some(checkpoints);
    }

    /// All that the steps to come depend on.
    pub fn checkpoint(&mut self) -> Checkpoint {
        self.bring();
        let Run { clock, tally, state, due, history, .. } = &self.run;
        Checkpoint {
            clock: *clock,
            tally: tally.clone(),
            state: state.to_vec(),
            due: due.clone(),
            observers: self.observers.iter().map(|observer| observer.save()).collect(),
            history: (self.retries > 0).then(|| history.clone()),
        }
    }

    /// Goes on from `checkpoint`. Scheme, integrator, settings and observers have to be those of the
    /// run that it was taken from.
    ///
    /// # Errors
    /// It cannot be a checkpoint of this run.
    pub fn resume(&mut self, checkpoint: Checkpoint) -> Result<(), Misfit> {
        checkpoint.check(self.run.state.len(), self.observers.len(), self.end)?;
        for (observer, saved) in self.observers.iter_mut().zip(&checkpoint.observers) {
            observer.restore(saved)?;
        }
        let Checkpoint { clock, tally, state, due, history, .. } = checkpoint;
        self.run = Run::at(clock, tally, state, due);
        self.run.resumed = Some((clock.time, clock.step));
        if let Some(history) = history {
            self.run.history = history;
        }
        self.previous.clock = clock;
        if let Some(checkpoints) = &mut self.checkpoints {
            checkpoints.start(&clock);
        }
        (self.is_seen, self.outcome, self.is_broken) = (false, None, false);
        self.is_here = true;
        self.hand_over();
        Ok(())
    }

    /// Ends the run because of a `cause` outside of it: at this state, or, where that is already affected, at the last
    /// mark.
    pub fn give_up(&mut self, cause: String, is_affected: bool) {
        let clock = if is_affected { self.run.history.last().clock } else { self.run.clock };
        let failure = Failure::Outside { cause, step: clock.step, time: clock.time };
        self.is_broken = false;
        match is_affected {
            true => self.lose(failure),
            false => self.outcome = Some(Outcome::Failed(failure)),
        }
    }

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

    /// Goes back to the older mark, with half the step from there on.
    pub(super) fn go_back(&mut self, failure: &Failure) -> Result<(), ObserveError> {
        let Run { clock, tally, state, due, history, .. } = &mut self.run;
        let (step, time) = (clock.step, clock.time);
        let (kind, factor) = (failure.kind().to_owned(), tally.factor * Self::RETRY_FACTOR);
        history.go_back().restore(clock, tally, due, Arc::make_mut(state).as_mut_slice());
        let (failure, back_to) = (failure.to_string(), clock.time);
        tally.retries.push(Retry { kind, failure, step, time, back_to, factor });
        tally.factor = factor;
        self.is_here = true;
        self.hand_over();
        for observer in &mut self.observers {
            observer.rewind(back_to)?;
        }
        Ok(())
    }

    /// Takes a checkpoint of a run that was interrupted, or that is to be continued later. It
    /// is taken before the observers are shown the last moment, which another end would not have.
    pub(super) fn save_at_end(&mut self, outcome: &Outcome) {
        let wanted = |completed| {
            let checkpoints = self.checkpoints.as_ref();
            checkpoints.is_some_and(|it| it.wanted_at(completed, &self.run.clock))
        };
        let take = match outcome {
            Outcome::Completed => wanted(true),
            Outcome::Interrupted => wanted(false),
            Outcome::Failed(Failure::Outside { .. }) => wanted(false),
            Outcome::Failed(failure) if failure.is_loss() => wanted(false),
            Outcome::Failed(_) => false,
        };
        if take {
            self.save();
        }
    }

    pub(super) fn save(&mut self) {
        let checkpoint = self.checkpoint();
        let Some(checkpoints) = &mut self.checkpoints else { return };
        let tally = &mut self.run.tally;
        let kept = tally.watches.checkpoint.time(|| checkpoints.keep(&checkpoint));
        tally.warnings.extend(kept.err());
    }
}
