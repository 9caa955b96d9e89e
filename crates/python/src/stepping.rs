//! How steps are taken: without the GIL, which is asked for to see to signals and to call functions.

use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use piola::case::{RunError, Session};
use piola::time::{Outcome, Progress};
use piola_cli::Pace;
use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError};
use pyo3::prelude::*;

use crate::errors::{Failed, file_error, guard, panic_error, run_error};
use crate::moment::{Moment, Watcher};
use crate::run::Run;
use crate::simulation::{Simulation, inside};

/// Wall time between looks for signals.
const BREATH: Duration = Duration::from_millis(50);
/// Wall time between lines of progress.
const LINE_INTERVAL: Duration = Duration::from_millis(500);

/// How far to go.
#[derive(Clone, Copy)]
pub enum Goal {
    Step,
    /// To a time in s.
    Until(f64),
    End,
}

/// Why a thread stops taking steps for a while.
enum Pause {
    Reached,
    /// The run has come to its end or has failed.
    Ended,
    /// A function of the case has raised.
    Raised,
    /// Signals are to be seen to, or functions to be called.
    Breath,
    Fault(RunError),
}

/// Takes the right to take steps, and gives it back.
struct Claim<'a>(&'a Simulation);

impl<'a> Claim<'a> {
    fn new(simulation: &'a Simulation) -> PyResult<Self> {
        match simulation.is_stepping.swap(true, Ordering::SeqCst) {
            false => Ok(Self(simulation)),
            true => Err(PyRuntimeError::new_err(
                "the simulation is taking steps already: a function that it calls, or another thread, cannot",
            )),
        }
    }
}

impl Drop for Claim<'_> {
    fn drop(&mut self) {
        self.0.is_stepping.store(false, Ordering::SeqCst);
    }
}

/// A line on the standard error output that says how far a run is.
struct Line {
    pace: Pace,
    shown: Option<Instant>,
    /// How long the line is that stands there.
    length: usize,
}

impl Line {
    fn new(progress: &Progress) -> Self {
        let mut pace = Pace::new(Instant::now());
        // What was done before is not of this pace.
        pace.line(progress);
        Self { pace, shown: None, length: 0 }
    }

    fn show(&mut self, py: Python<'_>, progress: &Progress, is_last: bool) -> PyResult<()> {
        if !is_last && self.shown.is_some_and(|shown| shown.elapsed() < LINE_INTERVAL) {
            return Ok(());
        }
        self.shown = Some(Instant::now());
        let end = if is_last { "\n" } else { "" };
        let line = self.pace.line(progress);
        let text = format!("\r{line:length$}{end}", length = self.length);
        self.length = line.len();
        let stderr = py.import("sys")?.getattr("stderr")?;
        if stderr.is_none() {
            return Ok(());
        }
        stderr.call_method1("write", (text,))?;
        stderr.call_method0("flush").map(|_| ())
    }
}

impl Simulation {
    /// Takes steps. Whether the run goes on.
    pub fn advance(slf: &Bound<'_, Self>, goal: Goal, shows: bool) -> PyResult<bool> {
        let (py, simulation) = (slf.py(), slf.get());
        let claim = Claim::new(simulation)?;
        if inside(&simulation.ended).is_some() {
            return Ok(false);
        }
        let mut line = shows.then(|| Line::new(&simulation.standing().progress));
        let paused = loop {
            let pause =
                simulation.call_watchers(slf, false).and_then(|()| simulation.burst(py, goal));
            // Signals are seen to after each pause, progress is shown at each.
            let seen = pause.and_then(|pause| {
                py.check_signals()?;
                let is_last = !matches!(pause, Pause::Breath);
                if let Some(line) = &mut line {
                    line.show(py, &simulation.standing().progress, is_last)?;
                }
                Ok(pause)
            });
            match seen {
                Ok(Pause::Breath) => {}
                other => break other,
            }
        };
        match paused {
            Ok(Pause::Reached | Pause::Breath) => {
                simulation
                    .call_watchers(slf, false)
                    .map_err(|error| simulation.stop(slf, error))?;
                Ok(true)
            }
            Ok(Pause::Ended) => {
                drop(claim);
                Self::conclude(slf).map(|_| false)
            }
            Ok(Pause::Raised) => {
                // The state has what came of it: the last good one is looked for.
                let raised = simulation.functions.take();
                let text = "a function of the case has raised";
                let told = raised.as_ref().map(|raised| format!("{text}: {raised}"));
                let run = simulation.close(py, told.map(|cause| (cause, true)))?;
                let failed =
                    Failed { kind: "function", run: Some(run.into_any()), ..Failed::default() };
                Err(raised.unwrap_or_else(|| run_error(py, text.to_owned(), failed)))
            }
            Ok(Pause::Fault(error)) => Err(file_error(py, &error)),
            Err(error) => Err(simulation.stop(slf, error)),
        }
    }

