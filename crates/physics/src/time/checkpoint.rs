//! All that a run needs to go on from where it stands.

use std::error::Error;
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::clock::{Clock, Tally};
use super::history::History;

/// A run at one instant, after the observers that were due have looked and before the next step.
/// What it holds is all that the steps to come depend on, so that a run that continues from it
/// equals to the bit one that was never interrupted.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Checkpoint {
    pub(super) clock: Clock,
    pub(super) tally: Tally,
    pub(super) state: Vec<f64>,
    /// When each observer is due next, in s.
    pub(super) due: Vec<Option<f64>>,
    /// What each observer has to remember.
    pub(super) observers: Vec<Vec<u8>>,
    /// The last steps, where a failure may send the run back to them.
    pub(super) history: Option<History>,
}

/// A checkpoint that does not belong to what it is to continue.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("the checkpoint does not fit: {0}")]
pub struct Misfit(pub String);

impl Checkpoint {
    /// Nothing needs more.
    const MOST_STEPS: u64 = 1 << 60;

    /// Simulated time in s.
    pub fn time(&self) -> f64 {
        self.clock.time
    }

    /// Steps taken.
    pub fn step(&self) -> u64 {
        self.clock.step
    }

    /// Refuses what cannot be a checkpoint of a run with states of `length` numbers, `observers`
    /// observers and this `end`.
    pub(super) fn check(&self, length: usize, observers: usize, end: f64) -> Result<(), Misfit> {
        let refuse = |what: String| Err(Misfit(what));
        let lengths = self.history.iter().flat_map(History::lengths);
        for got in lengths.chain([self.state.len()]) {
            if got != length {
                return refuse(format!("its state has {got} numbers, this run has {length}"));
            }
        }
        let outputs = self.history.iter().flat_map(History::outputs);
        for got in outputs.chain([self.observers.len(), self.due.len()]) {
            if got != observers {
                return refuse(format!("it knows {got} outputs, this run has {observers}"));
            }
        }
        let step = self.clock.step;
        let marks = self.history.iter().flat_map(History::mark_steps);
        if step > Self::MOST_STEPS || marks.into_iter().any(|mark| mark > step) {
            return refuse(format!("its number of steps, {step}, is not possible"));
        }
        let time = self.clock.time;
        if !(time >= 0.0 && time <= end * (1.0 + 1e-12)) {
            return refuse(format!("it is at t = {time} s, and the run goes from 0 to {end} s"));
        }
        Ok(())
    }
}

/// When checkpoints are taken. Each of the intervals may be given or not.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CheckpointPolicy {
    /// After this many steps.
    pub steps: Option<u64>,
    /// At the first step at or after each multiple of this many seconds of simulated time. Steps are
    /// not shortened for it: results do not depend on checkpoints.
    pub time: Option<f64>,
    /// After so much wall time.
    pub wall: Option<Duration>,
    /// When the run is complete.
    pub at_end: bool,
}

/// Where checkpoints go.
pub trait CheckpointStore: Send {
    /// Keeps `checkpoint`.
    ///
    /// # Errors
    /// It could not be kept; the run goes on and says so at its end.
    fn store(&mut self, checkpoint: &Checkpoint) -> Result<(), Box<dyn Error + Send + Sync>>;
}

/// Takes checkpoints when they are due.
pub struct Checkpoints {
    policy: CheckpointPolicy,
    store: Box<dyn CheckpointStore>,
    last: Instant,
    last_time: f64,
    last_step: Option<u64>,
}

impl Checkpoints {
    /// Puts checkpoints into `store` as `policy` says, and one whenever the run is interrupted.
    pub fn new(policy: CheckpointPolicy, store: Box<dyn CheckpointStore>) -> Self {
        Self { policy, store, last: Instant::now(), last_time: 0.0, last_step: None }
    }

    /// Takes note that the run starts here.
    pub(super) fn start(&mut self, clock: &Clock) {
        self.last = Instant::now();
        self.last_time = clock.time;
        self.last_step = Some(clock.step);
    }

    /// Whether one is due.
    pub(super) fn due(&self, clock: &Clock) -> bool {
        let CheckpointPolicy { steps, time, wall, .. } = self.policy;
        if self.last_step == Some(clock.step) {
            return false;
        }
        let by_steps = steps.is_some_and(|steps| clock.step.is_multiple_of(steps.max(1)));
        let multiple = |interval: f64, time: f64| (time / interval * (1.0 + 1e-12)).floor();
        let by_time = time.is_some_and(|interval| {
            interval > 0.0 && multiple(interval, clock.time) > multiple(interval, self.last_time)
        });
        by_steps || by_time || wall.is_some_and(|wall| self.last.elapsed() >= wall)
    }

    /// Whether one is wanted when the run ends like this.
    pub(super) fn wanted_at(&self, completed: bool, clock: &Clock) -> bool {
        let new = self.last_step != Some(clock.step) || clock.step == 0;
        new && (!completed || self.policy.at_end)
    }

    /// Keeps a checkpoint, or tells why it could not.
    pub(super) fn keep(&mut self, checkpoint: &Checkpoint) -> Result<(), String> {
        self.last = Instant::now();
        self.last_time = checkpoint.clock.time;
        self.last_step = Some(checkpoint.clock.step);
        self.store.store(checkpoint).map_err(|error| {
            let (step, time) = (checkpoint.clock.step, checkpoint.clock.time);
            format!("no checkpoint was written after step {step}, t = {time} s: {error}")
        })
    }
}
