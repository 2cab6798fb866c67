//! The results of an earlier run, kept until all of a new run's have taken their names.
//!
//! No system renames several files at once. So a whole set of results is first linked into a hidden directory beside
//! it, which takes no room and no time to speak of; the summary's name is then given up first and taken last. A directory
//! without a summary is thus one in which a run was interrupted, and the hidden one holds what it held before.

use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use meshtone_io::atomic_file::WriteFileError;

use crate::replacement::unless_absent;
use crate::results::{RESULTS, SUMMARY};

/// Folder in which a whole set of results is kept.
const KEPT: &str = ".meshtone-earlier";
/// Folder of a set that is not yet whole, and of a file on its way back.
const IN_THE_MAKING: &str = ".meshtone-earlier-new";
const RETURNING: &str = ".meshtone-returning";

/// Keeps the directory's results, if they are whole.
///
/// Where the file system has no links they are not kept; each file is replaced whole all the same.
pub fn keep(directory: &Path) {
    if directory.join(SUMMARY).exists() && link_all(directory).is_err() {
        let _ = fs::remove_dir_all(directory.join(IN_THE_MAKING));
    }
}

fn link_all(directory: &Path) -> io::Result<()> {
    let copies = directory.join(IN_THE_MAKING);
    fs::create_dir(&copies)?;
    for name in RESULTS {
        unless_absent(fs::hard_link(directory.join(name), copies.join(name)))?;
    }
    fs::rename(copies, directory.join(KEPT))
}

/// Puts the earlier results back where a run was interrupted while it replaced them, and clears away what is no longer
/// needed. Interrupted itself, it can be done again.
///
/// Returns whether anything was put back.
pub fn put_back(directory: &Path) -> Result<bool, WriteFileError> {
    let _ = fs::remove_dir_all(directory.join(IN_THE_MAKING));
    let kept = directory.join(KEPT);
    if directory.join(SUMMARY).exists() || !kept.join(SUMMARY).exists() {
        forget(directory);
        return Ok(false);
    }
    // The summary last.
    for name in RESULTS.into_iter().rev() {
        let path = directory.join(name);
        return_file(&kept.join(name), &path, &directory.join(RETURNING))
            .map_err(|source| WriteFileError { path, source })?;
    }
    forget(directory);
    Ok(true)
}

/// Gives `path` to the file kept; where none is, there was none.
fn return_file(kept: &Path, path: &PathBuf, returning: &Path) -> io::Result<()> {
    let _ = fs::remove_file(returning);
    let linked = fs::hard_link(kept, returning).and_then(|()| fs::rename(returning, path));
    // Renaming one link of a file to another does nothing and leaves both.
    let _ = fs::remove_file(returning);
    match linked {
        Err(error) if error.kind() == ErrorKind::NotFound => unless_absent(fs::remove_file(path)),
        linked => linked,
    }
}

/// Clears away what [`keep`] has kept.
pub fn forget(directory: &Path) {
    let kept = directory.join(KEPT);
    // Without its summary it is no set that could be put back.
    let _ = fs::remove_file(kept.join(SUMMARY));
    let _ = fs::remove_dir_all(kept);
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use tempfile::{TempDir, tempdir};

    use super::*;
    use crate::results::{PANEL, SIGNALS};

    /// What a run writes that is asked for no other format.
    const WRITTEN: [&str; 4] = [SUMMARY, SIGNALS, PANEL[0], PANEL[1]];

    fn write(directory: &TempDir, name: &str, content: &str) {
        // As a run does it: another file takes the name.
        fs::write(directory.path().join("staged"), content).unwrap();
        fs::rename(directory.path().join("staged"), directory.path().join(name)).unwrap();
    }

    /// Names and contents of all files.
    fn content(directory: &TempDir) -> Vec<(String, String)> {
        let entries = fs::read_dir(directory.path()).unwrap().map(|entry| entry.unwrap());
        let mut files: Vec<_> = entries
            .map(|entry| {
                let content = fs::read_to_string(entry.path()).unwrap_or_else(|_| "directory".to_string());
                (entry.file_name().into_string().unwrap(), content)
            })
            .collect();
        files.sort();
        files
    }

    type Step = Box<dyn Fn(&TempDir)>;

    /// Steps of a run, at any of which it may be killed.
    fn steps() -> Vec<Step> {
        let give = |name: &'static str| -> Step { Box::new(move |directory| write(directory, name, "new")) };
        vec![
            Box::new(|directory| keep(directory.path())),
            Box::new(|directory| fs::remove_file(directory.path().join(SUMMARY)).unwrap()),
            give(SIGNALS),
            give(PANEL[0]),
            give(PANEL[1]),
        ]
    }

    #[test]
    fn a_run_killed_at_any_step_is_undone() {
        for with_panel in [true, false] {
            for done in 0..=steps().len() {
                let directory = tempdir().unwrap();
                let names = if with_panel { &WRITTEN[..] } else { &[SIGNALS, SUMMARY] };
                names.iter().for_each(|name| write(&directory, name, "old"));
                write(&directory, "notes.txt", "mine");
                let before = content(&directory);
                steps().iter().take(done).for_each(|step| step(&directory));
                let interrupted = done >= 2;
                assert_eq!(put_back(directory.path()).unwrap(), interrupted, "{done}");
                assert_eq!(content(&directory), before, "{done}");
                assert!(!put_back(directory.path()).unwrap());
            }
        }
    }

    #[test]
    fn a_run_that_is_through_is_not_undone() {
        let directory = tempdir().unwrap();
        WRITTEN.iter().for_each(|name| write(&directory, name, "old"));
        steps().iter().for_each(|step| step(&directory));
        write(&directory, SUMMARY, "new");
        assert!(!put_back(directory.path()).unwrap());
        let expected = WRITTEN.map(|name| (name.to_string(), "new".to_string()));
        let mut expected = expected.to_vec();
        expected.sort();
        assert_eq!(content(&directory), expected);
    }

    #[test]
    fn a_set_that_was_not_whole_is_not_kept() {
        let directory = tempdir().unwrap();
        write(&directory, SIGNALS, "old");
        keep(directory.path());
        assert_eq!(content(&directory), [(SIGNALS.to_string(), "old".to_string())]);
    }
}
