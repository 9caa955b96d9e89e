//! A run that has ended.

use std::path::PathBuf;

use piola::case::Finished;
use piola::observe::Series;
use piola::output::ResultsFolder;
use piola::time::Outcome;
use piola_cli::count;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;

use crate::arrays::array;
use crate::display::{page, seconds, table};
use crate::tables::Tables;

/// A run that has ended, successfully or not.
#[pyclass(module = "piola", frozen)]
pub struct Run {
    pub finished: Finished,
    /// What the case shows, in one line.
    #[pyo3(get)]
    title: String,
    /// Where its results are, or None.
    #[pyo3(get)]
    folder: Option<PathBuf>,
}

impl Run {
    pub fn new(title: String, folder: Option<PathBuf>, finished: Finished) -> Self {
        Self { finished, title, folder }
    }

    /// The report, or a table of what there is to say.
    pub fn html(&self) -> String {
        let report = self.report().and_then(|path| std::fs::read_to_string(path).ok());
        if let Some(report) = report {
            return page(&report);
        }
        let summary = &self.finished.summary;
        let time = seconds(summary.time);
        let (steps, particles) = (summary.steps.to_string(), self.finished.particles.to_string());
        let [notes, warnings] =
            [&self.finished.notes, &self.finished.warnings].map(|lines| lines.join("; "));
        let outcome = self.outcome();
        let rows = [
            ["outcome", outcome.as_str()],
            ["time", &time],
            ["steps", &steps],
            ["particles", &particles],
            ["notes", &notes],
            ["warnings", &warnings],
        ];
        table(&self.title, rows)
    }
}

#[pymethods]
impl Run {
    /// `completed`, `interrupted`, or `failed: KIND`.
    #[getter]
    fn outcome(&self) -> String {
        self.finished.summary.outcome.summary()
    }

    /// Why it failed, in one sentence, or None.
    #[getter]
    fn message(&self) -> Option<String> {
        match &self.finished.summary.outcome {
            Outcome::Failed(failure) => Some(failure.to_string()),
            _ => None,
        }
    }

    /// Simulated time reached in s.
    #[getter]
    fn time(&self) -> f64 {
        self.finished.summary.time
    }

    /// Steps taken.
    #[getter]
    fn steps(&self) -> u64 {
        self.finished.summary.steps
    }

    /// Number of particles.
    #[getter]
    fn particles(&self) -> usize {
        self.finished.particles
    }

    /// Warnings, one sentence each.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.finished.warnings.clone()
    }

    /// What it has been given without being asked for, one sentence each.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.finished.notes.clone()
    }

    /// The files that were written.
    #[getter]
    fn files(&self) -> Vec<PathBuf> {
        self.finished.files.clone()
    }

    /// The pictures that were written, which a notebook shows.
    #[getter]
    fn pictures<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let picture = py.import("piola")?.getattr("Picture")?;
        let folder = self.folder.as_ref().map(|folder| ResultsFolder::at(folder));
        let files = folder.map(|folder| folder.all_pictures()).unwrap_or_default();
        files.into_iter().map(|file| picture.call1((file,))).collect()
    }

    /// The page with all results, or None.
    #[getter]
    fn report(&self) -> Option<PathBuf> {
        let path = ResultsFolder::at(self.folder.as_ref()?).report();
        self.finished.files.contains(&path).then_some(path)
    }

    /// What was recorded.
    #[getter]
    fn tables(&self) -> Tables {
        Tables::new(self.finished.tables.clone())
    }

    /// The quantity `name` of checks of a case: the values of a history or profile as an array, or a number or text of
    /// the run as a whole, such as `run.steps`.
    ///
    /// Raises KeyError.
    fn quantity<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        match self.finished.quantity(name) {
            Some(Series::Curve { values, .. }) => {
                let shape = [values.len()];
                array(py, values, &shape)
            }
            Some(Series::Number { value, .. }) => Ok(value.into_pyobject(py)?.into_any()),
            Some(Series::Text(text)) => Ok(text.into_pyobject(py)?.into_any()),
            None => Err(PyKeyError::new_err(format!("the run has no quantity `{name}`"))),
        }
    }

    fn __repr__(&self) -> String {
        let summary = &self.finished.summary;
        let (time, steps) = (seconds(summary.time), count(summary.steps, "step"));
        format!("<Run {} at t = {time}, after {steps}>", self.outcome())
    }

    fn _repr_html_(&self) -> String {
        self.html()
    }
}
