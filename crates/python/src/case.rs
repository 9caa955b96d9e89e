//! Cases.

use std::path::PathBuf;
use std::sync::Arc;

use ::toml::Value;
use piola::case::{self, Level, LoadOptions, Problems, Session, load, parse_in};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::array;
use crate::bodies::no_body;
use crate::display::{preformatted, seconds, table};
use crate::errors::{Fault, case_error, faults, file_error, guard};
use crate::functions::{Registry, Shared, make_threads, refuse_inside};
use crate::plan::Plan;
use crate::simulation::Simulation;
use crate::toml;

/// The name of the text of a dict in messages and records.
const DICT: &str = "case";

/// Where the text of a case is.
#[derive(Clone, Debug)]
enum Source {
    File(PathBuf),
    Text { text: String, folder: PathBuf },
}

/// A case: the content of a case file, with all changes by `set`.
///
/// Case(table, *, folder=".", variant=None, level="case")
///
/// table: a dict with the keys of a case file (docs/case-file.md). NumPy arrays and numbers, tuples and paths
/// are accepted, functions of any of x, y, z and t in place of expressions, a `Cloud` in place of the shape of a body,
/// and arrays in place of its initial `velocity` and `displacement`, of shape (particles, D), and `pressure`, of shape
/// (particles,), with rows in the order of `positions`. It is turned into the text of a case file, which `case.toml` shows and messages refer to.
/// folder: where files named in the case are searched for.
/// variant: name of a variant, or of a member of a sweep (`NAME.3`).
/// level: "case", or the settings "coarse" or "paper" of the case.
///
/// `faults` lists what is wrong with a case; `check` and `start` raise it as `CaseError`.
///
/// >>> import piola
/// >>> case = piola.Case({"version": 1, "title": "a bar", "dimension": 4})
/// >>> [fault.message for fault in case.faults() if "dimension" in fault.message]
/// ['`dimension` must be from 1 to 3, got 4']
#[pyclass(module = "piola")]
pub struct Case {
    source: Source,
    /// What the case is read with, but for the changes.
    options: LoadOptions,
    changes: Vec<Change>,
    registry: Registry,
}

impl Case {
    fn of(
        source: Source,
        registry: Registry,
        variant: Option<String>,
        level: &str,
    ) -> PyResult<Self> {
        let found = Level::ALL.into_iter().find(|known| known.name() == level);
        let level = found.ok_or_else(|| {
            PyValueError::new_err(format!(
                "level must be \"case\", \"coarse\" or \"paper\", not {level:?}"
            ))
        })?;
        let options = LoadOptions { variant, level, ..LoadOptions::default() };
        Ok(Self { source, options, changes: Vec::new(), registry })
    }

    /// Reads the case as it is now, without the GIL, and what the functions of its run share.
    fn read(&self, py: Python<'_>) -> PyResult<(Result<case::Case, Problems>, Arc<Shared>)> {
        let (functions, shared) = self.registry.for_a_run();
        let Registry { clouds, arrays, .. } = &self.registry;
        let (clouds, arrays) = (clouds.clone(), arrays.clone());
        let overrides = self.changes.iter().map(Change::text).collect();
        let options = LoadOptions { overrides, functions, clouds, arrays, ..self.options.clone() };
        let read = guard(py, || match &self.source {
            Source::File(path) => load(path, &options),
            Source::Text { text, folder } => parse_in(folder, text, DICT, &options),
        })?;
        Ok((read, shared))
    }

    /// Lets go of clouds and arrays that nothing stands for any more.
    fn release(&mut self) {
        let changes: Vec<String> = self.changes.iter().map(Change::text).collect();
        let source = match &self.source {
            Source::File(_) => "",
            Source::Text { text, .. } => text,
        };
        let texts = || changes.iter().map(String::as_str).chain([source]);
        let is_used = |name: &str| texts().any(|text| text.contains(&format!("@{name}")));
        self.registry.clouds.keep(is_used);
        self.registry.arrays.keep(is_used);
    }

    fn model(&self, py: Python<'_>) -> PyResult<(case::Case, Arc<Shared>)> {
        let (case, shared) = self.read(py)?;
        Ok((case.map_err(|problems| case_error(py, &problems))?, shared))
    }

    fn build(&self, py: Python<'_>) -> PyResult<(Session, Arc<Shared>)> {
        let (case, shared) = self.model(py)?;
        let session = built(py, &case, &shared)?.map_err(|problems| case_error(py, &problems))?;
        Ok((session, shared))
    }
}

