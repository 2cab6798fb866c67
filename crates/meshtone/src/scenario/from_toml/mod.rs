//! A scenario from TOML.

mod fault;
mod files;
mod gears;
mod operation;
mod quality;
mod rig;
mod solver;

pub use files::{FileProblem, ScenarioFiles};

use self::files::NoFiles;
use super::{Convention, MemoryLimit, Scenario, ScenarioError};
use crate::toml_reader::{ReadResult, TomlDocument, TomlTable};

const CONVENTIONS: [(&str, Convention); 2] =
    [("corrected", Convention::Corrected), ("published", Convention::Published)];

impl Convention {
    /// The name in the scenario file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Corrected => "corrected",
            Self::Published => "published",
        }
    }
}

impl Scenario {
    /// Reads and validates a scenario that names no other file.
    ///
    /// # Arguments
    /// * `text` - the scenario file's text
    ///
    /// # Errors
    /// The first thing that is wrong: text that is not TOML, an unknown or missing key, a value of
    /// the wrong type, and whatever [`Scenario::validate`] refuses, each with its line. A key that
    /// names a file is refused too: see [`Scenario::from_toml_with_files`].
    ///
    /// ```
    /// use meshtone::scenario::Scenario;
    ///
    /// let scenario = Scenario::from_toml(
    ///     r#"
    ///     [gears]
    ///     module_mm = 3.0
    ///     pinion_teeth = 17
    ///     gear_teeth = 38
    ///     face_width_mm = 15.0
    ///     [operation]
    ///     pinion_speed_hz = 40.0
    ///     brake_torque_nm = 10.0
    ///     "#,
    /// )?;
    /// assert_eq!(scenario, Scenario::new(3.0, 17, 38, 15.0, 40.0, 10.0));
    /// # Ok::<(), meshtone::scenario::ScenarioError>(())
    /// ```
    pub fn from_toml(text: &str) -> Result<Self, ScenarioError> {
        Self::from_toml_with_files(text, &NoFiles)
    }

    /// Reads and validates a scenario that may name other files, whose content becomes part of it.
    ///
    /// # Arguments
    /// * `text` - the scenario file's text
    /// * `files` - loads the files that the text names
    ///
    /// # Errors
    /// As [`Scenario::from_toml`], and what `files` reports, at the line that names the file.
    pub fn from_toml_with_files(text: &str, files: &dyn ScenarioFiles) -> Result<Self, ScenarioError> {
        Self::from_toml_within(text, files, MemoryLimit::default())
    }

    /// As [`Scenario::from_toml_with_files`], with another limit of memory.
    ///
    /// # Arguments
    /// * `text` - the scenario file's text
    /// * `files` - loads the files that the text names
    /// * `limit` - most that [`Scenario::memory_estimate_bytes`] may be
    ///
    /// # Errors
    /// As [`Scenario::from_toml_with_files`].
    pub fn from_toml_within(
        text: &str,
        files: &dyn ScenarioFiles,
        limit: MemoryLimit,
    ) -> Result<Self, ScenarioError> {
        let document = TomlDocument::parse(text)?;
        let scenario = document.root().read(|root| Self::from_table(root, files))?;
        match scenario.validate_within(limit) {
            Ok(_) => Ok(scenario),
            Err(error) => Err(document.locate(quality::in_its_file(&document, error))),
        }
    }

    /// Reads a scenario that is a table of another file, without validating it.
    ///
    /// # Arguments
    /// * `table` - with the sections of a scenario file
    /// * `files` - loads the files that it names
    ///
    /// # Errors
    /// An unknown or missing key, a value of the wrong type, what `files` reports.
    pub fn from_table(table: &TomlTable<'_>, files: &dyn ScenarioFiles) -> ReadResult<Self> {
        read_scenario(table, files)
    }
}

/// The 1-based line of a key in a scenario file, for an error that is found after reading.
///
/// # Arguments
/// * `text` - the scenario file's text
/// * `key` - dotted key, as in [`ScenarioError::key`]
///
/// # Returns
/// Where the text leaves the key at its default, the line of the nearest table around it; none
/// where it has neither, or is not TOML.
///
/// ```
/// use meshtone::scenario::line_of_key;
///
/// let text = "seed = 1\n[gears]\nmodule_mm = 3.0\n";
/// assert_eq!(line_of_key(text, "gears.module_mm"), Some(3));
/// assert_eq!(line_of_key(text, "gears.crowning_mm"), Some(2));
/// assert_eq!(line_of_key(text, "solver.settle_fraction"), None);
/// ```
pub fn line_of_key(text: &str, key: &str) -> Option<usize> {
    TomlDocument::parse(text).ok()?.line_of_key(key)
}

fn read_scenario(root: &TomlTable<'_>, files: &dyn ScenarioFiles) -> ReadResult<Scenario> {
    let convention = root.optional("convention").map(|value| value.choice(&CONVENTIONS)).transpose()?;
    let seed = root.optional("seed").map(|value| value.integer(0..=u64::MAX)).transpose()?;
    Ok(Scenario {
        convention: convention.unwrap_or_default(),
        seed: seed.unwrap_or(1),
        gears: root.table_or_empty("gears")?.read(gears::read)?,
        operation: root.table_or_empty("operation")?.read(|table| operation::read(table, files))?,
        quality: root.table_or_empty("quality")?.read(|table| quality::read(table, files))?,
        fault: fault::read_optional(root)?,
        rig: root.table_or_empty("rig")?.read(rig::read)?,
        solver: root.table_or_empty("solver")?.read(solver::read)?,
    })
}
