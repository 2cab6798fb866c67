//! Checksums of the recordings, so that a file that has changed since its first use is noticed.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use meshtone_dataset::digest::Digest;

/// The file, in the form of `sha256sum`.
pub const FILE: &str = "SHA256SUMS";

/// SHA-256 of files by their paths.
#[derive(Default)]
pub struct Checksums(BTreeMap<String, String>);

impl Checksums {
    /// Those that an earlier run recorded.
    ///
    /// # Arguments
    /// * `output` - the directory of results
    pub fn recorded(output: &Path) -> Self {
        let text = fs::read_to_string(output.join(FILE)).unwrap_or_default();
        Self(
            text.lines()
                .filter_map(|line| line.split_once("  "))
                .map(|(sum, path)| (path.to_owned(), sum.to_owned()))
                .collect(),
        )
    }

    /// Checks a file, and records it at its first use.
    ///
    /// # Arguments
    /// * `name` - by which it is recorded
    /// * `path` - the file
    ///
    /// Returns its checksum, where it can be read, and whether it has changed.
    pub fn check(&mut self, name: &str, path: &Path) -> (Option<String>, bool) {
        let Ok(bytes) = fs::read(path) else { return (None, false) };
        let found = Digest::of(&bytes).sha256;
        let recorded = self.0.entry(name.to_owned()).or_insert_with(|| found.clone());
        let has_changed = *recorded != found;
        (Some(found), has_changed)
    }

    /// The text of the file.
    pub fn text(&self) -> String {
        self.0.iter().map(|(path, sum)| format!("{sum}  {path}\n")).collect()
    }
}
