//! NumPy arrays from numbers, and numbers from arrays.

use numpy::{PyArray1, PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::toml::kind;

/// An array that owns its numbers.
pub fn array<'py>(
    py: Python<'py>,
    values: Vec<f64>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyAny>> {
    Ok(PyArray1::from_vec(py, values).reshape(shape)?.into_any())
}

/// The numbers of whatever NumPy takes for an array, last axis first, however they lie in memory, with its shape.
///
/// # Errors
/// It is no array of numbers that fit 64-bit floats.
pub fn floats(what: &str, given: &Bound<'_, PyAny>) -> PyResult<(Vec<f64>, Vec<usize>)> {
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
    Ok((array.readonly().as_array().iter().copied().collect(), array.shape().to_vec()))
}

/// As [`floats`], of a known shape.
///
/// # Errors
/// As there, and if it has another shape than `expected`.
pub fn numbers(what: &str, given: &Bound<'_, PyAny>, expected: &[usize]) -> PyResult<Vec<f64>> {
    let (numbers, shape) = floats(what, given)?;
    if shape != expected {
        let [expected, got] = [expected, &shape].map(shape_text);
        return Err(PyValueError::new_err(format!("{what} has the shape {expected}, not {got}")));
    }
    Ok(numbers)
}

/// A shape as Python writes it.
pub fn shape_text(shape: &[usize]) -> String {
    match shape {
        [one] => format!("({one},)"),
        more => format!("({})", more.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")),
    }
}
