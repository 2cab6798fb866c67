//! Surroundings that no developer has: tests that rely on a developer's fail in the checks, not on somebody's machine.

use std::ffi::OsString;
use std::path::PathBuf;

use crate::step::StepRunner;

/// Variables of the surroundings in which tests run, with their values: a home and a folder for temporary files with nothing in
/// them, a language that is not English, text that is not UTF-8 where nothing is said of it, a time zone of half an hour, a narrow
/// terminal that shows nothing, and colours asked for all the same.
///
/// # Errors
/// 1 where a folder cannot be made.
pub fn unusual(row: &StepRunner) -> Result<Vec<(&'static str, OsString)>, u8> {
    let folder = row.root().join("target").join("checks");
    let [home, temporary] = ["home", "temporary files"].map(|name| folder.join(name));
    for folder in [&home, &temporary] {
        std::fs::create_dir_all(folder).map_err(|error| row.fail_at(folder, &error))?;
    }
    let fixed = [
        ("LC_ALL", "C"),
        ("LANGUAGE", "tr"),
        // Python would take `C` for UTF-8.
        ("PYTHONCOERCECLOCALE", "0"),
        ("PYTHONUTF8", "0"),
        ("TZ", "Asia/Kolkata"),
        ("TERM", "dumb"),
        ("COLUMNS", "37"),
        ("LINES", "7"),
        ("CLICOLOR_FORCE", "1"),
        ("FORCE_COLOR", "1"),
    ];
    let mut variables: Vec<(&str, OsString)> = fixed.map(|(name, value)| (name, value.into())).into();
    variables.extend(toolchain_homes());
    variables.push(("HOME", home.into()));
    variables.push(("TMPDIR", temporary.into()));
    Ok(variables)
}

/// The folders of the Rust toolchain, which are sought in the home where nothing is said of them.
fn toolchain_homes() -> impl Iterator<Item = (&'static str, OsString)> {
    let home = std::env::home_dir();
    let folders = [("CARGO_HOME", ".cargo"), ("RUSTUP_HOME", ".rustup")];
    folders.into_iter().filter_map(move |(variable, folder)| {
        let given = std::env::var_os(variable).map(PathBuf::from);
        Some((variable, given.or_else(|| Some(home.as_ref()?.join(folder)))?.into()))
    })
}
