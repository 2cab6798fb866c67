//! Checks of a scenario before any result is written.

use meshtone::Stages;
use meshtone::scenario::{Scenario, ScenarioError, ScenarioWarning};
use meshtone_io::memory;

/// Checks a scenario as far as that is possible without integrating in time: its values, the memory that it
/// needs, and whether the faults fit their teeth.
///
/// Returns what deserves attention, and the stages that were computed to know it.
pub fn check(scenario: impl Into<Scenario>) -> Result<(Vec<ScenarioWarning>, Stages), ScenarioError> {
    let (stages, warnings) = meshtone::stages_and_warnings(scenario, memory::limit())?;
    Ok((warnings, stages))
}
