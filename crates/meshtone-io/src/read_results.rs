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
    /// The scenario in the file is refused, perhaps because another version wrote it.
    #[error("{}: the scenario in {SCENARIO_KEY} is refused: {error}", path.display())]
    Scenario {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        error: Box<ScenarioError>,
    },
}

impl ReadResultsError {
    pub(crate) fn unreadable(path: &Path, source: io::Error) -> Self {
        Self::Unreadable { path: path.to_path_buf(), source }
    }

    pub(crate) fn foreign(path: &Path, problem: String) -> Self {
        Self::Foreign { path: path.to_path_buf(), problem }
    }
}
