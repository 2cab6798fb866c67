//! The limit of memory.

use meshtone::scenario::MemoryLimit;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Sets the limit for everything that is read and simulated from then on.
#[pyfunction]
#[pyo3(signature = (limit_bytes))]
pub fn set_memory_limit(limit_bytes: Option<u64>) -> PyResult<()> {
    if limit_bytes == Some(0) {
        return Err(PyValueError::new_err("limit_bytes = 0: must be above 0, or None for the default"));
    }
    MemoryLimit::set(limit_bytes);
    Ok(())
}
