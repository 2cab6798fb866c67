//! A data set in a directory.

use std::collections::BTreeMap;
use std::fmt;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use meshtone_io::atomic_file;
use meshtone_io::own_file::{self, Claim, PREFIX};

use super::{Claimed, Place};
use crate::part_list;
use crate::shard::{self, ReadShard, Wanted};

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
    fn files(&self) -> io::Result<BTreeMap<String, u64>> {
        let mut files = BTreeMap::new();
        if self.path.exists() {
            collect(&self.path, "", &mut files)?;
        }
        Ok(files)
    }

    fn files_in(&self, folder: &str) -> io::Result<BTreeMap<String, u64>> {
        let mut files = BTreeMap::new();
        let path = self.path.join(folder);
        if path.exists() {
            collect(&path, &format!("{folder}/"), &mut files)?;
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

    /// A folder of the data set that it leaves empty goes with it.
    fn remove(&self, name: &str) -> io::Result<()> {
        let path = self.path.join(name);
        fs::remove_file(&path)?;
        if let (Some(folder), true) = (path.parent(), name.contains('/')) {
            let _ = fs::remove_dir(folder);
        }
        Ok(())
    }

    fn name_of(&self, name: &str) -> String {
        self.path.join(name).display().to_string()
    }

    fn claim(&self, what: &str) -> io::Result<Option<Claimed>> {
        Ok(Claim::take(&self.path, what)?.map(|claim| Claimed { _claim: Some(claim) }))
    }

    fn remove_leftovers(&self) {
        remove_leftovers(&self.path, "");
    }

    fn check_writable(&self) -> io::Result<()> {
        if self.path.exists() && !self.path.is_dir() {
            return Err(io::Error::new(io::ErrorKind::NotADirectory, "it is a file"));
        }
        own_file::create_directories(&self.path)?;
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

/// Whether a folder is one of a data set: those of its shards, and that of its parts' lists.
///
/// # Arguments
/// * `before` - the folder that it is in, with a `/` at its end; empty for the data set's own directory
fn is_own_folder(before: &str, name: &str) -> bool {
    match before {
        "" => name == shard::FOLDER || name == part_list::FOLDER,
        before => {
            before.strip_suffix('/') == Some(shard::FOLDER) && name.bytes().all(|byte| byte.is_ascii_digit())
        }
    }
}

fn collect(directory: &Path, before: &str, files: &mut BTreeMap<String, u64>) -> io::Result<()> {
    for entry in fs::read_dir(directory)? {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        if is_own_folder(before, &name) && entry.file_type()?.is_dir() {
            collect(&entry.path(), &format!("{before}{name}/"), files)?;
        } else if !name.starts_with(PREFIX) {
            // Of the entry itself, as a look by the whole path takes longer; only a link leads elsewhere.
            let is_link = entry.file_type()?.is_symlink();
            let metadata = if is_link { fs::metadata(entry.path()) } else { entry.metadata() };
            match metadata {
                Ok(metadata) => drop(files.insert(format!("{before}{name}"), metadata.len())),
                // Another part has just removed it.
                Err(error) if error.kind() == io::ErrorKind::NotFound => {}
                Err(error) => return Err(error),
            }
        }
    }
    Ok(())
}

/// In all folders of a data set.
fn remove_leftovers(directory: &Path, before: &str) {
    own_file::remove_leftovers(directory);
    // Only these have folders in them; the others may hold a thousand files each.
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
