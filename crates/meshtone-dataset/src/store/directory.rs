//! A data set in a directory.

use std::fmt;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use meshtone_io::atomic_file;
use meshtone_io::own_file::{self, PREFIX};

use super::{Files, Storage};
use crate::shard::{self, ReadShard, Wanted};

/// A directory, which need not exist.
#[derive(Debug)]
pub(super) struct Directory {
    pub path: PathBuf,
}

impl Storage for Directory {
    /// Unfinished files are left out.
    fn files(&self) -> io::Result<Files> {
        let mut files = Files::new();
        if self.path.exists() {
            collect(&self.path, "", &mut files)?;
        }
        Ok(files)
    }

    fn open(&self, name: &str) -> io::Result<Box<dyn Read + '_>> {
        Ok(Box::new(File::open(self.path.join(name))?))
    }

    fn shard(&self, name: &str, wanted: Wanted) -> io::Result<ReadShard> {
        shard::read(File::open(self.path.join(name))?, wanted)
    }

    fn write(&self, name: &str, content: &mut dyn FnMut(&mut File) -> io::Result<()>) -> io::Result<()> {
        let path = self.path.join(name);
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        atomic_file::write_atomically(&path, content).map_err(|error| error.source)
    }

    fn name_of(&self, name: &str) -> String {
        self.path.join(name).display().to_string()
    }
}

impl fmt::Display for Directory {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.path.display().fmt(formatter)
    }
}

/// Returns whether a folder is one of a data set: those of its shards.
///
/// # Arguments
/// * `before` - the folder that it is in, with a `/` at its end; empty for the data set's own directory
fn is_own_folder(before: &str, name: &str) -> bool {
    match before {
        "" => name == shard::FOLDER,
        before => {
            before.strip_suffix('/') == Some(shard::FOLDER) && name.bytes().all(|byte| byte.is_ascii_digit())
        }
    }
}

fn collect(directory: &Path, before: &str, files: &mut Files) -> io::Result<()> {
    for entry in fs::read_dir(directory)? {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        if is_own_folder(before, &name) && entry.file_type()?.is_dir() {
            collect(&entry.path(), &format!("{before}{name}/"), files)?;
        } else if !name.starts_with(PREFIX) {
            // The entry's own metadata is faster to get than that of its path; only a link needs the latter.
            let is_link = entry.file_type()?.is_symlink();
            let metadata = if is_link { fs::metadata(entry.path()) } else { entry.metadata() };
            match metadata {
                Ok(metadata) => drop(files.insert(format!("{before}{name}"), metadata.len())),
                // Another part has just removed the file.
                Err(error) if error.kind() == io::ErrorKind::NotFound => {}
                Err(error) => return Err(error),
            }
        }
    }
    Ok(())
}

/// Creates a directory, unless it exists, and checks that files can be written to it.
pub(super) fn check_writable(path: &Path) -> io::Result<()> {
    if path.exists() && !path.is_dir() {
        return Err(io::Error::new(io::ErrorKind::NotADirectory, "it is a file"));
    }
    own_file::create_directories(path)?;
    atomic_file::check_writable(path).map_err(|error| error.source)
}

/// Removes unfinished files from all folders of a data set.
///
/// # Arguments
/// * `directory` - the folder
/// * `before` - its name from the data set's directory, with a `/` at its end; empty for that directory
pub(super) fn remove_leftovers(directory: &Path, before: &str) {
    own_file::remove_leftovers(directory);
    // Only these folders have folders in them; the others may hold a thousand files each.
    if !before.is_empty() && before.strip_suffix('/') != Some(shard::FOLDER) {
        return;
    }
    for entry in fs::read_dir(directory).into_iter().flatten().flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        if is_own_folder(before, &name) {
            remove_leftovers(&entry.path(), &format!("{before}{name}/"));
        }
    }
}
