//! Arrays from and for NumPy.

use meshtone::TraceField;
use numpy::{IntoPyArray, PyArray1, PyArrayMethods, PyReadonlyArray1};
use pyo3::prelude::*;

use crate::error::value_error;

/// A signal that Python gives.
pub type Signal<'py> = PyReadonlyArray1<'py, f64>;

/// The samples of a signal, where they lie side by side.
pub fn samples<'a>(signal: &'a Signal<'_>) -> PyResult<&'a [f64]> {
    signal.as_slice().map_err(value_error)
}

/// A NumPy array that takes the vector's memory over.
pub fn array<T: numpy::Element>(py: Python<'_>, values: Vec<T>) -> Bound<'_, PyArray1<T>> {
    values.into_pyarray(py)
}

/// A field of a trace: a number, or an array of its shape.
pub fn field(py: Python<'_>, field: TraceField) -> PyResult<Bound<'_, PyAny>> {
    match (field.shape.as_slice(), field.values.first()) {
        ([], Some(number)) => Ok(number.into_pyobject(py)?.into_any()),
        ([rows, columns], _) => {
            Ok(array(py, field.values).reshape([*rows, *columns]).map_err(value_error)?.into_any())
        }
        _ => Ok(array(py, field.values).into_any()),
    }
}
