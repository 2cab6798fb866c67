//! A scenario file with its text, for errors that are found after reading.

use std::path::{Path, PathBuf};

use meshtone::scenario::{Scenario, ScenarioError};
use meshtone_toml::TomlDocument;

use super::{FileKind, FilesBeside, ReadScenarioError};
use crate::input_file::read_document;
use crate::memory;

/// A scenario file that has been read.
#[derive(Debug, Clone, PartialEq)]
pub struct ScenarioFile {
    /// Where it was read from.
    pub path: PathBuf,
    /// Its text.
    pub text: String,
    /// What it says.
    pub scenario: Scenario,
    /// The files that it names.
    pub named_files: Vec<PathBuf>,
}

impl ScenarioFile {
    /// Reads and validates a scenario file, and the files that it names, within the [limit](memory::limit) of memory.
    ///
    /// # Arguments
    /// * `path` - the scenario file; names of other files in it are relative to its directory
    ///
    /// # Errors
    /// The file cannot be read or is not UTF-8 text, or [`Scenario::from_toml_with_files`] refuses it.
    ///
    /// ```
    /// use meshtone::scenario::template;
    /// use meshtone_io::scenario_file::ScenarioFile;
    ///
    /// let directory = tempfile::tempdir()?;
    /// let path = directory.path().join("healthy.toml");
    /// std::fs::write(&path, template("healthy").unwrap())?;
    /// assert_eq!(ScenarioFile::read(&path)?.scenario.wheels[0].teeth, 17);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn read(path: &Path) -> Result<Self, ReadScenarioError> {
        Self::read_checked(path, |_| Ok(()))
    }

    /// Does what [`Self::read`] does, where one pair is expected.
    ///
    /// # Arguments
    /// * `path` - the scenario file
    ///
    /// # Errors
    /// Those of [`Self::read`]; a gearbox.
    pub fn read_pair(path: &Path) -> Result<Self, ReadScenarioError> {
        Self::read_checked(path, |scenario| scenario.expect_pair().map(drop))
    }

    fn read_checked(
        path: &Path,
        check: fn(&Scenario) -> Result<(), ScenarioError>,
    ) -> Result<Self, ReadScenarioError> {
        let text = read_text(path)?;
        let files = FilesBeside::new(path.parent().unwrap_or(Path::new("")));
        let path = path.to_path_buf();
        let read = Scenario::from_toml_within(&text, &files, memory::limit());
        match read.and_then(|scenario| check(&scenario).map(|()| scenario)) {
            Ok(scenario) => Ok(Self { path, text, scenario, named_files: files.named.into_inner() }),
            Err(error) => Err(ReadScenarioError::invalid(FileKind::Scenario, path, text, error)),
        }
    }

    /// Replaces what the file says, and keeps its path, its text and the files that it names.
    ///
    /// # Arguments
    /// * `scenario` - what it says instead
    pub fn with(self, scenario: Scenario) -> Self {
        Self { scenario, ..self }
    }

    /// The scenario file and the files that it names.
    pub fn sources(&self) -> impl Iterator<Item = &Path> {
        std::iter::once(&self.path).chain(&self.named_files).map(PathBuf::as_path)
    }

    /// An error that was found after reading, with the key's line and its value as written.
    ///
    /// # Arguments
    /// * `error` - about a key of the file
    pub fn refuse(&self, error: ScenarioError) -> ReadScenarioError {
        let error = match TomlDocument::parse(&self.text) {
            Ok(document) => document.locate(error),
            Err(_) => error,
        };
        let (path, text) = (self.path.clone(), self.text.clone());
        ReadScenarioError::Invalid { path, text, error: Box::new(error) }
    }
}

/// Some editors start a text with a mark that it is UTF-8.
const BYTE_ORDER_MARK: char = '\u{feff}';

/// Reads the text of a file that a user wrote.
///
/// # Arguments
/// * `path` - the file
///
/// # Errors
/// It cannot be read, or is not UTF-8 text.
pub fn read_text(path: &Path) -> Result<String, ReadScenarioError> {
    let path_buf = || path.to_path_buf();
    let bytes =
        read_document(path).map_err(|source| ReadScenarioError::Unreadable { path: path_buf(), source })?;
    let text = String::from_utf8(bytes).map_err(|error| {
        let (bytes, start) = (error.as_bytes(), error.utf8_error().valid_up_to());
        let line = 1 + bytes[..start].iter().filter(|&&byte| byte == b'\n').count();
        ReadScenarioError::NotText { path: path_buf(), line, byte: bytes[start] }
    })?;
    Ok(text.strip_prefix(BYTE_ORDER_MARK).map(str::to_string).unwrap_or(text))
}
