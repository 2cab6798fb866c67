//! The project's packages.

use std::ffi::OsString;
use std::path::Path;

use crate::step::StepRunner;

/// Names of the packages below `crates`, in the order of their names.
///
/// # Errors
/// 1 where the folder cannot be read.
pub fn names(row: &StepRunner) -> Result<Vec<String>, u8> {
    entries(row, &row.root().join("crates"))
}

/// A package's test programs, in the order of their names: files below `tests`, and folders with a `main.rs`.
///
/// # Errors
/// 1 where the folder cannot be read.
pub fn test_programs(row: &StepRunner, package: &str) -> Result<Vec<String>, u8> {
    let folder = row.root().join("crates").join(package).join("tests");
    let program = |name: String| match name.strip_suffix(".rs") {
        Some(file) => Some(file.to_owned()),
        None => folder.join(&name).join("main.rs").is_file().then_some(name),
    };
    Ok(entries(row, &folder)?.into_iter().filter_map(program).collect())
}

fn entries(row: &StepRunner, folder: &Path) -> Result<Vec<String>, u8> {
    let entries = std::fs::read_dir(folder).map_err(|error| row.fail_at(folder, &error))?;
    let mut names: Vec<String> =
        entries.flatten().filter_map(|entry| entry.file_name().into_string().ok()).collect();
    names.sort();
    Ok(names)
}

/// Cargo's setting of how well one is optimised, for `--config`.
pub fn opt_level(package: &str, level: u8) -> String {
    format!("profile.release.package.{package}.opt-level={level}")
}

/// Names the packages whose features all builds have, see `crates/workspace-features`.
pub const ALIKE: [&str; 4] = ["--package", "meshtone-cli", "--package", "workspace-features"];

/// Tests of a package that is compiled once more for them, as well as it is said.
///
/// What it depends on stays as it was compiled for the program, hence one package a run. The program and the package of common
/// features, none of whose targets is built, are named so that all packages have the features that they have elsewhere.
///
/// # Arguments
/// * `level` - how well it is optimised
/// * `targets` - which of its targets, and which of their tests
/// * `surroundings` - variables of the tests
///
/// # Errors
/// Cargo's exit code.
pub fn tests_of(
    row: &StepRunner,
    package: &str,
    level: u8,
    targets: &[&str],
    surroundings: &[(&str, OsString)],
) -> Result<(), u8> {
    let level = opt_level(package, level);
    let tests = ["test", "--release", "--package", package, "--config", &level];
    row.cargo(&[&tests[..], &ALIKE, targets].concat(), surroundings)
}