    /// Takes steps without the GIL until there is a reason to pause.
    fn burst(&self, py: Python<'_>, goal: Goal) -> PyResult<Pause> {
        let due = inside(&self.watchers).iter().map(Watcher::due).fold(f64::MAX, f64::min);
        let burst = || {
            let start = Instant::now();
            loop {
                let time = self.standing().progress.time;
                if let Goal::Until(until) = goal
                    && !(time < until * (1.0 - 1e-12))
                {
                    return Some(Pause::Reached);
                }
                if due <= time * (1.0 + 1e-12) || start.elapsed() > BREATH {
                    return Some(Pause::Breath);
                }
                let stepped = self.change(Session::step)?;
                if self.functions.has_raised() {
                    return Some(Pause::Raised);
                }
                match stepped {
                    Ok(true) if matches!(goal, Goal::Step) => return Some(Pause::Reached),
                    Ok(true) => {}
                    Ok(false) => return Some(Pause::Ended),
                    Err(error) => return Some(Pause::Fault(error)),
                }
            }
        };
        guard(py, burst)
            .inspect_err(|_| self.is_broken.store(true, Ordering::SeqCst))?
            .ok_or_else(|| panic_error(py))
    }

    /// Calls the functions for which the moment is due, or all that have not seen it.
    fn call_watchers(&self, slf: &Bound<'_, Self>, is_last: bool) -> PyResult<()> {
        let standing = self.standing();
        let mut due = Vec::new();
        for watcher in inside(&self.watchers).iter_mut() {
            if watcher.takes(standing, is_last) {
                due.push(watcher.function.clone_ref(slf.py()));
            }
        }
        due.iter().try_for_each(|function| function.call1(slf.py(), (Moment::of(slf),)).map(|_| ()))
    }

    /// Ends a run whose results go to a folder because of `error`, so that its last state is on disk, and gives
    /// the error back.
    fn stop(&self, slf: &Bound<'_, Self>, error: PyErr) -> PyErr {
        let py = slf.py();
        let cause = (!error.is_instance_of::<PyKeyboardInterrupt>(py))
            .then(|| (format!("an exception stopped the run: {error}"), false));
        if self.folder.is_some()
            && let Err(other) = self.close(py, cause)
        {
            other.set_cause(slf.py(), Some(error));
            return other;
        }
        error
    }

    /// Ends the run where it is, and raises if that is a failure.
    pub fn conclude(slf: &Bound<'_, Self>) -> PyResult<Py<Run>> {
        let (py, simulation) = (slf.py(), slf.get());
        if let Some(run) = inside(&simulation.ended).as_ref() {
            return Ok(run.clone_ref(py));
        }
        let _claim = Claim::new(simulation)?;
        let run = simulation.close(py, None)?;
        let finished = &run.get().finished;
        if let Outcome::Failed(failure) = &finished.summary.outcome {
            let particle = failure.particle();
            let particle = simulation
                .with(py, |session| particle.map(|index| session.scheme().particle(index)))?;
            let failed = Failed {
                kind: failure.kind(),
                particle: particle.map(|particle| (particle.id, particle.reference)),
                at: Some((finished.summary.time, finished.summary.steps)),
                run: Some(run.clone_ref(py).into_any()),
            };
            return Err(run_error(py, format!("the run failed: {failure}"), failed));
        }
        simulation.call_watchers(slf, true)?;
        Ok(run)
    }

    /// Writes what is left of a run, which ends because of something outside of it if there is a cause; with it whether the
    /// state is affected.
    fn close(&self, py: Python<'_>, cause: Option<(String, bool)>) -> PyResult<Py<Run>> {
        let finished = self.with(py, |session| {
            if let Some((cause, is_affected)) = cause {
                session.give_up(cause, is_affected);
            }
            let finished = session.finish();
            self.note(session);
            finished
        })?;
        let finished = finished.map_err(|error| file_error(py, &error))?;
        let run = Py::new(py, Run::new(self.title.clone(), self.folder.clone(), finished))?;
        *inside(&self.ended) = Some(run.clone_ref(py));
        Ok(run)
    }
}
