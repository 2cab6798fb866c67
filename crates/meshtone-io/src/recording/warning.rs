//! What is doubtful about a file.

use thiserror::Error;

/// Something about a file that was read, but that its user should know.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum RecordingWarning {
    /// The last line of a text file has no end, and its last number is not written like those above it: the file may be cut
    /// off within that number.
    #[error(
        "line {line}, the last, has no end of line, and its last cell, `{text}` in column {column}, is not written like those \
         above: the file may be cut off there; compare it with the original, or remove the line"
    )]
    MayBeCut {
        /// The line, counted from 1.
        line: u64,
        /// The last column.
        column: String,
        /// The cell.
        text: String,
    },
}
