//! A run, a step at a time.

mod costs;
mod device;
mod growth;
mod kept;
mod ranks;
mod shown;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::checkpoint::Checkpoints;
use super::clock::{Clock, Tally};
use super::failure::Failure;
use super::history::{History, Mark};
use super::integrator::Integrator;
use super::judgement::supersonic;
use super::observer::{ObserveError, Observer};
use super::run::Run;
use super::step::StepControl;
use super::summary::{Outcome, Progress, Summary};
use crate::schemes::{DeviceSteps, Observation, Phase, RankCosts, Scheme, StepLimit};
use crate::solve::Costs;

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
    observers: Vec<Box<dyn Observer>>,
    checkpoints: Option<Checkpoints>,
    pub(super) run: Run,
    /// Evaluations of single particles in one of the steps of each system.
    evaluations: Vec<u64>,
    /// What the parts of steps took before there were more particles.
    phases: Vec<Phase>,
    /// The same of ranks.
    costs: Vec<RankCosts>,
    /// Whether another run goes on, and both are of all of this one.
    has_left: bool,
    /// Where the next state is made.
    next: Arc<Vec<f64>>,
    /// The run before the last step, which one that fails ends with.
    previous: Previous,
    limits: Vec<StepLimit>,
    /// Whether the state has been judged, shown and saved where that was due.
    is_seen: bool,
    outcome: Option<Outcome>,
    /// Whether the outcome is a failure that the last step led to.
    is_broken: bool,
    /// Who takes the steps, if that is a device or several ranks.
    device: Option<Box<dyn DeviceSteps>>,
    /// Whether the state is that of the moment: a device may be ahead.
    is_here: bool,
}

/// A run before its last step: what of it is not in the history, and not added up.
struct Previous {
    clock: Clock,
    state: Arc<Vec<f64>>,
    /// The last step as it was chosen in s, and what every step was multiplied by.
    wanted: f64,
    factor: f64,
    /// Evaluations of single particles up to then.
    evaluations: u64,
}

