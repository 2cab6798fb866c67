//! The library's errors as Python's, with the same text.

use std::fmt::Display;
use std::io;
use std::path::Path;

use meshtone::scenario::ScenarioError;
use meshtone_io::printable::printable;
use meshtone_io::scenario_file::ReadScenarioError;
use pyo3::PyErr;
use pyo3::exceptions::{PyFileNotFoundError, PyOSError, PyValueError};

/// `errno.ENOENT`.
const NOT_FOUND: i32 = 2;

/// Bad input.
pub fn value_error(error: impl Display) -> PyErr {
    PyValueError::new_err(printable(error, &['\n']))
}

/// Bad input: the problem, and below it what to do about it.
pub fn with_help(error: impl Display, help: Option<&str>) -> PyErr {
    match help {
        Some(help) => value_error(format!("{error}\n{help}")),
        None => value_error(error),
    }
}

/// A scenario that cannot be simulated.
pub fn scenario_error(error: &ScenarioError) -> PyErr {
    with_help(error, error.help.as_deref())
}

/// A scenario that gave no simulation, with the same words.
pub fn simulation_error(error: &meshtone::Error) -> PyErr {
    with_help(error, error.help())
}

/// A scenario, plan or experiment file that could not be read: the problem, and below it what to do about it.
pub fn read_error(path: &Path, error: &ReadScenarioError) -> PyErr {
    match error {
        ReadScenarioError::Invalid { error: invalid, .. } => with_help(error, invalid.help.as_deref()),
        ReadScenarioError::Unreadable { source, .. } => file_error(path, Some(source), error),
        _ => file_error(path, None, error),
    }
}

/// A file that could not be read: what the system refused, or bad content.
///
/// # Arguments
/// * `path` - the file
/// * `source` - why it could not be opened or read, if that is what is wrong
/// * `error` - the same in words
pub fn file_error(path: &Path, source: Option<&io::Error>, error: impl Display) -> PyErr {
    let name = || path.to_string_lossy().into_owned();
    match source.filter(|source| source.raw_os_error().is_some()) {
        Some(source) => os_error("read", name(), source),
        None if path.exists() => value_error(error),
        None => PyFileNotFoundError::new_err((NOT_FOUND, "No such file or directory", name())),
    }
}

/// An error of the system, as the subclass of `OSError` that Python has for it, with `errno` and `filename`.
///
/// # Arguments
/// * `doing` - what could not be done: `read` or `write`
/// * `name` - to which file
/// * `source` - why
pub fn os_error(doing: &str, name: String, source: &io::Error) -> PyErr {
    match source.raw_os_error() {
        Some(number) => {
            let reason = source.to_string();
            // Python names the number by itself.
            let words = reason.strip_suffix(&format!(" (os error {number})")).unwrap_or(&reason);
            PyOSError::new_err((number, format!("cannot {doing}: {words}"), name))
        }
        None => PyOSError::new_err(printable(format_args!("cannot {doing} {name}: {source}"), &[])),
    }
}
