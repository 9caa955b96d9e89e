//! Bodies and their fields.

use std::sync::Arc;

use numpy::PyArray1;
use piola::case::Session;
use piola::fields::{FieldDescription, Life};
use piola_cli::count;
use pyo3::exceptions::{PyKeyError, PyTypeError};
use pyo3::prelude::*;

use crate::arrays::numbers;
use crate::errors::column_error;
use crate::field::Field;
use crate::moment::there;
use crate::simulation::{Simulation, Standing};

/// A body that is not among those with these names.
pub fn no_body<'a>(name: &str, names: impl Iterator<Item = &'a str>) -> PyErr {
    let known = names.collect::<Vec<_>>().join("`, `");
    PyKeyError::new_err(format!("there is no body `{name}`; there are `{known}`"))
}

/// The bodies of a simulation, by name.
#[pyclass(module = "piola", frozen, mapping)]
pub struct Bodies {
    simulation: Py<Simulation>,
    /// The moment they belong to; if there is none, their current state is read.
    moment: Option<Standing>,
}

impl Bodies {
    pub fn new(simulation: Py<Simulation>, moment: Option<Standing>) -> Self {
        Self { simulation, moment }
    }
}

#[pymethods]
impl Bodies {
    fn __getitem__(&self, py: Python<'_>, name: &str) -> PyResult<Body> {
        let names = &self.simulation.get().bodies;
        let number = names.iter().position(|known| known == name);
        let number = number.ok_or_else(|| no_body(name, names.iter().map(String::as_str)))?;
        let simulation = self.simulation.clone_ref(py);
        let name = Some(name.to_owned());
        Ok(Body { simulation, moment: self.moment, number: Some(number), name })
    }

    fn __len__(&self) -> usize {
        self.simulation.get().bodies.len()
    }

    fn __contains__(&self, name: &str) -> bool {
        self.simulation.get().bodies.iter().any(|known| known == name)
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(self.keys().into_pyobject(py)?.try_iter()?.into_any())
    }

    /// The names, in the order of the case.
    fn keys(&self) -> Vec<String> {
        self.simulation.get().bodies.clone()
    }

    fn __repr__(&self) -> String {
        format!("<Bodies {}>", self.simulation.get().bodies.join(", "))
    }
}

/// A body, with its fields as arrays: `body["velocity"]`.
///
/// An array has a row for each particle, in the order of particle files, which is the same at all moments (where
/// particles enter or leave, for those present). Its shape is (particles,) for a scalar, (particles, D) for a vector,
/// (particles, D, D) for a tensor, (particles, 6) for xx, yy, zz, yz, xz, xy of symmetric tensors; units are SI, as
/// listed by `fields()`. It is read-only and does not change when the run continues: `array.base` is a `Field`, which
/// says whether the simulation is still at that state, and whether the array is a view of its memory or a copy.
///
/// `body["velocity"] = values` sets a field, before the first step or between two steps, from an array of the shape
/// that reading it gives, of numbers that convert safely to 64-bit floats, in any memory layout. Prescribed values stay
/// as they are.
///
/// Reading and writing raise KeyError if the scheme has no such field, and RuntimeError if the body belongs to a moment
/// that is over; writing raises ValueError for a wrong shape, NaN, infinity, or a field that cannot be set, and
/// TypeError for other types. In these cases nothing is changed.
#[pyclass(module = "piola", frozen)]
pub struct Body {
    simulation: Py<Simulation>,
    moment: Option<Standing>,
    /// Its number in the case, or all particles.
    number: Option<usize>,
    /// Its name in the case, or None for all particles.
    #[pyo3(get)]
    name: Option<String>,
}

impl Body {
    /// All particles.
    pub fn of_all(simulation: Py<Simulation>, moment: Option<Standing>) -> Self {
        Self { simulation, moment, number: None, name: None }
    }

    /// Works on the session, if it is still at that moment.
    fn with<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut Session) -> T + Send,
    ) -> PyResult<T> {
        let (simulation, moment) = (self.simulation.get(), self.moment);
        simulation.with(py, move |session| {
            moment.map_or(Ok(simulation), |moment| there(simulation, moment))?;
            Ok(work(session))
        })?
    }

    /// Its particles, by index in the columns.
    fn rows(&self, py: Python<'_>) -> PyResult<Vec<usize>> {
        let number = self.number;
        self.with(py, |session| session.particles_of(number))
    }

    fn label(&self) -> String {
        self.name.as_ref().map_or_else(|| "all particles".to_owned(), |name| format!("`{name}`"))
    }
}

#[pymethods]
impl Body {
    /// The values of a field at the moment.
    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let (number, simulation) = (self.number, self.simulation.get());
        let (view, read) =
            self.with(py, |session| (session.view(name, number), simulation.standing()))?;
        let view = view.map_err(|error| column_error(&error))?;
        let standing = (read, Arc::clone(&simulation.standing_now));
        Field::array(py, view, standing, self.name.clone())
    }

    /// Sets the values of a field.
    fn __setitem__(&self, py: Python<'_>, name: &str, values: &Bound<'_, PyAny>) -> PyResult<()> {
        let number = self.number;
        let shape = self.with(py, |session| session.view(name, number).map(|view| view.shape()))?;
        let shape = shape.map_err(|error| column_error(&error))?;
        let given = numbers(&format!("`{name}` of {}", self.label()), values, &shape)?;
        let simulation = self.simulation.get();
        let set = self.with(py, |session| {
            let set = session.set_of(name, number, &given);
            if set.is_ok() {
                simulation.note(session);
            }
            set
        })?;
        set.map_err(|error| column_error(&error))
    }

    fn __delitem__(&self, name: &str) -> PyResult<()> {
        Err(PyTypeError::new_err(format!("a field cannot be deleted: `{name}`")))
    }

    fn __contains__(&self, py: Python<'_>, name: &str) -> PyResult<bool> {
        Ok(self.keys(py)?.iter().any(|known| known == name))
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(self.keys(py)?.into_pyobject(py)?.try_iter()?.into_any())
    }

    /// The names of its fields.
    fn keys(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        Ok(self.fields(py)?.into_iter().map(|(name, ..)| name).collect())
    }

    /// Its fields: name, unit and meaning of each.
    fn fields(&self, py: Python<'_>) -> PyResult<Vec<(String, String, String)>> {
        self.with(py, |session| {
            let shown = session.columns().iter().filter(|field| field.life != Life::Kept);
            let texts = |field: &FieldDescription| {
                (field.name.to_owned(), field.unit.to_owned(), field.meaning.to_owned())
            };
            shown.map(texts).collect()
        })
    }

    /// Number of each particle in the order of creation.
    #[getter]
    fn ids<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let number = self.number;
        let ids: Vec<u32> = self.with(py, |session| session.ids_of(number))?;
        Ok(PyArray1::from_vec(py, ids).into_any())
    }

    /// The rows of its particles among all: `simulation.particles[field][body.rows]` is `body[field]`, if no particle
    /// has entered or left.
    #[getter(rows)]
    fn all_rows<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(PyArray1::from_vec(py, self.rows(py)?).into_any())
    }

    fn __len__(&self, py: Python<'_>) -> PyResult<usize> {
        Ok(self.rows(py)?.len())
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let name = self.name.as_ref().map_or_else(String::new, |name| format!(" {name}"));
        Ok(format!("<Body{name} of {}>", count(self.__len__(py)? as u64, "particle")))
    }
}
