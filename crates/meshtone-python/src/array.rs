//! Arrays from and for NumPy.

use meshtone::TraceField;
use meshtone::sensor::Channels;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};

use crate::error::value_error;

/// A signal that Python gives.
pub type Signal<'py> = PyReadonlyArray1<'py, f64>;

/// A signal for Python.
pub type Array<'py> = Bound<'py, PyArray1<f64>>;

/// The samples of a signal, where they lie side by side.
pub fn samples<'a>(signal: &'a Signal<'_>) -> PyResult<&'a [f64]> {
    signal.as_slice().map_err(value_error)
}

/// A NumPy array that takes the vector's memory over.
pub fn array<T: numpy::Element>(py: Python<'_>, values: Vec<T>) -> Bound<'_, PyArray1<T>> {
    values.into_pyarray(py)
}

/// A NumPy array of rows, one after the other.
pub fn matrix<'py>(
    py: Python<'py>,
    values: Vec<f64>,
    shape: [usize; 2],
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    array(py, values).reshape(shape).map_err(value_error)
}

/// A simulation's signals by their names, in their order.
pub fn named_arrays(py: Python<'_>, channels: Channels) -> PyResult<Py<PyDict>> {
    let named = channels.signals.into_iter().map(|signal| (signal.name, array(py, signal.values)));
    Ok(named.collect::<Vec<_>>().into_py_dict(py)?.unbind())
}

/// A field of a trace: a number, or an array of its shape.
pub fn field(py: Python<'_>, field: TraceField) -> PyResult<Bound<'_, PyAny>> {
    match (field.shape.as_slice(), field.values.first()) {
        ([], Some(number)) => Ok(number.into_pyobject(py)?.into_any()),
        ([rows, columns], _) => Ok(matrix(py, field.values, [*rows, *columns])?.into_any()),
        _ => Ok(array(py, field.values).into_any()),
    }
}
