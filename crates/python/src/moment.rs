//! Moments of a run: as they are iterated over, and as functions see them.

use piola::time::{Progress, Schedule};
use piola_cli::count;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;

use crate::bodies::{Bodies, Body};
use crate::display::seconds;
use crate::simulation::{Simulation, Standing};
use crate::stepping::Goal;

/// At each multiple of an interval in s.
pub fn schedule(interval: f64) -> PyResult<Schedule> {
    if interval > 0.0 && interval.is_finite() {
        return Ok(Schedule::Every(interval));
    }
    Err(PyValueError::new_err(format!("the interval must be a time above 0 in s, not {interval}")))
}

/// When a schedule is due after `time`, by more than what two times may differ by and be the same.
fn next_due(schedule: &Schedule, time: f64) -> f64 {
    // Nothing comes next where intervals are too short to be counted: that is the next step.
    let next = schedule.next_after(time * (1.0 + 1e-12)).filter(|next| next.is_finite());
    next.unwrap_or(0.0).max(time * (1.0 + 2e-12))
}

/// A moment of a run. What it shows of the state (bodies, energy, limits) is no longer available once the run has
/// continued: accessing it then raises RuntimeError.
#[pyclass(module = "piola", frozen)]
pub struct Moment {
    simulation: Py<Simulation>,
    standing: Standing,
}

impl Moment {
    /// As it is.
    pub fn of(simulation: &Bound<'_, Simulation>) -> Self {
        let standing = simulation.get().standing();
        Self { simulation: simulation.clone().unbind(), standing }
    }

    fn still_there(&self) -> PyResult<&Simulation> {
        there(self.simulation.get(), self.standing)
    }
}

/// The simulation, if its state is still that of a moment.
pub fn there(simulation: &Simulation, moment: Standing) -> PyResult<&Simulation> {
    let now = simulation.standing();
    if now.changes == moment.changes {
        return Ok(simulation);
    }
    Err(PyRuntimeError::new_err(format!(
        "this moment is at t = {}, and the state has changed since (now t = {}): read what you \
         need before a step or a new value; arrays remain valid",
        seconds(moment.progress.time),
        seconds(now.progress.time)
    )))
}

#[pymethods]
impl Moment {
    /// Simulated time in s.
    #[getter]
    fn time(&self) -> f64 {
        self.standing.progress.time
    }

    /// Steps taken.
    #[getter]
    fn steps(&self) -> u64 {
        self.standing.progress.step
    }

    /// Size of the last step in s, 0 at the start.
    #[getter]
    fn step_size(&self) -> f64 {
        self.standing.progress.step_size
    }

    /// The bodies by name.
    #[getter]
    fn bodies(&self, py: Python<'_>) -> PyResult<Bodies> {
        self.still_there()?;
        Ok(Bodies::new(self.simulation.clone_ref(py), Some(self.standing)))
    }

    /// All particles.
    #[getter]
    fn particles(&self, py: Python<'_>) -> PyResult<Body> {
        self.still_there()?;
        Ok(Body::of_all(self.simulation.clone_ref(py), Some(self.standing)))
    }

    /// Whether the simulation still has this state.
    #[getter]
    fn is_current(&self) -> bool {
        self.still_there().is_ok()
    }

    /// The energies in J, by name, with their sum `total`.
    #[getter]
    fn energy<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(self.still_there()?.energy(py)?.into_any())
    }

    /// The bounds on the next step, smallest first: dicts of name, step in s, particle, place in m.
    #[getter]
    fn limits<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.still_there()?.limits(py)
    }

    fn __repr__(&self) -> String {
        let Progress { time, step, .. } = self.standing.progress;
        format!("<Moment t = {}, after {}>", seconds(time), count(step, "step"))
    }
}

/// The moments of a run, one after another.
#[pyclass(module = "piola")]
pub struct Every {
    simulation: Py<Simulation>,
    schedule: Schedule,
    /// The state that was shown last.
    shown: Option<u64>,
}

impl Every {
    pub fn new(simulation: Py<Simulation>, interval: f64) -> PyResult<Self> {
        Ok(Self { simulation, schedule: schedule(interval)?, shown: None })
    }
}

#[pymethods]
impl Every {
    fn __iter__(slf: PyRef<'_, Self>) -> PyRef<'_, Self> {
        slf
    }

    fn __next__(&mut self, py: Python<'_>) -> PyResult<Option<Moment>> {
        let simulation = self.simulation.bind(py);
        if self.shown.is_some() {
            let time = simulation.get().standing().progress.time;
            let goal = Goal::Until(next_due(&self.schedule, time));
            if !Simulation::advance(simulation, goal, false)? {
                let is_ended = simulation.get().standing().changes;
                // The end is shown once.
                if self.shown == Some(is_ended) {
                    return Ok(None);
                }
            }
        }
        let moment = Moment::of(simulation);
        self.shown = Some(moment.standing.changes);
        Ok(Some(moment))
    }
}

/// A function that looks at moments.
pub struct Watcher {
    schedule: Schedule,
    /// When it is to look next, in s.
    due: f64,
    /// The time that it saw last, in s.
    seen: Option<f64>,
    pub function: Py<PyAny>,
}

impl Watcher {
    pub fn new(schedule: Schedule, now: Standing, function: Py<PyAny>) -> Self {
        let time = now.progress.time;
        let due = if now.progress.step == 0 { time } else { next_due(&schedule, time) };
        Self { schedule, due, seen: None, function }
    }

    /// When it is to look next, in s.
    pub fn due(&self) -> f64 {
        self.due
    }

    /// Whether it is to look at this moment; then it has.
    pub fn takes(&mut self, now: Standing, is_last: bool) -> bool {
        let time = now.progress.time;
        if self.seen.is_some_and(|seen| seen > time) {
            // The run has gone back.
            self.due = next_due(&self.schedule, time);
        }
        let is_due = self.due <= time * (1.0 + 1e-12);
        let takes = self.seen != Some(time) && (is_due || is_last);
        if takes {
            self.seen = Some(time);
            self.due = next_due(&self.schedule, time);
        }
        takes
    }
}
