//! The loop over steps.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::failure::Failure;
use super::integrator::Integrator;
use super::observer::{Moment, ObserveError, Observer};
use super::step::{ChosenStep, StepControl};
use crate::schemes::{Health, Scheme, StepLimit};

/// Owns a run: the clock, the state, the observers, and the reasons to stop.
pub struct Executor {
    /// The formulation.
    pub scheme: Box<dyn Scheme>,
    /// The integrator.
    pub integrator: Box<dyn Integrator>,
    /// How steps are chosen.
    pub control: StepControl,
    /// Simulated time at which the run ends in s.
    pub end: f64,
    /// Most steps.
    pub max_steps: u64,
    /// A smaller step in s is a failure; by default [`Executor::FLOOR`] of the first.
    pub min_step: Option<f64>,
    /// Who looks.
    pub observers: Vec<Box<dyn Observer>>,
}

/// Where a run stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Simulated time in s.
    pub time: f64,
    /// Where it ends in s.
    pub end: f64,
    /// Steps taken.
    pub step: u64,
    /// Size of the last step in s.
    pub step_size: f64,
    /// What limited it.
    pub limiter: &'static str,
    /// Evaluations of the rates times particles so far.
    pub evaluations: u64,
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// At its end.
    Completed,
    /// On request, after a whole step.
    Interrupted,
    /// With a failure; the last good state has been shown to all observers.
    Failed(Failure),
}

impl Outcome {
    /// One line for tables and checks: `completed`, `interrupted` or `failed: KIND`.
    pub fn summary(&self) -> String {
        match self {
            Self::Completed => "completed".into(),
            Self::Interrupted => "interrupted".into(),
            Self::Failed(failure) => format!("failed: {}", failure.kind()),
        }
    }
}

/// Wall time of one stage of the loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timing {
    /// Its name.
    pub stage: &'static str,
    /// Wall time in s.
    pub seconds: f64,
    /// How often it ran.
    pub calls: u64,
}

/// What is known at the end of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// How it ended.
    pub outcome: Outcome,
    /// Simulated time reached in s.
    pub time: f64,
    /// Steps taken.
    pub steps: u64,
    /// The step that the first state allows, before it is shortened to meet an output, in s.
    pub first_step: f64,
    /// Smallest and largest step taken in s.
    pub step_range: [f64; 2],
    /// Smallest volume ratio over the run.
    pub smallest_ratio: f64,
    /// Largest difference between evolved J and det F over the run.
    pub ratio_mismatch: f64,
    /// Largest speed over the run in m/s.
    pub largest_speed: f64,
    /// Evaluations of the rates times particles.
    pub evaluations: u64,
    /// Wall time by stage.
    pub timings: Vec<Timing>,
}

/// Stop watches of the loop.
#[derive(Default)]
struct Watches {
    inspect: (Duration, u64),
    step: (Duration, u64),
    observe: (Duration, u64),
}

fn timed<T>(watch: &mut (Duration, u64), body: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let value = body();
    watch.0 += start.elapsed();
    watch.1 += 1;
    value
}

/// The moving parts of a run.
struct Clock {
    state: Vec<f64>,
    time: f64,
    step: u64,
    chosen: ChosenStep,
    health: Health,
}

impl Executor {
    /// A volume ratio below this is a particle that is collapsing.
    const CRUSHED: f64 = 0.1;

    /// The default floor of the step as a fraction of the first.
    pub const FLOOR: f64 = 1e-6;

