//! What the checks compile, step by step: all with the same features and levels, so that nothing is compiled twice.

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

/// Cargo's setting of how well a package is optimised, for `--config`.
fn level(package: &str, level: u8) -> String {
    format!("profile.release.package.{package}.opt-level={level}")
}
