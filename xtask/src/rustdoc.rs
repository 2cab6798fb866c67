//! Documentation and its examples in one step: this program passes for rustdoc.
//!
//! Cargo documents with packages that it compiles for nothing else. Where it runs the examples of a library, rustdoc is given the
//! packages that the program is made of: with them this program documents the library as well, and every warning is an error.

use std::ffi::OsString;
use std::path::PathBuf;
use std::process::{Command, ExitCode};

use crate::step::{StepRunner, exit_code};

/// Variable with the folder into which libraries are documented: where it is set, this program is run in place of rustdoc.
const FOLDER: &str = "MESHTONE_DOCUMENTATION";

/// Variables with which cargo runs this program in place of rustdoc.
///
/// # Errors
/// 1 where this program cannot say where it is.
pub fn variables(row: &StepRunner) -> Result<Vec<(&'static str, OsString)>, u8> {
    let program = std::env::current_exe().map_err(|error| row.fail(&format!("this program: {error}")))?;
    let folder = row.root().join("target").join("doc");
    Ok(vec![("RUSTDOC", program.into()), (FOLDER, folder.into())])
}

/// The folder into which libraries are documented, where this program is run in place of rustdoc.
pub fn folder() -> Option<PathBuf> {
    std::env::var_os(FOLDER).map(PathBuf::from)
}

/// Runs rustdoc as it is asked to; where that is for the examples of a library, documents the library first.
///
/// # Arguments
/// * `folder` - where the documentation is put
pub fn run(folder: PathBuf) -> ExitCode {
    let arguments: Vec<OsString> = std::env::args_os().skip(1).collect();
    let status = |arguments: &[OsString]| {
        let status = Command::new("rustdoc").args(arguments).env_remove(FOLDER).status();
        status.map_or(1, |status| if status.success() { 0 } else { exit_code(status.code()) })
    };
    if let Some(mut documenting) = without_examples(&arguments) {
        documenting.extend(["-D", "warnings", "--out-dir"].map(OsString::from));
        documenting.push(folder.into());
        let code = status(&documenting);
        if code != 0 {
            return ExitCode::from(code);
        }
    }
    ExitCode::from(status(&arguments))
}

/// Arguments that document what `arguments` test; none where they test nothing.
fn without_examples(arguments: &[OsString]) -> Option<Vec<OsString>> {
    /// Options of the tests alone that are followed by a value.
    const OF_TESTS: [&str; 5] =
        ["--test-run-directory", "--test-args", "--test-runtool", "--test-runtool-arg", "--test-builder"];
    let start = arguments.iter().position(|argument| argument == "--test")?;
    let mut rest =
        arguments.iter().enumerate().filter(|(index, _)| *index != start).map(|(_, argument)| argument);
    let mut kept = Vec::new();
    while let Some(argument) = rest.next() {
        if OF_TESTS.iter().any(|option| argument == option) {
            rest.next();
        } else {
            kept.push(argument.clone());
        }
    }
    Some(kept)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_of_the_examples_are_left_out() {
        let words = |text: &str| text.split(' ').map(OsString::from).collect::<Vec<_>>();
        let asked = words("--crate-name a --test src/lib.rs --test-run-directory x -L dependency=deps");
        assert_eq!(without_examples(&asked), Some(words("--crate-name a src/lib.rs -L dependency=deps")));
        assert_eq!(without_examples(&words("-vV")), None);
    }
}
