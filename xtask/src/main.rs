//! Development tasks, run as `cargo xtask TASK`.
// A program that reports to the terminal.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod docs;
mod environment;
mod kernels;
mod python;
mod rooms;
mod scipy;
mod step;

use std::path::Path;
use std::process::ExitCode;

const HELP: &str = "\
Development tasks of Meshtone

Usage: cargo xtask TASK

Tasks:
  test         Everything that a change must pass, in this order, stopping at the first failure:
               formatting, lints, the direction of imports, tests (with the examples in the documentation, and against SciPy,
               pyarrow and polars, which are installed under target/scipy once: needs Python 3.11
               or later, as python3 or under the name in the variable PYTHON), a look for vector
               instructions that are calls, the library's documentation, and the check of the book
  wheel        Build the Python package's wheel into target/wheels
  check-rooms  Only the check that no folder of the library imports against the direction of the data
  check-docs   Only the check of the book: its table of contents, its links, pictures and formulas
  docs         Build the book into docs/book (needs mdbook)
  help         Print this text (also -h, --help)
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let root = workspace_root();
    let outcome = match words.as_slice() {
        ["test"] => test(root),
        ["check-rooms"] => step::run("rooms check", || rooms::check(root)),
        ["check-docs"] => step::run("docs check", || docs::check_and_report(root)),
        ["docs"] => docs::build(root),
        ["wheel"] => python::wheel(root),
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

/// Everything that a change must pass.
fn test(root: &Path) -> Result<(), u8> {
    step::cargo(root, &["fmt", "--all", "--check"], &[])?;
    step::cargo(root, &["clippy", "--workspace", "--all-targets", "--release", "--", "-D", "warnings"], &[])?;
    step::run("rooms check", || rooms::check(root))?;
    let [scipy, python] = scipy::reference(root)?;
    let python = [("MESHTONE_SCIPY_REFERENCE", scipy.as_os_str()), ("MESHTONE_PYTHON", python.as_os_str())];
    step::cargo(root, &["test", "--workspace", "--release"], &python)?;
    step::run("kernels check", || kernels::check(root))?;
    python::test(root)?;
    step::cargo(
        root,
        &["doc", "--workspace", "--no-deps", "--release"],
        &[("RUSTDOCFLAGS", "-D warnings".as_ref())],
    )?;
    step::run("docs check", || docs::check_and_report(root))
}
