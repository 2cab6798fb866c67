//! Parts of a release: the program, the wheel and the source distribution, each tried where there is nothing else.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::step::StepRunner;
use crate::{compilations, environment, kernels};

/// Program that tries an installed package.
const TRIAL: &str = "\
import meshtone as mt
simulation = mt.simulate(mt.examples.healthy().copy(sampling_rate_hz=1e4))
assert simulation.vertical_g.std() > 0
";

/// Maturin's arguments for a small module: without names, and, where Rust links with LLD, with one of functions that are alike, which is safe since
/// Rust promises no function an address of its own. The linker does both, and so the module is compiled for it: with and without are two compilations.
const SMALL: &[&str] = if cfg!(all(target_arch = "x86_64", target_os = "linux", target_env = "gnu")) {
    &["--strip", "--", "-Clink-arg=-Wl,--icf=all"]
} else {
    &["--strip"]
};

/// Frozen plans of the benchmark's data sets, by whose names the Python package knows the sets.
const PLANS: &str = "python/meshtone/benchmark";

/// Makes everything that a release carries but the benchmark's data sets.
///
/// # Errors
/// The exit code of what failed.
pub fn make(row: &StepRunner) -> Result<(), u8> {
    let python = environment::of_checks(row)?;
    let program = program(row)?;
    row.check("kernels check", kernels::problems)?;
    let made = [program, wheel(row, &python)?, source(row, &python)?];
    report(row, &made);
    Ok(())
}

/// Makes the wheel.
///
/// # Errors
/// The exit code of what failed.
pub fn make_wheel(row: &StepRunner) -> Result<(), u8> {
    let python = environment::of_checks(row)?;
    report(row, &[wheel(row, &python)?]);
    Ok(())
}

/// Makes the benchmark's data sets, or goes on with them, and packs each as an archive.
///
/// # Errors
/// The exit code of what failed; the Python package has another SHA-256 of a data set, so that it would refuse the archive.
pub fn benchmark(row: &StepRunner) -> Result<(), u8> {
    let program = program(row)?;
    for plan in of_kind(row, &row.root().join(PLANS), "toml")? {
        let set = folder(row).join(plan.file_stem().unwrap_or_default());
        row.step(&format!("Data set {}", set.display()), || {
            row.program(Command::new(&program).arg("dataset").arg(&plan).arg("-o").arg(&set))
        })?;
        row.step("Archive of the data set", || {
            let arguments = ["--published", "python/meshtone/_published.py"];
            row.program(environment::base().arg("examples/datasets/publish.py").arg(&set).args(arguments))
        })?;
    }
    Ok(())
}

/// Says what was made, and how large it is.
fn report(row: &StepRunner, files: &[PathBuf]) {
    for file in files {
        let bytes = std::fs::metadata(file).map_or(0, |metadata| metadata.len());
        row.say(&format!("{}: {:.1} MB", file.display(), bytes as f64 / 1e6));
    }
}

/// The folder of what a release carries.
fn folder(row: &StepRunner) -> PathBuf {
    row.root().join("target").join("dist")
}

/// Builds the program and leaves out of it the names that only those who work on it need.
///
/// # Errors
/// The exit code of what failed.
pub fn program(row: &StepRunner) -> Result<PathBuf, u8> {
    row.compile(&compilations::program(), &[], &[])?;
    row.step("Program, stripped", || {
        let name = format!("meshtone{}", std::env::consts::EXE_SUFFIX);
        let built = row.root().join("target").join("release").join(&name);
        let program = folder(row).join(name);
        std::fs::create_dir_all(folder(row)).map_err(|error| row.fail_at(&program, &error))?;
        std::fs::copy(&built, &program).map_err(|error| row.fail_at(&built, &error))?;
        // Windows has them in a file of their own.
        if cfg!(unix) {
            row.program(Command::new("strip").arg(&program))?;
        }
        Ok(program)
    })
}

/// Builds the wheel.
///
/// # Arguments
/// * `python` - an interpreter with maturin
///
/// # Errors
/// The exit code of what failed.
pub fn wheel(row: &StepRunner, python: &Path) -> Result<PathBuf, u8> {
    row.step("Python wheel", || {
        let arguments = ["--release", "--locked", "--quiet", "--compression-level", "9"];
        maturin(row, python, "whl", "build", &[&arguments[..], SMALL].concat())
    })
}

/// Packs the source distribution.
///
/// # Arguments
/// * `python` - an interpreter with maturin
///
/// # Errors
/// The exit code of what failed.
pub fn source(row: &StepRunner, python: &Path) -> Result<PathBuf, u8> {
    row.step("Source distribution", || maturin(row, python, "gz", "sdist", &[]))
}

/// Lets maturin make one file; returns it. Earlier ones of its kind are removed.
fn maturin(
    row: &StepRunner,
    python: &Path,
    extension: &str,
    command: &str,
    arguments: &[&str],
) -> Result<PathBuf, u8> {
    let folder = folder(row);
    std::fs::create_dir_all(&folder).map_err(|error| row.fail_at(&folder, &error))?;
    for old in of_kind(row, &folder, extension)? {
        std::fs::remove_file(&old).map_err(|error| row.fail_at(&old, &error))?;
    }
    let mut maturin = Command::new(python);
    maturin.args(["-m", "maturin", command, "--out"]).arg(&folder).args(arguments).envs(row.environment());
    row.program(&mut maturin)?;
    let made = of_kind(row, &folder, extension)?.pop();
    made.ok_or_else(|| row.fail(&format!("{}: nothing was made", folder.display())))
}

