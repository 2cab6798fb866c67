//! Errors of the hybrid stage.

use thiserror::Error;

use crate::error::{Error, ScenarioError};
use crate::signal::SignalError;

/// Why a signal cannot be enhanced, or a simulation not be tuned.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum HybridError {
    /// A parameter is out of its range.
    #[error("{name} is {value}, but must be {allowed}")]
    Parameter {
        /// Its name.
        name: String,
        /// The given value.
        value: String,
        /// The allowed values.
        allowed: String,
    },
    /// A cycle is too short to be interpolated.
    #[error("{what} has {values} values, but needs 4 or more")]
    TooShort {
        /// Name of the cycle.
        what: &'static str,
        /// Its length.
        values: usize,
    },
    /// The wheel over whose revolutions signals are averaged is none of the machine's.
    #[error("signal.wheel: there is no wheel `{wheel}`; it must be one of {known}")]
    NoSuchWheel {
        /// Its name.
        wheel: String,
        /// The names of those that there are.
        known: String,
    },
    /// A planetary set, whose wheels pass the sensor or turn about moving axes.
    #[error("the scenario has a planetary set; tuning is of pairs and of gearboxes without one")]
    Planetary,
    /// A value is not a finite number.
    #[error("value {index} of {what} is not a finite number")]
    NotANumber {
        /// Name of the cycle.
        what: &'static str,
        /// Place of the value, from 0 on.
        index: usize,
    },
    /// A cycle is not as long as the healthy one.
    #[error(
        "a cycle of {signal} values cannot be compared with a healthy one of {healthy}; resample them alike"
    )]
    LengthMismatch {
        /// Length of the cycle.
        signal: usize,
        /// Length of the healthy one.
        healthy: usize,
    },
    /// A signal without shape.
    #[error("a signal is constant, so it has no {indicator}")]
    Constant {
        /// The requested indicator.
        indicator: &'static str,
    },
    /// Nothing to tune by.
    #[error("no indicator is given; name at least one")]
    NoIndicator,
    /// A case without measurements.
    #[error(
        "case {case} has no measured {indicator}; every case needs at least one record of every indicator"
    )]
    NoRecords {
        /// Number of the case, the healthy one is 0.
        case: usize,
        /// Name of the indicator.
        indicator: &'static str,
    },
    /// A measured value is not a finite number.
    #[error("record {record} of {indicator} in case {case} is not a finite number")]
    RecordNotANumber {
        /// Number of the case, the healthy one is 0.
        case: usize,
        /// Name of the indicator.
        indicator: &'static str,
        /// Number of the record, from 0 on.
        record: usize,
    },
    /// Errors are measured by the scatter of the records, and there is none.
    #[error("all records of {indicator} are equal, so an error has no scale; leave the indicator out")]
    NoScatter {
        /// Name of the indicator.
        indicator: &'static str,
    },
    /// Fewer than two cases, or not as many as were measured.
    #[error(
        "{simulated} simulated cases cannot be compared with {measured} measured ones; there must be as many, two or more, the healthy one first"
    )]
    Cases {
        /// Simulated.
        simulated: usize,
        /// Measured.
        measured: usize,
    },
    /// No parameters within the bounds give an error that is a number.
    #[error("no parameters within the ranges give an error that is a number; widen the ranges")]
    NoFit,
    /// The first case is healthy, all others are faulty.
    #[error("case {case} ({label}) {}", if *case == 0 { "has a fault, but the first case must be the healthy one" } else { "has no fault, but only the first case can be the healthy one" })]
    HealthyCase {
        /// Its number.
        case: usize,
        /// Its name.
        label: String,
    },
    /// A tuned key is not in any scenario.
    #[error(
        "no case has a number at the key {key}; one that is left out of the scenario must be stated there"
    )]
    NoSuchKey {
        /// The key.
        key: String,
    },
    /// A tuned key is given twice.
    #[error("the key {key} is given twice")]
    KeyTwice {
        /// The key.
        key: String,
    },
    /// A tuned key has no effect.
    #[error(
        "the key {key} has no effect on any case under the scenario's model, so it cannot be tuned; remove it, or set model = \"linear\""
    )]
    IgnoredKey {
        /// The key.
        key: String,
    },
    /// No candidates, or too many.
    #[error("{candidates} candidates; must be a whole number from 1 to {most}")]
    Candidates {
        /// The number.
        candidates: usize,
        /// The largest number allowed.
        most: usize,
    },
    /// None of the combinations of the keys' values could be simulated.
    #[error("none of the tried values of the keys can be simulated; the first failure was: {first_failure}")]
    NoCandidate {
        /// Why.
        first_failure: String,
    },
    /// The caller stopped it.
    #[error("stopped before the end")]
    Cancelled,
    /// A scenario cannot be simulated.
    #[error(transparent)]
    Simulation(#[from] Error),
    /// The signal chain refuses.
    #[error(transparent)]
    Signal(#[from] SignalError),
}

impl HybridError {
    /// A parameter that is out of its range.
    pub(super) fn parameter(name: &str, value: f64, allowed: &str) -> Self {
        Self::Parameter { name: name.into(), value: format!("{value}"), allowed: allowed.into() }
    }
}

impl From<ScenarioError> for HybridError {
    fn from(error: ScenarioError) -> Self {
        Self::Simulation(error.into())
    }
}
