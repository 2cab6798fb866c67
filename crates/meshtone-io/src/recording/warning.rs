//! What is doubtful about a file.

use thiserror::Error;

use super::time::readable;

/// Times as far apart as on average that samples are at uneven times.
const UNEVEN: f64 = 1.5;

/// Something about a file that was read, but that its user should know.
#[derive(Debug, Clone, PartialEq, Error)]
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
    /// The last segment of a TDMS file has no end, as its recorder broke off.
    #[error(
        "the recorder broke off while it wrote the file: what had not been written is missing, and of its last block up to {samples} \
         samples a channel are left out"
    )]
    BrokenOff {
        /// Samples of the channel that has most of them in the block.
        samples: u64,
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
    /// A channel has another rate than the others, and was brought to theirs.
    #[error(
        "{name} was recorded at {own_hz} S/s{} and is interpolated to {rate_hz} S/s, which is right for a speed or a torque; read a \
         vibration by itself",
        unevenly(*own_hz, *apart_s)
    )]
    Interpolated {
        /// The channel.
        name: String,
        /// (S/s) The rate at which it was recorded, or its mean.
        own_hz: f64,
        /// (s) The longest time from one of its samples to the next.
        apart_s: f64,
        /// (S/s) That of the recording.
        rate_hz: f64,
    },
    /// The rate that the options state is not the file's.
    #[error(
        "the sampling rate is stated as {stated_hz} S/s, but {by} says {own_hz} S/s: the stated one counts"
    )]
    OtherRate {
        /// (S/s) The rate of the options.
        stated_hz: f64,
        /// (S/s) That of the file.
        own_hz: f64,
        /// What of the file says it.
        by: String,
    },
    /// A column counts the samples.
    #[error("column {name} counts the samples and is left out")]
    Counter {
        /// The column.
        name: String,
    },
    /// A channel has the samples of another.
    #[error(
        "{name} has the samples of {of}: one input may have been recorded twice; check the cables and the recorder's channels"
    )]
    Copy {
        /// The channel.
        name: String,
        /// The one before it.
        of: String,
    },
}

/// Words where samples are much further apart than on average.
fn unevenly(own_hz: f64, apart_s: f64) -> String {
    if apart_s * own_hz < UNEVEN {
        return String::new();
    }
    format!(" on average, with up to {} s from one sample to the next,", readable(apart_s))
}

impl RecordingWarning {
    /// The name of what it is about, for programs to distinguish.
    pub fn code(&self) -> &'static str {
        match self {
            Self::MayBeCut { .. } => "may-be-cut",
            Self::BrokenOff { .. } => "broken-off",
            Self::ZeroTwin { .. } => "zero-twin",
            Self::Interpolated { .. } => "interpolated",
            Self::OtherRate { .. } => "other-rate",
            Self::Counter { .. } => "counter",
            Self::Copy { .. } => "copied-channel",
        }
    }
}
