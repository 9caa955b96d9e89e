//! Whether a state is sound and how far the next step may go.

use super::clock::{Clock, Tally};
use super::executor::Executor;
use super::failure::Failure;
use super::step::{ChosenStep, StepControl};
use crate::schemes::{Health, Particle, StepLimit};

impl Executor {
    /// A volume ratio below this is a particle that is collapsing.
    const CRUSHED: f64 = 0.1;

    /// The speed in m/s above which a run that starts with these has gone wrong.
    fn speed_limit(&self, [speed, wave_speed]: [f64; 2]) -> f64 {
        // A scheme without waves gives no measure.
        let limit = match wave_speed > 0.0 {
            true => Self::TOO_FAST * (speed + wave_speed),
            false => f64::INFINITY,
        };
        self.max_speed.unwrap_or(limit)
    }

    /// Reference position and number of a particle in a state.
    fn particle(&self, index: usize, state: &[f64]) -> Particle {
        let ids = self.scheme.ids_of(state, &[index as u32]);
        let particle = self.scheme.particle(index);
        Particle { id: ids.first().copied().unwrap_or(particle.id), ..particle }
    }

    /// The failure that a state's health shows, if any.
    pub(super) fn broken(
        &self,
        health: &Health,
        state: &[f64],
        clock: &Clock,
        start_speeds: [f64; 2],
    ) -> Option<Failure> {
        let (step, time) = (clock.step, clock.time);
        let speed_limit = self.speed_limit(start_speeds);
        let advice = self.scheme.stability_advice();
        if let Some(index) = health.first_not_finite {
            let particle = self.particle(index, state);
            return Some(Failure::NotFinite { index, particle, step, time, advice });
        }
        if !(health.smallest_ratio > 0.0) {
            let index = health.smallest_ratio_particle;
            return Some(Failure::Inverted {
                index,
                particle: self.particle(index, state),
                ratio: health.smallest_ratio,
                step,
                time,
                advice: match supersonic(start_speeds) {
                    Some(cause) => {
                        format!("{cause}; otherwise {}", self.scheme.collapse_advice(index))
                    }
                    None => self.scheme.collapse_advice(index),
                },
            });
        }
        if let Some(index) = health.first_escaped
            && let Some(escape) = self.scheme.escape(index, state)
        {
            let particle = self.particle(index, state);
            let escape = Box::new(escape);
            return Some(Failure::Escaped { index, particle, escape, step, time });
        }
        if health.largest_speed > speed_limit {
            let index = health.largest_speed_particle;
            return Some(Failure::TooFast {
                index,
                particle: self.particle(index, state),
                speed: health.largest_speed,
                limit: speed_limit,
                step,
                time,
                advice,
            });
        }
        None
    }

    /// The next step, or the failure that there is none.
    pub(super) fn choose(
        &self,
        limits: &[StepLimit],
        clock: &Clock,
        tally: &Tally,
    ) -> Result<ChosenStep, Failure> {
        let (time, step) = (clock.time, clock.step);
        if step >= self.max_steps {
            return Err(Failure::TooManySteps { steps: step, time });
        }
        let mut chosen = self.control.choose(limits).map_err(|too_large| {
            let index = too_large.bound.particle;
            Failure::FixedStepTooLarge {
                index,
                particle: self.particle(index, &self.run.state),
                step: too_large.step,
                stable: too_large.bound.step,
                limiter: too_large.bound.limiter,
                time,
            }
        })?;
        if let StepControl::Cfl(_) = self.control {
            let growth = limits.iter().map(|limit| limit.growth).fold(f64::INFINITY, f64::min);
            let most = tally.wanted * growth;
            // A step that is no number stays one, and infinity times anything is no bound.
            if chosen.step > most {
                chosen.step = most;
            }
        }
        chosen.step *= tally.factor;
        if tally.factor < 1.0 && self.integrator.growth().is_some() {
            chosen.limiter = Self::ACCURACY;
        }
        // Before the first step, and after one without any limit, there is nothing to compare to.
        let first_step = tally.first_step;
        let first = if first_step.is_finite() { first_step } else { 0.0 };
        let floor = self.min_step.unwrap_or(Self::FLOOR * first);
        // A step of zero, or of no number, would never get to the end.
        if !(chosen.step > 0.0 && chosen.step >= floor) {
            let ChosenStep { step: size, limiter, particle: index } = chosen;
            let Health { smallest_ratio: ratio, smallest_ratio_particle, .. } = clock.health;
            let advice = if ratio < Self::CRUSHED {
                self.scheme.collapse_advice(smallest_ratio_particle)
            } else if limiter == Self::ACCURACY {
                "raise `time.error`, or lower `time.min_step`".into()
            } else {
                format!("{}, or lower `time.min_step`", self.scheme.stability_advice())
            };
            return Err(Failure::StepBelowFloor {
                index,
                particle: self.particle(index, &self.run.state),
                size,
                floor,
                limiter,
                ratio,
                step,
                time,
                advice,
            });
        }
        Ok(chosen)
    }
}

/// What the user should know if a run starts with a speed above the speed of its waves, in m/s:
/// possible, but most often a stiffness in another unit.
pub fn supersonic([speed, wave_speed]: [f64; 2]) -> Option<String> {
    (speed > wave_speed && wave_speed > 0.0).then(|| {
        format!(
            "the largest speed at the start, {speed:.3e} m/s, is above the wave speed of the \
             material, {wave_speed:.3e} m/s: check the stiffness, the density and their units"
        )
    })
}