/// The files of a folder whose names end alike.
fn of_kind(row: &StepRunner, folder: &Path, extension: &str) -> Result<Vec<PathBuf>, u8> {
    let entries = std::fs::read_dir(folder).map_err(|error| row.fail_at(folder, &error))?;
    let paths = entries.flatten().map(|entry| entry.path());
    Ok(paths.filter(|path| path.extension().is_some_and(|end| end == extension)).collect())
}

/// Runs the program in an empty folder without any variables.
///
/// # Errors
/// The exit code of what failed.
pub fn try_program(row: &StepRunner, program: &Path) -> Result<(), u8> {
    row.step("Program, in an empty folder", || {
        let folder = empty_folder(row, "program")?;
        let run = |arguments: &[&str]| {
            row.program(Command::new(program).args(arguments).env_clear().current_dir(&folder))
        };
        run(&["init", "tooth-breakage", "-o", "broken.toml"])?;
        run(&["simulate", "broken.toml", "-o", "results"])?;
        let results = ["panel.png", "panel.svg", "signals.parquet", "summary.json"];
        match results.iter().find(|name| !folder.join("results").join(name).is_file()) {
            None => Ok(()),
            Some(name) => Err(row.fail(&format!("the program wrote no {name}"))),
        }
    })
}

/// Installs the wheel into an empty environment and simulates there.
///
/// # Arguments
/// * `python` - an interpreter with pip
///
/// # Errors
/// The exit code of what failed.
pub fn try_wheel(row: &StepRunner, python: &Path, wheel: &Path) -> Result<(), u8> {
    row.step("Python wheel, in an empty environment", || try_package(row, python, "wheel", wheel))
}

/// Builds a wheel from the source distribution as pip does, installs it into an empty environment and simulates there.
///
/// Its sources are those of the workspace, which is checked first. So cargo takes what it has compiled of them for the wheel, unless a
/// source is missing, and nothing is compiled twice. The interpreter that builds is the one that built the wheel, as PyO3 is compiled anew
/// for every other.
///
/// # Arguments
/// * `python` - an interpreter with pip
///
/// # Errors
/// The exit code of what failed.
pub fn try_source(row: &StepRunner, python: &Path, source: &Path) -> Result<(), u8> {
    row.step("Source distribution, in an empty environment", || {
        row.program(Command::new(python).args(["-c", COMPARISON]).arg(source).arg(row.root()))?;
        let alike = [
            ("CARGO_TARGET_DIR", row.root().join("target").into_os_string()),
            ("MATURIN_PEP517_ARGS", SMALL.join(" ").into()),
        ];
        let built = empty_folder(row, "source wheel")?;
        environment::pip_wheel(row, python, &built, |pip| {
            pip.envs(row.environment()).envs(alike).arg(source)
        })?;
        let wheel = of_kind(row, &built, "whl")?.pop();
        let wheel = wheel.ok_or_else(|| row.fail(&format!("{}: nothing was made", built.display())))?;
        try_package(row, python, "source", &wheel)
    })
}

/// Program that compares the sources of a source distribution with those of the workspace. What describes packages is written anew
/// for it: it names those packages alone that are there.
const COMPARISON: &str = "\
import pathlib, sys, tarfile
root, compared = pathlib.Path(sys.argv[2]), 0
with tarfile.open(sys.argv[1]) as archive:
    for member in filter(tarfile.TarInfo.isfile, archive):
        path = pathlib.PurePosixPath(member.name).relative_to(pathlib.PurePosixPath(member.name).parts[0])
        if path.name in ('PKG-INFO', 'README.md', 'Cargo.toml', 'Cargo.lock', 'pyproject.toml'):
            continue
        if archive.extractfile(member).read() != (root / path).read_bytes():
            sys.exit(f'{path} in the source distribution is not the one of the workspace')
        compared += 1
assert compared > 100, compared
";

fn try_package(row: &StepRunner, pip: &Path, name: &str, wheel: &Path) -> Result<(), u8> {
    let folder = empty_folder(row, name)?;
    let python = environment::empty(row, pip, &folder.join("venv"))?;
    environment::pip_install(row, pip, &python, |pip| pip.arg(wheel))?;
    row.program(Command::new(&python).args(["-c", TRIAL]).env_clear().current_dir(&folder))
}

/// A folder below `target/checks` with nothing in it.
fn empty_folder(row: &StepRunner, name: &str) -> Result<PathBuf, u8> {
    let folder = row.root().join("target").join("checks").join(name);
    let emptied = if folder.exists() { std::fs::remove_dir_all(&folder) } else { Ok(()) };
    emptied.and_then(|()| std::fs::create_dir_all(&folder)).map_err(|error| row.fail_at(&folder, &error))?;
    Ok(folder)
}
