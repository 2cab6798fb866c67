//! Files that appear complete or not at all.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

use crate::own_file::{self, TemporaryFile};

/// A file that could not be written.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {source}", path.display())]
pub struct WriteFileError {
    /// The file that was to be written.
    pub path: PathBuf,
    /// Why it could not be.
    pub source: io::Error,
}

/// Writes a file under a temporary name beside its target, then renames it.
///
/// A reader sees the old file or the complete new one; where anything fails, the old one stays and
/// nothing is left behind. A target that is a symbolic link is replaced, not followed.
///
/// # Arguments
/// * `path` - the file to write; it is replaced if it exists
/// * `write` - writes the content; to be wrapped in a buffer where it writes in small pieces
///
/// # Errors
/// The directory does not exist or is not writable, the disk is full, or `write` fails.
///
/// ```
/// use std::io::Write;
/// use meshtone_io::atomic_file::write_atomically;
///
/// let directory = tempfile::tempdir()?;
/// let path = directory.path().join("note.txt");
/// write_atomically(&path, |file| file.write_all(b"17/38"))?;
/// assert_eq!(std::fs::read_to_string(&path)?, "17/38");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_atomically(
    path: &Path,
    write: impl FnOnce(&mut File) -> io::Result<()>,
) -> Result<(), WriteFileError> {
    StagedFile::write(path, write)?.commit()
}

/// A complete file under a temporary name beside its target.
///
/// Several files that belong together are all staged first and then committed, one right after the other, so
/// that hardly any moment is left in which only some of them are new. Dropped without being committed, it
/// disappears; where the program is killed, it stays behind until another program
/// [clears up](crate::own_file::remove_leftovers).
#[derive(Debug)]
#[must_use = "a staged file disappears unless it is committed"]
pub struct StagedFile {
    temporary: TemporaryFile,
    /// The name that it is to take.
    pub path: PathBuf,
}

impl StagedFile {
    /// Writes the content beside its target.
    ///
    /// # Arguments
    /// * `path` - the target
    /// * `write` - writes the content; to be wrapped in a buffer where it writes in small pieces
    ///
    /// # Errors
    /// The directory does not exist or is not writable, the disk is full, or `write` fails.
    pub fn write(
        path: &Path,
        write: impl FnOnce(&mut File) -> io::Result<()>,
    ) -> Result<Self, WriteFileError> {
        let path = path.to_path_buf();
        let written = temporary_beside(&path).and_then(|mut temporary| {
            write(temporary.file.as_file_mut())?;
            // Without this a power failure after the rename could leave an empty file under the name.
            temporary.file.as_file().sync_all()?;
            Ok(temporary)
        });
        match written {
            Ok(temporary) => Ok(Self { temporary, path }),
            Err(source) => Err(WriteFileError { path, source }),
        }
    }

    /// Gives the file its name, in place of the file that had it.
    ///
    /// # Errors
    /// The file cannot be renamed; the one that had the name is then still there.
    pub fn commit(self) -> Result<(), WriteFileError> {
        self.persist(|file, path| file.persist(path))
    }

    /// Gives the file its name, unless another file has it.
    ///
    /// # Errors
    /// There is a file of that name (`AlreadyExists`), or the file cannot be renamed.
    pub fn commit_new(self) -> Result<(), WriteFileError> {
        self.persist(|file, path| file.persist_noclobber(path))
    }

    fn persist(self, persist: own_file::Persist) -> Result<(), WriteFileError> {
        let Self { temporary, path } = self;
        temporary.persist(&path, persist).map_err(|source| WriteFileError { path, source })
    }
}

/// Whether a file can be written, tried with an empty one beside it that disappears at once. What has the name now stays
/// as it is.
///
/// # Arguments
/// * `path` - the file
///
/// # Errors
/// As [`StagedFile::write`], but for what only the content brings about.
///
/// ```
/// use meshtone_io::atomic_file::check_target;
///
/// let directory = tempfile::tempdir()?;
/// assert!(check_target(&directory.path().join("signals.parquet")).is_ok());
/// let error = check_target(directory.path()).unwrap_err();
/// assert!(error.to_string().ends_with("it is a directory"));
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn check_target(path: &Path) -> Result<(), WriteFileError> {
    temporary_beside(path).map(drop).map_err(|source| WriteFileError { path: path.to_path_buf(), source })
}

/// Whether files can be written into a directory, tried with an empty one that disappears at once.
///
/// # Arguments
/// * `directory` - an existing directory
///
/// # Errors
/// Why files cannot be written.
pub fn check_writable(directory: &Path) -> Result<(), WriteFileError> {
    temporary_in(directory)
        .map(drop)
        .map_err(|source| WriteFileError { path: directory.to_path_buf(), source })
}

/// A temporary file that can take the name `path`.
fn temporary_beside(path: &Path) -> io::Result<TemporaryFile> {
    use io::ErrorKind::{InvalidInput, IsADirectory};

    match path.metadata() {
        Ok(taken) if taken.is_dir() => return Err(io::Error::new(IsADirectory, "it is a directory")),
        // Renaming would put a file in the place of a device such as /dev/null.
        Ok(taken) if !taken.is_file() => return Err(io::Error::new(InvalidInput, "it is no ordinary file")),
        _ => {}
    }
    let ends_as_directory = path.to_string_lossy().ends_with(std::path::is_separator);
    if path.file_name().is_none() || ends_as_directory {
        return Err(io::Error::new(InvalidInput, "it is no name of a file"));
    }
    temporary_in(path.parent().unwrap_or(Path::new("")))
}

fn temporary_in(directory: &Path) -> io::Result<TemporaryFile> {
    // The current directory is an empty path as a file's parent.
    let directory = if directory.as_os_str().is_empty() { Path::new(".") } else { directory };
    TemporaryFile::begin(directory).map_err(|error| match directory.is_dir() {
        true => io::Error::new(own_file::refusal(&error), without_temporary_name(&error)),
        false => {
            let problem = format!("there is no directory {}", directory.display());
            io::Error::new(io::ErrorKind::NotFound, problem)
        }
    })
}

/// The error without the name of the temporary file, which means nothing to a user.
fn without_temporary_name(error: &io::Error) -> String {
    let cause = error.get_ref().and_then(|wrapped| wrapped.source());
    cause.map_or_else(|| error.to_string(), ToString::to_string)
}
