//! The files that a run writes, checked before anything is simulated.

use std::path::{Path, PathBuf};

use meshtone_io::atomic_file::check_target;

use crate::failure::Failure;
use crate::results::RESULTS;
use crate::same_file::is_same_file;

/// The directory of what is told about a recording, in the current one.
///
/// # Arguments
/// * `recording` - a file, or a directory that `meshtone simulate` wrote
/// * `what` - is told
pub fn named_after(recording: &Path, what: &str) -> PathBuf {
    let stem = if recording.is_dir() { recording.file_name() } else { recording.file_stem() };
    let mut name = stem.unwrap_or_default().to_os_string();
    name.push(if name.is_empty() { what.to_owned() } else { format!("_{what}") });
    PathBuf::from(name)
}

/// Refuses results that would replace a file that is read.
///
/// # Arguments
/// * `results` - the files that are written
/// * `read` - those that are read
pub fn check_not_read<'f>(
    results: &[PathBuf],
    read: impl IntoIterator<Item = &'f PathBuf>,
) -> Result<(), Failure> {
    let read: Vec<&PathBuf> = read.into_iter().collect();
    match results.iter().find(|result| read.iter().any(|file| is_same_file(result, file))) {
        None => Ok(()),
        Some(result) => {
            let problem = format!("the result {} would replace a file that is read", result.display());
            Err(Failure::bad_input(problem).with_help("name another directory with -o"))
        }
    }
}

/// Where runs write to.
pub struct Targets<'t> {
    /// Directory of each run's results.
    pub directories: Vec<&'t Path>,
    /// File for every stage's output.
    pub trace: Option<&'t Path>,
}

impl Targets<'_> {
    /// Refuses a trace that cannot be written or would replace a result, and whatever would replace a file that
    /// the runs read.
    ///
    /// The directories must exist.
    pub fn check(&self, read: &[&Path]) -> Result<(), Failure> {
        let results: Vec<PathBuf> =
            self.directories.iter().flat_map(|directory| RESULTS.map(|name| directory.join(name))).collect();
        if let Some(trace) = self.trace {
            check_trace(trace, &results, read)?;
        }
        let replaces = |result: &&PathBuf| read.iter().any(|file| is_same_file(result, file));
        let Some(result) = results.iter().find(replaces) else {
            return Ok(());
        };
        let problem = format!("the result {} would replace a file that is read", result.display());
        Err(Failure::bad_input(problem).with_help("name another directory with -o"))
    }
}

fn check_trace(trace: &Path, results: &[PathBuf], read: &[&Path]) -> Result<(), Failure> {
    const HELP: &str = "name another file with --trace, in a directory that exists";
    let named = format!("--trace {}", trace.display());
    if results.iter().any(|result| is_same_file(trace, result)) {
        let problem =
            format!("{named}: is where the run writes another of its results; must be a file of its own");
        return Err(Failure::bad_input(problem).with_help(HELP));
    }
    if read.iter().any(|file| is_same_file(trace, file)) {
        let problem = format!("{named}: is a file that the run reads; must be a file of its own");
        return Err(Failure::bad_input(problem).with_help(HELP));
    }
    check_target(trace).map_err(|error| {
        let message = format!("{named}: cannot be written: {}", error.source);
        Failure::of_writing(error.source.kind(), message).with_help(HELP)
    })
}
