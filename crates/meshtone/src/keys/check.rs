//! Rules about values.

use crate::error::ScenarioError;

/// Passes, or says what is wrong.
pub(crate) type Check = Result<(), ScenarioError>;

/// An error about a number.
pub(crate) fn refuse(key: &str, value: f64, problem: impl Into<String>) -> ScenarioError {
    ScenarioError::new(key, format!("{value:?}"), problem)
}

/// Passes where `holds`.
pub(crate) fn require(key: &str, value: f64, holds: bool, problem: impl Into<String>) -> Check {
    if holds { Ok(()) } else { Err(refuse(key, value, problem)) }
}

/// Less than `limit`, which is `limit_is`.
pub(crate) fn below(key: &str, value: f64, limit_mm: f64, limit_is: &str) -> Check {
    require(key, value, value < limit_mm, format!("must be less than {limit_mm:.4} mm, {limit_is}"))
}
