//! A case that is built: the only entry point to a run.

mod growth;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use piola_device::{Device, Language, Precision};
use piola_ranks::Ranks;
use thiserror::Error;

use super::assembly::{self, Built};
use super::diagnostics::Problem;
use super::finished::{Finished, removed, unbalanced};
use super::model::Case;
use super::outputs::Outputs;
use super::ranks;
use super::resume::{self, Resumed};
use super::source::Located;
use super::views::Rows;
use super::{Problems, report};
use crate::neighbors::NeighborStatistics;
use crate::observe::{Line, ProfileRecorder, Recorder, SharedTables};
use crate::output::checkpoint::Identity;
use crate::output::{CheckpointError, OutputError, ResultsFolder};
use crate::schemes::{DeviceRefusal, DeviceStage, Scheme};
use crate::time::{
    Checkpoint, Checkpoints, Executor, Misfit, ObserveError, Observer, Progress, Schedule, Summary,
};

/// A checkpoint of a run with openings or finer regions may be this many times as large as the state at the start.
const MOST_GROWTH: usize = 64;

/// A run of a case, from its particles at the start to its results: as a whole, in parts or step by step, with
/// results identical to the bit.
///
/// ```
/// use std::sync::atomic::AtomicBool;
///
/// use piola::case::{self, Level, LoadOptions, Session, template};
///
/// let text = template::new_case("a column of water");
/// let coarse = LoadOptions { level: Level::Coarse, ..LoadOptions::default() };
/// let mut session = Session::new(&case::parse(&text, "column.toml", &coarse)?)?;
///
/// // Half as fast as the case says.
/// let mut velocity = session.column("velocity")?.values;
/// velocity.iter_mut().for_each(|component| *component *= 0.5);
/// session.set("velocity", &velocity)?;
///
/// session.run_until(0.1)?;
/// assert_eq!(session.column("pressure")?.values.len(), session.ids().len());
///
/// let finished = session.run(&AtomicBool::new(false), &mut |_| {})?;
/// assert_eq!(finished.summary.outcome.summary(), "completed");
/// assert!(finished.tables.curve("top.displacement.y").is_some());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Session {
    pub(super) case: Case,
    pub(super) built: Built,
    pub(super) executor: Executor,
    /// The device that takes the steps, if it is not the processor.
    device: Option<String>,
    /// Wall time of building in s.
    build_seconds: f64,
    tables: SharedTables,
    outputs: Option<Outputs>,
    /// Whose checkpoints are those of this run.
    identity: Identity,
    /// Observers that the case asks for, who come first.
    own: usize,
    resumed: Option<Resumed>,
    /// Whether the folder of the results is this run's.
    has_begun: bool,
    /// The processes that take the steps together, if there are several.
    processes: Option<Arc<dyn Ranks>>,
    /// The particles of each body, where they are the same at all times and have been asked for.
    pub(super) rows_of_bodies: Vec<Rows>,
}

