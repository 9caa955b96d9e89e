//! NumPy arrays from numbers, and numbers from arrays.

use numpy::{PyArray1, PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use piola::fields::{FieldDescription, FieldKind};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::toml::kind;

/// The shape of a field of `count` particles.
pub fn shape(field: &FieldDescription, count: usize, dimension: usize) -> Vec<usize> {
    match field.kind {
        FieldKind::Scalar => vec![count],
        FieldKind::Vector => vec![count, dimension],
        FieldKind::Tensor => vec![count, dimension, dimension],
        FieldKind::Symmetric => vec![count, 6],
    }
}

/// An array that owns its numbers.
pub fn array<'py>(
    py: Python<'py>,
    values: Vec<f64>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyAny>> {
    Ok(PyArray1::from_vec(py, values).reshape(shape)?.into_any())
}

/// The numbers of whatever NumPy takes for an array, last axis first, however they lie in memory.
///
/// # Errors
/// It is no array of numbers that fit 64-bit floats, or has another shape than `expected`.
pub fn numbers(what: &str, given: &Bound<'_, PyAny>, expected: &[usize]) -> PyResult<Vec<f64>> {
    let py = given.py();
    let numpy = py.import("numpy")?;
    let array = numpy.call_method1("asarray", (given,))?;
    let dtype = array.getattr("dtype")?;
    let float = numpy.getattr("float64")?;
    let fits: bool = numpy.call_method1("can_cast", (&dtype, &float, "safe"))?.extract()?;
    if !fits {
        let message = format!("{what} takes 64-bit floats, not {dtype} (of a {})", kind(given));
        return Err(PyTypeError::new_err(message));
    }
    let options = PyDict::new(py);
    options.set_item("dtype", float)?;
    let array = numpy.call_method("asarray", (array,), Some(&options))?;
    let array = array.cast_into::<PyArrayDyn<f64>>()?;
    if array.shape() != expected {
        let [expected, got] = [expected, array.shape()].map(shape_text);
        return Err(PyValueError::new_err(format!("{what} has the shape {expected}, not {got}")));
    }
    Ok(array.readonly().as_array().iter().copied().collect())
}

/// A shape as Python writes it.
fn shape_text(shape: &[usize]) -> String {
    match shape {
        [one] => format!("({one},)"),
        more => format!("({})", more.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")),
    }
}
