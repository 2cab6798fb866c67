//! The Python package: its wheel, and its tests where the wheel is installed.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::environment::{environment, pip_install};
use crate::step;

/// Folder of the package, from the workspace's root.
const FOLDER: &str = "python";

/// Builds the wheel into `target/wheels`.
///
/// # Errors
/// The exit code of what failed.
pub fn wheel(root: &Path) -> Result<(), u8> {
    step::run("Python wheel", || {
        let file = build(root)?;
        println!("    {}", file.display());
        Ok(())
    })
}

/// Installs the wheel into a virtual environment of its own and tests the package there: its tests, the examples in its
/// documentation, its types.
///
/// # Errors
/// The exit code of what failed.
pub fn test(root: &Path) -> Result<(), u8> {
    let mut python = PathBuf::new();
    step::run("Python wheel, installed", || {
        let wheel = build(root)?;
        python = environment(&target(root).join("tests"), &root.join(FOLDER).join("tests/requirements.txt"))?;
        pip_install(&python, |pip| pip.args(["--force-reinstall", "--no-deps"]).arg(wheel))
    })?;
    let run = |name: &str, arguments: &[&str]| {
        step::run(name, || step::program(Command::new(&python).current_dir(root).args(arguments)))
    };
    run("Python tests", &["-m", "pytest", "--quiet", "python/tests"])?;
    run(
        "Python examples",
        &[
            "-m",
            "pytest",
            "--quiet",
            "--doctest-modules",
            "--doctest-ignore-import-errors",
            "--pyargs",
            "meshtone",
        ],
    )?;
    run(
        "Python types",
        &[
            "-m",
            "mypy",
            "--config-file",
            "pyproject.toml",
            "python/meshtone",
            "python/tests",
            "python/gallery",
        ],
    )?;
    run("Python stubs", &["-m", "mypy.stubtest", "meshtone._core"])
}

fn target(root: &Path) -> PathBuf {
    root.join("target").join("python")
}

/// Builds the wheel; returns its file.
fn build(root: &Path) -> Result<PathBuf, u8> {
    let python = environment(&target(root).join("build"), &root.join(FOLDER).join("build-requirements.txt"))?;
    let wheels = root.join("target").join("wheels");
    // Only the one that is built now lies there.
    if wheels.exists() {
        std::fs::remove_dir_all(&wheels).map_err(|error| failed(&wheels, &error))?;
    }
    let mut maturin = Command::new(python);
    maturin.args(["-m", "maturin", "build", "--release", "--locked", "--quiet", "--out"]).arg(&wheels);
    step::program(maturin.current_dir(root))?;
    let entries = std::fs::read_dir(&wheels).map_err(|error| failed(&wheels, &error))?;
    let wheel = entries
        .flatten()
        .map(|entry| entry.path())
        .find(|path| path.extension().is_some_and(|end| end == "whl"));
    wheel.ok_or_else(|| {
        eprintln!("error: {}: no wheel was built", wheels.display());
        1
    })
}

fn failed(path: &Path, error: &std::io::Error) -> u8 {
    eprintln!("error: {}: {error}", path.display());
    1
}
