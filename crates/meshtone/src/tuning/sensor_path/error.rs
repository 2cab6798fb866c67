//! Errors of the estimate of a path.

use std::ops::RangeInclusive;

use thiserror::Error;

use crate::error::{Error, ScenarioError};
use crate::signal::{SignalError, SignalWarning};

/// Why a path cannot be estimated.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum PathError {
    /// Nothing to compare.
    #[error("no recording is given; give at least one of the healthy machine")]
    NoRecording,
    /// The scatter of few draws is not known, and many tell no more.
    #[error(
        "{draws} draws of the wheels; must be {} to {}, whose scatter says how sure the path is",
        allowed.start(), allowed.end()
    )]
    Draws {
        /// The number.
        draws: usize,
        /// The numbers that are allowed.
        allowed: RangeInclusive<usize>,
    },
    /// One of the recordings does not serve.
    #[error("recording {} {problem}", index + 1)]
    Recording {
        /// Its place in the list, from 0.
        index: usize,
        /// What is wrong with it.
        problem: RecordingProblem,
    },
    /// Nothing stands out of the noise.
    #[error("the recordings show no mesh vibration above their noise")]
    OnlyNoise,
    /// No path explains the recordings.
    #[error(
        "the recordings are unlike the healthy machine behind any path: mesh harmonics, sidebands and remainder differ {:.1} times as much \
         as draws of the wheels do (at most {:.1}); is the machine healthy, and are speed, load, teeth and quality.din_grade those \
         of the scenario?",
        misfit.sqrt(), most.sqrt()
    )]
    UnlikeSimulations {
        /// (-) Mean square of the difference over what draws explain.
        misfit: f64,
        /// (-) The most that is taken.
        most: f64,
    },
    /// The equations of the path have no solution.
    #[error("the path cannot be solved for; are the recordings of one sensor?")]
    NotSolved,
    /// The caller stopped it.
    #[error("stopped before the end")]
    Cancelled,
    /// The scenario cannot be simulated, or does not serve for an estimate.
    #[error(transparent)]
    Simulation(#[from] Error),
}

impl From<ScenarioError> for PathError {
    fn from(error: ScenarioError) -> Self {
        Self::Simulation(error.into())
    }
}

/// Why a recording does not serve to estimate a path; each text goes on where the recording was named.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum RecordingProblem {
    /// It is too short.
    #[error(
        "has {recording_s:.3} s with a known angle of the shaft; must have at least {needed_s:.3} s at this speed"
    )]
    TooShort {
        /// (s) Its length.
        recording_s: f64,
        /// (s) The least length.
        needed_s: f64,
    },
    /// Its rate shows no mesh harmonic.
    #[error("has {rate_hz} samples a second; must have at least {needed_hz:.0} at this speed")]
    LowRate {
        /// (S/s) Its rate.
        rate_hz: f64,
        /// (S/s) The least rate.
        needed_hz: f64,
    },
    /// Its phase is of a shaft that the machine does not have.
    #[error("has the phase of shaft {shaft}, counted from 0, but the machine has {shafts} shafts")]
    NoSuchShaft {
        /// The number.
        shaft: usize,
        /// How many there are.
        shafts: usize,
    },
    /// It contradicts what is stated about it, or shows strong tones of something else.
    #[error("does not fit the scenario: {0}")]
    DoesNotFit(Box<SignalWarning>),
    /// The signal chain refuses it.
    #[error("cannot be used: {0}")]
    Signal(#[from] SignalError),
}
