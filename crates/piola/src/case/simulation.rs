//! A case that is built and ready to run.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use thiserror::Error;

use super::build::{self, Built};
use super::model::Case;
use super::outputs::Outputs;
use super::report;
use crate::observe::{Recorder, Series, Tables};
use crate::output::OutputError;
use crate::schemes::Scheme;
use crate::time::{Executor, ObserveError, Progress, Schedule, Summary};

/// A case with its particles, lists and scheme.
pub struct Simulation {
    pub(super) case: Case,
    pub(super) built: Built,
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
}

impl Simulation {
    pub(super) fn new(case: &Case, built: Built) -> Self {
        Self { case: case.clone(), built, build_seconds: 0.0 }
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
        let Self { case, built, build_seconds } = self;
        let particles = built.scheme.particle_count();
        let outputs = folder.map(|folder| Outputs::new(&case, &built, folder)).transpose()?;
        let recorder = Recorder::new(
            built.scheme.as_ref(),
            built.probes,
            Schedule::Every(*case.output.table_every),
            Schedule::Every(*case.output.every),
            outputs.as_ref().map(Outputs::for_tables),
        );
        let tables = recorder.tables();
        let mut observers: Vec<Box<dyn crate::time::Observer>> = vec![Box::new(recorder)];
        if let Some(outputs) = &outputs {
            observers.extend(outputs.observers(&case, &built.bodies));
        }
        let length = built.scheme.initial_state().len();
        let mut executor = Executor {
            scheme: built.scheme,
            integrator: build::integrator(&case).build(length),
            control: build::step_control(&case),
            end: *case.time.end,
            max_steps: case.time.max_steps.unwrap_or(u64::MAX),
            min_step: case.time.min_step,
            observers,
        };
        let summary = executor.run(stop, progress)?;
        let tables = tables.lock().clone();
        let mut finished =
            Finished { summary, tables, files: Vec::new(), warnings: built.warnings, particles };
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

/// The names behind `run.`, numbers and texts of a run as a whole.
pub(super) const RUN_QUANTITIES: [&str; 10] = [
    "first_step",
    "smallest_step",
    "largest_step",
    "steps",
    "particles",
    "time",
    "smallest_ratio",
    "ratio_mismatch",
    "largest_speed",
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
            Some("smallest_ratio") => number(summary.smallest_ratio, "1"),
            Some("ratio_mismatch") => number(summary.ratio_mismatch, "1"),
            Some("largest_speed") => number(summary.largest_speed, "m/s"),
            Some("outcome") => Some(Series::Text(summary.outcome.summary())),
            Some(_) => None,
        }
    }
}
