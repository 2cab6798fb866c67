//! A table of the scenario file.

use meshtone_toml::{ReadResult, TomlTable};

use super::check::Check;
use super::description::KeyDescription;
use super::files::NumberFiles;
use super::row::KeyRow;
use super::value::Written;

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
    S::rows().iter().try_for_each(|row| row.read(section, table, files))
}

/// The rows of a section but for some, by their names.
pub(crate) fn rows_but<S: Keys>(names: &[&str]) -> Vec<KeyRow<S>> {
    S::rows().into_iter().filter(|row| !names.contains(&row.name)).collect()
}

/// The keys and values of some rows.
pub(super) fn written_pairs<S>(rows: &[KeyRow<S>], section: &S) -> Vec<(String, String)> {
    let pairs = |row: &KeyRow<S>| match row.write(section) {
        Written::Nothing => Vec::new(),
        Written::Value(value) => vec![(row.name.to_string(), value)],
        Written::Lines(pairs) => {
            pairs.into_iter().map(|(key, value)| (format!("{}.{key}", row.name), value)).collect()
        }
    };
    rows.iter().flat_map(pairs).collect()
}

/// The lines of a section, without its header.
pub(crate) fn write_keys<S: Keys>(section: &S) -> String {
    write_rows(&S::rows(), section)
}

/// The lines of some keys of a section.
pub(crate) fn write_rows<S: Keys>(rows: &[KeyRow<S>], section: &S) -> String {
    written_pairs(rows, section).iter().map(|(key, value)| format!("{key} = {value}\n")).collect()
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
pub(crate) fn check_rows<S: Keys>(rows: &[KeyRow<S>], section: &S, path: &str) -> Check {
    rows.iter().try_for_each(|row| row.check(section, path))
}

/// Describes the keys of a section.
pub(crate) fn describe<S: Keys>() -> Vec<KeyDescription> {
    describe_from(&S::start())
}

/// Describes the keys of a section, with what `start` has as defaults.
pub(crate) fn describe_from<S: Keys>(start: &S) -> Vec<KeyDescription> {
    S::rows().iter().flat_map(|row| row.describe(start, S::SECTION)).collect()
}

/// The lines of a section with a comment for every key, without its header.
pub(crate) fn commented<S: Keys>(section: &S) -> String {
    commented_rows(&S::rows(), section, &S::start())
}

/// The lines of a section's keys without which it would be another, each with its meaning behind it.
pub(crate) fn essential<S: Keys>(section: &S) -> String {
    essential_rows(&S::rows(), section, &S::start())
}

/// The lines of some keys of a section, likewise, with what `start` has as defaults.
pub(crate) fn essential_rows<S: Keys>(rows: &[KeyRow<S>], section: &S, start: &S) -> String {
    let keys: Vec<[String; 2]> = rows.iter().filter_map(|row| row.essential(section, start)).collect();
    let width = keys.iter().map(|[line, _]| line.chars().count()).max().unwrap_or(0);
    keys.iter().map(|[line, meaning]| format!("{line:width$}  # {meaning}\n")).collect()
}

/// The lines of some keys of a section with a comment for each, with what `start` has as defaults.
pub(crate) fn commented_rows<S: Keys>(rows: &[KeyRow<S>], section: &S, start: &S) -> String {
    rows.iter().map(|row| row.commented(section, start, S::SECTION)).collect()
}
