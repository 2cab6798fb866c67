//! Rules that many keys share.

use super::super::ScenarioError;

pub(super) type Check = Result<(), ScenarioError>;

/// An error about a number.
pub(super) fn refuse(key: &str, value: f64, problem: impl Into<String>) -> ScenarioError {
    ScenarioError::new(key, format!("{value:?}"), problem)
}

/// Passes where `holds`; a number that is not finite never does.
pub(super) fn require(key: &str, value: f64, holds: bool, problem: impl Into<String>) -> Check {
    finite(key, value)?;
    if holds { Ok(()) } else { Err(refuse(key, value, problem)) }
}

pub(super) fn finite(key: &str, value: f64) -> Check {
    if value.is_finite() { Ok(()) } else { Err(refuse(key, value, "must be a finite number")) }
}

pub(super) fn positive(key: &str, value: f64, unit: &str) -> Check {
    require(key, value, value > 0.0, format!("must be more than 0 {unit}").trim_end())
}

pub(super) fn not_negative(key: &str, value: f64, unit: &str) -> Check {
    require(key, value, value >= 0.0, format!("must be 0 {unit} or more").replace("  ", " "))
}

/// Positive, and not so large that it can only be a slip of the pen or of the unit.
pub(super) fn positive_up_to(key: &str, value: f64, largest: f64, unit: &str) -> Check {
    positive(key, value, unit)?;
    require(key, value, value <= largest, format!("must be at most {largest} {unit}"))
        .map_err(|error| error.with_help(format!("check the unit: it is {unit}")))
}

/// From 0 to less than `limit`, which is `limit_is`.
pub(super) fn below(key: &str, value: f64, limit: f64, limit_is: &str) -> Check {
    not_negative(key, value, "mm")?;
    require(key, value, value < limit, format!("must be less than {limit:.4} mm, {limit_is}"))
}