/// A key that has been set, or removed.
struct Change {
    path: String,
    /// Nothing for a key that has been removed.
    value: Option<Value>,
}

impl Change {
    /// As an override of the command line.
    fn text(&self) -> String {
        let value = self.value.as_ref().map(Value::to_string).unwrap_or_default();
        format!("{}={value}", self.path)
    }

    /// Whether it gives a name, by which later paths may find something.
    fn gives_a_name(&self) -> bool {
        fn has_name(value: &Value) -> bool {
            match value {
                Value::Table(table) => {
                    table.iter().any(|(key, value)| key == "name" || has_name(value))
                }
                Value::Array(values) => values.iter().any(has_name),
                _ => false,
            }
        }
        self.path.ends_with(".name") || self.value.as_ref().is_some_and(has_name)
    }

    /// Whether it sets something within a key, or appends to it.
    fn is_within(&self, path: &str) -> bool {
        self.path.strip_prefix(path).is_some_and(|rest| rest.starts_with(['.', '+']))
    }
}

/// Drops the last change of a key that is set once more, if nothing since can depend on it: something within it, what is
/// found by a name that it gives, or places in a list that something has been removed from.
fn forget(changes: &mut Vec<Change>, path: &str) {
    let Some(last) = changes.iter().rposition(|known| known.path == path) else { return };
    let depends = |later: &Change| later.value.is_none() || later.is_within(path);
    let is_needed = changes[last].gives_a_name() || changes[last..].iter().any(depends);
    if !is_needed && !path.ends_with('+') {
        changes.remove(last);
    }
}

/// Creates the particles. Functions are called for the values at the start.
fn built(
    py: Python<'_>,
    case: &case::Case,
    shared: &Shared,
) -> PyResult<Result<Session, Problems>> {
    refuse_inside()?;
    shared.set_end(*case.time.end);
    let session = guard(py, || {
        make_threads();
        Session::new(case)
    })?;
    shared.sound()?;
    Ok(session)
}

#[pymethods]
impl Case {
    #[new]
    #[pyo3(signature = (table, *, folder=None, variant=None, level="case"))]
    fn new(
        table: &Bound<'_, PyAny>,
        folder: Option<PathBuf>,
        variant: Option<String>,
        level: &str,
    ) -> PyResult<Self> {
        let table = table.cast::<PyDict>().map_err(|_| {
            let kind = table.get_type();
            PyTypeError::new_err(format!(
                "a case is a dict, not {kind}: piola.Case.load(path) reads a case file"
            ))
        })?;
        let mut registry = Registry::default();
        let text = ::toml::to_string(&toml::table(table, &mut registry)?)
            .map_err(|error| PyValueError::new_err(format!("this is not TOML: {error}")))?;
        let source = Source::Text { text, folder: folder.unwrap_or_default() };
        Self::of(source, registry, variant, level)
    }

    /// Reads the case file at `path`. The file is read again whenever the case is used later.
    ///
    /// Raises CaseError if there is no such file. `faults` lists what is wrong in it.
    #[staticmethod]
    #[pyo3(signature = (path, *, variant=None, level="case"))]
    fn load(py: Python<'_>, path: PathBuf, variant: Option<String>, level: &str) -> PyResult<Self> {
        let case = Self::of(Source::File(path), Registry::default(), variant, level)?;
        match case.read(py)?.0 {
            Err(problems) if problems.is_io() => Err(case_error(py, &problems)),
            _ => Ok(case),
        }
    }

