//! What a file or directory is that a command cannot read: which command reads it.

use std::fs::{self, File};
use std::io::Read;
use std::path::Path;

use meshtone_io::scenario_file::FileKind;

use crate::failure::Failure;
use crate::results::SIGNALS;

/// A data set's list of its files.
pub const MANIFEST: &str = "manifest.json";
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
    let path = path.display();
    let readers: Vec<String> = readers.iter().map(|reader| format!("`{reader} {path}`")).collect();
    let read = if readers.len() == 1 { "reads" } else { "read" };
    Failure::bad_input(format!("{path}: is {what}, and {expected} is expected here"))
        .with_help(format!("{} {read} it", readers.join(" and ")))
}

/// What a path is, and the commands that read it.
fn found(path: &Path) -> Option<(&'static str, Vec<&'static str>)> {
    if path.is_dir() {
        let results = || ("what `meshtone simulate` wrote", vec!["meshtone indicators", "meshtone panel"]);
        return match path.join(MANIFEST).is_file() {
            true => Some(("a data set", vec!["meshtone dataset verify"])),
            false => path.join(SIGNALS).is_file().then(results),
        };
    }
    // To open a pipe would wait for its other end.
    let metadata = fs::metadata(path).ok().filter(fs::Metadata::is_file)?;
    if starts_as_parquet(path) {
        return Some(("a recording", vec!["meshtone indicators"]));
    }
    if metadata.len() > LARGEST {
        return None;
    }
    let kind = FileKind::of(&fs::read_to_string(path).ok()?)?;
    Some((kind.in_words(), vec![kind.reader()]))
}

fn starts_as_parquet(path: &Path) -> bool {
    let mut head = [0; 4];
    File::open(path).and_then(|mut file| file.read_exact(&mut head)).is_ok() && head == *b"PAR1"
}