    /// Runs to the end, to a failure, or until `stop` is set, and calls `progress` each step.
    ///
    /// # Errors
    /// A fault of an observer. What was observed before stays.
    pub fn run(
        &mut self,
        stop: &AtomicBool,
        progress: &mut dyn FnMut(&Progress),
    ) -> Result<Summary, ObserveError> {
        let start = ChosenStep { step: 0.0, limiter: "start", particle: 0 };
        let mut clock = Clock {
            state: self.scheme.initial_state(),
            time: 0.0,
            step: 0,
            chosen: start,
            health: Health::NEUTRAL,
        };
        self.scheme.constrain(0.0, &mut clock.state);
        // The state before the last step: where a run goes back to when a step fails.
        let mut previous = clock.state.clone();
        let mut previous_clock = (clock.time, clock.step, clock.chosen, clock.health);
        let mut next = clock.state.clone();
        let mut due: Vec<Option<f64>> = self
            .observers
            .iter()
            .map(|observer| match observer.schedule() {
                schedule if schedule.includes_start() => Some(0.0),
                schedule => schedule.next_after(0.0),
            })
            .collect();
        let mut limits: Vec<StepLimit> = Vec::with_capacity(8);
        let mut watches = Watches::default();
        let mut worst = Health::NEUTRAL;
        let mut first_step = f64::NAN;
        let mut step_range = [f64::INFINITY, 0.0];
        let evaluations = self.integrator.evaluations() * self.scheme.particle_count() as u64;

        let outcome = loop {
            let health =
                timed(&mut watches.inspect, || self.scheme.inspect(&clock.state, &mut limits));
            if let Some(failure) = self.broken(&health, clock.step, clock.time) {
                if clock.step > 0 {
                    std::mem::swap(&mut clock.state, &mut previous);
                    (clock.time, clock.step, clock.chosen, clock.health) = previous_clock;
                }
                break Outcome::Failed(failure);
            }
            clock.health = health;
            worst = worst.worse(health);
            let ended = clock.time >= self.end * (1.0 - 1e-12);
            if ended {
                break Outcome::Completed;
            }
            timed(&mut watches.observe, || self.observe(&mut clock, &mut due, false))?;
            if stop.load(Ordering::Relaxed) {
                break Outcome::Interrupted;
            }
            let chosen = match self.choose(&limits, &clock, first_step) {
                Ok(chosen) => chosen,
                Err(failure) => break Outcome::Failed(failure),
            };
            if clock.step == 0 {
                first_step = chosen.step;
            }
            let soonest = due.iter().flatten().copied().fold(self.end, f64::min);
            let met = self.control.meet(chosen, clock.time, soonest);
            timed(&mut watches.step, || {
                let scheme = self.scheme.as_mut();
                self.integrator.step(scheme, clock.time, met.step, &clock.state, &mut next);
            });
            previous_clock = (clock.time, clock.step, clock.chosen, clock.health);
            std::mem::swap(&mut previous, &mut clock.state);
            std::mem::swap(&mut clock.state, &mut next);
            clock.step += 1;
            clock.time = match self.control {
                StepControl::Fixed(step) => clock.step as f64 * step,
                StepControl::Cfl(_) if met.step == soonest - clock.time => soonest,
                StepControl::Cfl(_) => clock.time + met.step,
            };
            clock.chosen = met;
            step_range = [step_range[0].min(met.step), step_range[1].max(met.step)];
            progress(&Progress {
                time: clock.time,
                end: self.end,
                step: clock.step,
                step_size: met.step,
                limiter: met.limiter,
                evaluations: evaluations * clock.step,
            });
        };
        timed(&mut watches.observe, || self.observe(&mut clock, &mut due, true))?;
        let timing = |stage, (duration, calls): (Duration, u64)| Timing {
            stage,
            seconds: duration.as_secs_f64(),
            calls,
        };
        Ok(Summary {
            outcome,
            time: clock.time,
            steps: clock.step,
            first_step,
            step_range,
            smallest_ratio: worst.smallest_ratio,
            ratio_mismatch: worst.ratio_mismatch,
            largest_speed: worst.largest_speed,
            evaluations: evaluations * clock.step,
            timings: vec![
                timing("step", watches.step),
                timing("inspect", watches.inspect),
                timing("observe", watches.observe),
            ],
        })
    }

    /// The failure that a state's health shows, if any.
    fn broken(&self, health: &Health, step: u64, time: f64) -> Option<Failure> {
        if let Some(index) = health.first_not_finite {
            return Some(Failure::NotFinite { particle: self.scheme.particle(index), step, time });
        }
        if health.smallest_ratio > 0.0 {
            return None;
        }
        let index = health.smallest_ratio_particle;
        Some(Failure::Inverted {
            particle: self.scheme.particle(index),
            ratio: health.smallest_ratio,
            step,
            time,
            advice: self.scheme.collapse_advice(index),
        })
    }

    fn choose(
        &self,
        limits: &[StepLimit],
        clock: &Clock,
        first_step: f64,
    ) -> Result<ChosenStep, Failure> {
        let (time, step) = (clock.time, clock.step);
        if step >= self.max_steps {
            return Err(Failure::TooManySteps { steps: step, time });
        }
        let chosen = self.control.choose(limits)?;
        // Before the first step, and after one without any limit, there is nothing to compare to.
        let first = if first_step.is_finite() { first_step } else { 0.0 };
        let floor = self.min_step.unwrap_or(Self::FLOOR * first);
        // A step of zero, or of no number, would never get to the end.
        if !(chosen.step > 0.0 && chosen.step >= floor) {
            let ChosenStep { step: size, limiter, particle } = chosen;
            let Health { smallest_ratio: ratio, smallest_ratio_particle, .. } = clock.health;
            let advice = if ratio < Self::CRUSHED {
                self.scheme.collapse_advice(smallest_ratio_particle)
            } else {
                "raise `scheme.tau_velocity`, or lower `time.min_step`".into()
            };
            return Err(Failure::StepBelowFloor {
                particle: self.scheme.particle(particle),
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

    /// Shows the moment to the observers for whom it is due, or to all if it is the last.
    fn observe(
        &mut self,
        clock: &mut Clock,
        due: &mut [Option<f64>],
        last: bool,
    ) -> Result<(), ObserveError> {
        for (observer, due) in self.observers.iter_mut().zip(due) {
            let is_due = due.is_some_and(|due| due <= clock.time * (1.0 + 1e-12));
            if !is_due && !last {
                continue;
            }
            observer.observe(&mut Moment {
                time: clock.time,
                step: clock.step,
                step_size: clock.chosen.step,
                limiter: clock.chosen.limiter,
                health: &clock.health,
                scheme: self.scheme.as_mut(),
                state: &clock.state,
                last,
            })?;
            *due = observer.schedule().next_after(clock.time);
        }
        Ok(())
    }
}
