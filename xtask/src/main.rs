//! Development tasks, run as `cargo xtask TASK`.
// A program that reports to the terminal.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod budgets;
mod checks;
mod compilations;
mod dist;
mod docs;
mod environment;
mod features;
mod files;
mod formatting;
mod fuzz;
mod kernels;
mod packages;
mod python;
mod rooms;
mod rustdoc;
mod scipy;
mod step;
mod surroundings;
mod toolchain;
mod yardstick;

use std::path::Path;
use std::process::ExitCode;

use step::StepRunner;

const HELP: &str = "\
Development tasks of Meshtone

Usage: cargo xtask TASK

Tasks:
  check        What is quick: formatting, lints, and the tests of the core
  test         Everything that a change must pass, which CONTRIBUTING.md lists; no step begins once
               one has failed. Python 3.11 or later is needed, as python3 or under the name in the
               variable PYTHON, and a package index
  measure      Print the tables of the Validation page: tests that count over many simulations; then the processor time of README's
               first command from nothing, and where there is valgrind the instructions of the program (half an hour on two cores;
               needs Python)
  dist         Make what a release carries, in target/dist: the program, the Python package's wheel
               and its source distribution
  wheel        Of these, only the wheel
  benchmark    Make the benchmark's data sets there, as the archives that a release carries (four minutes on two cores; needs
               Python), and check that the package has their SHA-256
  generate     Write what follows from the rows of the library's keys: Python's arguments and classes, the guide's lists
  check-rooms  Only the check that no folder of the library imports against the direction of the data
  check-docs   Only the check of the book: its table of contents, its links, pictures and formulas
  docs         Build the book into docs/book (needs mdbook)
  fuzz scenarios  Simulate odd but legal gearboxes and check every result: --count 317, --seed 58, --number 7 for that one alone
  fuzz         Try input on every reader, guided by coverage: --minutes 5, --target hdf5 for one alone (needs a C++ compiler)
  help         Print this text (also -h, --help)
";

/// Runs the program that simulates odd gearboxes; its arguments come behind.
const FUZZ_SCENARIOS: [&str; 7] =
    ["run", "--release", "--package", "meshtone", "--example", "fuzz_scenarios", "--"];

fn main() -> ExitCode {
    if let Some(folder) = rustdoc::folder() {
        return rustdoc::run(folder);
    }
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let root = workspace_root();
    let row = StepRunner::at_terminal(root, &[]);
    let linted = StepRunner::at_terminal(root, &checks::linted());
    let outcome = match words.as_slice() {
        ["check"] => checks::quick(&linted),
        ["test"] => checks::all(root),
        ["measure"] => checks::measure(&linted),
        ["dist"] => dist::make(&row),
        ["fuzz", "scenarios", arguments @ ..] => row.cargo(&[&FUZZ_SCENARIOS[..], arguments].concat(), &[]),
        ["fuzz", arguments @ ..] => fuzz::run(&row, arguments),
        ["docs"] => docs::build(root),
        ["wheel"] => dist::make_wheel(&row),
        ["benchmark"] => dist::benchmark(&row),
        ["generate"] => checks::generate(&linted),
        ["check-rooms"] => row.check("rooms check", rooms::problems),
        ["check-docs"] => row.check("docs check", docs::problems),
        ["help" | "-h" | "--help"] => {
            print!("{HELP}");
            Ok(())
        }
        [] => {
            eprint!("{HELP}");
            Err(2)
        }
        [task, rest @ ..] => {
            if rest.is_empty() {
                eprintln!("error: there is no task '{task}'\n");
            } else {
                eprintln!("error: cannot understand '{}': a task takes no arguments\n", words.join(" "));
            }
            eprint!("{HELP}");
            Err(2)
        }
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(code) => ExitCode::from(code),
    }
}

/// The folder of the workspace's `Cargo.toml`: the parent of this package's.
fn workspace_root() -> &'static Path {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    package.parent().unwrap_or(package)
}
