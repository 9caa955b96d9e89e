//! A simulation, shared between threads of Python.
//!
//! One thread takes steps. It holds the session for one step at a time, without the GIL, so that others read
//! between two steps; who waits for the session lets go of the GIL. Python functions are called with the GIL and
//! without the session.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use piola::case::Session;
use piola::time::Progress;
use piola_cli::count;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::sync::MutexExt;
use pyo3::types::PyDict;

use crate::bodies::{Bodies, Body};
use crate::display::{seconds, table};
use crate::errors::{guard, panic_error};
use crate::functions::{Shared, refuse_inside};
use crate::moment::{Every, Moment, Watcher, schedule};
use crate::plan;
use crate::run::Run;
use crate::sensitivity::Sensitivity;
use crate::stepping::Goal;
use crate::tables::Tables;

/// The progress of a simulation, which can be read at any time.
#[derive(Clone, Copy)]
pub struct Standing {
    /// Time, steps, and what limited the last one.
    pub progress: Progress,
    /// How many times the state has changed: that of a moment is gone when this has.
    pub changes: u64,
}

/// A run of a case, from its particles at the start to its results.
///
/// Steps are taken without the GIL. Fields, energies and tables are those of the moment at which they are read, and do
/// not change when the run continues. A simulation may be read from any thread, and stepped by one thread at a time.
#[pyclass(module = "piola", frozen)]
pub struct Simulation {
    session: Mutex<Session>,
    /// Shared with the arrays that look at its states.
    pub standing_now: Arc<Mutex<Standing>>,
    /// Threads that wait for the session.
    waiting: AtomicUsize,
    /// Whether a thread takes steps.
    pub is_stepping: AtomicBool,
    /// Whether a panic has left the session as it may not be.
    pub is_broken: AtomicBool,
    /// Functions that look at moments.
    pub watchers: Mutex<Vec<Watcher>>,
    /// What is left of the run when it has ended.
    pub ended: Mutex<Option<Py<Run>>>,
    /// The functions of the case.
    pub functions: Arc<Shared>,
    pub folder: Option<PathBuf>,
    pub title: String,
    pub end: f64,
    /// Names of the bodies.
    pub bodies: Vec<String>,
}

/// The inside of a lock of which no thread can leave anything broken behind.
pub fn inside<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Simulation {
    pub fn new(session: Session, folder: Option<PathBuf>, functions: Arc<Shared>) -> Self {
        let case = session.case();
        Self {
            functions,
            folder,
            title: case.title.clone(),
            end: *case.time.end,
            bodies: case.bodies.iter().map(|body| body.name.value.clone()).collect(),
            standing_now: Arc::new(Mutex::new(Standing {
                progress: session.progress(),
                changes: 0,
            })),
            waiting: AtomicUsize::new(0),
            is_stepping: AtomicBool::new(false),
            is_broken: AtomicBool::new(false),
            watchers: Mutex::new(Vec::new()),
            ended: Mutex::new(None),
            session: Mutex::new(session),
        }
    }

    /// Where it stands.
    pub fn standing(&self) -> Standing {
        *inside(&self.standing_now)
    }

    /// The session, for a thread that holds the GIL. After a panic there is none.
    pub fn session(&self, py: Python<'_>) -> PyResult<MutexGuard<'_, Session>> {
        refuse_inside()?;
        self.waiting.fetch_add(1, Ordering::SeqCst);
        let locked = self.session.lock_py_attached(py);
        self.waiting.fetch_sub(1, Ordering::SeqCst);
        match self.is_broken.load(Ordering::SeqCst) {
            false => Ok(locked.unwrap_or_else(PoisonError::into_inner)),
            true => Err(panic_error(py)),
        }
    }

    /// Works on the session without the GIL.
    pub fn with<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut Session) -> T + Send,
    ) -> PyResult<T> {
        let mut session = self.session(py)?;
        let session: &mut Session = &mut session;
        let done = guard(py, move || work(session));
        done.inspect_err(|_| self.is_broken.store(true, Ordering::SeqCst))
    }

    /// Changes the session with the step that a thread without the GIL takes, and notes where it is then.
    /// Nothing after a panic.
    pub fn change<T>(&self, work: impl FnOnce(&mut Session) -> T) -> Option<T> {
        // Who waits is let in: a lock that is taken again at once would keep them out.
        while self.waiting.load(Ordering::SeqCst) > 0 {
            std::thread::yield_now();
        }
        let mut session = self.session.lock().ok()?;
        if self.is_broken.load(Ordering::SeqCst) {
            return None;
        }
        let result = work(&mut session);
        self.note(&session);
        Some(result)
    }

    /// Notes that the state is another one.
    pub fn note(&self, session: &Session) {
        let mut standing = inside(&self.standing_now);
        standing.progress = session.progress();
        standing.changes += 1;
    }
}

