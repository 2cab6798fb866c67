//! Errors of the estimate of a path.

use thiserror::Error;

use crate::error::{Error, ScenarioError};
use crate::signal::SignalError;

/// Why a path cannot be estimated.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum PathError {
    /// Nothing to compare.
    #[error("no recording is given; give at least one of the healthy machine")]
    NoRecording,
    /// The scatter of so few draws is not known.
    #[error("{draws} draws of the wheels; must be at least 8, whose scatter says how sure the path is")]
    TooFewDraws {
        /// The number.
        draws: usize,
    },
    /// Ideal wheels have no sidebands, and no draw differs from another.
    #[error(
        "quality.din_grade is 0, that of ideal wheels; must be the wheels' own grade, by which they are drawn"
    )]
    IdealWheels,
    /// A recording is too short.
    #[error(
        "recording {recording} has {recording_s:.3} s with a known angle of the shaft; must have at least {needed_s:.3} s at this speed"
    )]
    TooShort {
        /// Its number, from 1.
        recording: usize,
        /// (s) Its length.
        recording_s: f64,
        /// (s) The least length.
        needed_s: f64,
    },
    /// A recording contradicts what is stated about it.
    #[error("recording {recording} does not fit the scenario: {reason}")]
    DoesNotFit {
        /// Its number, from 1.
        recording: usize,
        /// Why.
        reason: String,
    },
    /// Nothing stands out of the noise.
    #[error("the recordings show nothing of the mesh above their noise")]
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
    /// A scenario cannot be simulated.
    #[error(transparent)]
    Scenario(Box<ScenarioError>),
    /// A simulation fails.
    #[error(transparent)]
    Simulation(Error),
    /// The signal chain refuses.
    #[error(transparent)]
    Signal(#[from] SignalError),
}

impl From<Error> for PathError {
    fn from(error: Error) -> Self {
        match error {
            Error::Scenario(error) => Self::Scenario(Box::new(error)),
            error => Self::Simulation(error),
        }
    }
}
