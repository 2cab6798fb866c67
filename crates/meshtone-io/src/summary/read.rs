//! Reading what tells a summary's run.

use std::path::Path;

use serde_json::Value;

use crate::ReadResultsError;
use crate::input_file::read_document;
use crate::run_identity::RunIdentity;

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
pub fn read_run(path: &Path) -> Result<RunIdentity, ReadResultsError> {
    let text = read_document(path).map_err(|source| ReadResultsError::unreadable(path, source))?;
    let foreign = |problem: String| ReadResultsError::foreign(path, problem);
    let summary: Value =
        serde_json::from_slice(&text).map_err(|error| foreign(format!("is not whole JSON: {error}")))?;
    let run = summary.get("run").and_then(Value::as_str);
    let run =
        run.ok_or_else(|| foreign("has no `run`, so `meshtone simulate` did not write it".to_string()))?;
    run.parse().map_err(|error| foreign(format!("run: {error}")))
}
