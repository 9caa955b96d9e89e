//! Moments of a run that are kept: checkpoints, and marks to go back to.

use std::sync::Arc;

use super::Executor;
use crate::time::checkpoint::{Checkpoint, Checkpoints, Misfit};
use crate::time::failure::Failure;
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
