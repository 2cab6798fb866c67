//! Checks of a scenario before any result is written.

use meshtone::scenario::{Scenario, ScenarioError, ScenarioForm, ScenarioWarning};
use meshtone::{Stages, gearbox_stages_within};
use meshtone_io::memory;

/// Checks a scenario as far as that is possible without integrating in time: its values, the memory that it
/// needs, and whether the faults fit their teeth.
///
/// Returns what deserves attention, and the stages that were computed to know it.
pub fn check(scenario: &Scenario) -> Result<(Vec<ScenarioWarning>, Stages), ScenarioError> {
    let (stages, warnings) = meshtone::stages_and_warnings(scenario, memory::limit())?;
    Ok((warnings, stages))
}

/// Does what [`check`] does of either form of a scenario, and returns what deserves attention.
pub fn check_form(scenario: &ScenarioForm) -> Result<Vec<ScenarioWarning>, ScenarioError> {
    match scenario {
        ScenarioForm::Pair(scenario) => check(scenario).map(|(warnings, _)| warnings),
        ScenarioForm::Gearbox(gearbox) => {
            gearbox_stages_within(gearbox, memory::limit()).map(|stages| stages.warnings())
        }
    }
}
