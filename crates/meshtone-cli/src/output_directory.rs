//! The directory that a run writes to.

use std::io::{Error, ErrorKind};
use std::path::{Path, PathBuf};

use meshtone_io::atomic_file::{check_target, check_writable};
use meshtone_io::own_file::{Claim, NewDirectory};

use crate::failure::Failure;
use crate::results::{RESULTS, finish_interrupted};
use crate::same_file::is_same_file;

/// A directory that exists, can be written to, and is this program's alone. What had to be created for it is removed again, unless
/// something is in it.
#[derive(Debug)]
pub struct OutputDirectory {
    /// The directory.
    pub path: PathBuf,
    // Given back before an empty directory can be removed.
    _claim: Claim,
    _created: Vec<NewDirectory>,
}

/// Directory of results unless the user names another: that of the input's name with what the results are, in the current
/// directory, such as `run_indicators`.
///
/// # Arguments
/// * `input` - a file, or a directory that `meshtone simulate` wrote
/// * `results` - what the results are
pub fn named_after(input: &Path, results: &str) -> PathBuf {
    let stem = if input.is_dir() { input.file_name() } else { input.file_stem() };
    let mut name = stem.unwrap_or_default().to_os_string();
    name.push(if name.is_empty() { results.to_owned() } else { format!("_{results}") });
    PathBuf::from(name)
}

/// Has a directory's results for this program alone.
pub fn claim(directory: &Path) -> Result<Claim, Failure> {
    let name = directory.display();
    let claim = Claim::take(directory, "results").map_err(|error| {
        Failure::of_writing(error.kind(), format!("cannot write results to the directory {name}: {error}"))
    })?;
    claim.ok_or_else(|| {
        Failure::failed(format!("another program is writing results to the directory {name}"))
            .with_help("wait until it has ended, or name another directory")
    })
}

impl OutputDirectory {
    /// Prepares a directory for the results of `meshtone simulate`, after it has named what an interrupted run had finished.
    pub fn prepare(path: &Path, read: &[&Path]) -> Result<Self, Failure> {
        let directory = Self::for_files(path, &RESULTS, read)?;
        finish_interrupted(path)?;
        Ok(directory)
    }

    /// Creates the directory where it does not exist, and tries whether the results can be written to it, so that no
    /// simulation runs whose results could not be kept.
    ///
    /// # Arguments
    /// * `path` - the directory
    /// * `names` - of the results
    /// * `read` - files that are read, which no result may replace
    pub fn for_files(path: &Path, names: &[&str], read: &[&Path]) -> Result<Self, Failure> {
        let refuse = |error: Error| {
            let message = format!("cannot write results to the directory {}: {error}", path.display());
            Failure::of_writing(error.kind(), message)
                .with_help("name another directory with -o, or change its permissions")
        };
        let mut results = names.iter().map(|name| path.join(name));
        if let Some(result) = results.find(|result| read.iter().any(|file| is_same_file(result, file))) {
            let problem = format!("the result {} would replace a file that is read", result.display());
            return Failure::refuse(problem, "name another directory with -o");
        }
        if path.exists() && !path.is_dir() {
            return Err(refuse(Error::new(ErrorKind::NotADirectory, "it is a file")));
        }
        let created = NewDirectory::create_all(path).map_err(refuse)?;
        check_writable(path).map_err(|error| refuse(error.source))?;
        let claim = claim(path)?;
        names.iter().try_for_each(|name| check_target(&path.join(name)))?;
        Ok(Self { path: path.to_path_buf(), _claim: claim, _created: created })
    }
}
