//! A data set in a directory.

use std::fmt;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use meshtone_io::atomic_file;

use super::Place;
use crate::shard::{self, ReadShard, Wanted};

/// What names of unfinished files begin with.
const UNFINISHED: &str = ".meshtone-";

/// A directory, which need not exist.
#[derive(Debug)]
pub(super) struct Directory {
    path: PathBuf,
}

impl Directory {
    pub fn new(path: PathBuf) -> Self {
        Self { path }
    }
}

impl Place for Directory {
    /// Unfinished files are left out.
    fn names(&self) -> io::Result<Vec<String>> {
        let mut names = Vec::new();
        if self.path.exists() {
            collect(&self.path, "", &mut names)?;
        }
        names.sort();
        Ok(names)
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

    /// What cannot be removed stays.
    fn remove_leftovers(&self) {
        for folder in [self.path.clone(), self.path.join(shard::FOLDER)] {
            for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
                if entry.file_name().to_string_lossy().starts_with(UNFINISHED) {
                    let _ = fs::remove_file(entry.path());
                }
            }
        }
    }

    fn check_writable(&self) -> io::Result<()> {
        if self.path.exists() && !self.path.is_dir() {
            return Err(io::Error::new(io::ErrorKind::NotADirectory, "it is a file"));
        }
        fs::create_dir_all(&self.path)?;
        atomic_file::check_writable(&self.path).map_err(|error| error.source)
    }

    fn path(&self) -> Option<&Path> {
        Some(&self.path)
    }
}

impl fmt::Display for Directory {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.path.display().fmt(formatter)
    }
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
