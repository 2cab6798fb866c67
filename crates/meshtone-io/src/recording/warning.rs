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
    /// Of two arrays of one name one is 0 throughout, and the other was read.
    #[error(
        "the file has `{name}` more than once; as column {number} it is 0 throughout and left out: choose it by that number"
    )]
    ZeroTwin {
        /// The name.
        name: String,
        /// The column that was left out, counted from 1.
        number: usize,
    },
}
