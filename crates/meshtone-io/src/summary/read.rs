//! Reading what tells a summary's run.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::run_identity::RunIdentity;

/// A summary that could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadSummaryError {
    /// The file cannot be opened or read.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why it cannot be read.
        source: io::Error,
    },
    /// The file holds something else than a summary.
    #[error("{}: {problem}", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
        /// What is not as `meshtone simulate` writes it.
        problem: String,
    },
}

/// The identity of the run that a summary is of.
///
/// # Arguments
/// * `path` - what [`Summary::write_json`](super::Summary::write_json) wrote
///
/// # Errors
/// The file cannot be read, or it is no summary.
///
/// ```
/// use meshtone_io::summary::read_run;
///
/// let directory = tempfile::tempdir()?;
/// let path = directory.path().join("summary.json");
/// std::fs::write(&path, r#"{ "run": "00000000000000ff" }"#)?;
/// assert_eq!(read_run(&path)?.number(), 255);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_run(path: &Path) -> Result<RunIdentity, ReadSummaryError> {
    let text =
        fs::read(path).map_err(|source| ReadSummaryError::Unreadable { path: path.to_path_buf(), source })?;
    let foreign = |problem: String| ReadSummaryError::Foreign { path: path.to_path_buf(), problem };
    let summary: Value =
        serde_json::from_slice(&text).map_err(|error| foreign(format!("is not whole JSON: {error}")))?;
    let run = summary.get("run").and_then(Value::as_str);
    let run =
        run.ok_or_else(|| foreign("has no `run`, so `meshtone simulate` did not write it".to_string()))?;
    run.parse().map_err(|error| foreign(format!("run: {error}")))
}
