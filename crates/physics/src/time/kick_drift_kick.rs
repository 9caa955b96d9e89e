//! The kick-drift-kick method.

use super::failure::Failure;
use super::integrator::{Integrator, Unserved};
use crate::schemes::split::KICK_DRIFT_KICK;
use crate::schemes::{Capability, PartitionedScheme, Scheme};

/// Half a kick, a drift, and half a kick with the accelerations at its end, CTVF (54) to (60).
///
/// Second order; for conservative forces it is the velocity Verlet method, which keeps the energy
/// of an undamped mode of angular frequency w within `(w dt)^2 / 4` of its own, without growth, up to
/// `w dt = 2`. Schemes that keep their accelerations in their state take one evaluation a step;
/// those that are [partitioned](PartitionedScheme) two, of which the first finds the rates of the
/// drift.
#[derive(Clone, Debug, Default)]
pub struct KickDriftKick {
    /// The end of the last step of a partitioned scheme, with the rates there.
    last: Vec<f64>,
    rate: Vec<f64>,
    time: f64,
}

impl KickDriftKick {
    /// Its name.
    pub const NAME: &str = KICK_DRIFT_KICK;

    fn partitioned(
        &mut self,
        scheme: &mut dyn PartitionedScheme,
        [time, step]: [f64; 2],
        old: &[f64],
        new: &mut [f64],
    ) {
        let (half, rows) = (0.5 * step, scheme.particle_count() * scheme.width());
        // A run that is resumed finds the same accelerations anew: they depend on places only.
        if self.time != time || self.last != old {
            self.rate.resize(old.len(), 0.0);
            scheme.rates(time, old, &mut self.rate);
        }
        let account = |rate: &[f64], new: &mut [f64]| {
            let tail = new[rows..].iter_mut().zip(&rate[rows..]);
            tail.for_each(|(integral, power)| *integral += half * power);
        };
        new.copy_from_slice(old);
        scheme.kick(half, &self.rate, new);
        scheme.constrain(time + half, new);
        scheme.rates(time, new, &mut self.rate);
        account(&self.rate, new);
        scheme.drift(step, &self.rate, new);
        scheme.rates(time + step, new, &mut self.rate);
        account(&self.rate, new);
        scheme.kick(half, &self.rate, new);
        scheme.constrain(time + step, new);
        self.time = time + step;
        self.last.clear();
        self.last.extend_from_slice(new);
    }
}

impl Integrator for KickDriftKick {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn evaluations(&self, scheme: &mut dyn Scheme) -> u64 {
        if scheme.split().is_some() { 1 } else { 2 }
    }

    fn energy_factor(&self, phase: f64) -> Option<f64> {
        // The larger of the two factors of the amplitude, squared: above 2 they are real.
        let half = 0.5 * phase * phase - 1.0;
        Some(if half <= 1.0 { 1.0 } else { (half + (half * half - 1.0).sqrt()).powi(2) })
    }

    fn renewed(&self, _scheme: &mut dyn Scheme) -> Option<Box<dyn Integrator>> {
        Some(Box::new(Self::default()))
    }

    fn step(
        &mut self,
        scheme: &mut dyn Scheme,
        time: f64,
        step: f64,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<(), Failure> {
        if let Some(split) = scheme.split() {
            new.copy_from_slice(old);
            split.kick(0.5 * step, new);
            split.drift(time, step, new);
            split.constrain(time + step, new);
            split.accelerate(time + step, new);
            split.kick(0.5 * step, new);
            return Ok(());
        }
        if let Some(scheme) = scheme.partitioned() {
            self.partitioned(scheme, [time, step], old, new);
            return Ok(());
        }
        match Capability::Kicks.is_offered_by(scheme) {
            // There is nothing to move.
            true => Ok(()),
            false => Err(Unserved::new(self.name(), scheme).into()),
        }
    }
}
