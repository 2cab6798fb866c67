//! Virtual environments of Python under `target`.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::step;

/// Names the Python interpreter that makes the virtual environments.
const PYTHON: &str = "PYTHON";

/// The interpreter of the virtual environment in `folder`, which is made anew when its requirements have changed.
///
/// # Arguments
/// * `folder` - where it lies
/// * `requirements` - the file of what is installed into it
///
/// # Errors
/// The exit code of what failed: there is no Python, or the packages cannot be installed.
pub fn environment(folder: &Path, requirements: &Path) -> Result<PathBuf, u8> {
    let venv = folder.join("venv");
    let python = if cfg!(windows) { venv.join("Scripts/python.exe") } else { venv.join("bin/python") };
    let wanted = std::fs::read_to_string(requirements).map_err(|error| {
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
    pip_install(&python, |pip| pip.arg("--requirement").arg(requirements))?;
    std::fs::write(&installed, wanted).map_err(|error| {
        eprintln!("error: {}: {error}", installed.display());
        1
    })?;
    Ok(python)
}

/// Installs packages into the environment of `python`.
///
/// # Arguments
/// * `python` - the environment's interpreter
/// * `what` - adds pip's arguments
///
/// # Errors
/// Pip's exit code.
pub fn pip_install(python: &Path, what: impl FnOnce(&mut Command) -> &mut Command) -> Result<(), u8> {
    let mut pip = Command::new(python);
    step::program(what(pip.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"])))
}
