//! Advice for a file or directory that a command cannot read: which command reads it.

use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};

use meshtone_io::recording::{RecordingFormat, signals_in};
use meshtone_io::scenario_file::FileKind;

use crate::failure::Failure;

/// A data set's list of its files.
pub const MANIFEST: &str = "manifest.json";
/// Name of the file that `meshtone tune` writes.
pub const TUNED: &str = "tuned.toml";
/// Directories of a directory that are looked into.
const LOOKED_INTO: usize = 100;
/// (bytes) Larger files than this are none that users write.
const LARGEST: u64 = 1 << 20;

/// A failure about a path, or, where that is something that another command reads, that this one does not.
///
/// # Arguments
/// * `path` - what was to be read
/// * `expected` - what is read here, such as "a recording"
/// * `failure` - what would be said otherwise
pub fn or_other_kind(path: &Path, expected: &str, failure: Failure) -> Failure {
    let Some((what, readers)) = found(path) else { return failure };
    let readers: Vec<String> = readers.iter().map(|reader| format!("`{reader}`")).collect();
    let read = if readers.len() == 1 { "reads" } else { "read" };
    Failure::bad_input(format!("{}: is {what}, and {expected} is expected here", path.display()))
        .with_help(format!("{} {read} it", readers.join(" and ")))
}

/// Kind of a path, and the commands that read it.
fn found(path: &Path) -> Option<(&'static str, Vec<String>)> {
    let by = |commands: &[&str], path: &Path| -> Vec<String> {
        commands.iter().map(|command| format!("{command} {}", path.display())).collect()
    };
    if path.is_dir() {
        let inside = |name: &str| Some(path.join(name)).filter(|file| file.is_file());
        if inside(MANIFEST).is_some() {
            return Some(("a data set", by(&["meshtone dataset verify"], path)));
        }
        if signals_in(path).is_some() {
            let readers = by(&["meshtone indicators", "meshtone panel"], path);
            return Some(("what `meshtone simulate` wrote", readers));
        }
        return inside(TUNED)
            .map(|file| ("what `meshtone tune` wrote", by(&[FileKind::Tuned.reader()], &file)));
    }
    // To open a pipe would wait for its other end.
    let metadata = fs::metadata(path).ok().filter(fs::Metadata::is_file)?;
    if starts_as_parquet(path) {
        return Some(("a recording", by(&["meshtone indicators"], path)));
    }
    if metadata.len() > LARGEST {
        return None;
    }
    let kind = FileKind::of(&fs::read_to_string(path).ok()?)?;
    Some((kind.in_words(), by(&[kind.reader()], path)))
}

/// A directory of recordings or of results, or of directories of such: one of them.
pub fn recording_within(directory: &Path) -> Option<PathBuf> {
    let is_directory = |path: &&PathBuf| path.is_dir();
    let entries = sorted_entries(directory);
    entries.iter().find(|path| is_recording(path)).cloned().or_else(|| {
        let inner = entries.iter().filter(is_directory).take(LOOKED_INTO);
        inner.flat_map(|inner| sorted_entries(inner)).find(|path| is_recording(path))
    })
}

fn sorted_entries(directory: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(directory).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    paths.sort();
    paths
}

fn is_recording(path: &Path) -> bool {
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    signals_in(path).is_some() || path.is_file() && RecordingFormat::of_ending(&ending).is_some()
}

fn starts_as_parquet(path: &Path) -> bool {
    let mut head = [0; 4];
    File::open(path).and_then(|mut file| file.read_exact(&mut head)).is_ok() && head == *b"PAR1"
}
