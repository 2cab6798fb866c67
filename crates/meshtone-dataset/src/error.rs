//! What can go wrong.

use std::io;

use meshtone_io::scenario_file::ReadScenarioError;

use crate::shard::FailedRecord;

/// A data set that could not be made, or not to its end.
#[derive(Debug, thiserror::Error)]
pub enum DatasetError {
    /// The plan is wrong.
    #[error(transparent)]
    Plan(#[from] ReadScenarioError),
    /// Something about the place to write to, or about what was asked for, stands in the way.
    #[error("{problem}")]
    Refused {
        /// What.
        problem: String,
        /// What to do about it.
        help: String,
    },
    /// Something cannot be read or written.
    #[error("cannot {doing} {name}: {source}")]
    File {
        /// `read` or `write`.
        doing: &'static str,
        /// What.
        name: String,
        /// Why.
        source: io::Error,
    },
    /// Another program does the same in the same place.
    #[error("another program {doing} {place}")]
    Busy {
        /// What it does.
        doing: String,
        /// Where.
        place: String,
    },
    /// No record of the plan could be simulated.
    #[error("none of the plan's {records} records could be simulated; record {}: {}", first.record, first.reason)]
    NoRecord {
        /// Number of the records.
        records: u64,
        /// One of those that failed.
        first: FailedRecord,
    },
    /// The preview cannot be drawn.
    #[error("cannot draw the preview: {0}")]
    Preview(#[from] meshtone_plot::PlotError),
    /// It was stopped.
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
