//! The limit of memory.

use meshtone::scenario::MemoryLimit;
use pyo3::prelude::*;

use crate::error::value_error;

/// Sets the limit for everything that is read and simulated from then on.
#[pyfunction]
#[pyo3(signature = (limit_bytes))]
pub fn set_memory_limit(limit_bytes: Option<u64>) -> PyResult<()> {
    if limit_bytes == Some(0) {
        return Err(value_error("limit_bytes = 0: must be above 0, or None for the default"));
    }
    MemoryLimit::set(limit_bytes);
    Ok(())
}
