//! What observes a run.

use thiserror::Error;

use super::checkpoint::Misfit;
use super::schedule::Schedule;
use crate::schemes::{Health, Observation};

/// One instant of a run.
pub struct Moment<'a, 'b> {
    /// Steps taken.
    pub step: u64,
    /// Size of the last step in s, 0 at the start.
    pub step_size: f64,
    /// What limited it.
    pub limiter: &'static str,
    /// Health of the state.
    pub health: &'a Health,
    /// The formulation at the state.
    pub now: &'a mut Observation<'b>,
    /// Whether it is the last one: the end, an interruption, or the last good state of a run
    /// that failed.
    pub last: bool,
}

/// A fault of an observer, in practice of a file.
#[derive(Debug, Error)]
#[error("{what} at t = {time} s: {source}")]
pub struct ObserveError {
    /// What was being done.
    pub what: &'static str,
    /// Simulated time in s.
    pub time: f64,
    /// The fault itself.
    pub source: Box<dyn std::error::Error + Send + Sync>,
}

/// Something that observes chosen moments, and the last one, which it may have been shown
/// already: then it sees it again, marked as the last.
pub trait Observer: Send {
    /// When it wants to look.
    fn schedule(&self) -> &Schedule;

    /// Looks.
    ///
    /// # Errors
    /// A fault stops the run.
    fn observe(&mut self, moment: &mut Moment) -> Result<(), ObserveError>;

    /// What it has to remember for a run that continues from a checkpoint taken now. One without
    /// memory need not say anything.
    fn save(&self) -> Vec<u8> {
        Vec::new()
    }

    /// Takes up what [`Observer::save`] gave.
    ///
    /// # Errors
    /// `saved` is not of such an observer.
    fn restore(&mut self, saved: &[u8]) -> Result<(), Misfit> {
        match saved {
            [] => Ok(()),
            _ => Err(Misfit(
                "one of its outputs holds data that the output of this run does not know".into(),
            )),
        }
    }

    /// Forgets all that it was shown after `time` in s, because the run goes back there.
    ///
    /// # Errors
    /// A fault stops the run.
    fn rewind(&mut self, _time: f64) -> Result<(), ObserveError> {
        Ok(())
    }
}
