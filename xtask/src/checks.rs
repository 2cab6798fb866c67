//! Everything that a change must pass, and the part of it that is quick.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};

use crate::packages::{ALIKE, tests_of};
use crate::step::{StepRunner, in_parallel};
use crate::surroundings::unusual;
use crate::{
    dependencies, dist, docs, environment, features, kernels, packages, python, rooms, scipy, toolchain,
};

/// The parts of Python that the tests of the Rust packages need.
struct Prepared {
    /// An interpreter with pyarrow and polars, which read data sets.
    python: PathBuf,
    /// SciPy's results.
    scipy: PathBuf,
}

/// Formatting, lints and the tests of the core: what is worth waiting for after every small change.
///
/// # Errors
/// The exit code of what failed.
pub fn quick(row: &StepRunner) -> Result<(), u8> {
    formatting(row)?;
    row.check("rooms check", rooms::problems)?;
    lints(row)?;
    row.cargo(&[&CORE_TESTS[..], &ALIKE].concat(), &[])?;
    tests_of(row, "meshtone", 0, &["--lib"], &[])
}

/// Arguments of cargo for the tests of the core that run whole simulations.
const CORE_TESTS: [&str; 6] = ["test", "--release", "--test", "all", "--package", "meshtone"];

/// The packages that have tests. The one that has none, but benchmarks, asks for features of `serde` that no other does: with it, the
/// project's own packages would be compiled for the tests and once more for the program and the wheel.
const TESTED: [&str; 3] = ["--workspace", "--exclude", "meshtone-bench"];

/// The package of recordings is tested alone, see [`unit_tests`].
const BY_ITSELF: [&str; 2] = ["--exclude", READER];

/// Everything.
///
/// Two rows of steps run at once: most of what Rust needs is done by both processors, most of what Python needs by one, or by
/// none while packages are fetched.
///
/// # Errors
/// The exit code of what failed first.
pub fn all(root: &Path) -> Result<(), u8> {
    let [rust, python] = StepRunner::pair(root, &root.join("target").join("checks").join("log"))?;
    formatting(&rust)?;
    rust.check("rooms check", rooms::problems)?;
    let (ready, prepared) = channel();
    in_parallel(|| rust_row(&rust, &prepared), move || python_row(&python, &ready))
}

fn rust_row(row: &StepRunner, prepared: &Receiver<Prepared>) -> Result<(), u8> {
    lints(row)?;
    // All that the platform needs has been fetched for the lints.
    row.check("dependencies check", dependencies::problems)?;
    // Nothing comes where that has failed, which has been said.
    let prepared = prepared.recv().map_err(|_| 1)?;
    let mut surroundings = unusual(row)?;
    surroundings.push(("MESHTONE_SCIPY_REFERENCE", prepared.scipy.into()));
    surroundings.push(("MESHTONE_PYTHON", prepared.python.into()));
    // Not the examples: the lints have looked at them, and nothing runs them.
    let programs = ["test", "--release", "--bins", "--test", "*"];
    row.cargo(&[&programs, &TESTED[..], &BY_ITSELF].concat(), &surroundings)?;
    unit_tests(row, &surroundings)?;
    features::object_stores(row, &surroundings)?;
    row.cargo(&[&["test", "--release", "--doc"], &TESTED[..]].concat(), &surroundings)?;
    row.check("kernels check", kernels::problems)?;
    let program = dist::program(row)?;
    dist::try_program(row, &program)?;
    documentation(row)?;
    features::without_threads(row)?;
    toolchain::check(row)
}

fn python_row(row: &StepRunner, ready: &Sender<Prepared>) -> Result<(), u8> {
    let python = environment::of_checks(row)?;
    let scipy = scipy::reference(row, &python)?;
    // Whoever waited for it has failed where it cannot be sent.
    let _ = ready.send(Prepared { python: python.clone(), scipy });
    let wheel = dist::wheel(row, &python)?;
    python::test(row, &python, &wheel)?;
    dist::try_wheel(row, &python, &wheel)?;
    let source = dist::source(row, &python)?;
    dist::try_source(row, &python, &source)
}

/// The unit tests of every package that has some, with the other tests of the recordings' package, which take longer to compile than
/// to run.
fn unit_tests(row: &StepRunner, surroundings: &[(&str, OsString)]) -> Result<(), u8> {
    let tested = |package: &&String| !WITHOUT_UNIT_TESTS.contains(&package.as_str());
    packages::names(row)?.iter().filter(tested).try_for_each(|package| match package.as_str() {
        // They learn from many records.
        "meshtone-diagnose" => tests_of(row, package, 3, &["--lib"], surroundings),
        READER => {
            let programs = packages::test_programs(row, package)?;
            let named = programs.iter().flat_map(|program| ["--test", program]);
            tests_of(row, package, 0, &[vec!["--lib"], named.collect()].concat(), surroundings)
        }
        _ => tests_of(row, package, 0, &["--lib"], surroundings),
    })
}

/// The package that reads recordings.
const READER: &str = "meshtone-io";

/// Packages that have no unit tests of a library: the benchmarks and the interfaces.
const WITHOUT_UNIT_TESTS: [&str; 4] =
    ["meshtone-bench", "meshtone-cli", "meshtone-python", "workspace-features"];

/// Writes what the tests of the core compare with the rows of the keys.
///
/// # Errors
/// The exit code of what failed.
pub fn generate(row: &StepRunner) -> Result<(), u8> {
    row.cargo(&[&CORE_TESTS[..], &ALIKE, &["generated::"]].concat(), &[("MESHTONE_GENERATE", "1".into())])
}

fn formatting(row: &StepRunner) -> Result<(), u8> {
    row.cargo(&["fmt", "--all", "--check"], &[])
}

fn lints(row: &StepRunner) -> Result<(), u8> {
    row.cargo(&["clippy", "--workspace", "--all-targets", "--release", "--", "-D", "warnings"], &[])
}

fn documentation(row: &StepRunner) -> Result<(), u8> {
    let arguments = ["doc", "--workspace", "--no-deps", "--release"];
    row.cargo(&arguments, &[("RUSTDOCFLAGS", "-D warnings".into())])?;
    row.check("docs check", docs::problems)
}
