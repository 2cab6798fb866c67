//! Why a command did not succeed, in words for its user.

use std::io::ErrorKind;

use meshtone_dataset::DatasetError;
use meshtone_io::ReadResultsError;
use meshtone_io::atomic_file::WriteFileError;
use meshtone_io::scenario_file::{FileKind, ReadScenarioError};

use crate::other_kind::or_other_kind;

/// Why a command did not succeed.
#[derive(Debug)]
pub struct Failure {
    /// 1: the input is good, but could not be carried out; 2: the user's input is wrong.
    pub exit_code: u8,
    /// The problem, its place, and what is allowed.
    pub message: String,
    /// Advice, where the message does not make it plain.
    pub help: Option<String>,
    /// The line that it is about.
    pub snippet: Option<Snippet>,
}

/// A line of a file.
#[derive(Debug)]
pub struct Snippet {
    /// Its whole text.
    pub text: String,
    /// 1-based.
    pub line: usize,
}

impl Failure {
    /// The user's input is wrong.
    pub fn bad_input(message: impl Into<String>) -> Self {
        Self { exit_code: 2, message: message.into(), help: None, snippet: None }
    }

    /// Refuses the user's input, with advice.
    ///
    /// # Arguments
    /// * `problem` - what is wrong with it
    /// * `help` - what the user can do
    pub fn refuse<T>(problem: impl Into<String>, help: impl Into<String>) -> Result<T, Self> {
        Err(Self::bad_input(problem).with_help(help))
    }

    /// The input is good, but could not be carried out.
    pub fn failed(message: impl Into<String>) -> Self {
        Self { exit_code: 1, ..Self::bad_input(message) }
    }

    /// Something cannot be read: the user's input is wrong where a name or a permission stands in the way, but not where the disk is
    /// broken.
    pub fn of_reading(error: ErrorKind, message: impl Into<String>) -> Self {
        match error {
            ErrorKind::PermissionDenied | ErrorKind::FileTooLarge => Self::bad_input(message),
            error => Self::of_writing(error, message),
        }
    }

    /// Something cannot be written: the user's input is wrong where a name is, but not where the place is closed to the user, or
    /// the disk full or broken.
    pub fn of_writing(error: ErrorKind, message: impl Into<String>) -> Self {
        use ErrorKind::{InvalidFilename, InvalidInput, IsADirectory, NotADirectory, NotFound};

        match error {
            InvalidFilename | InvalidInput | IsADirectory | NotADirectory | NotFound => {
                Self::bad_input(message)
            }
            _ => Self::failed(message),
        }
    }

    /// Returns the failure with advice.
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

impl From<ReadScenarioError> for Failure {
    fn from(error: ReadScenarioError) -> Self {
        Self::of_file(FileKind::Scenario, error)
    }
}

impl Failure {
    /// A file that could not be read.
    ///
    /// # Arguments
    /// * `kind` - what it should be
    /// * `error` - what is wrong
    pub fn of_file(kind: FileKind, error: ReadScenarioError) -> Self {
        match error {
            ReadScenarioError::Unreadable { path, source } => {
                let shown = path.display();
                let failure = match source.kind() {
                    ErrorKind::NotFound => {
                        let it = if kind == FileKind::Tuned { "it" } else { "one to start from" };
                        Self::bad_input(format!("there is no {} {shown}", noun(kind)))
                            .with_help(format!("check the name; `{}` writes {it}", kind.writer()))
                    }
                    ErrorKind::IsADirectory => {
                        Self::bad_input(format!("{shown} is a directory; must be a file"))
                    }
                    other => Self::of_reading(other, format!("cannot read {shown}: {source}")),
                };
                or_other_kind(&path, kind.in_words(), failure)
            }
            ReadScenarioError::NotText { ref path, .. } => {
                let failure = Self::bad_input(error.to_string())
                    .with_help("a scenario is a text file; save it in UTF-8, as every editor can");
                or_other_kind(path, kind.in_words(), failure)
            }
            // The error about a text says already what kind it is.
            ReadScenarioError::Invalid { path, text, error } => {
                let file = path.display().to_string();
                let message = format!("{file}: {error}");
                let snippet = error.line.map(|line| Snippet { text, line });
                Self { help: error.help, snippet, ..Self::bad_input(message) }
            }
        }
    }
}

/// Name of a file of a kind.
fn noun(kind: FileKind) -> &'static str {
    match kind {
        FileKind::Scenario => "scenario file",
        FileKind::Plan => "plan",
        FileKind::Experiment => "experiment",
        FileKind::Tuned => "file",
    }
}

impl From<WriteFileError> for Failure {
    fn from(error: WriteFileError) -> Self {
        Self::of_writing(error.source.kind(), error.to_string())
    }
}

impl From<ReadResultsError> for Failure {
    fn from(error: ReadResultsError) -> Self {
        match &error {
            ReadResultsError::Unreadable { path, source } if source.kind() == ErrorKind::NotFound => {
                Self::bad_input(format!("there is no file {}", path.display()))
                    .with_help("name the directory that `meshtone simulate` wrote its results to")
            }
            ReadResultsError::Unreadable { source, .. } => Self::of_reading(source.kind(), error.to_string()),
            ReadResultsError::Foreign { .. } => Self::bad_input(error.to_string())
                .with_help("simulate again with this version: `meshtone simulate SCENARIO.toml -o DIR`"),
        }
    }
}

impl From<DatasetError> for Failure {
    fn from(error: DatasetError) -> Self {
        let message = error.to_string();
        match error {
            DatasetError::Plan(error) => Self::of_file(FileKind::Plan, error),
            DatasetError::Refused { problem, help } => Self::bad_input(problem).with_help(help),
            DatasetError::File { doing: "read", source, .. } => Self::of_reading(source.kind(), message),
            DatasetError::File { source, .. } => Self::of_writing(source.kind(), message).with_help(
                "what is complete is kept: correct the cause and run the same command again to continue",
            ),
            DatasetError::NoRecord { .. } => Self::bad_input(message).with_help(
                "narrow what the plan varies, or add a constraint, so that records can be simulated",
            ),
            DatasetError::Busy { .. } => {
                Self::failed(message).with_help("wait until it has ended, or name another directory with -o")
            }
            DatasetError::Preview(_) | DatasetError::Stopped => Self::failed(message),
        }
    }
}
