//! What is checked of a scenario before any result is written.

use meshtone::Stages;
use meshtone::scenario::{Scenario, ScenarioError, ScenarioWarning};

use crate::memory;

/// Checks a scenario as far as that is possible without integrating in time: its values, the memory that it
/// needs, and whether the faults fit their teeth.
///
/// Returns what deserves attention, and the stages that were computed to know it.
pub fn check(scenario: &Scenario) -> Result<(Vec<ScenarioWarning>, Stages), ScenarioError> {
    let mut warnings = scenario.validate_within(memory::limit())?;
    let stages = meshtone::stages(scenario)?;
    if stages.time.kept_samples() == 0 {
        return Err(nothing_is_kept(&stages.scenario));
    }
    warnings.extend(scenario.ignored_by_model());
    warnings.extend(stages.warnings());
    Ok((warnings, stages))
}

fn nothing_is_kept(scenario: &Scenario) -> ScenarioError {
    let settle = scenario.solver.settle_fraction;
    let problem = "leaves no sample to keep; must be smaller";
    ScenarioError::new("solver.settle_fraction", format!("{settle:?}"), problem)
}
