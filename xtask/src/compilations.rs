//! What the checks compile, step by step, and whether a step compiles again what an earlier one has compiled.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::Value;

use crate::packages;
use crate::step::cargo;

/// One run of cargo that compiles.
pub struct Compilation {
    /// What it is for, in words.
    pub name: String,
    /// Cargo's arguments.
    pub arguments: Vec<String>,
}

impl Compilation {
    fn new(name: &str, arguments: &[&[&str]]) -> Self {
        Self { name: name.to_owned(), arguments: arguments.concat().into_iter().map(str::to_owned).collect() }
    }
}

/// Names the packages whose features all builds have, see `crates/workspace-features`.
const ALIKE: [&str; 4] = ["--package", "meshtone-cli", "--package", "workspace-features"];

/// The program.
pub fn program() -> Compilation {
    Compilation::new("program", &[&["build", "--release", "--locked", "--bins"], &ALIKE])
}

/// The libraries, the program and the programs of the tests.
pub fn tests() -> Compilation {
    let arguments = ["test", "--release", "--locked", "--workspace", "--bins", "--test", "*", "--no-run"];
    Compilation::new("tests", &[&arguments])
}

/// The same, and the tests run.
pub fn run_tests() -> Compilation {
    let Compilation { mut arguments, .. } = tests();
    arguments.retain(|argument| argument != "--no-run");
    Compilation { name: "tests, run".to_owned(), arguments }
}

/// The examples and the benchmarks: nothing runs them, they are linted as they are compiled.
///
/// The benchmarks' own package is not optimised for this.
pub fn examples_and_benchmarks() -> Compilation {
    let arguments = ["build", "--release", "--locked", "--workspace", "--examples", "--benches"];
    Compilation::new("examples and benchmarks", &[&arguments, &["--config", &level("meshtone-bench", 0)]])
}

/// The tests of the core from outside.
pub fn core_tests() -> Compilation {
    let packages = ["--package", "meshtone-tests", "--package", "meshtone"];
    let arguments = ["test", "--release", "--locked", "--test", "core", "--test", "solvers"];
    Compilation::new("tests of the core", &[&arguments, &packages, &ALIKE])
}

/// Unit tests of a library, for which it is compiled once more and not optimised.
///
/// What it depends on stays as it was compiled for the program, hence one package a run.
pub fn unit_tests(package: &str) -> Compilation {
    let level = level(package, 0);
    let arguments = ["test", "--release", "--locked", "--package", package, "--lib", "--config", &level];
    Compilation::new(&format!("unit tests of {package}"), &[&arguments, &ALIKE])
}

/// Tests of data sets in object stores: the package is compiled once more for these few tests, and not optimised.
pub fn object_stores() -> Compilation {
    let level = level("meshtone-dataset", 0);
    let arguments = ["test", "--release", "--locked", "--package", "meshtone-tests", "--config", &level];
    let tests = ["--features", "meshtone-tests/objects", "--test", "dataset"];
    Compilation::new("object stores", &[&arguments, &tests, &ALIKE])
}

/// The examples in the documentation.
pub fn documentation_tests() -> Compilation {
    let arguments = ["test", "--release", "--locked", "--doc", "--workspace", "--exclude", "meshtone-bench"];
    Compilation::new("documentation", &[&arguments])
}

/// The core without threads, and not optimised: that it compiles is all that is asked.
///
/// # Arguments
/// * `machine` - Rust's name of the kind of machine; none for the one that compiles
pub fn without_threads(machine: Option<&str>) -> Compilation {
    let level = level("meshtone", 0);
    let arguments = ["build", "--release", "--locked", "--package", "meshtone", "--no-default-features"];
    match machine {
        None => {
            let features = ["--package", "workspace-features", "--config", &level];
            Compilation::new("core without threads", &[&arguments, &features])
        }
        // A browser has no terminal, which some packages of the common features are about.
        Some(machine) => {
            let name = format!("core without threads for {machine}");
            Compilation::new(&name, &[&arguments, &["--target", machine, "--config", &level]])
        }
    }
}

/// What maturin compiles for the wheel.
fn wheel() -> Compilation {
    let arguments = ["build", "--release", "--locked", "--package", "meshtone-python", "--lib"];
    Compilation::new("wheel", &[&arguments])
}

/// Cargo's setting of how well a package is optimised, for `--config`.
fn level(package: &str, level: u8) -> String {
    format!("profile.release.package.{package}.opt-level={level}")
}

/// All of them, in the order in which the checks run them.
fn all(root: &Path) -> Result<Vec<Compilation>, String> {
    let units = packages::with_unit_tests(root)?.into_iter().map(|package| unit_tests(&package));
    let checks = Compilation::new("checks", &[&["build", "--release", "--package", "xtask"]]);
    let first = [checks, tests(), examples_and_benchmarks(), wheel()];
    let last = [object_stores(), documentation_tests(), program(), without_threads(None)];
    Ok(first.into_iter().chain(units).chain(last).collect())
}

/// A thing that a compilation makes: package, target, kind of build, machine.
type Unit = [String; 4];

/// How a unit is compiled.
#[derive(Clone, PartialEq, Eq)]
struct Manner {
    features: Vec<String>,
    level: String,
    /// The step that compiles it first.
    step: String,
}

