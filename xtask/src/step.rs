//! One timed step of a task.

use std::ffi::{OsStr, OsString};
use std::path::Path;
use std::process::Command;
use std::time::Instant;

/// Runs cargo in `root` as a step named after its arguments.
///
/// # Arguments
/// * `root` - folder to run in
/// * `arguments` - cargo's arguments
/// * `environment` - variables to set, by name
///
/// # Errors
/// Cargo's exit code, or 1 where it could not be started or was killed.
pub fn cargo(root: &Path, arguments: &[&str], environment: &[(&str, &OsStr)]) -> Result<(), u8> {
    // Cargo tells the programs that it runs which cargo it is.
    let program = std::env::var_os("CARGO").unwrap_or_else(|| OsString::from("cargo"));
    run(&format!("cargo {}", arguments.join(" ")), || {
        let environment = environment.iter().copied();
        self::program(Command::new(&program).args(arguments).envs(environment).current_dir(root))
    })
}

/// Runs a program to its end.
///
/// # Errors
/// Its exit code, or 1 where it could not be started or was killed.
pub fn program(command: &mut Command) -> Result<(), u8> {
    let status = command.status().map_err(|error| {
        eprintln!("error: cannot start {}: {error}", command.get_program().display());
        1
    })?;
    if status.success() { Ok(()) } else { Err(exit_code(status.code())) }
}

/// Runs `work` between two lines that name the step and say how long it took.
///
/// # Errors
/// The exit code that `work` failed with.
pub fn run(name: &str, work: impl FnOnce() -> Result<(), u8>) -> Result<(), u8> {
    println!("==> {name}");
    let start = Instant::now();
    let outcome = work();
    let seconds = start.elapsed().as_secs_f64();
    match outcome {
        Ok(()) => println!("    ok, {seconds:.1} s"),
        Err(code) => eprintln!("    FAILED with exit code {code} after {seconds:.1} s: {name}"),
    }
    outcome
}

/// A failed program's exit code as this program's own: never 0, and 1 where it has none.
pub fn exit_code(code: Option<i32>) -> u8 {
    code.and_then(|code| u8::try_from(code).ok()).filter(|&code| code != 0).unwrap_or(1)
}

#[cfg(test)]
mod tests {
    use super::exit_code;

    #[test]
    fn a_failure_never_becomes_success() {
        assert_eq!(exit_code(Some(101)), 101);
        assert_eq!(exit_code(Some(256)), 1);
        assert_eq!(exit_code(Some(0)), 1);
        assert_eq!(exit_code(None), 1);
    }
}
