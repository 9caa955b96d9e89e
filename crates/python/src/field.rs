//! Fields as arrays that look at the memory of a state.

use std::sync::{Arc, Mutex};

use piola::case::FieldView;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::display::seconds;
use crate::simulation::{Standing, inside};

/// 64-bit floats in the order of bytes of this machine, as NumPy writes it.
const FLOATS: &str = if cfg!(target_endian = "little") { "<f8" } else { ">f8" };

/// A field as it was when it was read: the memory that its array views and keeps alive (`array.base`; for a slice
/// `piola.field_of(slice)`). The numbers never change: the simulation writes its next states to other memory.
#[pyclass(module = "piola", frozen, weakref)]
pub struct Field {
    view: FieldView,
    /// The state of the simulation at that time.
    read: Standing,
    /// Its current state.
    now: Arc<Mutex<Standing>>,
    /// Name of the body, or None for all particles.
    #[pyo3(get)]
    body: Option<String>,
}

impl Field {
    /// An array on the memory of a view.
    pub fn array<'py>(
        py: Python<'py>,
        view: FieldView,
        (read, now): (Standing, Arc<Mutex<Standing>>),
        body: Option<String>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let field = Bound::new(py, Self { view, read, now, body })?;
        py.import("numpy")?.call_method1("asarray", (field,))
    }
}

#[pymethods]
impl Field {
    /// Name of the field.
    #[getter]
    fn name(&self) -> &str {
        self.view.description().name
    }

    /// SI unit.
    #[getter]
    fn unit(&self) -> &str {
        self.view.description().unit
    }

    /// The time in s at which it was read.
    #[getter]
    fn time(&self) -> f64 {
        self.read.progress.time
    }

    /// Steps taken when it was read.
    #[getter]
    fn steps(&self) -> u64 {
        self.read.progress.step
    }

    /// Whether the simulation still has this state: False once a step has been taken, a field has been set, or the run
    /// has ended.
    #[getter]
    fn is_current(&self) -> bool {
        inside(&self.now).changes == self.read.changes
    }

    /// Whether it is a copy, and not the memory of the simulation: the field is not part of the state but computed from
    /// it, or the particles of the body are not contiguous in memory.
    #[getter]
    fn is_copy(&self) -> bool {
        self.view.is_copy()
    }

    /// Where the numbers are, for NumPy: read-only.
    #[getter]
    fn __array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let address = self.view.numbers().as_ptr().expose_provenance();
        let bytes = self.view.strides().into_iter().map(|stride| stride * size_of::<f64>());
        let interface = PyDict::new(py);
        interface.set_item("version", 3)?;
        interface.set_item("typestr", FLOATS)?;
        interface.set_item("shape", PyTuple::new(py, self.view.shape())?)?;
        interface.set_item("strides", PyTuple::new(py, bytes.collect::<Vec<_>>())?)?;
        interface.set_item("data", (address, true))?;
        Ok(interface)
    }

    fn __repr__(&self) -> String {
        let of = self.body.as_ref().map_or_else(String::new, |body| format!(" of {body}"));
        let copy = if self.is_copy() { ", a copy" } else { "" };
        let past = if self.is_current() { "" } else { ", past" };
        format!("<Field {}{of} at t = {}{copy}{past}>", self.name(), seconds(self.time()))
    }
}

/// The `Field` behind an array or a slice of it; None for an array with memory of its own.
#[pyfunction]
pub fn field_of<'py>(array: &Bound<'py, PyAny>) -> PyResult<Option<Bound<'py, Field>>> {
    let mut base = array.clone();
    while let Some(next) = base.getattr_opt("base")?.filter(|next| !next.is_none()) {
        match next.cast_into::<Field>() {
            Ok(field) => return Ok(Some(field)),
            Err(other) => base = other.into_inner(),
        }
    }
    Ok(None)
}
