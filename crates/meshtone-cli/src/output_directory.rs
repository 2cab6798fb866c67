//! The directory that a run writes to.

use std::fs;
use std::io::{Error, ErrorKind};
use std::path::{Path, PathBuf};

use meshtone_io::atomic_file::{check_target, check_writable};

use crate::earlier_results;
use crate::failure::Failure;
use crate::results::RESULTS;

/// A directory that exists and can be written to. What had to be created for it is removed again unless it is
/// kept.
#[derive(Debug)]
pub struct OutputDirectory {
    path: PathBuf,
    /// Innermost first.
    created: Vec<PathBuf>,
}

/// Where results of a file go unless the user says otherwise: its name without the ending and with `suffix`, in the
/// current directory. None where the path names no file.
pub fn named_after(input: &Path, suffix: &str) -> Option<PathBuf> {
    let mut name = input.file_stem()?.to_os_string();
    name.push(suffix);
    Some(PathBuf::from(name))
}

impl OutputDirectory {
    /// Creates the directory where it does not exist, and tries whether the results can be written to it, so that no
    /// simulation runs whose results could not be kept.
    pub fn prepare(path: &Path) -> Result<Self, Failure> {
        let directory = Self::for_files(path, &RESULTS)?;
        earlier_results::put_back(path)?;
        Ok(directory)
    }

    /// The same for files of other names, for which nothing is put back.
    pub fn for_files(path: &Path, names: &[&str]) -> Result<Self, Failure> {
        let missing = path.ancestors().filter(|part| !part.as_os_str().is_empty());
        let created = missing.take_while(|part| !part.exists()).map(Path::to_path_buf).collect();
        let directory = Self { path: path.to_path_buf(), created };
        let refuse = |error: Error| {
            let message = format!("cannot write results to the directory {}: {error}", path.display());
            Failure::of_file(error.kind(), message)
                .with_help("name another directory with -o, or change its permissions")
        };
        if path.exists() && !path.is_dir() {
            return Err(refuse(Error::new(ErrorKind::NotADirectory, "it is a file")));
        }
        fs::create_dir_all(path).map_err(refuse)?;
        check_writable(path).map_err(|error| refuse(error.source))?;
        names.iter().try_for_each(|name| check_target(&path.join(name)))?;
        Ok(directory)
    }

    /// The directory.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Keeps the directory.
    pub fn keep(mut self) {
        self.created.clear();
    }
}

impl Drop for OutputDirectory {
    fn drop(&mut self) {
        for directory in &self.created {
            // What is not empty stays.
            let _ = fs::remove_dir(directory);
        }
    }
}
