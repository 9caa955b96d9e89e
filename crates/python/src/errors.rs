//! Faults of the library as Python exceptions.

use std::panic::{AssertUnwindSafe, catch_unwind};

use piola::case::{self, ColumnError, Problems, SensitivityError};
use pyo3::create_exception;
use pyo3::exceptions::{PyException, PyKeyError, PyValueError};
use pyo3::prelude::*;

create_exception!(
    piola,
    CaseError,
    PyValueError,
    "A case that cannot be read or built. Its text is that of the program, with the places of all faults;\n\
     `faults` is a list of them."
);

create_exception!(
    piola,
    RunError,
    PyException,
    "A run that failed, or whose files cannot be written.\n\n\
     kind: one word for the cause, for example `inverted`; `files` or `panic` if the cause is not physical.\n\
     particle: number of the particle in the order of creation, or None.\n\
     place: reference position of the particle in m, or None.\n\
     time, step: of the last good state, in s and counted from the start, or None.\n\
     run: the `Run` up to the failure, or None."
);

/// One thing that is wrong with a case.
#[pyclass(module = "piola", frozen, get_all)]
pub struct Fault {
    /// A sentence: what is wrong, what was expected, what was found.
    message: String,
    /// A few words for the underlined text; may be empty.
    label: String,
    /// What to do, or None.
    help: Option<String>,
    /// The file, or the override, that it is in.
    source: String,
    /// Line in `source` from 1, or None if the fault is not in a single place.
    line: Option<usize>,
    /// Column in characters from 1, or None.
    column: Option<usize>,
}

#[pymethods]
impl Fault {
    fn __repr__(&self) -> String {
        let place = match (self.line, self.column) {
            (Some(line), Some(column)) => format!("{}:{line}:{column}", self.source),
            _ => self.source.clone(),
        };
        format!("<Fault {place}: {}>", self.message)
    }
}

/// All problems of a case, one by one.
pub fn faults(problems: &Problems) -> Vec<Fault> {
    let fault = |problem| {
        let (line, column) = problems.line_column(problem).unzip();
        let source = problems.source(problem).map(|source| source.name.clone()).unwrap_or_default();
        let case::Problem { message, label, help, .. } = problem.clone();
        Fault { message, label, help, source, line, column }
    };
    problems.iter().map(fault).collect()
}

/// The text that the program shows.
pub fn case_error(py: Python<'_>, problems: &Problems) -> PyErr {
    let error = CaseError::new_err(problems.to_string());
    match error.value(py).setattr("faults", faults(problems)) {
        Ok(()) => error,
        Err(other) => other,
    }
}

/// What is known of a run that failed, beside its text.
#[derive(Default)]
pub struct Failed {
    /// The cause in one word.
    pub kind: &'static str,
    /// The number of the particle and its reference position in m.
    pub particle: Option<(u32, Vec<f64>)>,
    /// Time in s and number of steps of the last good state.
    pub at: Option<(f64, u64)>,
    /// The run as far as it came.
    pub run: Option<Py<PyAny>>,
}

/// A run that failed.
pub fn run_error(py: Python<'_>, text: String, failed: Failed) -> PyErr {
    let error = RunError::new_err(text);
    let (particle, place) = failed.particle.unzip();
    let (time, step) = failed.at.unzip();
    let value = error.value(py);
    let set = value
        .setattr("kind", failed.kind)
        .and_then(|()| value.setattr("particle", particle))
        .and_then(|()| value.setattr("place", place))
        .and_then(|()| value.setattr("time", time))
        .and_then(|()| value.setattr("step", step))
        .and_then(|()| value.setattr("run", failed.run));
    match set {
        Ok(()) => error,
        Err(other) => other,
    }
}

/// A fault of files or checkpoints.
pub fn file_error(py: Python<'_>, error: &case::RunError) -> PyErr {
    run_error(py, error.to_string(), Failed { kind: "files", ..Failed::default() })
}

/// A column that cannot be read or set.
pub fn column_error(error: &ColumnError) -> PyErr {
    match error {
        ColumnError::Unknown { .. } => PyKeyError::new_err(error.to_string()),
        _ => PyValueError::new_err(error.to_string()),
    }
}

/// A derivative that is not known.
pub fn sensitivity_error(error: &SensitivityError) -> PyErr {
    match error {
        SensitivityError::Unknown { .. } => PyKeyError::new_err(error.to_string()),
        _ => PyValueError::new_err(error.to_string()),
    }
}

/// What is said after a panic, which is a fault of the program.
pub fn panic_error(py: Python<'_>) -> PyErr {
    let text = "piola has stopped because of a bug, which the standard error output names; \
    please report it, with the case. The objects in use cannot be used any more";
    run_error(py, text.to_owned(), Failed { kind: "panic", ..Failed::default() })
}

/// Runs `work` without the GIL. A panic in it becomes an exception.
pub fn guard<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    let done = py.detach(|| catch_unwind(AssertUnwindSafe(work)).ok());
    done.ok_or_else(|| panic_error(py))
}
