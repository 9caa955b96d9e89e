//! The loop over steps.

use std::sync::atomic::{AtomicBool, Ordering};

use super::checkpoint::{Checkpoint, Checkpoints, Misfit};
use super::clock::{Clock, Tally};
use super::failure::Failure;
use super::history::{History, Mark};
use super::integrator::Integrator;
use super::judgement::supersonic;
use super::observer::{Moment, ObserveError, Observer};
use super::step::{ChosenStep, StepControl};
use super::summary::{Outcome, Progress, Retry, Summary};
use crate::schemes::{Observation, Scheme, StepLimit};

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
    /// A larger speed in m/s is a failure; by default [`Executor::TOO_FAST`] times the sum of the
    /// largest speed and the largest wave speed at the start.
    pub max_speed: Option<f64>,
    /// How often a run that goes wrong may go back and try with half the step. A fixed step is
    /// never changed.
    pub retries: usize,
    /// Who looks.
    pub observers: Vec<Box<dyn Observer>>,
    /// When and where checkpoints are taken.
    pub checkpoints: Option<Checkpoints>,
    resume: Option<Checkpoint>,
}

/// A run between two steps.
struct Run {
    clock: Clock,
    tally: Tally,
    state: Vec<f64>,
    /// When each observer is due next.
    due: Vec<Option<f64>>,
    history: History,
    resumed: Option<(f64, u64)>,
}

/// What a look at a state leads to.
enum Verdict {
    Sound,
    Back,
    End(Outcome),
}

impl Executor {
    /// The default floor of the step as a fraction of the first.
    pub const FLOOR: f64 = 1e-6;

    /// How much faster than speed and wave speed at the start is too fast. What is simulated with
    /// explicit steps moves at about these speeds; what moves ten times as fast has broken up.
    pub const TOO_FAST: f64 = 10.0;

    /// What a retry multiplies the steps by.
    pub const RETRY_FACTOR: f64 = 0.5;

    /// What multiplies steps that retries have made shorter, after one that was quick.
    pub const GROWTH_FACTOR: f64 = 1.5;

    /// What limits a step that the error of longer ones would be too large for.
    pub const ACCURACY: &str = "accuracy";

    /// A run without observers and checkpoints, with as many steps as it takes and no retries.
    pub fn new(
        scheme: Box<dyn Scheme>,
        integrator: Box<dyn Integrator>,
        control: StepControl,
        end: f64,
    ) -> Self {
        Self {
            scheme,
            integrator,
            control,
            end,
            max_steps: u64::MAX,
            min_step: None,
            max_speed: None,
            retries: 0,
            observers: Vec::new(),
            checkpoints: None,
            resume: None,
        }
    }

    /// The formulation that it moves.
    pub fn scheme(&self) -> &dyn Scheme {
        self.scheme.as_ref()
    }

    /// Lets the run go on from `checkpoint` instead of the start. Scheme, integrator, settings and
    /// observers have to be those of the run that it was taken from.
    ///
    /// # Errors
    /// It cannot be a checkpoint of this run.
    pub fn resume(&mut self, checkpoint: Checkpoint) -> Result<(), Misfit> {
        let length = self.scheme.initial_state().len();
        checkpoint.check(length, self.observers.len(), self.end)?;
        for (observer, saved) in self.observers.iter_mut().zip(&checkpoint.observers) {
            observer.restore(saved)?;
        }
        self.resume = Some(checkpoint);
        Ok(())
    }