#[pymethods]
impl Simulation {
    /// Takes a step. Returns whether the run continues: False when it has reached its end, and its results have been
    /// written.
    ///
    /// Raises RunError if the run fails.
    fn step(slf: &Bound<'_, Self>) -> PyResult<bool> {
        Self::advance(slf, Goal::Step, false)
    }

    /// Takes steps until the time is `until` (in s) or later, or to the end. No step is shortened to meet `until`, so
    /// results do not depend on it.
    ///
    /// progress: shows progress on standard error.
    ///
    /// Returns the `Run` if the run has reached its end, else None. Raises RunError if it fails.
    ///
    /// Ctrl-C, and a function that raises an exception, stop it after a whole step. If the results go to a folder the
    /// run is then ended, with its last state on disk, and `start(out, resume=True)` continues it; otherwise this
    /// simulation can be continued.
    #[pyo3(signature = (until=None, *, progress=false))]
    fn run(slf: &Bound<'_, Self>, until: Option<f64>, progress: bool) -> PyResult<Option<Py<Run>>> {
        let goal = match until {
            None => Goal::End,
            Some(time) if time.is_nan() => {
                return Err(PyValueError::new_err("until must be a time in s, not nan"));
            }
            Some(time) => Goal::Until(time),
        };
        Self::advance(slf, goal, progress)?;
        Ok(slf.get().ended_run(slf.py()))
    }

    /// Ends the run where it is, and writes its results. Fields can still be read, but no more steps taken.
    ///
    /// Raises RunError if files cannot be written.
    fn finish(slf: &Bound<'_, Self>) -> PyResult<Py<Run>> {
        Self::conclude(slf)
    }

    /// The moments of a run: now, then the first one at or after each multiple of `interval` (in s), and the end.
    /// No step is shortened to meet them. What a moment shows is no longer available once the run has continued.
    fn every(slf: &Bound<'_, Self>, interval: f64) -> PyResult<Every> {
        Every::new(slf.clone().unbind(), interval)
    }

    /// Calls `function(moment)` at the first moment at or after each multiple of `interval` (in s) from 0 on, and
    /// at the end. Steps are not shortened, so results do not depend on it. If the function raises an exception, the
    /// run stops.
    fn observe(&self, interval: f64, function: &Bound<'_, PyAny>) -> PyResult<()> {
        if !function.is_callable() {
            return Err(pyo3::exceptions::PyTypeError::new_err("an observer must be a function"));
        }
        let watcher = Watcher::new(schedule(interval)?, self.standing(), function.clone().unbind());
        inside(&self.watchers).push(watcher);
        Ok(())
    }

    /// The derivatives of displacements, reactions and probes by a constant of a material, of the current state in
    /// equilibrium: exact, for the cost of a factorisation and a solution. For runs with `time.integrator` `static` or
    /// `arc_length`.
    ///
    /// key: a key of the material that the case has, as `body.bar.material.young_modulus`, or
    /// `body.bar.material.moduli.0` of several. All other constants stay fixed, even if they are computed
    /// from the same parameter of the case.
    ///
    /// Raises KeyError if it is no elastic constant of a named law, ValueError if the derivative is not available.
    fn sensitivity(&self, py: Python<'_>, key: String) -> PyResult<Sensitivity> {
        Sensitivity::of(self, py, key)
    }

