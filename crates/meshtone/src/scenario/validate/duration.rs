//! Limits of the duration of a simulation.

use super::super::{Scenario, ScenarioError, Solver};
use crate::keys::Check;
use crate::operation::LengthKey;

/// The kept signal has one length, and it has samples.
pub(super) fn check(scenario: &Scenario) -> Check {
    let Solver { duration_s, pinion_revolutions, .. } = &scenario.solver;
    if let Some(revolutions) = pinion_revolutions {
        let refuse = |problem: &str, help: &str| {
            Err(ScenarioError::new("solver.pinion_revolutions", revolutions, problem).with_help(help))
        };
        if duration_s.is_some() {
            return refuse(
                "given beside solver.duration_s; the kept signal has one length",
                "remove one of the two",
            );
        }
        if scenario.operation.speed_profile_hz.is_some() {
            return refuse(
                "given with operation.speed_profile_hz, whose speeds vary",
                "remove it: the profile is kept from its start to its end",
            );
        }
        let kept_s = revolutions / scenario.operation.pinion_speed_hz;
        scenario.operation.check_length("solver.pinion_revolutions", *revolutions, kept_s)?;
    }
    if let Some(duration_s) = *duration_s {
        scenario.operation.check_length("solver.duration_s", duration_s, duration_s)?;
    }
    if scenario.time_grid().kept_samples() > 0 {
        return Ok(());
    }
    let LengthKey { name, value, change } = scenario.solver.length_key();
    Err(ScenarioError::new(format!("solver.{name}"), value, "leaves no sample to keep")
        .with_help(format!("{change} it, or raise solver.sampling_rate_hz")))
}
