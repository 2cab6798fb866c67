//! Files that a scenario file names.

use crate::error_table::ErrorTable;
use std::fmt;

use meshtone_toml::{ReadResult, TomlValue};

/// A problem of a file that a scenario names.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct FileProblem {
    /// The problem, and what is allowed.
    pub problem: String,
    /// Advice to the user.
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

/// Loads the numbers in files that a scenario file names.
pub(crate) trait NumberFiles {
    /// Times and the values at them.
    fn times_and_values(&self, name: &str) -> Result<[Vec<f64>; 2], FileProblem>;

    /// Frequencies, and magnitude and phase in degrees at them.
    fn frequencies_magnitudes_phases(&self, name: &str) -> Result<[Vec<f64>; 3], FileProblem>;

    /// A matrix of the pinion and one of the gear.
    fn matrices(&self, name: &str) -> Result<[ErrorTable; 2], FileProblem>;

    /// Further numbers of a file of matrices, by their keys.
    fn named_numbers(&self, name: &str) -> Result<Vec<(&'static str, Vec<f64>)>, FileProblem>;
}

/// For a text that was not read from a file, so that no directory is known to look in.
pub(crate) struct NoFiles;

impl NumberFiles for NoFiles {
    fn times_and_values(&self, _name: &str) -> Result<[Vec<f64>; 2], FileProblem> {
        Err(no_files("{ time_s = […], value = […] }"))
    }

    fn frequencies_magnitudes_phases(&self, _name: &str) -> Result<[Vec<f64>; 3], FileProblem> {
        Err(no_files("{ frequency_hz = […], magnitude = […], phase_deg = […] }"))
    }

    fn matrices(&self, _name: &str) -> Result<[ErrorTable; 2], FileProblem> {
        Err(no_files("pinion_profile_errors_mm and gear_profile_errors_mm"))
    }

    fn named_numbers(&self, _name: &str) -> Result<Vec<(&'static str, Vec<f64>)>, FileProblem> {
        Ok(Vec::new())
    }
}

fn no_files(inline: &str) -> FileProblem {
    FileProblem::new(
        "names a file, but the scenario was given as text alone, without a directory to look in",
        format!("read the scenario from its file, or write the values here as {inline}"),
    )
}

/// The content of the file that a value names, or its problem at the value's line.
pub(crate) fn load<T>(
    value: &TomlValue<'_>,
    load: impl FnOnce(&str) -> Result<T, FileProblem>,
) -> ReadResult<T> {
    load(value.string()?).map_err(|problem| value.error(problem.problem).with_help(problem.help))
}
