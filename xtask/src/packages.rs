//! The project's packages.

use std::path::Path;

use crate::files;

/// Packages that have no unit tests of a library: the benchmarks and the interfaces.
const WITHOUT_UNIT_TESTS: [&str; 5] =
    ["meshtone-bench", "meshtone-cli", "meshtone-python", "meshtone-tests", "workspace-features"];

/// Names of the packages below `crates` that have unit tests, in the order of their names.
///
/// # Errors
/// The folder cannot be read.
pub fn with_unit_tests(root: &Path) -> Result<Vec<String>, String> {
    let names = files::names_in(&root.join("crates")).map_err(|error| error.to_string())?;
    Ok(names.into_iter().filter(|name| !WITHOUT_UNIT_TESTS.contains(&name.as_str())).collect())
}
