//! Recordings that could not be read.

use std::fmt::Display;
use std::io;
use std::path::{Path, PathBuf};

use zip::result::ZipError;

/// Names of a list that a message shows; the others are counted.
const NAMES_SHOWN: usize = 30;

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
    /// Neither the first bytes nor the ending of the file belong to a format that is read.
    #[error(
        "{}: has no known format ({found}); known are CSV, TSV and other separated text (.csv, .tsv, .txt, \
         .dat, .asc, .lvm), Parquet (.parquet), NumPy (.npy, .npz), MATLAB (.mat), HDF5 (.h5), WAV (.wav), \
         universal files (.uff), TDMS (.tdms), MDF 4 (.mf4) and Excel (.xlsx), also in gzip or ZIP",
        path.display()
    )]
    UnknownFormat {
        /// The file.
        path: PathBuf,
        /// What its ending and first bytes are.
        found: String,
    },
    /// The content of the file gives no recording: it is cut off, does not hold what the options choose, or is no signal of one
    /// constant sampling rate.
    #[error("{}: {problem}", path.display())]
    Refused {
        /// The file.
        path: PathBuf,
        /// What is wrong, where in the file, and what to do.
        problem: String,
    },
    /// An option is impossible.
    #[error("{problem}")]
    Option {
        /// What is wrong, and what is allowed.
        problem: String,
    },
}

/// Why a file gives no recording. Its path and format are added where the readers are called ([`Problem::of_file`]).
#[derive(Debug)]
pub(super) enum Problem {
    /// The file cannot be read, or ends too early.
    Io(io::Error),
    /// The file is cut off, or does not follow the rules of its format.
    Broken(String),
    /// The format of the file is not known.
    UnknownFormat(String),
    /// Nothing says the sampling rate.
    NoRate(String),
    /// The content is refused.
    Refused(String),
    /// An option is impossible.
    Option(String),
}

impl From<io::Error> for Problem {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl From<ZipError> for Problem {
    fn from(error: ZipError) -> Self {
        match error {
            ZipError::Io(error) => Self::Io(error),
            // Its table of contents stands at the end.
            other => Self::Broken(format!("{other}; is the file cut off?")),
        }
    }
}

/// What a message calls a column; one without a name is already called by its number.
pub(super) fn column_words(name: &str) -> String {
    if name.starts_with("column ") { name.to_owned() } else { format!("column {name}") }
}

impl Problem {
    /// The error of a file.
    ///
    /// # Arguments
    /// * `path` - the file
    /// * `format` - the name of its format
    pub(super) fn of_file(self, path: &Path, format: &str) -> ReadRecordingError {
        use io::ErrorKind::{InvalidData, InvalidInput, Other, UnexpectedEof};

        let path = path.to_path_buf();
        let broken = |problem: String| format!("is not a whole {format} file: {problem}");
        let problem = match self {
            Self::Io(error) => match error.kind() {
                UnexpectedEof => broken("it ends too early".to_owned()),
                InvalidData | InvalidInput | Other => broken(error.to_string()),
                _ => return ReadRecordingError::Unreadable { path, source: error },
            },
            Self::Broken(problem) => broken(problem),
            Self::UnknownFormat(found) => return ReadRecordingError::UnknownFormat { path, found },
            Self::NoRate(problem) | Self::Refused(problem) => problem,
            Self::Option(problem) => return ReadRecordingError::Option { problem },
        };
        ReadRecordingError::Refused { path, problem }
    }

    /// The problem; where nothing says the sampling rate, with numbers of the file that may be it.
    pub(super) fn with_numbers(self, numbers: &[String]) -> Self {
        match self {
            Self::NoRate(problem) if !numbers.is_empty() => {
                Self::NoRate(format!("{problem}; its single numbers are {}", names(numbers)))
            }
            other => other,
        }
    }

    pub(super) fn broken(problem: impl Display) -> Self {
        Self::Broken(problem.to_string())
    }

    /// A known format that must be converted.
    ///
    /// # Arguments
    /// * `what` - what the file is
    /// * `how` - how to convert it
    pub(super) fn convert(what: &str, how: &str) -> Self {
        Self::Refused(format!("is {what}, which is not read; {how}"))
    }

    /// A sample that is missing or not finite.
    ///
    /// # Arguments
    /// * `place` - its line or its number
    /// * `column` - the name of its column
    /// * `what` - what stands there
    pub(super) fn gap(place: String, column: &str, what: &str) -> Self {
        Self::Refused(format!(
            "{place} of {} is {what}; every sample must be a finite number: cut the recording there, fill the gap, or \
             choose other columns (option channels)",
            column_words(column)
        ))
    }

    /// A time column that does not give the sampling rate.
    pub(super) fn time(column: &str, problem: &str) -> Self {
        Self::rate(&format!("time column {column} {problem}"))
    }

    /// A stated sampling rate that cannot be used.
    pub(super) fn rate(problem: &str) -> Self {
        Self::Refused(format!("{problem}; give the sampling rate (option sampling_rate_hz)"))
    }

    /// A column or a variable that does not exist.
    ///
    /// # Arguments
    /// * `wanted` - what was asked for, in words
    /// * `nearest` - the name that was probably meant
    /// * `present` - the names that exist
    pub(super) fn absent(wanted: &str, nearest: Option<&str>, present: &[String]) -> Self {
        let nearest = nearest.map(|name| format!(" (did you mean `{name}`?)")).unwrap_or_default();
        Self::Refused(format!("has no {wanted}{nearest}; it has {}", names(present)))
    }
}

/// A list of names in words, shortened where it is long.
///
/// # Arguments
/// * `present` - the names
pub fn names(present: &[String]) -> String {
    if present.is_empty() {
        return "none".to_string();
    }
    let shown = present[..present.len().min(NAMES_SHOWN)].join(", ");
    match present.len().saturating_sub(NAMES_SHOWN) {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}
