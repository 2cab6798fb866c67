//! Scenario files, with the files that they name.

mod kind;
mod number_csv;
mod profile_errors_npz;
mod source;

use std::cell::RefCell;
use std::io;
use std::path::{Path, PathBuf};

use meshtone::scenario::{
    FileProblem, FrequencyResponse, Profile, ProfileErrors, ScenarioFiles, WheelDeviations,
};
use meshtone_toml::TomlError;

pub use kind::FileKind;
pub use profile_errors_npz::write_wheels_npz;
pub use source::{ScenarioFile, read_text};

use number_csv::{FREQUENCY_RESPONSE, PROFILE};

/// A scenario file that could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadScenarioError {
    /// The file itself cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// The scenario file.
        path: PathBuf,
        /// Why it cannot be read.
        source: io::Error,
    },
    /// The file holds something else than text.
    #[error("{}: line {line}: is not UTF-8 text: the byte 0x{byte:02x} belongs to no character", path.display())]
    NotText {
        /// The scenario file.
        path: PathBuf,
        /// 1-based line of the first byte that is wrong.
        line: usize,
        /// That byte.
        byte: u8,
    },
    /// What it says is wrong, or what a file that it names says.
    #[error("{}: {error}", path.display())]
    Invalid {
        /// The scenario file.
        path: PathBuf,
        /// Its text, to show the line.
        text: String,
        /// What is wrong, with key and line.
        error: Box<TomlError>,
    },
}

/// The files that a scenario names, relative to a directory.
#[derive(Debug, Clone)]
pub struct FilesBeside {
    directory: PathBuf,
    /// The files that the scenario named, in the order of reading.
    named: RefCell<Vec<PathBuf>>,
}

impl FilesBeside {
    /// Files relative to a directory.
    ///
    /// # Arguments
    /// * `directory` - where relative names start
    pub fn new(directory: impl Into<PathBuf>) -> Self {
        Self { directory: directory.into(), named: RefCell::default() }
    }

    /// Where the file of a name is, which is kept among the named ones.
    fn path_of(&self, name: &str) -> PathBuf {
        let path = self.directory.join(name);
        let mut named = self.named.borrow_mut();
        if !named.contains(&path) {
            named.push(path.clone());
        }
        path
    }
}

impl ScenarioFiles for FilesBeside {
    fn profile_errors(&self, name: &str) -> Result<ProfileErrors, FileProblem> {
        profile_errors_npz::read(&self.path_of(name))
    }

    fn wheel_deviations(&self, name: &str) -> Result<[WheelDeviations; 2], FileProblem> {
        profile_errors_npz::read_deviations(&self.path_of(name))
    }

    fn profile(&self, name: &str) -> Result<Profile, FileProblem> {
        let [time_s, value] = PROFILE.read(&self.path_of(name))?;
        Ok(Profile { time_s, value })
    }

    fn frequency_response(&self, name: &str) -> Result<FrequencyResponse, FileProblem> {
        let [frequency_hz, magnitude, phase_deg] = FREQUENCY_RESPONSE.read(&self.path_of(name))?;
        Ok(FrequencyResponse { frequency_hz, magnitude, phase_deg })
    }
}

/// A file that cannot be opened or read.
fn unreadable(path: &Path, error: &io::Error) -> FileProblem {
    let shown = path.display();
    match error.kind() {
        io::ErrorKind::NotFound => FileProblem::new(
            format!("there is no file {shown}"),
            "check the name; it is relative to the scenario file's directory",
        ),
        io::ErrorKind::InvalidInput | io::ErrorKind::FileTooLarge => FileProblem::new(
            format!("cannot read {shown}: {error}"),
            "name an ordinary file of moderate size",
        ),
        _ => FileProblem::new(format!("cannot read {shown}: {error}"), "check the file and its permissions"),
    }
}
