//! Arrays as initial fields of a case.

use ::toml::Value;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::{floats, shape_text};
use crate::functions::Registry;
use crate::toml::within;

/// Keys of an initial state that have components, and those that have none.
const VECTORS: [&str; 2] = ["velocity", "displacement"];
const SCALAR: &str = "pressure";

/// What the array for a key has in its row.
#[derive(Clone, Copy, PartialEq)]
enum Row {
    Vector,
    Number,
}

/// The kind of initial field that the key `path` is, or that it is a component of, if it is any.
fn row_of(path: &str) -> Option<Row> {
    let keys: Vec<&str> = path.split('.').collect();
    match keys[..] {
        [.., "initial", key] if VECTORS.contains(&key) => Some(Row::Vector),
        [.., "initial", SCALAR] => Some(Row::Number),
        [.., "initial", key, _] if VECTORS.contains(&key) => Some(Row::Number),
        _ => None,
    }
}

/// What stands in the text of a case for an array with a row for each particle: of a vector a list of its components. Nothing for
/// other values, such as the components of a uniform vector.
///
/// # Errors
/// An array for an initial field that has another number of axes, other numbers than 64-bit floats hold, NaN or infinity.
pub fn array(
    value: &Bound<'_, PyAny>,
    path: &str,
    registry: &mut Registry,
) -> PyResult<Option<Value>> {
    let Some(row) = row_of(path) else { return Ok(None) };
    let axes = match value.hasattr("__array__")? {
        true => value.getattr_opt("ndim")?.map(|axes| axes.extract::<usize>()).transpose()?,
        false => None,
    };
    let is_uniform = match (row, axes) {
        (_, None | Some(0)) => true,
        (Row::Vector, Some(1)) => value.len()? <= 3,
        _ => false,
    };
    if is_uniform {
        return Ok(None);
    }
    let (numbers, shape) = floats(&format!("`{path}`"), value)?;
    let columns = match (row, &shape[..]) {
        (Row::Vector, [_, columns]) => *columns,
        (Row::Number, [_]) => 1,
        _ => {
            let expected = if row == Row::Vector { "(particles, D)" } else { "(particles,)" };
            let message = format!("`{path}` has the shape {expected}, not {}", shape_text(&shape));
            return Err(PyValueError::new_err(message));
        }
    };
    if let Some(at) = numbers.iter().position(|number| !number.is_finite()) {
        let (number, row) = (numbers[at], at / columns);
        let place = match shape.len() {
            1 => format!("[{row}]"),
            _ => format!("[{row}, {}]", at % columns),
        };
        let message =
            format!("the array for `{path}` has {number} at {place}, expected finite numbers");
        return Err(PyValueError::new_err(message));
    }
    if numbers.is_empty() {
        let message =
            format!("the array is empty, of the shape {}: {}", shape_text(&shape), within(path));
        return Err(PyValueError::new_err(message));
    }
    let column = |k: usize| numbers.iter().skip(k).step_by(columns).copied().collect::<Vec<f64>>();
    let names = (0..columns).map(|k| Value::String(registry.add_array(column(k))));
    let mut names: Vec<Value> = names.collect();
    Ok(match row {
        Row::Vector => Some(Value::Array(names)),
        Row::Number => names.pop(),
    })
}
