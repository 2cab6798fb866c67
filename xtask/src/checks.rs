//! Everything that a change must pass, and the part of it that is quick.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};

use crate::step::{StepRunner, in_parallel};
use crate::surroundings::unusual;
use crate::yardstick::Yardstick;
use crate::{
    budgets, compilations, dist, docs, environment, features, formatting, kernels, packages, python, rooms,
    rustdoc, scipy, toolchain,
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
    sources(row)?;
    row.compile(&compilations::tests(), &[], &[])?;
    row.compile(&compilations::core_tests(), &[], &[])?;
    row.compile(&compilations::unit_tests("meshtone"), &[], &[])
}

/// What needs the sources alone.
fn sources(row: &StepRunner) -> Result<(), u8> {
    row.check("formatting", formatting::problems)?;
    row.check("rooms check", rooms::problems)?;
    row.check("docs check", docs::problems)?;
    row.check("budgets of sources", budgets::of_sources)
}

/// Everything.
///
/// Two rows of steps run at once: most of what Rust needs is done by both processors, most of what Python needs by one, or by
/// none while packages are fetched.
///
/// # Errors
/// The exit code of what failed first.
pub fn all(root: &Path) -> Result<(), u8> {
    let yardstick = Yardstick::begin();
    let logs = root.join("target").join("checks").join("log");
    let [rust, python] = StepRunner::pair(root, &logs, &linted())?;
    sources(&rust)?;
    rust.cargo(&["fetch", "--locked"], &[])?;
    // The fuzzing targets are not compiled here; at least their lock must fit the packages that they take.
    rust.cargo(&["fetch", "--locked", "--manifest-path", "fuzz/Cargo.toml"], &[])?;
    rust.check("nothing is compiled twice", compilations::problems)?;
    let (ready, prepared) = channel();
    in_parallel(|| rust_row(&rust, &prepared), move || python_row(&python, &ready))?;
    rust.check("budgets", |root| budgets::of_checks(root, &rust.times(), &yardstick))
}

/// Variables with which the compiler's own lints and Clippy's are errors of each compilation: no package is compiled apart for the lints.
///
/// Clippy's compiler hands LLVM what it has not simplified itself, so that the code of the checks is that of the same sources, optimised
/// by LLVM alone. What a release carries is compiled without it.
pub fn linted() -> Vec<(&'static str, OsString)> {
    let arguments = ["-D", "warnings"].map(|argument| format!("{argument}__CLIPPY_HACKERY__")).concat();
    vec![("RUSTC_WORKSPACE_WRAPPER", "clippy-driver".into()), ("CLIPPY_ARGS", arguments.into())]
}

fn rust_row(row: &StepRunner, prepared: &Receiver<Prepared>) -> Result<(), u8> {
    // Compiled first: what fails soonest, and without what Python prepares meanwhile.
    row.compile(&compilations::tests(), &[], &[])?;
    // Nothing comes where that has failed, which has been said.
    let prepared = prepared.recv().map_err(|_| 1)?;
    let mut surroundings = unusual(row)?;
    surroundings.push(("MESHTONE_SCIPY_REFERENCE", prepared.scipy.into()));
    surroundings.push(("MESHTONE_PYTHON", prepared.python.into()));
    row.compile(&compilations::run_tests(), &[], &surroundings)?;
    unit_tests(row, &surroundings)?;
    row.compile(&compilations::object_stores(), &["objects::"], &surroundings)?;
    row.compile(&compilations::examples_and_benchmarks(), &[], &[])?;
    let mut documented = rustdoc::variables(row)?;
    documented.extend(surroundings);
    row.compile(&compilations::documentation_tests(), &[], &documented)?;
    let program = dist::program(row)?;
    row.check("kernels check", kernels::problems)?;
    dist::try_program(row, &program)?;
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

/// The unit tests of every package that has some.
fn unit_tests(row: &StepRunner, surroundings: &[(&str, OsString)]) -> Result<(), u8> {
    let packages = packages::with_unit_tests(row.root()).map_err(|error| row.fail(&error))?;
    packages.iter().try_for_each(|package| row.compile(&compilations::unit_tests(package), &[], surroundings))
}

/// Writes what the tests of the core compare with the rows of the keys.
///
/// # Errors
/// The exit code of what failed.
pub fn generate(row: &StepRunner) -> Result<(), u8> {
    row.compile(&compilations::core_tests(), &["generated::"], &[("MESHTONE_GENERATE", "1".into())])
}

/// Prints the tables of the Validation page: tests that count over many simulations, which the checks leave out.
///
/// # Errors
/// The exit code of what failed.
pub fn measure(row: &StepRunner) -> Result<(), u8> {
    let python = environment::of_checks(row)?;
    let scipy = scipy::reference(row, &python)?;
    let results = [("MESHTONE_SCIPY_REFERENCE", scipy.into()), ("MESHTONE_PYTHON", python.clone().into())];
    row.compile(&compilations::run_tests(), &["--", "--ignored", "--nocapture"], &results)?;
    let wheel = dist::wheel(row, &python)?;
    python::measure(row, &python, &wheel)?;
    budgets::measure(row)
}