/// What is compiled again, with other features or optimised otherwise, after an earlier step has compiled it.
///
/// Cargo says of each step what it would compile, as a graph. A unit that differs from an earlier one in its own features or level is named;
/// those that are compiled again only because of what they depend on follow from it.
///
/// # Errors
/// Cargo cannot say what it compiles.
pub fn problems(root: &Path) -> Result<Vec<String>, String> {
    let mut seen: BTreeMap<Unit, Vec<Manner>> = BTreeMap::new();
    let mut problems = Vec::new();
    for compilation in all(root)? {
        for (unit, manner) in units(root, &compilation)? {
            let before = seen.entry(unit.clone()).or_default();
            if before.iter().any(|other| other.features == manner.features && other.level == manner.level) {
                continue;
            }
            if let Some(first) = before.first()
                && !is_meant(&unit, &manner)
            {
                problems.push(described(&unit, first, &manner));
            }
            before.push(manner);
        }
    }
    Ok(problems)
}

/// Whether a package is compiled again on purpose: data sets with object stores and their tests, see [`object_stores`], and the core
/// without threads.
fn is_meant([package, _, _, _]: &Unit, manner: &Manner) -> bool {
    let has = |name: &str| manner.features.iter().any(|feature| feature == name);
    match package.as_str() {
        "meshtone-dataset" | "meshtone-tests" => has("objects"),
        "meshtone" => !has("threads"),
        _ => false,
    }
}

fn described([package, target, mode, _]: &Unit, first: &Manner, again: &Manner) -> String {
    let differ = |one: &Manner, other: &Manner| {
        let only: Vec<&str> =
            one.features.iter().filter(|name| !other.features.contains(name)).map(|name| &**name).collect();
        if only.is_empty() { "no feature of its own".to_owned() } else { only.join(", ") }
    };
    format!(
        "{package} ({target}, {mode}) is compiled for `{}` at level {} with {}, and again for `{}` at level {} with {}: ask for \
         the features in crates/workspace-features, or for one level in Cargo.toml",
        first.step,
        first.level,
        differ(first, again),
        again.step,
        again.level,
        differ(again, first)
    )
}

/// The units that cargo would compile in one step.
fn units(root: &Path, compilation: &Compilation) -> Result<Vec<(Unit, Manner)>, String> {
    let (command, arguments) =
        compilation.arguments.split_first().ok_or("a compilation without arguments")?;
    let mut cargo = cargo();
    cargo.arg(command).args(["--unit-graph", "-Z", "unstable-options"]).args(arguments);
    // The graph is printed by versions under development alone, unless they are told to pass for one. Nothing is compiled with it.
    let output = cargo.env("RUSTC_BOOTSTRAP", "1").current_dir(root).output();
    let output = output.map_err(|error| format!("cannot start cargo: {error}"))?;
    if !output.status.success() {
        return Err(format!(
            "cargo {}: {}",
            compilation.arguments.join(" "),
            String::from_utf8_lossy(&output.stderr)
        ));
    }
    let graph: Value =
        serde_json::from_slice(&output.stdout).map_err(|error| format!("cargo's graph of units: {error}"))?;
    let units = graph["units"].as_array().ok_or("cargo's graph has no units")?;
    let read = |unit: &Value| {
        read_unit(unit, &compilation.name)
            .ok_or_else(|| format!("cargo's graph has a unit that is not understood: {unit}"))
    };
    units.iter().map(read).collect()
}

/// None where the graph, which cargo may change, says something else than it did.
fn read_unit(unit: &Value, step: &str) -> Option<(Unit, Manner)> {
    let text = |value: &Value| value.as_str().map(str::to_owned);
    let id = text(&unit["pkg_id"])?;
    // `registry+…#syn@2.0.1` or `path+file:///…/meshtone#0.1.0`.
    let (place, version) = id.rsplit_once('#')?;
    let package = if version.contains('@') { version } else { place.rsplit('/').next()? };
    let features = unit["features"].as_array()?.iter().filter_map(text).collect();
    let target = format!("{} {}", text(&unit["target"]["name"])?, unit["target"]["kind"][0].as_str()?);
    let manner = Manner { features, level: text(&unit["profile"]["opt_level"])?, step: step.to_owned() };
    // Without a platform it is this machine, for what is run while others are compiled.
    let platform = text(&unit["platform"]).unwrap_or_default();
    Some(([package.to_owned(), target, text(&unit["mode"])?, platform], manner))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_that_differs_is_named_with_what_differs() {
        let manner = |features: &[&str], level: &str, step: &str| Manner {
            features: features.iter().map(|&name| name.to_owned()).collect(),
            level: level.to_owned(),
            step: step.to_owned(),
        };
        let unit = ["byteorder@1.5.0", "byteorder lib", "build", ""].map(str::to_owned);
        let said = described(&unit, &manner(&[], "0", "program"), &manner(&["std"], "3", "tests"));
        for part in ["byteorder@1.5.0", "`program` at level 0 with no feature", "`tests` at level 3 with std"]
        {
            assert!(said.contains(part), "{said}");
        }
    }

    #[test]
    fn packages_are_named_with_their_versions_or_folders() {
        let unit = serde_json::json!({
            "pkg_id": "path+file:///somewhere/crates/meshtone-io#0.1.0", "target": {"name": "meshtone_io", "kind": ["lib"]},
            "profile": {"opt_level": "3"}, "platform": null, "mode": "build", "features": ["a"]
        });
        let (unit, manner) = read_unit(&unit, "tests").expect("a unit");
        assert_eq!(unit, ["meshtone-io", "meshtone_io lib", "build", ""].map(str::to_owned));
        assert_eq!((manner.features, manner.level), (vec!["a".to_owned()], "3".to_owned()));
        assert!(
            read_unit(&serde_json::json!({"pkg_id": "path+file:///somewhere#0.1.0", "level": "3"}), "tests")
                .is_none()
        );
    }
}
