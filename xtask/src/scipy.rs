//! SciPy's results, for the tests that compare with them.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::step::StepRunner;

/// The script that computes them, from the workspace's root.
const SCRIPT: &str = "crates/meshtone/tests/scipy/reference.py";

/// Lets SciPy write its results under `target`; returns their file.
///
/// # Arguments
/// * `python` - an interpreter with SciPy
///
/// # Errors
/// The script's exit code.
pub fn reference(row: &StepRunner, python: &Path) -> Result<PathBuf, u8> {
    let results = row.root().join("target").join("python").join("scipy_reference.npz");
    row.step("SciPy's results", || {
        row.program(Command::new(python).arg(row.root().join(SCRIPT)).arg(&results))
    })?;
    Ok(results)
}