    /// Runs to the end, to a failure, or until `stop` is set, and calls `progress` each step.
    ///
    /// # Errors
    /// A fault of an observer. What was observed before stays.
    pub fn run(
        &mut self,
        stop: &AtomicBool,
        progress: &mut dyn FnMut(&Progress),
    ) -> Result<Summary, ObserveError> {
        let mut run = self.start();
        if let Some(checkpoints) = &mut self.checkpoints {
            checkpoints.start(&run.clock);
        }
        let mut next = run.state.clone();
        // The state before the last step: where a run goes back to when a step fails for good.
        let mut previous = (run.clock, run.state.clone());
        let mut limits: Vec<StepLimit> = Vec::with_capacity(8);
        let evaluations =
            self.integrator.evaluations(self.scheme.as_mut()) * self.scheme.particle_count() as u64;
        let mut failed_in_step = false;

        let outcome = loop {
            match self.judge(&mut run, &mut limits)? {
                Verdict::Sound => {}
                Verdict::Back => continue,
                Verdict::End(outcome) => {
                    failed_in_step = matches!(outcome, Outcome::Failed(_));
                    break outcome;
                }
            }
            self.show(&mut run, false)?;
            run.history.mark(&run.clock, &run.tally, &run.due, &run.state);
            self.save_if_due(&mut run);
            if stop.load(Ordering::Relaxed) {
                break Outcome::Interrupted;
            }
            let chosen = match self.choose(&limits, &run.clock, &run.tally) {
                Ok(chosen) => chosen,
                Err(failure) => break Outcome::Failed(failure),
            };
            if run.clock.step == 0 {
                run.tally.first_step = chosen.step;
            }
            let soonest = run.due.iter().flatten().copied().fold(self.end, f64::min);
            let met = self.control.meet(chosen, run.clock.time, soonest);
            let (scheme, integrator) = (self.scheme.as_mut(), self.integrator.as_mut());
            let taken =
                run.tally.watches.step.time(|| {
                    integrator.step(scheme, run.clock.time, met.step, &run.state, &mut next)
                });
            let growth = self.integrator.growth();
            if let (Err(Failure::Inaccurate { .. }), Some(growth), true) =
                (&taken, growth, self.control.adapts())
            {
                run.tally.factor *= growth * met.step / chosen.step;
                continue;
            }
            if let Err(failure) = taken {
                if run.tally.retries.len() < self.retries && self.control.adapts() {
                    run.shorten(&failure);
                    continue;
                }
                break Outcome::Failed(failure);
            }
            previous.0 = run.clock;
            std::mem::swap(&mut previous.1, &mut run.state);
            std::mem::swap(&mut run.state, &mut next);
            run.tally.wanted = chosen.step / run.tally.factor;
            run.advance(self.control, met, soonest);
            run.lengthen(self.integrator.as_ref(), self.scheme.as_ref(), chosen, met);
            progress(&Progress {
                time: run.clock.time,
                end: self.end,
                step: run.clock.step,
                step_size: met.step,
                limiter: met.limiter,
                evaluations: evaluations * run.clock.step,
                retries: run.tally.retries.len(),
            });
        };
        let trace = match &outcome {
            Outcome::Failed(failure) => self.trace(&run.history, failure),
            _ => None,
        };
        if failed_in_step && run.clock.step > previous.0.step {
            (run.clock, run.state) = previous;
        }
        self.save_at_end(&mut run, &outcome);
        self.show(&mut run, true)?;
        Ok(Summary {
            outcome,
            time: run.clock.time,
            steps: run.clock.step,
            first_step: run.tally.first_step,
            step_range: run.tally.step_range,
            worst: run.tally.worst,
            evaluations: evaluations * run.clock.step,
            timings: run.tally.watches.timings(),
            retries: run.tally.retries,
            trace,
            resumed: run.resumed,
            warnings: run.tally.warnings,
        })
    }