/// Brings accelerations that a state holds, and what a formulation knows of neighbours, into line with the rest of it.
fn refresh(scheme: &mut dyn Scheme, time: f64, state: &mut [f64]) {
    if let Some(scheme) = scheme.split() {
        scheme.accelerate(time, state);
    } else if let Some(scheme) = scheme.coupled() {
        scheme.refresh(time, state);
    }
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

    /// A run at its start, without observers and checkpoints, with as many steps as it takes and no
    /// retries.
    pub fn new(
        mut scheme: Box<dyn Scheme>,
        integrator: Box<dyn Integrator>,
        control: StepControl,
        end: f64,
    ) -> Self {
        let mut state = scheme.initial_state();
        scheme.constrain(0.0, &mut state);
        let evaluations = integrator.evaluations_by_system(scheme.as_mut());
        Self {
            control,
            end,
            max_steps: u64::MAX,
            min_step: None,
            max_speed: None,
            retries: 0,
            observers: Vec::new(),
            checkpoints: None,
            evaluations,
            next: Arc::new(state.clone()),
            phases: Vec::new(),
            costs: Vec::new(),
            has_left: false,
            previous: Previous {
                clock: Clock::START,
                state: Arc::new(state.clone()),
                wanted: Tally::START.wanted,
                factor: Tally::START.factor,
                evaluations: 0,
            },
            limits: Vec::with_capacity(8),
            is_seen: false,
            outcome: None,
            is_broken: false,
            device: None,
            is_here: true,
            run: Run::at(Clock::START, Tally::START, state, Vec::new()),
            scheme,
            integrator,
        }
    }

    /// Simulated time in s.
    pub fn time(&self) -> f64 {
        self.run.clock.time
    }

    /// What linear equations have taken so far, where there are any.
    pub fn linear_costs(&self) -> Option<Costs> {
        let elsewhere = self.device.as_ref().and_then(|device| device.linear_costs());
        elsewhere.or_else(|| self.scheme.linear_costs())
    }

    /// The state as it is between two steps.
    pub fn state(&mut self) -> &[f64] {
        self.bring();
        &self.run.state
    }

    /// The state as it is between two steps, for as long as it is held: what comes next goes to other memory.
    pub fn shared_state(&mut self) -> Arc<Vec<f64>> {
        self.bring();
        Arc::clone(&self.run.state)
    }

    /// Where the run stands.
    pub fn progress(&self) -> Progress {
        let Run { clock, tally, .. } = &self.run;
        Progress {
            time: clock.time,
            end: self.end,
            step: clock.step,
            step_size: clock.chosen.step,
            limiter: clock.chosen.limiter,
            evaluations: tally.evaluations,
            retries: tally.retries.len(),
        }
    }

    /// Has the state looked at once more before the next step: somebody has let the formulation look at another one.
    pub fn look_anew(&mut self) {
        self.is_seen = false;
    }

    /// Changes the state between two steps; what is prescribed stays as it is, and accelerations that
    /// the state holds follow. The run cannot go back to before it, and what it does to energy and
    /// momentum is in no ledger.
    pub fn change(&mut self, change: impl FnOnce(&mut [f64])) {
        self.bring();
        let Run { clock, tally, state, due, history, .. } = &mut self.run;
        let state = Arc::make_mut(state);
        change(state);
        self.scheme.constrain(clock.time, state);
        refresh(self.scheme.as_mut(), clock.time, state);
        *history = History::new(Mark::of(clock, tally, due, state));
        self.is_seen = false;
        self.hand_over();
    }

    /// The formulation at the moment.
    pub fn now(&mut self) -> Observation<'_> {
        self.bring();
        let Run { clock, state, .. } = &self.run;
        Observation::new(self.scheme.as_mut(), clock.time, state)
    }

    /// Takes a step, and lets the observers look for whom the moment after it is due. Before the first
    /// step they are shown the start. Whether the run goes on: it does not where it has come to its end
    /// or has failed, and is where it was then.
    ///
    /// A run that may retry may find itself at an earlier moment after a step.
    ///
    /// # Errors
    /// A fault of an observer. What was observed before stays.
    pub fn step(&mut self) -> Result<bool, ObserveError> {
        self.look()?;
        while self.outcome.is_none() && !self.advance() {
            self.look()?;
        }
        self.look()?;
        Ok(self.outcome.is_none())
    }

    /// Whether there is another step to take: not at the end, after a failure, or where `stop` or a device asks to end.
    pub fn goes_on(&self, stop: &AtomicBool) -> bool {
        !stop.load(Ordering::Relaxed)
            && !self.device.as_ref().is_some_and(|device| device.stops())
            && self.outcome.is_none()
    }

    /// Runs to the end, to a failure, or until `stop` is set, and calls `progress` after each step.
    ///
    /// # Errors
    /// A fault of an observer. What was observed before stays.
    pub fn run(
        &mut self,
        stop: &AtomicBool,
        progress: &mut dyn FnMut(&Progress),
    ) -> Result<Summary, ObserveError> {
        while self.goes_on(stop) {
            let before = self.run.clock.step;
            self.step()?;
            if self.run.clock.step != before {
                progress(&self.progress());
            }
        }
        self.finish()
    }

    /// Ends the run where it is, and shows this moment to all observers as the last.
    ///
    /// # Errors
    /// A fault of an observer. What was observed before stays.
    pub fn finish(&mut self) -> Result<Summary, ObserveError> {
        self.look()?;
        if !self.is_broken {
            // Figures are of neighbours at this state; the formulation has looked at one that is broken.
            self.ask();
        }
        self.bring();
        let mut outcome = self.outcome.get_or_insert(Outcome::Interrupted).clone();
        let trace = match &outcome {
            Outcome::Failed(failure) => failure.particle().map(|index| {
                let (scheme, integrator) = (self.scheme.as_mut(), self.integrator.as_mut());
                if self.device.is_some() {
                    // Who is near is asked of the formulation, which has not seen this state yet.
                    refresh(scheme, self.run.clock.time, &mut self.run.state.to_vec());
                }
                self.run.history.trace(scheme, integrator, index)
            }),
            _ => None,
        };
        if self.is_broken
            && self.run.clock.step > self.previous.clock.step
            && let Some(failure) = self.step_back()
        {
            outcome = Outcome::Failed(failure);
        }
        self.save_at_end(&outcome);
        self.show(true)?;
        let Run { clock, tally, resumed, .. } = &self.run;
        Ok(Summary {
            outcome,
            time: clock.time,
            steps: clock.step,
            first_step: tally.first_step,
            step_range: tally.step_range,
            worst: tally.worst,
            evaluations: tally.evaluations,
            timings: tally.watches.timings(),
            phases: self.phases(),
            ranks: self.costs(),
            retries: tally.retries.clone(),
            trace,
            resumed: *resumed,
            warnings: tally.warnings.clone(),
        })
    }

    /// Judges the state, shows it and saves it where that is due, once a state. Where it is broken the
    /// run goes back as long as it may.
    fn look(&mut self) -> Result<(), ObserveError> {
        while !self.is_seen && self.outcome.is_none() {
            match self.judge() {
                None if self.run.clock.time >= self.end * (1.0 - 1e-12) => {
                    self.outcome = Some(Outcome::Completed);
                }
                None => {
                    self.show(false)?;
                    if self.run.history.is_due(&self.run.clock) {
                        self.bring();
                    }
                    if self.outcome.is_some() {
                        return Ok(());
                    }
                    let Run { clock, tally, state, due, history, .. } = &mut self.run;
                    history.mark(clock, tally, due, state);
                    if self.checkpoints.as_ref().is_some_and(|it| it.due(&self.run.clock)) {
                        self.save();
                    }
                    self.is_seen = true;
                }
                Some(failure) if failure.is_loss() => self.lose(failure),
                Some(failure)
                    if self.run.clock.step > 0
                        && self.may_retry()
                        && !matches!(failure, Failure::NoneInReserve { .. }) =>
                {
                    self.go_back(&failure)?;
                }
                Some(failure) => {
                    self.outcome = Some(Outcome::Failed(failure));
                    self.is_broken = true;
                }
            }
        }
        Ok(())
    }

    /// Looks for what is wrong with the state, and how far the next step may go.
    fn judge(&mut self) -> Option<Failure> {
        let Run { clock: Clock { step, time, .. }, state, .. } = &self.run;
        let missing = match &self.device {
            Some(device) => device.missing(),
            None => self.scheme.missing(state),
        };
        if missing > 0 {
            return Some(Failure::NoneInReserve { missing, step: *step, time: *time });
        }
        let health = match self.inspect() {
            Ok(health) => health,
            Err(failure) => return Some(failure),
        };
        let Run { clock, tally, .. } = &mut self.run;
        if clock.step == 0 {
            tally.start_speeds = [health.largest_speed, health.largest_wave_speed];
            let warning = supersonic(tally.start_speeds);
            tally.warnings.extend(warning.filter(|warning| !tally.warnings.contains(warning)));
        }
        let speeds = tally.start_speeds;
        let broken = self.broken(&health, &self.run.state, &self.run.clock, speeds);
        let warns = self.device.as_ref().is_some_and(|device| device.warns());
        let elsewhere = self.device.as_ref().and_then(|device| device.warning());
        if broken.is_some() || !self.run.tally.warned && warns && elsewhere.is_none() {
            self.ask();
        }
        if broken.is_some() {
            return self.broken(&health, &self.run.state, &self.run.clock, speeds).or(broken);
        }
        let Run { clock, tally, .. } = &mut self.run;
        if let (false, Some(warning)) = (tally.warned, elsewhere.or_else(|| self.scheme.warning()))
        {
            let Clock { step, time, .. } = *clock;
            tally.warnings.push(format!("{warning}; first seen at t = {time:e} s, step {step}"));
            tally.warned = true;
        }
        clock.health = health;
        tally.worst = tally.worst.worse(health);
        None
    }

    fn may_retry(&self) -> bool {
        self.run.tally.retries.len() < self.retries && self.control.adapts()
    }

    /// Goes on by one step. Where there is none the run ends, or is to try a shorter one.
    fn advance(&mut self) -> bool {
        let chosen = match self.choose(&self.limits, &self.run.clock, &self.run.tally) {
            Ok(chosen) => chosen,
            Err(failure) => {
                self.ask();
                let told = self.choose(&self.limits, &self.run.clock, &self.run.tally).err();
                self.outcome = Some(Outcome::Failed(told.unwrap_or(failure)));
                return false;
            }
        };
        let may_retry = self.may_retry();
        let Self { run, scheme, integrator, next, device, .. } = self;
        if run.clock.step == 0 {
            run.tally.first_step = chosen.step;
        }
        let soonest = run.due.iter().flatten().copied().fold(self.end, f64::min);
        let met = self.control.meet(chosen, run.clock.time, soonest);
        integrator.shorten(run.tally.factor);
        device.iter_mut().for_each(|device| device.shorten(run.tally.factor));
        let taken = run.tally.watches.step.time(|| match device {
            Some(device) => device.step(run.clock.time, met.step).map_err(Failure::from),
            None => {
                let next = Arc::make_mut(next);
                integrator.step(scheme.as_mut(), run.clock.time, met.step, &run.state, next)
            }
        });
        let growth = device.as_ref().map_or(integrator.growth(), |device| device.growth());
        if let Err(failure) = taken {
            self.is_seen = false;
            match (&failure, growth) {
                (Failure::Inaccurate(_), Some(growth)) if self.control.adapts() => {
                    run.tally.factor *= growth * met.step / chosen.step;
                }
                (lost, _) if lost.is_loss() => self.lose(failure),
                _ if may_retry => run.shorten(&failure),
                _ => self.outcome = Some(Outcome::Failed(failure)),
            }
            return false;
        }
        let Tally { wanted, factor, evaluations, .. } = run.tally;
        (self.previous.wanted, self.previous.factor) = (wanted, factor);
        self.previous.evaluations = evaluations;
        self.previous.clock = run.clock;
        if device.is_some() {
            self.is_here = false;
        } else {
            std::mem::swap(&mut self.previous.state, &mut run.state);
            std::mem::swap(&mut run.state, next);
        }
        run.tally.wanted = chosen.step / run.tally.factor;
        let steps = device.as_ref().map_or(integrator.steps_in_last(), |it| it.steps_in_last());
        run.tally.evaluations += costs::evaluated(&self.evaluations, steps);
        run.advance(self.control, met, soonest);
        // The state may be elsewhere.
        let was_quick = run.tally.factor < 1.0
            && match device {
                Some(device) => device.was_quick(),
                None => integrator.was_quick(scheme.as_ref(), &run.state),
            };
        run.lengthen(growth, was_quick, chosen, met);
        self.is_seen = false;
        true
    }
}
