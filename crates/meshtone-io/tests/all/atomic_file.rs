//! Files that appear complete or not at all.
#![allow(clippy::unwrap_used)]

use std::fs;
use std::io::{self, Write};
use std::path::Path;

use meshtone_io::atomic_file::{StagedFile, check_target, check_writable, write_atomically};
use tempfile::tempdir;

fn names_in(directory: &Path) -> Vec<String> {
    let names = fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().file_name());
    names.map(|name| name.to_string_lossy().into_owned()).collect()
}

#[test]
fn a_file_is_replaced() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("a.txt");
    fs::write(&path, "old").unwrap();
    write_atomically(&path, |file| file.write_all(b"new")).unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), "new");
    assert_eq!(names_in(directory.path()), ["a.txt"]);
}

#[test]
fn a_failure_leaves_the_old_file_and_nothing_else() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("a.txt");
    fs::write(&path, "old").unwrap();
    let error = write_atomically(&path, |file| {
        file.write_all(b"half")?;
        Err(io::Error::other("the disk is full"))
    })
    .unwrap_err();
    assert!(error.to_string().contains("a.txt: the disk is full"), "{error}");
    assert_eq!(fs::read_to_string(&path).unwrap(), "old");
    assert_eq!(names_in(directory.path()), ["a.txt"]);
}

#[test]
fn a_panic_leaves_nothing_behind() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("a.txt");
    let panicked = std::panic::catch_unwind(|| {
        write_atomically(&path, |_| std::panic::resume_unwind(Box::new("stopped")))
    });
    assert!(panicked.is_err());
    assert!(names_in(directory.path()).is_empty());
}

#[test]
fn directories_are_refused() {
    let directory = tempdir().unwrap();
    let into = write_atomically(directory.path(), |_| Ok(())).unwrap_err();
    assert!(into.to_string().contains("it is a directory"), "{into}");
    let absent = directory.path().join("absent").join("a.txt");
    let error = write_atomically(&absent, |_| Ok(())).unwrap_err();
    assert_eq!(error.path, absent);
    assert_eq!(error.source.kind(), io::ErrorKind::NotFound);
}

#[test]
fn what_can_be_written_is_known_before() {
    let directory = tempdir().unwrap();
    let refused = |name: &str, problem: &str| {
        let path = directory.path().join(name);
        let error = check_target(&path).unwrap_err();
        assert!(error.to_string().ends_with(problem), "{error}");
        assert_eq!(write_atomically(&path, |_| Ok(())).unwrap_err().to_string(), error.to_string());
    };
    refused("", "it is a directory");
    refused("a.txt/", "it is no name of a file");
    refused("deep/..", "it is no name of a file");
    fs::write(directory.path().join("b.txt"), "old").unwrap();
    assert!(check_target(&directory.path().join("a.txt")).is_ok());
    assert!(check_target(&directory.path().join("b.txt")).is_ok());
    assert_eq!(names_in(directory.path()), ["b.txt"]);
}

/// A renamed file would take the device's place.
#[cfg(unix)]
#[test]
fn devices_are_refused() {
    let error = check_target(Path::new("/dev/null")).unwrap_err();
    assert!(error.to_string().contains("it is no ordinary file"), "{error}");
}

#[cfg(unix)]
#[test]
fn permissions_are_those_of_any_new_file() {
    use std::os::unix::fs::PermissionsExt;

    let directory = tempdir().unwrap();
    let (plain, atomic) = (directory.path().join("plain"), directory.path().join("atomic"));
    fs::write(&plain, "").unwrap();
    write_atomically(&atomic, |_| Ok(())).unwrap();
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode();
    assert_eq!(mode(&atomic), mode(&plain));
}

#[test]
fn a_staged_file_shows_itself_only_when_committed() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("a.txt");
    fs::write(&path, "old").unwrap();
    let staged = StagedFile::write(&path, |file| file.write_all(b"new")).unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), "old");
    staged.commit().unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), "new");
    drop(StagedFile::write(&path, |file| file.write_all(b"newer")).unwrap());
    let refused = StagedFile::write(&path, |_| Ok(())).unwrap().commit_new().unwrap_err();
    assert_eq!(refused.source.kind(), io::ErrorKind::AlreadyExists);
    assert_eq!(fs::read_to_string(&path).unwrap(), "new");
    assert_eq!(names_in(directory.path()), ["a.txt"]);
    let absent = StagedFile::write(&directory.path().join("absent/a.txt"), |_| Ok(())).unwrap_err();
    assert!(absent.source.to_string().contains("there is no directory"), "{absent}");
    assert!(check_writable(directory.path()).is_ok() && check_writable(&path).is_err());
}