    /// The run at its first instant, or at that of the checkpoint to resume from.
    fn start(&mut self) -> Run {
        if let Some(checkpoint) = self.resume.take() {
            let Checkpoint { clock, tally, state, due, history, .. } = checkpoint;
            let mark =
                || Mark { clock, tally: tally.clone(), due: due.clone(), state: state.clone() };
            let history = history.unwrap_or_else(|| History::new(mark()));
            let resumed = Some((clock.time, clock.step));
            return Run { clock, tally, state, due, history, resumed };
        }
        let mut state = self.scheme.initial_state();
        self.scheme.constrain(0.0, &mut state);
        let due: Vec<Option<f64>> = self
            .observers
            .iter()
            .map(|observer| match observer.schedule() {
                schedule if schedule.includes_start() => Some(0.0),
                schedule => schedule.next_after(0.0),
            })
            .collect();
        let (clock, tally) = (Clock::START, Tally::START);
        let mark = Mark { clock, tally: tally.clone(), due: due.clone(), state: state.clone() };
        let history = History::new(mark);
        Run { clock, tally, state, due, history, resumed: None }
    }

    /// Looks at the state: it is sound, or the run ends, or it goes back.
    fn judge(
        &mut self,
        run: &mut Run,
        limits: &mut Vec<StepLimit>,
    ) -> Result<Verdict, ObserveError> {
        let Run { clock, tally, state, .. } = run;
        let scheme = self.scheme.as_mut();
        let health = tally.watches.inspect.time(|| scheme.inspect(state, limits));
        if clock.step == 0 {
            tally.start_speeds = [health.largest_speed, health.largest_wave_speed];
            tally.warnings.extend(supersonic(tally.start_speeds));
        }
        if let Some(failure) = self.broken(&health, state, clock, tally.start_speeds) {
            let may_retry =
                run.tally.retries.len() < self.retries && clock.step > 0 && self.control.adapts();
            if !may_retry {
                return Ok(Verdict::End(Outcome::Failed(failure)));
            }
            self.go_back(run, &failure)?;
            return Ok(Verdict::Back);
        }
        if let (false, Some(warning)) = (tally.warned, self.scheme.warning()) {
            let Clock { step, time, .. } = *clock;
            tally.warnings.push(format!("{warning}; seen first at t = {time:e} s, step {step}"));
            tally.warned = true;
        }
        clock.health = health;
        tally.worst = tally.worst.worse(health);
        let ended = clock.time >= self.end * (1.0 - 1e-12);
        Ok(if ended { Verdict::End(Outcome::Completed) } else { Verdict::Sound })
    }

    /// Goes back to the older mark, with half the step from there on.
    fn go_back(&mut self, run: &mut Run, failure: &Failure) -> Result<(), ObserveError> {
        let Run { clock, tally, state, due, history, .. } = run;
        let (step, time) = (clock.step, clock.time);
        let mark = history.go_back();
        // What the failed attempt took of wall time, that it was made, and its warnings are not forgotten.
        let (watches, mut retries) = (tally.watches, std::mem::take(&mut tally.retries));
        let (warnings, warned) = (std::mem::take(&mut tally.warnings), tally.warned);
        let factor = tally.factor * Self::RETRY_FACTOR;
        let back_to = mark.clock.time;
        let kind = failure.kind().to_owned();
        retries.push(Retry { kind, failure: failure.to_string(), step, time, back_to, factor });
        *clock = mark.clock;
        *tally = Tally { watches, retries, warnings, warned, factor, ..mark.tally.clone() };
        state.copy_from_slice(&mark.state);
        due.copy_from_slice(&mark.due);
        for observer in &mut self.observers {
            observer.rewind(back_to)?;
        }
        Ok(())
    }

    /// What happened around the particle of `failure`.
    fn trace(&mut self, history: &History, failure: &Failure) -> Option<super::Trace> {
        let index = failure.particle()?;
        Some(history.trace(self.scheme.as_mut(), self.integrator.as_mut(), index))
    }

