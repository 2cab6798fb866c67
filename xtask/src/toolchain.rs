//! A check of the oldest version of Rust that is declared to do.

use std::io::ErrorKind;
use std::process::Command;

use crate::step::StepRunner;

/// The oldest Rust that the packages declare to need.
const OLDEST: &str = env!("CARGO_PKG_RUST_VERSION");

/// Checks that the oldest version that is declared compiles everything.
///
/// # Errors
/// The exit code of what failed.
pub fn check(row: &StepRunner) -> Result<(), u8> {
    row.step(&format!("Rust {OLDEST}, the oldest that is declared"), || oldest(row))
}

/// Where the oldest version ran all other steps, nothing is left to do; else rustup's copy of it looks at all sources.
fn oldest(row: &StepRunner) -> Result<(), u8> {
    if is_of(&rustc(row, &["--version"])?, OLDEST) {
        row.say("the version that runs the checks");
        return Ok(());
    }
    let mut rustup = Command::new("rustup");
    if rustup.arg("--version").output().is_err_and(|error| error.kind() == ErrorKind::NotFound) {
        println!("    Rust {OLDEST} was not tried: there is no rustup");
        return Ok(());
    }
    let version = format!("{OLDEST}.0");
    let check = ["run", "--install", &version, "cargo", "check", "--release", "--workspace", "--all-targets"];
    row.program(Command::new("rustup").args(check).env_remove("RUSTUP_TOOLCHAIN"))
}

/// Output of the compiler of the checks.
fn rustc(row: &StepRunner, arguments: &[&str]) -> Result<String, u8> {
    let output = Command::new("rustc").args(arguments).current_dir(row.root()).output();
    let output = output.map_err(|error| row.fail(&format!("cannot start rustc: {error}")))?;
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// Returns whether what `rustc --version` prints is of a version like `1.95`, be it the first or a corrected one.
fn is_of(printed: &str, version: &str) -> bool {
    let number = printed.split_whitespace().nth(1).unwrap_or_default();
    number.strip_prefix(version).is_some_and(|rest| rest.starts_with('.'))
}

#[cfg(test)]
mod tests {
    use super::is_of;

    #[test]
    fn corrected_versions_are_of_the_version() {
        assert!(is_of("rustc 1.95.0 (59807616e 2026-04-14)\n", "1.95"));
        assert!(is_of("rustc 1.95.1 (59807616e 2026-04-14)", "1.95"));
        assert!(!is_of("rustc 1.96.0 (59807616e 2026-04-14)", "1.95"));
        assert!(!is_of("rustc 1.950.0", "1.95"));
        assert!(!is_of("", "1.95"));
    }
}
