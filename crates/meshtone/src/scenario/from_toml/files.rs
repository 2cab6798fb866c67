//! The files that a scenario file may name.

use std::fmt;

use super::super::{Profile, ProfileErrors, ScenarioError};
use crate::toml_reader::TomlValue;

/// Loads the files that a scenario file names, so that the library itself touches no files.
pub trait ScenarioFiles {
    /// The profile errors in a file named by `quality.errors_file`.
    ///
    /// # Arguments
    /// * `name` - as written in the scenario file
    ///
    /// # Errors
    /// What is wrong with the file. Shape and values are checked by
    /// [`Scenario::validate`](crate::scenario::Scenario::validate).
    fn profile_errors(&self, name: &str) -> Result<ProfileErrors, FileProblem>;

    /// The profile in a file named by `operation.speed_profile_hz` or `operation.torque_profile_nm`.
    ///
    /// # Arguments
    /// * `name` - as written in the scenario file
    ///
    /// # Errors
    /// What is wrong with the file. Order of times and values are checked by
    /// [`Scenario::validate`](crate::scenario::Scenario::validate).
    fn profile(&self, name: &str) -> Result<Profile, FileProblem>;
}

/// What is wrong with a file that a scenario names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileProblem {
    /// What is wrong and what is allowed.
    pub problem: String,
    /// What the user can do.
    pub help: String,
}

impl FileProblem {
    /// A problem with its remedy.
    ///
    /// # Arguments
    /// * `problem` - what is wrong and what is allowed
    /// * `help` - what the user can do
    pub fn new(problem: impl Into<String>, help: impl Into<String>) -> Self {
        Self { problem: problem.into(), help: help.into() }
    }
}

impl fmt::Display for FileProblem {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.problem)
    }
}

impl std::error::Error for FileProblem {}

/// For a text that was not read from a file, so that no directory is known to look in.
pub(super) struct NoFiles;

impl ScenarioFiles for NoFiles {
    fn profile_errors(&self, _name: &str) -> Result<ProfileErrors, FileProblem> {
        Err(no_files("pinion_profile_errors_mm and gear_profile_errors_mm"))
    }

    fn profile(&self, _name: &str) -> Result<Profile, FileProblem> {
        Err(no_files("{ time_s = […], value = […] }"))
    }
}

fn no_files(inline: &str) -> FileProblem {
    FileProblem::new(
        "names a file, but the scenario was given as text alone, without a directory to look in",
        format!("read the scenario from its file, or write the values here as {inline}"),
    )
}

/// The content of the file that a value names, or its problem at the value's line.
pub(super) fn load<T>(
    value: &TomlValue<'_>,
    load: impl FnOnce(&str) -> Result<T, FileProblem>,
) -> Result<T, ScenarioError> {
    load(value.string()?).map_err(|problem| value.error(problem.problem).with_help(problem.help))
}
