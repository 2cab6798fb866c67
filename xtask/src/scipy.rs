//! SciPy's results, for the tests that compare with them, and the Python that reads data sets in the tests.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::step;

/// Folder of the script and of what it needs, from the workspace's root.
const FOLDER: &str = "crates/meshtone/tests/scipy";
/// Names the Python interpreter that makes the virtual environment.
const PYTHON: &str = "PYTHON";

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
        python = environment(root, &folder)?;
        let script = root.join(FOLDER).join("reference.py");
        step::program(Command::new(&python).arg(script).arg(&results))
    })?;
    Ok([results, python])
}

/// The virtual environment's interpreter. It is made anew when its requirements have changed.
fn environment(root: &Path, folder: &Path) -> Result<PathBuf, u8> {
    let venv = folder.join("venv");
    let python = if cfg!(windows) { venv.join("Scripts/python.exe") } else { venv.join("bin/python") };
    let requirements = root.join(FOLDER).join("requirements.txt");
    let wanted = std::fs::read_to_string(&requirements).map_err(|error| {
        eprintln!("error: {}: {error}", requirements.display());
        1
    })?;
    // Written last, so that an installation that was cut off is done again.
    let installed = folder.join("installed.txt");
    if python.exists() && std::fs::read_to_string(&installed).is_ok_and(|text| text == wanted) {
        return Ok(python);
    }
    let base = std::env::var_os(PYTHON).unwrap_or_else(|| "python3".into());
    step::program(Command::new(base).args(["-m", "venv", "--clear"]).arg(&venv))?;
    let install = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--requirement"];
    step::program(Command::new(&python).args(install).arg(&requirements))?;
    std::fs::write(&installed, wanted).map_err(|error| {
        eprintln!("error: {}: {error}", installed.display());
        1
    })?;
    Ok(python)
}
