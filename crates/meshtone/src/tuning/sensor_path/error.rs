//! Errors of the estimate of a path.

use std::ops::RangeInclusive;

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
    /// The path is a ratio of accelerations.
    #[error(
        "sensor.response_input is \"force\", but the path that is estimated is a ratio of accelerations; remove response_input"
    )]
    ResponseToForce,
    /// Ideal wheels have no sidebands, and no draw differs from another.
    #[error(
        "quality.din_grade and quality.iso_class are 0, those of ideal wheels; one of them must be the wheels' own grade, by which they \
         are drawn"
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
    /// A recording's rate shows no mesh harmonic.
    #[error(
        "recording {recording} has {rate_hz} samples a second; must have at least {needed_hz:.0} at this speed"
    )]
    LowRate {
        /// Its number, from 1.
        recording: usize,
        /// (S/s) Its rate.
        rate_hz: f64,
        /// (S/s) The least rate.
        needed_hz: f64,
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
