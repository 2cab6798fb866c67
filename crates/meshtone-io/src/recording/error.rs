//! Recordings that could not be read.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// Names of a list that a message shows; the others are counted.
const NAMES_SHOWN: usize = 30;

/// A place in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Position {
    /// A line of a text file, counted from 1.
    Line(u64),
    /// A sample of a channel, counted from 1.
    Sample(u64),
}

impl fmt::Display for Position {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Position::Line(line) => write!(to, "line {line}"),
            Position::Sample(sample) => write!(to, "sample {sample}"),
        }
    }
}

/// A recording that could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadRecordingError {
    /// The file cannot be opened or read.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why it cannot be read.
        source: io::Error,
    },
    /// An option is impossible.
    #[error("{problem}")]
    Option {
        /// What is wrong, and what is allowed.
        problem: String,
    },
    /// Neither the first bytes nor the ending of the file belong to a format that is read.
    #[error(
        "{}: is of no format that is known here ({found}); known are CSV, TSV and other separated text (.csv, .tsv, .txt, .dat, \
         .asc), Parquet (.parquet), NumPy (.npy, .npz), MATLAB version 5 to 7 (.mat) and WAV (.wav)",
        path.display()
    )]
    UnknownFormat {
        /// The file.
        path: PathBuf,
        /// What its ending and first bytes are.
        found: String,
    },
    /// The file is of a known format that has to be converted.
    #[error("{}: is {what}, which is not read; {how}", path.display())]
    Convert {
        /// The file.
        path: PathBuf,
        /// What the file is.
        what: String,
        /// How to convert it.
        how: String,
    },
    /// There is nothing in the file, or nothing but names.
    #[error("{}: {problem}", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
        /// What is missing.
        problem: String,
    },
    /// The file is cut off, or is not what its format prescribes.
    #[error("{}: is not a whole {format} file: {problem}", path.display())]
    Broken {
        /// The file.
        path: PathBuf,
        /// The format.
        format: &'static str,
        /// What is wrong, and where.
        problem: String,
    },
    /// A cell of a text file that is no number.
    #[error("{}: {position}, column {column}: `{text}` is no number; {help}", path.display())]
    NotANumber {
        /// The file.
        path: PathBuf,
        /// The line.
        position: Position,
        /// The column.
        column: String,
        /// The cell.
        text: String,
        /// What to do.
        help: String,
    },
    /// A sample that is missing, or not finite.
    #[error(
        "{}: {position} of column {column} is {what}; every sample must be a finite number: cut the recording there, fill \
         the gap, or choose other columns (option channels)",
        path.display()
    )]
    Gap {
        /// The file.
        path: PathBuf,
        /// The line or sample.
        position: Position,
        /// The column.
        column: String,
        /// What stands there: empty, NaN, null, infinite.
        what: String,
    },
    /// A line of a text file with more or fewer cells than the others.
    #[error("{}: line {line} has {found} cells, but the lines above it have {expected}; {help}", path.display())]
    Ragged {
        /// The file.
        path: PathBuf,
        /// The line, counted from 1.
        line: u64,
        /// Its cells.
        found: usize,
        /// Cells of the others.
        expected: usize,
        /// What to do.
        help: String,
    },
    /// A column that does not exist.
    #[error("{}: has no column {wanted}{}; it has {}", path.display(), did_you_mean(nearest), names(present))]
    NoColumn {
        /// The file.
        path: PathBuf,
        /// What was asked for.
        wanted: String,
        /// The name that was probably meant.
        nearest: Option<String>,
        /// The columns of the file.
        present: Vec<String>,
    },
    /// A name that several columns have, a column that was chosen twice, or a text that can be read in two ways.
    #[error("{}: {problem}{}", path.display(), it_has(present))]
    Ambiguous {
        /// The file.
        path: PathBuf,
        /// What is ambiguous, and what to do.
        problem: String,
        /// The columns of the file, where they are known.
        present: Vec<String>,
    },
    /// A column that holds no numbers.
    #[error("{}: column {column} holds {kind}; must be real numbers", path.display())]
    NotNumeric {
        /// The file.
        path: PathBuf,
        /// The column.
        column: String,
        /// What it holds.
        kind: String,
    },
    /// A variable that does not exist, or holds no array of numbers.
    #[error("{}: has no variable `{wanted}` that holds numbers{}; it has {}", path.display(), did_you_mean(nearest), names(present))]
    NoVariable {
        /// The file.
        path: PathBuf,
        /// What was asked for.
        wanted: String,
        /// The name that was probably meant.
        nearest: Option<String>,
        /// The variables of the file, each with its shape.
        present: Vec<String>,
    },
    /// Channels that are not equally long.
    #[error(
        "{}: the channels are not equally long; choose those that belong together (option channels, or variable): {}",
        path.display(), names(lengths)
    )]
    UnequalLengths {
        /// The file.
        path: PathBuf,
        /// Each channel with its length.
        lengths: Vec<String>,
    },
    /// Nothing says the sampling rate.
    #[error("{}: does not say its sampling rate{}", path.display(), without_rate(present))]
    NoRate {
        /// The file.
        path: PathBuf,
        /// The columns of the file.
        present: Vec<String>,
    },
    /// The samples would take more memory than is allowed.
    #[error(
        "{}: {problem}; choose fewer channels (option channels), cut the recording, or raise the memory limit",
        path.display()
    )]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// What would be needed, and what is allowed.
        problem: String,
    },
    /// The sampling rate that the file says cannot be used, or is said differently in two places.
    #[error("{}: {problem}; give the sampling rate (option sampling_rate_hz)", path.display())]
    Rate {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        problem: String,
    },
    /// The time column is not uniform.
    #[error(
        "{}: time column {column} is not uniform: from sample {from_sample} to the next it advances by {step_s} s, elsewhere \
         by {interval_s} s; the largest deviation from uniform time is {largest_deviation_s} s, at sample \
         {deviation_sample}; resample the recording, cut it at the gap, or, if the samples are uniform and only the \
         time column is not, give the sampling rate (option sampling_rate_hz)",
        path.display()
    )]
    NonUniformTime {
        /// The file.
        path: PathBuf,
        /// The time column.
        column: String,
        /// Sample before the step that differs most from the others, counted from 1.
        from_sample: u64,
        /// (s) That step.
        step_s: f64,
        /// (s) Median of all steps.
        interval_s: f64,
        /// (s) Largest distance of a time from the straight line through all.
        largest_deviation_s: f64,
        /// Where it is, counted from 1.
        deviation_sample: u64,
    },
    /// The time column does not tell the sampling rate.
    #[error("{}: time column {column} {problem}; give the sampling rate (option sampling_rate_hz)", path.display())]
    Time {
        /// The file.
        path: PathBuf,
        /// The time column.
        column: String,
        /// What is wrong.
        problem: String,
    },
}

