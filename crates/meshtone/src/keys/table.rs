//! A table of the scenario file.

use meshtone_toml::{ReadResult, TomlTable};

use super::check::Check;
use super::description::KeyDescription;
use super::files::NumberFiles;
use super::row::KeyRow;
use super::text::lines;

/// Parameters that stand in one table of the scenario file.
pub(crate) trait Keys: Clone + PartialEq + 'static {
    /// Whether a table inside another one is written key by key, each on its own line.
    const IN_LINES: bool = false;

    /// Name of the section of the scenario file that it is; empty for other tables.
    const SECTION: &str = "";

    /// Every key at its default, those without one at whatever is refused or replaced.
    fn start() -> Self;

    /// Lists the keys in the order in which they are read and written.
    fn rows() -> Vec<KeyRow<Self>>;

    /// Chooses one of several forms of the table, for parameters that can be given in several ways; the form's keys are read
    /// afterwards.
    ///
    /// # Errors
    /// Keys of two forms, or of none.
    fn choose(&mut self, _table: &TomlTable<'_>, _files: &dyn NumberFiles) -> ReadResult<()> {
        Ok(())
    }
}

/// Reads a table over what the section has.
pub(crate) fn read_keys<S: Keys>(
    section: &mut S,
    table: &TomlTable<'_>,
    files: &dyn NumberFiles,
) -> ReadResult<()> {
    section.choose(table, files)?;
    read_rows(&S::rows(), section, table, files)
}

/// Reads some keys of a table over what the section has.
pub(crate) fn read_rows<S>(
    rows: &[KeyRow<S>],
    section: &mut S,
    table: &TomlTable<'_>,
    files: &dyn NumberFiles,
) -> ReadResult<()> {
    rows.iter().try_for_each(|row| row.read(section, table, files))
}

/// The rows of a section but for some, by their names.
pub(crate) fn rows_but<S: Keys>(names: &[&str]) -> Vec<KeyRow<S>> {
    let mut rows = S::rows();
    rows.retain(|row| !names.contains(&row.head.name));
    rows
}

/// The rows of a section's keys of some names, in the section's order.
pub(crate) fn rows_of<S: Keys>(names: &[&str]) -> Vec<KeyRow<S>> {
    let mut rows = S::rows();
    rows.retain(|row| names.contains(&row.head.name));
    rows
}

/// The keys and values of some rows.
pub(super) fn written_pairs<S>(rows: &[KeyRow<S>], section: &S) -> Vec<(String, String)> {
    let mut pairs = Vec::new();
    for row in rows {
        pairs.extend(row.head.pairs(row.write(section)));
    }
    pairs
}

/// The lines of a section, without its header.
pub(crate) fn write_keys<S: Keys>(section: &S) -> String {
    write_rows(&S::rows(), section)
}

/// The lines of some keys of a section.
pub(crate) fn write_rows<S>(rows: &[KeyRow<S>], section: &S) -> String {
    lines(&written_pairs(rows, section))
}

/// Every key alone.
///
/// # Arguments
/// * `section` - the parameters
/// * `path` - dotted key of the table
pub(crate) fn check_keys<S: Keys>(section: &S, path: &str) -> Check {
    check_rows(&S::rows(), section, path)
}

/// Some keys alone.
pub(crate) fn check_rows<S>(rows: &[KeyRow<S>], section: &S, path: &str) -> Check {
    rows.iter().try_for_each(|row| row.check(section, path))
}

/// Describes the keys of a section.
pub(crate) fn describe<S: Keys>() -> Vec<KeyDescription> {
    describe_from(&S::start())
}

/// Describes the keys of a section, with what `start` has as defaults.
pub(crate) fn describe_from<S: Keys>(start: &S) -> Vec<KeyDescription> {
    describe_rows(&S::rows(), start, S::SECTION)
}

/// Describes some keys, each followed by those inside it.
///
/// # Arguments
/// * `rows` - the keys
/// * `start` - the section with its defaults
/// * `section` - its name; empty for other tables
pub(crate) fn describe_rows<S>(rows: &[KeyRow<S>], start: &S, section: &str) -> Vec<KeyDescription> {
    let mut keys = Vec::new();
    for row in rows {
        keys.extend(row.head.describe(row.write(start), row.cell.inside(start), section));
    }
    keys
}

/// The lines of a section with a comment for every key, without its header.
pub(crate) fn commented<S: Keys>(section: &S) -> String {
    commented_rows(&S::rows(), section, &S::start(), S::SECTION)
}

/// The lines of some keys of a section without which it would be another, each with its meaning behind it, with what `start` has as defaults.
pub(crate) fn essential_rows<S>(rows: &[KeyRow<S>], section: &S, start: &S) -> String {
    let mut keys = Vec::new();
    for row in rows {
        keys.extend(row.head.essential(row.write(section), &row.write(start)));
    }
    in_columns(&keys)
}

/// Lines and what stands behind each, in a column of its own.
fn in_columns(lines: &[[String; 2]]) -> String {
    let width = lines.iter().map(|[line, _]| line.chars().count()).max().unwrap_or(0);
    lines.iter().map(|[line, meaning]| format!("{line:width$}  # {meaning}\n")).collect()
}

/// The lines of some keys of a section with a comment for each, with what `start` has as defaults.
///
/// # Arguments
/// * `rows` - the keys
/// * `section`, `start` - the section, and the one with its defaults
/// * `name` - its name
pub(crate) fn commented_rows<S>(rows: &[KeyRow<S>], section: &S, start: &S, name: &str) -> String {
    let commented = |row: &KeyRow<S>| row.head.commented(row.write(section), row.write(start), name);
    rows.iter().map(commented).collect()
}
