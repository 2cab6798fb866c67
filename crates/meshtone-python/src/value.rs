//! Python's values as TOML, and back.

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

/// A table as a dictionary.
pub fn dictionary<'py>(py: Python<'py>, table: &Table) -> PyResult<Bound<'py, PyDict>> {
    let dictionary = PyDict::new(py);
    for (key, value) in table {
        dictionary.set_item(key, python_value(py, value)?)?;
    }
    Ok(dictionary)
}

fn python_value<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Value::String(text) => PyString::new(py, text).into_any(),
        Value::Integer(number) => number.into_pyobject(py)?.into_any(),
        Value::Float(number) => PyFloat::new(py, *number).into_any(),
        Value::Boolean(flag) => PyBool::new(py, *flag).to_owned().into_any(),
        Value::Datetime(date) => PyString::new(py, &date.to_string()).into_any(),
        Value::Array(items) => {
            let list = PyList::empty(py);
            for item in items {
                list.append(python_value(py, item)?)?;
            }
            list.into_any()
        }
        Value::Table(inner) => dictionary(py, inner)?.into_any(),
    })
}