fn did_you_mean(nearest: &Option<String>) -> String {
    nearest.as_ref().map(|name| format!(" (did you mean `{name}`?)")).unwrap_or_default()
}

fn it_has(present: &[String]) -> String {
    if present.is_empty() { String::new() } else { format!("; it has {}", names(present)) }
}

/// What to do where nothing says the sampling rate: a single column is hardly the time.
fn without_rate(present: &[String]) -> String {
    match present {
        [_] => ", and has one column alone; give the sampling rate (option sampling_rate_hz)".to_owned(),
        _ => format!(
            ", and no column is named as time; give the sampling rate (option sampling_rate_hz) or say which column holds the \
             time (option time); it has {}",
            names(present)
        ),
    }
}

/// A list in words, shortened where it is long.
fn names(present: &[String]) -> String {
    if present.is_empty() {
        return "none".to_string();
    }
    let shown = present[..present.len().min(NAMES_SHOWN)].join(", ");
    match present.len().saturating_sub(NAMES_SHOWN) {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}

pub(super) fn unreadable(path: &Path, source: io::Error) -> ReadRecordingError {
    ReadRecordingError::Unreadable { path: path.to_path_buf(), source }
}

pub(super) fn broken(path: &Path, format: &'static str, problem: impl fmt::Display) -> ReadRecordingError {
    ReadRecordingError::Broken { path: path.to_path_buf(), format, problem: problem.to_string() }
}

/// A failed read: the end of the file comes too early, or something that is not the file's fault.
pub(super) fn read_failed(path: &Path, format: &'static str, error: io::Error) -> ReadRecordingError {
    match error.kind() {
        io::ErrorKind::UnexpectedEof => broken(path, format, "it ends too early"),
        io::ErrorKind::InvalidData | io::ErrorKind::InvalidInput | io::ErrorKind::Other => {
            broken(path, format, error)
        }
        _ => unreadable(path, error),
    }
}
