//! The library's errors as Python's, with the same text.

use std::fmt::Display;
use std::io;
use std::path::Path;

use meshtone::scenario::ScenarioError;
use meshtone_io::scenario_file::ReadScenarioError;
use pyo3::PyErr;
use pyo3::exceptions::{PyFileNotFoundError, PyOSError, PyValueError};

/// `errno.ENOENT`.
const NOT_FOUND: i32 = 2;

/// Bad input.
pub fn value_error(error: impl Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// A scenario that cannot be simulated: the problem, and below it what to do about it.
pub fn scenario_error(error: &ScenarioError) -> PyErr {
    match &error.help {
        Some(help) => PyValueError::new_err(format!("{error}\n{help}")),
        None => value_error(error),
    }
}

/// A scenario that gave no simulation, with the same words.
pub fn simulation_error(error: &meshtone::Error) -> PyErr {
    match error.help() {
        Some(help) => PyValueError::new_err(format!("{error}\n{help}")),
        None => value_error(error),
    }
}

/// A scenario, plan or experiment file that could not be read: the problem, and below it what to do about it.
pub fn read_error(path: &Path, error: &ReadScenarioError) -> PyErr {
    match error {
        ReadScenarioError::Invalid { error: invalid, .. } => match &invalid.help {
            Some(help) => PyValueError::new_err(format!("{error}\n{help}")),
            None => value_error(error),
        },
        _ => file_error(path, error),
    }
}

/// A file that could not be read: absent, or with bad content.
pub fn file_error(path: &Path, error: impl Display) -> PyErr {
    if path.exists() {
        return value_error(error);
    }
    PyFileNotFoundError::new_err((
        NOT_FOUND,
        "No such file or directory",
        path.to_string_lossy().into_owned(),
    ))
}

/// What the system refused, as the subclass of `OSError` that Python has for it, with `errno` and `filename`.
///
/// # Arguments
/// * `doing` - what could not be done: `read` or `write`
/// * `name` - to which file
/// * `source` - why
pub fn os_error(doing: &str, name: String, source: &io::Error) -> PyErr {
    match source.raw_os_error() {
        Some(number) => PyOSError::new_err((number, format!("cannot {doing}: {source}"), name)),
        None => PyOSError::new_err(format!("cannot {doing} {name}: {source}")),
    }
}
