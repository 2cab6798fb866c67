//! Errors of data sets.

use std::io;

use meshtone_io::scenario_file::ReadScenarioError;

use crate::shard::FailedRecord;

/// The reason why a data set could not be made or read.
#[derive(Debug, thiserror::Error)]
pub enum DatasetError {
    /// The plan is wrong.
    #[error(transparent)]
    Plan(#[from] ReadScenarioError),
    /// The place to write to, or what was asked for, is not acceptable.
    #[error("{problem}")]
    Refused {
        /// The problem.
        problem: String,
        /// What to do about it.
        help: String,
    },
    /// A file cannot be read or written.
    #[error("cannot {doing} {name}: {source}")]
    File {
        /// `read` or `write`.
        doing: &'static str,
        /// Name of the file.
        name: String,
        /// The system's error.
        source: io::Error,
    },
    /// Another program is doing the same in the same place.
    #[error("another program {doing} {place}")]
    Busy {
        /// This says what the other program is doing.
        doing: String,
        /// The place.
        place: String,
    },
    /// No record of the plan could be simulated.
    #[error("none of the plan's {records} records could be simulated; record {}: {}", first.record, first.reason)]
    NoRecord {
        /// Number of records of the plan.
        records: u64,
        /// The first record that failed.
        first: FailedRecord,
    },
    /// The preview cannot be drawn.
    #[error("cannot draw the preview: {0}")]
    Preview(#[from] meshtone_plot::PlotError),
    /// The user stopped the run.
    #[error("stopped")]
    Stopped,
}

impl DatasetError {
    pub(crate) fn refused(problem: impl Into<String>, help: impl Into<String>) -> Self {
        Self::Refused { problem: problem.into(), help: help.into() }
    }

    pub(crate) fn read(name: impl Into<String>) -> impl FnOnce(io::Error) -> Self {
        let name = name.into();
        move |source| Self::File { doing: "read", name, source }
    }

    pub(crate) fn write(name: impl Into<String>) -> impl FnOnce(io::Error) -> Self {
        let name = name.into();
        move |source| Self::File { doing: "write", name, source }
    }
}
