//! What a formulation offers to integrators that take velocities and places in turn.

use super::Scheme;
use crate::{Vector, parallel};

/// The name of the method that takes kicks and drifts in turn.
pub(crate) const KICK_DRIFT_KICK: &str = "kick_drift_kick";

/// A formulation whose state holds the accelerations that belong to it, so that a step can be
/// split into kicks, which change velocities only, and drifts, which change all the rest.
///
/// The state that [`Scheme::initial_state`] gives holds them already.
pub trait SplitScheme: Scheme {
    /// Changes velocities by their stored accelerations times `duration` s, CTVF (54) and (60).
    fn kick(&mut self, duration: f64, state: &mut [f64]);

    /// Moves places, densities and pressures from `time` to `time + step` with the velocities as
    /// they are, which are those of the middle of the step, CTVF (55) to (59).
    fn drift(&mut self, time: f64, step: f64, state: &mut [f64]);

    /// Finds the accelerations of `state` at `time` and stores them in it.
    fn accelerate(&mut self, time: f64, state: &mut [f64]);

    /// The same, to the bit, of a state that may differ from the last one in its velocities alone: what follows from
    /// places need not be found again.
    fn settle(&mut self, time: f64, state: &mut [f64]) {
        self.accelerate(time, state);
    }

    /// The same between two steps, where velocities have changed by an acceleration times the length of a step: forces of
    /// which the order in time is the first anyway may be those of the velocities before.
    fn settle_between(&mut self, time: f64, state: &mut [f64]) {
        self.settle(time, state);
    }
}

/// A formulation whose accelerations depend on places alone, and all else on velocities and places:
/// nothing in it dissipates.
pub trait PartitionedScheme: Scheme {
    /// Changes velocities by the accelerations in `rate` times `duration` s.
    fn kick(&self, duration: f64, rate: &[f64], state: &mut [f64]);

    /// Moves all the rest of the rows by `duration` s, on straight paths with the velocities as they
    /// are, of which `rate` has the rates at the start. The ledger is not its own.
    fn drift(&self, duration: f64, rate: &[f64], state: &mut [f64]);
}

/// Moves a column by its rates for a duration in s.
pub(crate) fn advance<const D: usize>(column: &mut [Vector<D>], rate: &[Vector<D>], duration: f64) {
    parallel::for_each_chunk(column, |first, column| {
        for (value, rate) in column.iter_mut().zip(&rate[first..]) {
            *value += rate * duration;
        }
    });
}
