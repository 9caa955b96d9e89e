//! Bodies and their fields.

use piola::case::{ColumnError, Session};
use piola::fields::{FieldDescription, FieldValues, Life};
use pyo3::exceptions::{PyKeyError, PyTypeError};
use pyo3::prelude::*;

use crate::arrays::{array, numbers, shape};
use crate::errors::column_error;
use crate::moment::there;
use crate::simulation::{Simulation, Standing};

/// The bodies of a simulation, by name.
#[pyclass(module = "piola", frozen, mapping)]
pub struct Bodies {
    simulation: Py<Simulation>,
    /// The moment that they are of, or they are as they are when they are read.
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
        let number = names.iter().position(|known| known == name).ok_or_else(|| {
            let known = names.join("`, `");
            PyKeyError::new_err(format!("there is no body `{name}`; there are `{known}`"))
        })?;
        let simulation = self.simulation.clone_ref(py);
        Ok(Body { simulation, moment: self.moment, number, name: name.to_owned() })
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
/// particles come in or go out, of those that are there). Its shape is (particles,) for a scalar, (particles, D) for a
/// vector, (particles, D, D) for a tensor, (particles, 6) for xx, yy, zz, yz, xz, xy of symmetric tensors; its unit is SI,
/// as `fields()` says. It is a copy: `body["velocity"][:, 0] = 0` changes nothing in the simulation.
///
/// `body["velocity"] = values` does, before the first step or between two: an array of the shape that reading it gives, of
/// numbers that fit 64-bit floats, in any order in memory. What is prescribed stays as it is.
///
/// To read or write raises KeyError if the scheme has no such field, RuntimeError if it is of a moment that is over; to
/// write, ValueError for a wrong shape, NaN, infinity, or a field that cannot be set, and TypeError for other types. Then
/// nothing is changed.
#[pyclass(module = "piola", frozen)]
pub struct Body {
    simulation: Py<Simulation>,
    moment: Option<Standing>,
    number: usize,
    /// Its name in the case.
    #[pyo3(get)]
    name: String,
}

impl Body {
    fn with<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut Session) -> T + Send,
    ) -> PyResult<T> {
        let simulation = self.simulation.get();
        if let Some(moment) = self.moment {
            there(simulation, moment)?;
        }
        simulation.with(py, work)
    }

    /// A column with the indices of the particles of this body.
    fn read(&self, py: Python<'_>, name: &str) -> PyResult<(FieldValues, Vec<usize>, usize)> {
        let number = self.number;
        let found = self.with(py, |session| {
            let column = session.column(name)?;
            let dimension = session.case().dimension;
            Ok((column, session.particles_of(number), dimension))
        })?;
        found.map_err(|error: ColumnError| column_error(&error))
    }
}

#[pymethods]
impl Body {
    /// The values of a field at the moment.
    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let (column, particles, dimension) = self.read(py, name)?;
        let shape = shape(&column.description, particles.len(), dimension);
        let width = shape[1..].iter().product::<usize>();
        let mut values = Vec::with_capacity(particles.len() * width);
        for particle in particles {
            values.extend_from_slice(&column.values[particle * width..(particle + 1) * width]);
        }
        array(py, values, &shape)
    }

    /// Gives a field other values.
    fn __setitem__(&self, py: Python<'_>, name: &str, values: &Bound<'_, PyAny>) -> PyResult<()> {
        let (mut column, particles, dimension) = self.read(py, name)?;
        let shape = shape(&column.description, particles.len(), dimension);
        let what = format!("`{name}` of `{}`", self.name);
        let given = numbers(&what, values, &shape)?;
        let width = shape[1..].iter().product::<usize>();
        for (particle, row) in particles.iter().zip(given.chunks_exact(width)) {
            column.values[particle * width..(particle + 1) * width].copy_from_slice(row);
        }
        let simulation = self.simulation.get();
        let set = self.with(py, |session| {
            let set = session.set(name, &column.values);
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
        let ids: Vec<u32> = self.with(py, |session| {
            let particles = session.particles_of(number);
            particles.iter().map(|&particle| session.ids()[particle]).collect()
        })?;
        Ok(numpy::PyArray1::from_vec(py, ids).into_any())
    }

    fn __len__(&self, py: Python<'_>) -> PyResult<usize> {
        let number = self.number;
        self.with(py, |session| session.particles_of(number).len())
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!("<Body {} of {} particles>", self.name, self.__len__(py)?))
    }
}