    /// Sets the key that `path` leads to, as `--set` does: `body.water.spacing`, `load.0.acceleration`. A path with `+`
    /// at its end appends to a list; the value None removes the key. A value may contain functions, clouds and
    /// arrays, as in `Case`. Returns the case itself.
    fn set<'py>(
        mut slf: PyRefMut<'py, Self>,
        path: &str,
        value: &Bound<'py, PyAny>,
    ) -> PyResult<PyRefMut<'py, Self>> {
        if path.contains('=') {
            return Err(PyValueError::new_err(format!("this is not the path of a key: {path:?}")));
        }
        let value = match value.is_none() {
            true => None,
            false => Some(toml::value(value, path, &mut slf.registry)?),
        };
        // What takes a key away needs it there.
        if value.is_some() {
            forget(&mut slf.changes, path);
        }
        slf.changes.push(Change { path: path.to_owned(), value });
        slf.release();
        Ok(slf)
    }

    /// What is wrong with the case, in the order of its text: a list of `Fault`, empty for a valid case. This creates
    /// the particles.
    fn faults(&self, py: Python<'_>) -> PyResult<Vec<Fault>> {
        let built = match self.read(py)? {
            (Ok(case), shared) => built(py, &case, &shared)?.map(|_| ()),
            (Err(problems), _) => Err(problems),
        };
        Ok(built.err().map(|problems| faults(&problems)).unwrap_or_default())
    }

    /// Positions at the start of the particles of the body `name`, in m: an array of shape (particles, D), in the order of
    /// creation. Arrays of initial fields have their rows in this order; of a `Cloud` it is its own.
    ///
    /// Raises CaseError, and KeyError if the case has no such body.
    fn positions<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        refuse_inside()?;
        let (case, _) = self.model(py)?;
        let names = || case.bodies.iter().map(|body| body.name.value.as_str());
        let number =
            names().position(|known| known == name).ok_or_else(|| no_body(name, names()))?;
        let positions = guard(py, || {
            make_threads();
            case.positions(number)
        })?;
        let positions = positions.map_err(|problems| case_error(py, &problems))?;
        let count = positions.len() / case.dimension;
        array(py, positions, &[count, case.dimension])
    }

    /// What a run will do, without running it: creates the particles and times two steps.
    ///
    /// Raises CaseError.
    fn check(&self, py: Python<'_>) -> PyResult<Plan> {
        let (mut session, shared) = self.build(py)?;
        let plan = guard(py, || session.plan())?;
        shared.sound()?;
        Ok(Plan::new(session.case(), plan))
    }

    /// Creates the particles and everything else that a run needs.
    ///
    /// out: folder of the results, as `piola run --out` writes it; None for a run in memory only.
    /// resume: continues from the newest checkpoint in `out`, with results identical to the bit.
    ///
    /// Raises CaseError; RunError if there is nothing to resume from.
    #[pyo3(signature = (out=None, *, resume=false))]
    fn start(&self, py: Python<'_>, out: Option<PathBuf>, resume: bool) -> PyResult<Simulation> {
        let (mut session, shared) = self.build(py)?;
        if let Some(folder) = &out {
            let placed = guard(py, || match resume {
                true => session.resume_from(folder),
                false => session.write_to(folder),
            })?;
            placed.map_err(|error| file_error(py, &error))?;
        } else if resume {
            return Err(PyValueError::new_err("resuming a run needs the folder of its results"));
        }
        Ok(Simulation::new(session, out, shared))
    }

    /// The text that the case is read from and that messages refer to: that of the file, or that made from the dict.
    ///
    /// Raises OSError if the file cannot be read.
    #[getter]
    fn text(&self) -> PyResult<String> {
        match &self.source {
            Source::File(path) => Ok(std::fs::read_to_string(path)?),
            Source::Text { text, .. } => Ok(text.clone()),
        }
    }

    /// The text of the case with all changes by `set`. Raises CaseError.
    #[getter]
    fn toml(&self, py: Python<'_>) -> PyResult<String> {
        Ok(self.model(py)?.0.as_run)
    }

    /// What the case shows, in one line. Raises CaseError.
    #[getter]
    fn title(&self, py: Python<'_>) -> PyResult<String> {
        Ok(self.model(py)?.0.title)
    }

    fn __repr__(&self) -> String {
        let source = match &self.source {
            Source::File(path) => path.display().to_string(),
            Source::Text { .. } => "of a dict".to_owned(),
        };
        let set = self.changes.iter().map(|change| format!(", {}", change.text()));
        format!("<Case {source}{}>", set.collect::<String>())
    }

    fn _repr_html_(&self, py: Python<'_>) -> PyResult<String> {
        let case = match self.read(py)?.0 {
            Ok(case) => case,
            Err(problems) => return Ok(preformatted(&problems.to_string())),
        };
        let dimension = format!("{}D", case.dimension);
        let bodies: Vec<&str> = case.bodies.iter().map(|body| body.name.value.as_str()).collect();
        let (bodies, end) = (bodies.join(", "), seconds(*case.time.end));
        let rows = [
            ["dimension", dimension.as_str()],
            ["bodies", &bodies],
            ["scheme", case.scheme.value.name()],
            ["end", &end],
        ];
        let text = preformatted(&case.as_run);
        let text = format!("<details><summary>text</summary>{text}</details>");
        Ok(table(&case.title, rows) + &text)
    }
}
