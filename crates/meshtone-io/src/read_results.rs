//! Results of a simulation that could not be read back.

use std::io;
use std::path::{Path, PathBuf};

use meshtone::scenario::ScenarioError;

use crate::signals::SCENARIO_KEY;

/// Signals or a summary that could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadResultsError {
    /// The file cannot be opened or read.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why it cannot be read.
        source: io::Error,
    },
    /// The file holds something else than such results.
    #[error("{}: {problem}", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
        /// What is not as `meshtone simulate` writes it.
        problem: String,
    },
}

impl ReadResultsError {
    pub(crate) fn unreadable(path: &Path, source: io::Error) -> Self {
        Self::Unreadable { path: path.to_path_buf(), source }
    }

    /// An error about what a file holds.
    ///
    /// # Arguments
    /// * `path` - the file
    /// * `problem` - what is not as `meshtone simulate` writes it
    pub fn foreign(path: &Path, problem: String) -> Self {
        Self::Foreign { path: path.to_path_buf(), problem }
    }

    /// An error about the scenario in a file, which is refused, perhaps because another version wrote it.
    ///
    /// # Arguments
    /// * `path` - the file
    /// * `error` - what is wrong with the scenario
    pub fn scenario(path: &Path, error: &ScenarioError) -> Self {
        Self::foreign(path, format!("the scenario in {SCENARIO_KEY} is refused: {error}"))
    }
}
