//! The Python of the checks: a virtual environment under `target`.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::step::StepRunner;

/// Names the Python interpreter that makes the virtual environments.
const PYTHON: &str = "PYTHON";
/// Packages that are installed for the checks, from the workspace's root.
const REQUIREMENTS: &str = "python/tests/requirements.txt";

/// The interpreter of the checks' environment, which is made anew when its requirements have changed.
///
/// # Errors
/// The exit code of what failed: there is no Python, or the packages cannot be installed.
pub fn of_checks(row: &StepRunner) -> Result<PathBuf, u8> {
    row.step("Python with what the checks need", || install(row))
}

fn install(row: &StepRunner) -> Result<PathBuf, u8> {
    let folder = row.root().join("target").join("python");
    let requirements = row.root().join(REQUIREMENTS);
    let python = interpreter(&folder.join("venv"));
    let wanted =
        std::fs::read_to_string(&requirements).map_err(|error| row.fail_at(&requirements, &error))?;
    // Written last, so that an installation that was cut off is done again.
    let installed = folder.join("installed.txt");
    if python.exists() && std::fs::read_to_string(&installed).is_ok_and(|text| text == wanted) {
        return Ok(python);
    }
    row.program(base().args(["-m", "venv", "--clear"]).arg(folder.join("venv")))?;
    pip_install(row, &python, &python, |pip| pip.arg("--requirement").arg(&requirements))?;
    std::fs::write(&installed, wanted).map_err(|error| row.fail_at(&installed, &error))?;
    Ok(python)
}

/// The interpreter that makes the environments, which has its standard library alone.
pub fn base() -> Command {
    Command::new(std::env::var_os(PYTHON).unwrap_or_else(|| "python3".into()))
}

/// A new environment with nothing in it but Python; returns its interpreter.
///
/// # Arguments
/// * `python` - makes it
/// * `folder` - where; what lies there is removed
///
/// # Errors
/// The exit code of what failed.
pub fn empty(row: &StepRunner, python: &Path, folder: &Path) -> Result<PathBuf, u8> {
    row.program(Command::new(python).args(["-m", "venv", "--clear", "--without-pip"]).arg(folder))?;
    Ok(interpreter(folder))
}

/// Installs packages.
///
/// # Arguments
/// * `pip` - an interpreter with pip
/// * `python` - the interpreter for which they are installed
/// * `what` - adds pip's arguments
///
/// # Errors
/// Pip's exit code.
pub fn pip_install(
    row: &StepRunner,
    pip: &Path,
    python: &Path,
    what: impl FnOnce(&mut Command) -> &mut Command,
) -> Result<(), u8> {
    let mut command = quiet_pip(pip);
    // What is imported is compiled then; most is not.
    command.arg("--python").arg(python).args(["install", "--no-compile"]);
    row.program(what(&mut command))
}

/// Builds the wheel of a package from its sources, where there is nothing but what it says that it needs.
///
/// # Arguments
/// * `pip` - an interpreter with pip, which builds
/// * `folder` - where the wheel is put
/// * `what` - adds pip's arguments
///
/// # Errors
/// Pip's exit code.
pub fn pip_wheel(
    row: &StepRunner,
    pip: &Path,
    folder: &Path,
    what: impl FnOnce(&mut Command) -> &mut Command,
) -> Result<(), u8> {
    let mut command = quiet_pip(pip);
    row.program(what(command.args(["wheel", "--no-deps", "--wheel-dir"]).arg(folder)))
}

fn quiet_pip(python: &Path) -> Command {
    let mut command = Command::new(python);
    command.args(["-m", "pip", "--quiet", "--disable-pip-version-check"]);
    command
}

/// The interpreter of a virtual environment.
fn interpreter(venv: &Path) -> PathBuf {
    if cfg!(windows) { venv.join("Scripts/python.exe") } else { venv.join("bin/python") }
}