    /// Shows the moment to the observers for whom it is due, or to all if it is the last.
    fn show(&mut self, run: &mut Run, last: bool) -> Result<(), ObserveError> {
        let Run { clock, tally, state, due, .. } = run;
        let (scheme, observers) = (self.scheme.as_mut(), &mut self.observers);
        tally.watches.observe.time(|| {
            let mut now = Observation::new(scheme, clock.time, state);
            for (observer, due) in observers.iter_mut().zip(due) {
                let is_due = due.is_some_and(|due| due <= clock.time * (1.0 + 1e-12));
                if !is_due && !last {
                    continue;
                }
                observer.observe(&mut Moment {
                    step: clock.step,
                    step_size: clock.chosen.step,
                    limiter: clock.chosen.limiter,
                    health: &clock.health,
                    now: &mut now,
                    last,
                })?;
                *due = observer.schedule().next_after(clock.time);
            }
            Ok(())
        })
    }

    fn save_if_due(&mut self, run: &mut Run) {
        if self.checkpoints.as_ref().is_some_and(|checkpoints| checkpoints.due(&run.clock)) {
            self.save(run);
        }
    }

    /// Takes a checkpoint of a run that was interrupted, or that is to be gone on with later. It
    /// is taken before the observers are shown the last moment, which another end would not have.
    fn save_at_end(&mut self, run: &mut Run, outcome: &Outcome) {
        let wanted = |completed| {
            let checkpoints = self.checkpoints.as_ref();
            checkpoints.is_some_and(|checkpoints| checkpoints.wanted_at(completed, &run.clock))
        };
        let take = match outcome {
            Outcome::Completed => wanted(true),
            Outcome::Interrupted => wanted(false),
            Outcome::Failed(_) => false,
        };
        if take {
            self.save(run);
        }
    }

    fn save(&mut self, run: &mut Run) {
        let checkpoint = Checkpoint {
            clock: run.clock,
            tally: run.tally.clone(),
            state: run.state.clone(),
            due: run.due.clone(),
            observers: self.observers.iter().map(|observer| observer.save()).collect(),
            history: (self.retries > 0).then(|| run.history.clone()),
        };
        let Some(checkpoints) = &mut self.checkpoints else { return };
        let kept = run.tally.watches.checkpoint.time(|| checkpoints.keep(&checkpoint));
        run.tally.warnings.extend(kept.err());
    }
}

impl Run {
    /// Halves the steps from here on, after one that did not end anywhere.
    fn shorten(&mut self, failure: &Failure) {
        let Clock { step, time, .. } = self.clock;
        self.tally.factor *= Executor::RETRY_FACTOR;
        let factor = self.tally.factor;
        let kind = failure.kind().to_owned();
        let failure = failure.to_string();
        self.tally.retries.push(Retry { kind, failure, step, time, back_to: time, factor });
    }

    /// Lets the next step be longer, or shorter, by what is known of the step `met`, which is
    /// `chosen` or was shortened to meet a due time.
    fn lengthen(
        &mut self,
        integrator: &dyn Integrator,
        scheme: &dyn Scheme,
        chosen: ChosenStep,
        met: ChosenStep,
    ) {
        let factor = self.tally.factor;
        let next = match integrator.growth() {
            Some(growth) => {
                let wanted = factor * growth * met.step / chosen.step;
                // What is good enough for a short step says little of one that was to be longer.
                if met.step < chosen.step && growth > 1.0 { wanted.max(factor) } else { wanted }
            }
            None if factor < 1.0 && integrator.was_quick(scheme, &self.state) => {
                factor * Executor::GROWTH_FACTOR
            }
            None => factor,
        };
        self.tally.factor = next.min(1.0);
    }

    /// Moves the clock on by the step `met`, which ends at `soonest` if it was shortened to.
    fn advance(&mut self, control: StepControl, met: ChosenStep, soonest: f64) {
        let Self { clock, tally, history, .. } = self;
        history.step(clock.time, met.step);
        clock.step += 1;
        clock.time = match control {
            StepControl::Fixed(step) => clock.step as f64 * step,
            _ if met.step == soonest - clock.time => soonest,
            _ => clock.time + met.step,
        };
        clock.chosen = met;
        let [smallest, largest] = tally.step_range;
        tally.step_range = [smallest.min(met.step), largest.max(met.step)];
    }
}