    /// What the case shows, in one line.
    #[getter]
    fn title(&self) -> &str {
        &self.title
    }

    /// Simulated time in s.
    #[getter]
    fn time(&self) -> f64 {
        self.standing().progress.time
    }

    /// The time at which the run ends, in s.
    #[getter]
    fn end(&self) -> f64 {
        self.end
    }

    /// Steps taken.
    #[getter]
    fn steps(&self) -> u64 {
        self.standing().progress.step
    }

    /// Size of the last step in s, 0 at the start.
    #[getter]
    fn step_size(&self) -> f64 {
        self.standing().progress.step_size
    }

    /// What limited the last step.
    #[getter]
    fn limiter(&self) -> &'static str {
        self.standing().progress.limiter
    }

    /// The energies in J, by name, with their sum `total`.
    #[getter]
    pub fn energy<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let energy = PyDict::new(py);
        for (name, joules) in self.with(py, Session::energies)? {
            energy.set_item(name, joules)?;
        }
        Ok(energy)
    }

    /// The bounds on the next step, smallest first: dicts of name, step in s, particle, place in m.
    #[getter]
    pub fn limits<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let limits = self.with(py, Session::limits)?;
        Ok(plan::limits(py, &limits)?.into_any())
    }

    /// The bodies by name. Fields are those of the moment at which they are read.
    #[getter]
    fn bodies(slf: &Bound<'_, Self>) -> Bodies {
        Bodies::new(slf.clone().unbind(), None)
    }

    /// All particles, like a body, with a row for each particle present. Fields are those of the moment at which they
    /// are read.
    #[getter]
    fn particles(slf: &Bound<'_, Self>) -> Body {
        Body::of_all(slf.clone().unbind(), None)
    }

    /// What has been recorded so far: a copy.
    #[getter]
    fn tables(&self, py: Python<'_>) -> PyResult<Tables> {
        self.with(py, |session| Tables::new(session.tables().lock().clone()))
    }

    /// The `Run` once the run has ended, else None.
    #[getter(result)]
    fn ended_run(&self, py: Python<'_>) -> Option<Py<Run>> {
        inside(&self.ended).as_ref().map(|run| run.clone_ref(py))
    }

    /// The current moment.
    fn now(slf: &Bound<'_, Self>) -> Moment {
        Moment::of(slf)
    }

    /// Panics, so that the tests see what comes of that.
    fn _panic(&self, py: Python<'_>) -> PyResult<()> {
        self.with(py, |_| panic!("a test has asked for it"))
    }

    fn __enter__(slf: Bound<'_, Self>) -> Bound<'_, Self> {
        slf
    }

    /// Ends the run, so that its results are on disk.
    #[pyo3(signature = (*_raised))]
    fn __exit__(
        slf: &Bound<'_, Self>,
        _raised: &Bound<'_, pyo3::types::PyTuple>,
    ) -> PyResult<bool> {
        Self::conclude(slf)?;
        Ok(false)
    }

    fn __repr__(&self) -> String {
        let Progress { time, end, step, .. } = self.standing().progress;
        let steps = count(step, "step");
        format!("<Simulation at t = {} of {}, after {steps}>", seconds(time), seconds(end))
    }

    fn _repr_html_(&self, py: Python<'_>) -> PyResult<String> {
        if let Some(run) = self.ended_run(py) {
            return Ok(run.get().html());
        }
        let Progress { time, end, step, step_size, limiter, .. } = self.standing().progress;
        let time = format!("{} of {}", seconds(time), seconds(end));
        let step = format!("{step}, the last of {} ({limiter})", seconds(step_size));
        Ok(table(&self.title, [["time", time.as_str()], ["steps", &step]]))
    }
}
