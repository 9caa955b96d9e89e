//! A case that is built and ready to run.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use thiserror::Error;

use super::build::{self, Built};
use super::model::{self, Case};
use super::outputs::Outputs;
use super::report;
use super::resume;
use crate::observe::{Line, ProfileRecorder, Recorder, Series, Tables};
use crate::output::{CheckpointError, OutputError, ResultsFolder};
use crate::schemes::Scheme;
use crate::solve::Costs;
use crate::time::{
    Checkpoints, Executor, Integrator, IntegratorKind, Misfit, ObserveError, Progress, Schedule,
    Summary,
};

/// A case with its particles, lists and scheme.
pub struct Simulation {
    pub(super) case: Case,
    pub(super) built: Built,
    pub(super) integrator: Box<dyn Integrator>,
    /// Wall time of building in s.
    pub(super) build_seconds: f64,
}

/// A run that has ended, well or not.
#[derive(Clone, Debug)]
pub struct Finished {
    /// How it ended, with its figures.
    pub summary: Summary,
    /// What was recorded.
    pub tables: Tables,
    /// Files written, in the order of writing.
    pub files: Vec<PathBuf>,
    /// What the user should know about the case.
    pub warnings: Vec<String>,
    /// Number of particles.
    pub particles: usize,
    /// What linear equations took since the run started, or went on; `None` where there were none.
    pub linear: Option<Costs>,
}

