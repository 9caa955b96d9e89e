//! The kick-drift-kick method.

use super::failure::Failure;
use super::integrator::Integrator;
use crate::schemes::Scheme;

/// Half a kick, a drift, and half a kick with the accelerations at its end, CTVF (54) to (60).
///
/// Second order, one evaluation a step; for conservative forces it is the velocity Verlet method,
/// stable for undamped modes of angular frequency w up to `w dt = 2` without growth.
#[derive(Clone, Copy, Debug, Default)]
pub struct KickDriftKick;

impl Integrator for KickDriftKick {
    fn name(&self) -> &'static str {
        "kick_drift_kick"
    }

    fn evaluations(&self) -> u64 {
        1
    }

    /// A scheme that cannot be split stays where it is; the reader of cases refuses the pairing.
    fn step(
        &mut self,
        scheme: &mut dyn Scheme,
        time: f64,
        step: f64,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<(), Failure> {
        new.copy_from_slice(old);
        let Some(split) = scheme.split() else { return Ok(()) };
        split.kick(0.5 * step, new);
        split.drift(time, step, new);
        split.constrain(time + step, new);
        split.accelerate(time + step, new);
        split.kick(0.5 * step, new);
        Ok(())
    }
}
