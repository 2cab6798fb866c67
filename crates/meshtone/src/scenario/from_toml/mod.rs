//! A scenario from TOML.

mod files;

use meshtone_toml::{ReadResult, TomlDocument, TomlTable};

pub use self::files::ScenarioFiles;

pub(super) use self::files::Numbers;
use super::{MemoryLimit, Scenario, ScenarioError, long, short};
use crate::keys::{NoFiles, NumberFiles};
use crate::wheel::WheelDeviations;

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
    /// use meshtone::scenario::{GearPair, Scenario};
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
    /// assert_eq!(scenario, Scenario::new(GearPair::example()));
    /// # Ok::<(), meshtone::scenario::ScenarioError>(())
    /// ```
    pub fn from_toml(text: &str) -> Result<Self, ScenarioError> {
        read_and_validate(text, &NoFiles, MemoryLimit::default())
    }

    /// Reads and validates a scenario that may name other files, whose content becomes part of it.
    ///
    /// # Arguments
    /// * `text` - the scenario file's text
    /// * `files` - loads the files that the text names
    ///
    /// # Errors
    /// Those of [`Scenario::from_toml`], and what `files` reports, at the line that names the file.
    pub fn from_toml_with_files(text: &str, files: &dyn ScenarioFiles) -> Result<Self, ScenarioError> {
        Self::from_toml_within(text, files, MemoryLimit::default())
    }

    /// Does what [`Scenario::from_toml_with_files`] does, with another limit of memory.
    ///
    /// # Arguments
    /// * `text` - the scenario file's text
    /// * `files` - loads the files that the text names
    /// * `limit` - most that [`Scenario::memory_estimate_bytes`] may be
    ///
    /// # Errors
    /// Those of [`Scenario::from_toml_with_files`].
    pub fn from_toml_within(
        text: &str,
        files: &dyn ScenarioFiles,
        limit: MemoryLimit,
    ) -> Result<Self, ScenarioError> {
        read_and_validate(text, &Numbers(files), limit)
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
        read(table, &Numbers(files))
    }
}

/// The 1-based line of a key in a scenario file, for an error that is found after reading.
///
/// # Arguments
/// * `text` - the scenario file's text
/// * `key` - dotted key, as in [`ScenarioError::key`]
///
/// # Returns
/// Line of the key; where the text leaves it at its default, the line of the nearest table around it; none
/// where it has neither, or is not TOML.
///
/// ```
/// use meshtone::scenario::line_of_key;
///
/// let text = "seed = 1\n[gears]\nmodule_mm = 3.0\n";
/// assert_eq!(line_of_key(text, "gears.module_mm"), Some(3));
/// assert_eq!(line_of_key(text, "gears.uniform_flank_reduction_mm"), Some(2));
/// assert_eq!(line_of_key(text, "solver.settle_fraction"), None);
/// ```
pub fn line_of_key(text: &str, key: &str) -> Option<usize> {
    TomlDocument::parse(text).ok()?.line_of_key(key)
}

fn read_and_validate(
    text: &str,
    files: &dyn NumberFiles,
    limit: MemoryLimit,
) -> Result<Scenario, ScenarioError> {
    let document = TomlDocument::parse(text)?;
    let scenario = document.root().read(|root| read(root, files)).map_err(|error| document.locate(error))?;
    scenario.validate_within(limit).map(|_| scenario).map_err(|error| located(&document, error))
}

/// Reads the form that a table has the sections of.
fn read(root: &TomlTable<'_>, files: &dyn NumberFiles) -> ReadResult<Scenario> {
    if long::is_written_in(root)? { long::read(root, files) } else { short::read(root, files) }
}

/// An error with its line. One about deviations that came from a file is about the key that names the file, in `quality` or in `wheel[n]`.
pub(super) fn located(document: &TomlDocument<'_>, mut error: ScenarioError) -> ScenarioError {
    let (section, entry) = error.key.split_once('.').unwrap_or_default();
    let key = entry.split('[').next().unwrap_or_default();
    let mut of_file = WheelDeviations::keys().chain(["pinion_profile_errors_mm", "gear_profile_errors_mm"]);
    let is_written = |key: &str| document.value_as_written(&format!("{section}.{key}")).is_some();
    // A wheel's keys lack the name of the pinion or the gear.
    if of_file.any(|of_wheel| of_wheel.ends_with(key)) && is_written("errors_file") && !is_written(key) {
        error.problem = format!("{entry}: {}", error.problem);
        error.key = format!("{section}.errors_file");
    }
    document.locate(error)
}
