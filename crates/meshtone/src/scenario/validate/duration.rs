//! Limits of the duration of a simulation.

use super::super::{Scenario, ScenarioError};
use crate::keys::Check;
use crate::operation::LengthKey;

/// The kept signal has one length, and it has samples.
pub(super) fn check(scenario: &Scenario) -> Check {
    if let (Some(_), Some(revolutions)) = (scenario.solver.duration_s, scenario.solver.pinion_revolutions) {
        let problem = "given beside solver.duration_s; the kept signal has one length";
        return Err(ScenarioError::new("solver.pinion_revolutions", revolutions, problem)
            .with_help("remove one of the two"));
    }
    check_profiles(scenario, "solver.pinion_revolutions")?;
    if scenario.time_grid().kept_samples() > 0 {
        return Ok(());
    }
    let LengthKey { name, value, change } = scenario.solver.length_key();
    Err(ScenarioError::new(format!("solver.{name}"), value, "leaves no sample to keep")
        .with_help(format!("{change} it, or raise solver.sampling_rate_hz")))
}

/// A length that is given agrees with the profiles.
///
/// # Arguments
/// * `of_revolutions` - key of the number of revolutions
pub(super) fn check_profiles(scenario: &Scenario, of_revolutions: &str) -> Check {
    let Scenario { operation, solver, .. } = scenario;
    if let Some(revolutions) = solver.pinion_revolutions {
        if operation.speed_profile_hz.is_some() {
            let problem = "given with operation.speed_profile_hz, whose speeds vary";
            return Err(ScenarioError::new(of_revolutions, revolutions, problem)
                .with_help("remove it: the profile is kept from its start to its end"));
        }
        operation.check_length(of_revolutions, revolutions, revolutions / operation.pinion_speed_hz)?;
    }
    solver
        .duration_s
        .map_or(Ok(()), |length_s| operation.check_length("solver.duration_s", length_s, length_s))
}
