//! Python values as values of a case file.

use ::toml::{Table, Value};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};

use crate::cloud::Cloud;
use crate::functions::Registry;
use crate::initial;

/// How deep values may be nested; the deepest key of a case file is far above.
const MAX_DEPTH: usize = 64;

/// A dict as a table. What is wrong with keys and values of a case is left to the reader of cases. Functions, clouds and
/// arrays of initial fields go to `functions`, and leave their names in the table.
///
/// # Errors
/// A key is no text, or a value is none that a case file can have.
pub fn table(dict: &Bound<'_, PyDict>, functions: &mut Registry) -> PyResult<Table> {
    table_at(dict, "", functions, 0)
}

/// A value for the key `path`.
///
/// # Errors
/// As [`table`].
pub fn value(value: &Bound<'_, PyAny>, path: &str, functions: &mut Registry) -> PyResult<Value> {
    value_at(value, path, functions, 0)
}

fn table_at(
    dict: &Bound<'_, PyDict>,
    path: &str,
    functions: &mut Registry,
    depth: usize,
) -> PyResult<Table> {
    let entries = dict.iter().map(|(key, value)| {
        let Ok(key) = key.cast::<PyString>() else {
            let message =
                format!("keys of a case must be strings, not {}: {}", kind(&key), within(path));
            return Err(PyTypeError::new_err(message));
        };
        let key = key.to_str()?.to_owned();
        let inner = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        Ok((key, value_at(&value, &inner, functions, depth + 1)?))
    });
    entries.collect()
}

fn value_at(
    value: &Bound<'_, PyAny>,
    path: &str,
    functions: &mut Registry,
    depth: usize,
) -> PyResult<Value> {
    if depth > MAX_DEPTH {
        return Err(PyValueError::new_err(format!("nested too deeply: {}", within(path))));
    }
    if let Some(names) = initial::array(value, path, functions)? {
        return Ok(names);
    }
    // True is an int, too.
    if let Ok(flag) = value.cast::<PyBool>() {
        return Ok(Value::Boolean(flag.is_true()));
    }
    if value.is_instance_of::<PyInt>() {
        let number = value.extract::<i64>();
        let message = || format!("the whole number is too large: {}", within(path));
        return number.map(Value::Integer).map_err(|_| PyValueError::new_err(message()));
    }
    if value.is_instance_of::<PyFloat>() {
        return Ok(Value::Float(value.extract()?));
    }
    if let Ok(text) = value.cast::<PyString>() {
        return Ok(Value::String(text.to_str()?.to_owned()));
    }
    if let Ok(dict) = value.cast::<PyDict>() {
        return Ok(Value::Table(table_at(dict, path, functions, depth)?));
    }
    if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        let items = value.try_iter()?.enumerate();
        let item = |(number, item): (usize, PyResult<Bound<'_, PyAny>>)| {
            value_at(&item?, &format!("{path}.{number}"), functions, depth + 1)
        };
        return Ok(Value::Array(items.map(item).collect::<PyResult<_>>()?));
    }
    if let Ok(cloud) = value.cast::<Cloud>() {
        let name = functions.add_cloud(&cloud.get().cloud);
        let entries = [("kind", "points".to_owned()), ("file", name)];
        let entry = |(key, text): (&str, String)| (key.to_owned(), Value::String(text));
        return Ok(Value::Table(entries.map(entry).into_iter().collect()));
    }
    if value.is_callable() {
        return functions.add(value).map(Value::String);
    }
    // Arrays and numbers of NumPy, and paths.
    for method in ["tolist", "__fspath__"] {
        if value.hasattr(method)? {
            return value_at(&value.call_method0(method)?, path, functions, depth + 1);
        }
    }
    let message = format!(
        "a case has numbers, strings, booleans, lists, dicts, functions, arrays and clouds, not {}: {}",
        kind(value),
        within(path)
    );
    Err(PyTypeError::new_err(message))
}

/// The type of a value.
pub fn kind(value: &Bound<'_, PyAny>) -> String {
    value.get_type().name().map_or_else(|_| "this".to_owned(), |name| format!("`{name}`"))
}

/// Where a value is.
pub fn within(path: &str) -> String {
    if path.is_empty() { "in the case itself".to_owned() } else { format!("in `{path}`") }
}
