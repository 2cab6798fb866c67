//! Limits of the duration of a simulation.

use super::super::{Scenario, ScenarioError};
use crate::keys::{Check, require};

/// A speed profile sets the duration, which must outlast what is discarded.
pub(super) fn check(scenario: &Scenario) -> Check {
    let operation = &scenario.operation;
    let Some(end) = operation.speed_profile_hz.as_ref().and_then(|profile| profile.time_s.last()) else {
        return Ok(());
    };
    let revolutions = f64::from(crate::operation::nominal_revolutions(scenario.gears.gear_teeth));
    let settling = scenario.solver.settle_fraction * revolutions / operation.pinion_speed_hz;
    let problem =
        format!("the profile ends at {end:?} s, within the first {settling:.4} s, which are discarded");
    require("operation.speed_profile_hz", *end, *end > settling, problem).map_err(|error: ScenarioError| {
        error.with_help("lengthen the profile, or lower solver.settle_fraction")
    })
}