/// A fault of files or folders. A run that fails is a [`crate::time::Outcome`], not this.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RunError {
    /// The results folder or a file in it.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// A file during the run.
    #[error(transparent)]
    Observe(#[from] ObserveError),
    /// There are checkpoints, and none of them is any good for this run.
    #[error("{newest}\nno checkpoint of this run is sound; nothing was changed")]
    NoCheckpoint {
        /// Why the newest was refused.
        newest: CheckpointError,
    },
    /// A checkpoint is of a run with other outputs.
    #[error("{0}; nothing was changed; start anew without `--resume`")]
    Misfit(#[from] Misfit),
}

impl Simulation {
    pub(super) fn new(case: &Case, built: Built, integrator: Box<dyn Integrator>) -> Self {
        Self { case: case.clone(), built, integrator, build_seconds: 0.0 }
    }

    /// The case it was built from.
    pub fn case(&self) -> &Case {
        &self.case
    }

    /// The formulation, bound to its particles.
    pub fn scheme(&mut self) -> &mut dyn Scheme {
        self.built.scheme.as_mut()
    }

    /// Runs to the end, to a failure, or until `stop` is set, with results in `folder`; without
    /// one the tables exist in memory only.
    ///
    /// # Errors
    /// [`RunError`] for faults of files. A run that fails is an outcome in the summary.
    pub fn run(
        self,
        folder: Option<&Path>,
        stop: &AtomicBool,
        progress: &mut dyn FnMut(&Progress),
    ) -> Result<Finished, RunError> {
        self.execute(folder, false, stop, progress)
    }

    /// Goes on with the run in `folder` from its newest sound checkpoint, and starts anew where
    /// there is none. The results are those of a run that was never broken off, to the bit.
    ///
    /// # Errors
    /// As [`Simulation::run`], and if there are checkpoints of which none is sound or of this
    /// case; then nothing is changed.
    pub fn resume(
        self,
        folder: &Path,
        stop: &AtomicBool,
        progress: &mut dyn FnMut(&Progress),
    ) -> Result<Finished, RunError> {
        self.execute(Some(folder), true, stop, progress)
    }

    fn execute(
        self,
        folder: Option<&Path>,
        resume: bool,
        stop: &AtomicBool,
        progress: &mut dyn FnMut(&Progress),
    ) -> Result<Finished, RunError> {
        let Self { case, built, integrator, build_seconds } = self;
        let particles = built.scheme.particle_count();
        let length = built.scheme.initial_state().len();
        let identity = resume::identity(&case, built.scheme.as_ref());
        // Without a record there is nothing to go on from.
        let old = folder.filter(|_| resume).and_then(|path| ResultsFolder::of_run(path).ok());
        let columns = Recorder::columns(built.scheme.as_ref(), &built.probes);
        let profiles = |line: &Line| match &line.schedule {
            Schedule::At(times) => times.len() + 1,
            // The checkpoint of a run that is to go on has no later ones.
            _ => resume::rows(*case.time.end, *case.output.every),
        };
        let lines =
            built.lines.iter().map(|line| line.numbers(case.dimension, profiles(line))).sum();
        let most = resume::most_bytes(&case, &columns, lines, length);
        let found =
            old.map(|(folder, _)| resume::find(&folder, &identity, most)).transpose()?.flatten();
        let (checkpoint, resumed) = found.unzip();
        let mut outputs = folder.map(|folder| Outputs::new(&case, &built, folder));
        let recorder = Recorder::new(
            built.scheme.as_ref(),
            built.probes,
            Schedule::Every(*case.output.table_every),
            Schedule::Every(*case.output.every),
            outputs.as_ref().map(Outputs::for_tables),
        );
        let tables = recorder.tables();
        let mut observers: Vec<Box<dyn crate::time::Observer>> = vec![Box::new(recorder)];
        for line in built.lines {
            let folder = outputs.as_ref().map(Outputs::for_tables);
            let tables = tables.clone();
            observers.push(Box::new(ProfileRecorder::new(line, case.dimension, tables, folder)));
        }
        if let Some(outputs) = &outputs {
            observers.extend(outputs.observers(&case, &built.bodies));
        }
        let control = build::step_control(&case);
        let mut executor = Executor::new(built.scheme, integrator, control, *case.time.end);
        executor.max_steps = case.time.max_steps.unwrap_or(u64::MAX);
        executor.min_step = case.time.min_step;
        executor.max_speed = case.time.max_speed;
        executor.retries = case.time.retries as usize;
        executor.observers = observers;
        executor.checkpoints = outputs.as_ref().map(|outputs| {
            let store = outputs.store(&case, identity);
            Checkpoints::new(build::checkpoint_policy(&case), Box::new(store))
        });
        let mut warnings = built.warnings;
        match (checkpoint, &resumed) {
            (Some(checkpoint), Some(resumed)) => {
                warnings.extend(resumed.warnings.iter().cloned());
                executor.resume(checkpoint)?;
            }
            _ if resume => {
                warnings.push("there was no checkpoint to resume from: started at t = 0".into());
            }
            _ => {}
        }
        // From here on the folder is this run's: what could be refused has been.
        if let Some(outputs) = &mut outputs {
            outputs.begin(resumed.as_ref())?;
        }
        let summary = executor.run(stop, progress)?;
        warnings.extend(summary.warnings.iter().cloned());
        let tables = tables.lock().clone();
        warnings.extend(unbalanced(&tables, &case.time));
        let gone = removed(&tables);
        if gone > 0.0 {
            warnings.push(format!(
                "{gone} of {particles} particles escaped and were removed: `step.removed` has when"
            ));
        }
        let linear = executor.scheme().linear_costs();
        let files = Vec::new();
        let mut finished = Finished { summary, tables, files, warnings, particles, linear };
        if let Some(outputs) = outputs {
            finished.files = outputs.finish(&case, &finished, build_seconds)?;
        }
        if let Some(folder) = folder.filter(|_| case.output.report) {
            // The results are whole without it.
            match report::write(folder) {
                Ok(file) => finished.files.push(file),
                Err(error) => finished.warnings.push(format!("there is no report: {error}")),
            }
        }
        Ok(finished)
    }
}

/// A share of the largest energy that does not balance, above which the user is told.
const UNBALANCED: f64 = 0.01;

/// What the user should know if energy is not accounted for: by theory (18) what the balance is off
/// by is the error of the integrator, which is damping where it is made to damp.
fn unbalanced(tables: &Tables, time: &model::Time) -> Option<String> {
    let off = tables.energy.values("balance")?.last()?.abs();
    let largest = |name: &str| -> f64 {
        let values = tables.energy.values(name).unwrap_or_default();
        values.iter().fold(0.0, |most, value| most.max(value.abs()))
    };
    let share = off / largest("total");
    let is_static =
        IntegratorKind::from_name(&time.integrator).is_some_and(IntegratorKind::is_static);
    let advice = match time.rule.is_some_and(|rule| rule.damps()) {
        _ if is_static => {
            "the steps of the load are too large for what happens, or one went over a limit of it; lower \
             `time.step` and compare"
        }
        true => {
            "the integrator damps what is short against its steps; if that is more than was meant, \
             lower `time.step`, or let it damp less"
        }
        false => {
            "the steps are too large for what happens; lower `time.cfl`, or `time.step` where it is \
             given, and compare"
        }
    };
    let message =
        || format!("{:.1} % of the largest energy is not accounted for: {advice}", 100.0 * share);
    (share > UNBALANCED).then(message)
}

/// Number of particles that were removed, by schemes that do so.
fn removed(tables: &Tables) -> f64 {
    tables.steps.values("removed").and_then(|values| values.last().copied()).unwrap_or(0.0)
}

/// The names behind `run.`, numbers and texts of a run as a whole.
pub(super) const RUN_QUANTITIES: [&str; 12] = [
    "first_step",
    "smallest_step",
    "largest_step",
    "steps",
    "particles",
    "time",
    "smallest_ratio",
    "ratio_mismatch",
    "largest_speed",
    "retries",
    "removed",
    "outcome",
];

impl Finished {
    /// What a check calls `name`: a column of a table, or `run.NAME`.
    pub fn quantity(&self, name: &str) -> Option<Series> {
        let number = |value: f64, unit| Some(Series::Number { value, unit });
        let summary = &self.summary;
        match name.strip_prefix("run.") {
            None => self.tables.curve(name),
            Some("first_step") => number(summary.first_step, "s"),
            Some("smallest_step") => number(summary.step_range[0], "s"),
            Some("largest_step") => number(summary.step_range[1], "s"),
            Some("steps") => number(summary.steps as f64, "1"),
            Some("particles") => number(self.particles as f64, "1"),
            Some("time") => number(summary.time, "s"),
            Some("smallest_ratio") => number(summary.worst.smallest_ratio, "1"),
            Some("ratio_mismatch") => number(summary.worst.ratio_mismatch, "1"),
            Some("largest_speed") => number(summary.worst.largest_speed, "m/s"),
            Some("retries") => number(summary.retries.len() as f64, "1"),
            Some("removed") => number(removed(&self.tables), "1"),
            Some("outcome") => Some(Series::Text(summary.outcome.summary())),
            Some(_) => None,
        }
    }
}
