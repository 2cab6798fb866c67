//! SciPy's results, for the tests that compare with them, and the Python that reads data sets in the tests.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::environment::environment;
use crate::step;

/// Folder of the script and of what it needs, from the workspace's root.
const FOLDER: &str = "crates/meshtone/tests/scipy";

/// Makes a virtual environment with SciPy under `target`, once, and lets it write its results there.
///
/// Returns the file of the results, and the environment's interpreter, which also reads data sets in the tests.
///
/// # Arguments
/// * `root` - folder of the workspace
///
/// # Errors
/// The exit code of what failed: there is no Python, or the packages cannot be installed.
pub fn reference(root: &Path) -> Result<[PathBuf; 2], u8> {
    let folder = root.join("target").join("scipy");
    let results = folder.join("reference.npz");
    let mut python = PathBuf::new();
    step::run("SciPy's results", || {
        python = environment(&folder, &root.join(FOLDER).join("requirements.txt"))?;
        let script = root.join(FOLDER).join("reference.py");
        step::program(Command::new(&python).arg(script).arg(&results))
    })?;
    Ok([results, python])
}
