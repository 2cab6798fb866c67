//! Builds with other features than the program's.

use std::path::Path;
use std::process::Command;

use crate::compilations;
use crate::step::StepRunner;

/// Rust's name of the machine that a browser is.
const BROWSER: &str = "wasm32-unknown-unknown";

/// Compiles the core without threads, also for a browser where Rust's libraries for one are installed.
///
/// # Errors
/// The exit code of what failed.
pub fn without_threads(row: &StepRunner) -> Result<(), u8> {
    row.compile(&compilations::without_threads(None), &[], &[])?;
    if is_installed(row, BROWSER)? {
        return row.compile(&compilations::without_threads(Some(BROWSER)), &[], &[]);
    }
    println!("    {BROWSER} was not tried: it is not installed");
    Ok(())
}

/// Returns whether Rust's libraries for a kind of machine are there.
fn is_installed(row: &StepRunner, machine: &str) -> Result<bool, u8> {
    let mut rustc = Command::new("rustc");
    rustc.args(["--print", "target-libdir", "--target", machine]).current_dir(row.root());
    let output = rustc.output().map_err(|error| row.fail(&format!("cannot start rustc: {error}")))?;
    Ok(output.status.success() && Path::new(String::from_utf8_lossy(&output.stdout).trim()).is_dir())
}