/// A fault of files or folders, or of a checkpoint. A run that fails is a [`crate::time::Outcome`].
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RunError {
    /// The results folder or a file in it.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// A file during the run.
    #[error(transparent)]
    Observe(#[from] ObserveError),
    /// There are checkpoints, but this run can be resumed from none of them.
    #[error("{newest}\nno checkpoint of this run is intact; nothing was changed")]
    NoCheckpoint {
        /// Why the newest was refused.
        newest: CheckpointError,
    },
    /// A checkpoint belongs to a run with other outputs.
    #[error("{0}; nothing was changed; start again without `--resume`")]
    Misfit(#[from] Misfit),
    /// A folder was given for a run that had begun without it.
    #[error("the run has begun: name the folder of its results before the first step")]
    Begun,
}

impl Session {
    /// Builds particles, lists, scheme and integrator of a case.
    ///
    /// # Errors
    /// Everything that appears only when particles exist: a body without particles, a selection that selects nothing,
    /// a particle without a gradient, a prestress that the material cannot carry.
    pub fn new(case: &Case) -> Result<Self, Problems> {
        let start = Instant::now();
        let (mut executor, built) = executor(case)?;
        let refuse = |problem| case.refuse(vec![problem]);
        let device =
            case.device.as_ref().map(|name| use_device(&mut executor, name, case.precision));
        let device = device.transpose().map_err(refuse)?;
        ranks::use_threads(&mut executor, case).map_err(refuse)?;
        Ok(Self::of(case, (executor, built), device, start))
    }

    /// As [`Session::new`], of a run whose steps this process and others take together, of which it is rank 0: the others
    /// [`serve`](super::serve).
    ///
    /// # Errors
    /// As [`Session::new`], and if the case cannot be shared, or the others cannot begin or have another one.
    pub fn on_ranks(case: &Case, ranks: Arc<dyn Ranks>) -> Result<Self, Problems> {
        let start = Instant::now();
        let (mut executor, built) = ranks::begin(case, ranks.as_ref())?;
        ranks::lead(&mut executor, case, ranks.clone())?;
        let processes = Some(ranks);
        Ok(Self { processes, ..Self::of(case, (executor, built), None, start) })
    }

    fn of(
        case: &Case,
        (mut executor, built): (Executor, Built),
        device: Option<String>,
        start: Instant,
    ) -> Self {
        let (tables, observers) = observers(case, &built, executor.scheme.as_ref(), None);
        let own = observers.len();
        observers.into_iter().for_each(|observer| executor.observe(observer));
        Self {
            case: case.clone(),
            built,
            executor,
            device,
            build_seconds: start.elapsed().as_secs_f64(),
            tables,
            outputs: None,
            identity: Identity::default(),
            own,
            resumed: None,
            has_begun: false,
            processes: None,
            rows_of_bodies: Vec::new(),
        }
    }

    /// The case it was built from.
    pub fn case(&self) -> &Case {
        &self.case
    }

    /// The formulation, bound to its particles.
    pub fn scheme(&mut self) -> &mut dyn Scheme {
        self.executor.scheme.as_mut()
    }

    /// Evaluations of single particles in a step, which run all stages of the formulation; nothing of several systems, and
    /// where a step solves equations.
    pub fn evaluations_in_step(&self) -> Option<u64> {
        self.executor.counted_evaluations()
    }

    /// Smallest, mean and largest number of neighbours at the start.
    pub fn neighbors(&self) -> &NeighborStatistics {
        &self.built.neighbors
    }

    /// The stages of a step on a device with their passes as text in a language, whether the steps are taken on one or
    /// not. No device is needed.
    ///
    /// # Errors
    /// The case has no steps on devices.
    pub fn device_stages(&self, language: Language) -> Result<Vec<DeviceStage>, DeviceRefusal> {
        self.executor.device_stages(language, self.case.precision)
    }

    /// Simulated time in s.
    pub fn time(&self) -> f64 {
        self.executor.time()
    }

    /// The progress of the run.
    pub fn progress(&self) -> Progress {
        self.executor.progress()
    }

    /// What has been recorded so far.
    pub fn tables(&self) -> &SharedTables {
        &self.tables
    }

    /// Adds an observer, which is called after those of the case.
    pub fn observe(&mut self, observer: Box<dyn Observer>) {
        self.executor.observe(observer);
    }

    /// Writes the results to `folder`; without one the tables exist in memory only. Nothing is written before the
    /// first step.
    ///
    /// # Errors
    /// [`RunError::Begun`] after the first step.
    pub fn write_to(&mut self, folder: &Path) -> Result<(), RunError> {
        if self.has_begun {
            return Err(RunError::Begun);
        }
        self.identity = resume::identity(&self.case, self.executor.scheme.as_ref());
        self.outputs = Some(Outputs::new(&self.case, &self.built, self.device.as_ref(), folder));
        let outside = self.executor.take_observers().split_off(self.own);
        self.equip(outside);
        Ok(())
    }

    /// Lets the observers that the case asks for look, with the files that there are, and then those from `outside`; and
    /// checkpoints be taken.
    fn equip(&mut self, outside: Vec<Box<dyn Observer>>) {
        let Self { case, built, executor, outputs, .. } = self;
        let (tables, mut all) = observers(case, built, executor.scheme.as_ref(), outputs.as_ref());
        (self.tables, self.own) = (tables, all.len());
        all.extend(outside);
        all.into_iter().for_each(|observer| executor.observe(observer));
        if let Some(outputs) = outputs {
            let store = outputs.store(case, self.identity);
            let policy = assembly::checkpoint_policy(case);
            executor.keep(Checkpoints::new(policy, Box::new(store)));
        }
    }

    /// Continues the run in `folder` from its newest sound checkpoint, and starts from the beginning if there is
    /// none. The results are those of an uninterrupted run, to the bit. Observers that were added to that run have to
    /// be added before.
    ///
    /// # Errors
    /// As [`Session::step`], and if there are checkpoints of which none is sound or of this case; nothing is changed
    /// then.
    pub fn resume_from(&mut self, folder: &Path) -> Result<(), RunError> {
        self.write_to(folder)?;
        let case = &self.case;
        let scheme = self.executor.scheme.as_ref();
        let is_closed = scheme.is_closed();
        // Without a record there is nothing to go on from.
        let old = ResultsFolder::of_run(folder).ok();
        let columns = Recorder::columns(scheme, &self.built.probes);
        let profiles = |line: &Line| match &line.schedule {
            Schedule::At(times) => times.len() + 1,
            // The checkpoint of a run that is to go on has no later ones.
            _ => resume::rows(*case.time.end, *case.output.every),
        };
        let lines = &self.built.lines;
        let lines = lines.iter().map(|line| line.numbers(case.dimension, profiles(line))).sum();
        let state = self.executor.state().len() * if is_closed { 1 } else { MOST_GROWTH };
        let most = resume::most_bytes(case, &columns, lines, state);
        let found = old.map(|(folder, _)| resume::find(&folder, &self.identity, most));
        match found.transpose()?.flatten() {
            Some((checkpoint, resumed)) => {
                if resumed.more_in_reserve > 0 {
                    self.enlarge(resumed.more_in_reserve)?;
                }
                self.executor.resume(checkpoint)?;
                self.built.warnings.extend(resumed.warnings.iter().cloned());
                self.resumed = Some(resumed);
            }
            None => {
                let warning = "there was no checkpoint to resume from: started at t = 0";
                self.built.warnings.push(warning.to_owned());
            }
        }
        self.begin()
    }

    /// Everything that further steps depend on.
    pub fn checkpoint(&mut self) -> Checkpoint {
        self.executor.checkpoint()
    }

    /// Continues from a checkpoint of a session of the same case with the same observers, whose reserve has been extended as
    /// often.
    ///
    /// # Errors
    /// It cannot be one; the session cannot be used then.
    pub fn resume(&mut self, checkpoint: Checkpoint) -> Result<(), Misfit> {
        self.executor.resume(checkpoint)
    }

    /// Takes a step, and calls the observers that are due after it; before the first step they are called for the
    /// initial state. Returns whether the run continues: it does not if it has reached its end or has failed. A run
    /// that may retry may be at an earlier time afterwards.
    ///
    /// # Errors
    /// [`RunError`] for faults of files. A run that fails is an outcome in the summary.
    pub fn step(&mut self) -> Result<bool, RunError> {
        self.begin()?;
        let mut goes_on = self.executor.step()?;
        while self.grows()? {
            goes_on = self.executor.step()?;
        }
        Ok(goes_on)
    }

    /// Takes steps until the time is `time` or later. No step is shortened to meet it, so results do not depend on
    /// it. Returns whether the run continues.
    ///
    /// # Errors
    /// As [`Session::step`].
    pub fn run_until(&mut self, time: f64) -> Result<bool, RunError> {
        while self.time() < time * (1.0 - 1e-12) {
            if !self.step()? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Runs to the end, to a failure, or until `stop` is set, and calls `progress` after each step.
    ///
    /// # Errors
    /// As [`Session::step`].
    pub fn run(
        mut self,
        stop: &AtomicBool,
        progress: &mut dyn FnMut(&Progress),
    ) -> Result<Finished, RunError> {
        self.begin()?;
        while self.executor.goes_on(stop) {
            let before = self.progress().step;
            self.step()?;
            if self.progress().step != before {
                progress(&self.progress());
            }
        }
        self.finish()
    }

    /// Ends the run where it is, and shows this moment to all observers as the last. No more steps can be taken, but
    /// columns can be read.
    ///
    /// # Errors
    /// As [`Session::step`].
    pub fn finish(&mut self) -> Result<Finished, RunError> {
        self.begin()?;
        let summary = self.executor.finish()?;
        self.conclude(summary)
    }

    /// Ends the run because of a `cause` outside of it, for example a function that has raised: at this moment, or, where the
    /// state is already affected, some steps before. It can be resumed from there. [`Self::finish`] reports it.
    pub fn give_up(&mut self, cause: String, is_affected: bool) {
        self.executor.give_up(cause, is_affected);
    }

    /// Makes the folder of the results this run's. What could be refused has been.
    fn begin(&mut self) -> Result<(), RunError> {
        if !std::mem::replace(&mut self.has_begun, true)
            && let Some(outputs) = &mut self.outputs
        {
            outputs.begin(self.resumed.as_ref())?;
        }
        Ok(())
    }

    /// What is left of a run: its tables, charts, record and report.
    fn conclude(&mut self, summary: Summary) -> Result<Finished, RunError> {
        let Self { case, built, executor, outputs, .. } = self;
        let tables = self.tables.lock().clone();
        let particles = executor.scheme.particle_count();
        let mut warnings = built.warnings.clone();
        warnings.extend(summary.warnings.iter().cloned());
        warnings.extend(unbalanced(&tables, &case.time));
        let gone = removed(&tables);
        if gone > 0.0 {
            warnings.push(format!(
                "{gone} of {particles} particles escaped and were removed: `step.removed` shows \
                 when"
            ));
        }
        let mut notes = built.notes.clone();
        if case.more_in_reserve > 0 {
            notes.push(format!(
                "the reserve ran out and was extended: by {} particles, or as many in each region",
                case.more_in_reserve
            ));
        }
        let linear = executor.linear_costs();
        let own_steps = executor.own_steps();
        let files: Vec<PathBuf> = Vec::new();
        let mut finished =
            Finished { summary, tables, files, notes, warnings, particles, linear, own_steps };
        let Some(outputs) = outputs.take() else { return Ok(finished) };
        let folder = outputs.folder().to_owned();
        finished.files = outputs.finish(case, &finished, self.build_seconds)?;
        if case.output.report {
            // The results are whole without it.
            match report::write(&folder) {
                Ok(file) => finished.files.push(file),
                Err(error) => finished.warnings.push(format!("there is no report: {error}")),
            }
        }
        Ok(finished)
    }
}

/// Lets a run take its steps on the device of a name, and says what that is.
fn use_device(
    executor: &mut Executor,
    name: &Located<String>,
    precision: Precision,
) -> Result<String, Problem> {
    let used = Device::open(name).map_err(DeviceRefusal::from).and_then(|device| {
        let mut found = device.found().to_string();
        if precision == Precision::Single {
            found += ", pairs in single precision";
        }
        executor.use_device(device, precision).map(|()| found)
    });
    used.map_err(|refusal| {
        let label = match &refusal {
            DeviceRefusal::Steps(_) => "the device",
            _ => "this case has no steps there",
        };
        Problem::new(name.place, refusal.to_string(), label)
    })
}

/// A run at its start, with what it was built of.
pub(super) fn executor(case: &Case) -> Result<(Executor, Built), Problems> {
    let (scheme, integrator, built) = assembly::build(case)?;
    let control = assembly::step_control(case);
    let mut executor = Executor::new(scheme, integrator, control, *case.time.end);
    executor.max_steps = case.time.max_steps.unwrap_or(u64::MAX);
    executor.min_step = case.time.min_step;
    executor.max_speed = case.time.max_speed;
    executor.retries = case.time.retries as usize;
    Ok((executor, built))
}

/// The observers that a case asks for, and the tables that they fill.
fn observers(
    case: &Case,
    built: &Built,
    scheme: &dyn Scheme,
    outputs: Option<&Outputs>,
) -> (SharedTables, Vec<Box<dyn Observer>>) {
    let recorder = Recorder::new(
        scheme,
        built.probes.clone(),
        Schedule::Every(*case.output.table_every),
        Schedule::Every(*case.output.every),
        outputs.map(Outputs::for_tables),
    );
    let tables = recorder.tables();
    let mut observers: Vec<Box<dyn Observer>> = vec![Box::new(recorder)];
    for line in &built.lines {
        let folder = outputs.map(Outputs::for_tables);
        let profile = ProfileRecorder::new(line.clone(), case.dimension, tables.clone(), folder);
        observers.push(Box::new(profile));
    }
    if let Some(outputs) = outputs {
        observers.extend(outputs.observers(case, &built.bodies));
    }
    (tables, observers)
}
