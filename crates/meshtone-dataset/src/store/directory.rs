//! A data set in a directory.

use std::fs::{self, File};
use std::io;
use std::path::Path;

use meshtone_io::atomic_file;

use crate::shard;

/// What names of unfinished files begin with.
const UNFINISHED: &str = ".meshtone-";

/// Names of all files, those in folders with the folder's name before; unfinished ones are left out.
pub(super) fn names(directory: &Path) -> io::Result<Vec<String>> {
    let mut names = Vec::new();
    if directory.exists() {
        collect(directory, "", &mut names)?;
    }
    names.sort();
    Ok(names)
}

fn collect(directory: &Path, before: &str, names: &mut Vec<String>) -> io::Result<()> {
    for entry in fs::read_dir(directory)? {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let own_folder = before.is_empty() && name == shard::FOLDER;
        if own_folder && entry.file_type()?.is_dir() {
            collect(&entry.path(), &format!("{name}/"), names)?;
        } else if !name.starts_with(UNFINISHED) {
            names.push(format!("{before}{name}"));
        }
    }
    Ok(())
}

pub(super) fn write<T>(
    directory: &Path,
    name: &str,
    write: impl FnOnce(&mut File) -> io::Result<T>,
) -> io::Result<T> {
    let path = directory.join(name);
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
    }
    let mut result = None;
    atomic_file::write_atomically(&path, |file| {
        result = Some(write(file)?);
        Ok(())
    })
    .map_err(|error| error.source)?;
    result.ok_or_else(|| io::Error::other("nothing was written"))
}

pub(super) fn check_writable(directory: &Path) -> io::Result<()> {
    if directory.exists() && !directory.is_dir() {
        return Err(io::Error::new(io::ErrorKind::NotADirectory, "it is a file"));
    }
    fs::create_dir_all(directory)?;
    atomic_file::check_writable(directory).map_err(|error| error.source)
}

/// Removes unfinished files; what cannot be removed stays.
pub(super) fn remove_leftovers(directory: &Path) {
    for folder in [directory.to_path_buf(), directory.join(shard::FOLDER)] {
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            if entry.file_name().to_string_lossy().starts_with(UNFINISHED) {
                let _ = fs::remove_file(entry.path());
            }
        }
    }
}
