//! Python's values as TOML.

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use toml::{Table, Value};

/// A dictionary as a table.
///
/// # Errors
/// A key that is no string; a value that TOML has nothing for.
pub fn table(dictionary: &Bound<'_, PyDict>) -> PyResult<Table> {
    dictionary.iter().map(|(key, value)| Ok((key.extract::<String>()?, toml_value(&value)?))).collect()
}

fn toml_value(value: &Bound<'_, PyAny>) -> PyResult<Value> {
    if let Ok(dictionary) = value.cast::<PyDict>() {
        return Ok(Value::Table(table(dictionary)?));
    }
    if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        let items = value.try_iter()?.map(|item| toml_value(&item?)).collect::<PyResult<_>>()?;
        return Ok(Value::Array(items));
    }
    if value.is_instance_of::<PyBool>() {
        return Ok(Value::Boolean(value.extract()?));
    }
    if value.is_instance_of::<PyInt>() {
        return Ok(Value::Integer(value.extract()?));
    }
    if value.is_instance_of::<PyFloat>() {
        return Ok(Value::Float(value.extract()?));
    }
    if value.is_instance_of::<PyString>() {
        return Ok(Value::String(value.extract()?));
    }
    let kind = value.get_type().name()?;
    Err(PyTypeError::new_err(format!("{value} is a {kind}: give a number, a string, a list or a dictionary")))
}
