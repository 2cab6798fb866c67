//! The project's packages.

use crate::step::Row;

/// Those below `crates`, in the order of their names.
///
/// # Errors
/// 1 where the folder cannot be read.
pub fn names(row: &Row) -> Result<Vec<String>, u8> {
    let folder = row.root().join("crates");
    let entries = std::fs::read_dir(&folder).map_err(|error| row.fail_at(&folder, &error))?;
    let mut names: Vec<String> =
        entries.flatten().filter_map(|entry| entry.file_name().into_string().ok()).collect();
    names.sort();
    Ok(names)
}

/// Cargo's setting of how well one is optimised, for `--config`.
pub fn opt_level(package: &str, level: u8) -> String {
    format!("profile.release.package.{package}.opt-level={level}")
}
