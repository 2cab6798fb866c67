//! Files that appear complete or not at all.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

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
    let written = write_beside(path, write);
    written.map_err(|source| WriteFileError { path: path.to_path_buf(), source })
}

fn write_beside(path: &Path, write: impl FnOnce(&mut File) -> io::Result<()>) -> io::Result<()> {
    if path.is_dir() {
        return Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a directory"));
    }
    let directory = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let mut temporary = builder().tempfile_in(directory)?;
    write(temporary.as_file_mut())?;
    // Without this a power failure after the rename could leave an empty file under the name.
    temporary.as_file().sync_all()?;
    temporary.persist(path).map_err(|error| error.error)?;
    Ok(())
}

/// Temporary files are private by default; a result is to have the permissions of any new file.
#[cfg(unix)]
fn builder() -> tempfile::Builder<'static, 'static> {
    use std::fs::Permissions;
    use std::os::unix::fs::PermissionsExt;

    let mut builder = tempfile::Builder::new();
    builder.prefix(".meshtone-").permissions(Permissions::from_mode(0o666));
    builder
}

#[cfg(not(unix))]
fn builder() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".meshtone-");
    builder
}
