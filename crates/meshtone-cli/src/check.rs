//! What is checked of a scenario before any result is written.

use meshtone::scenario::{MEMORY_LIMIT_BYTES, Scenario, ScenarioError, ScenarioWarning};

use crate::memory;

const GIBIBYTE: f64 = (1u64 << 30) as f64;

/// Checks a scenario as far as that is possible without integrating in time: its values, the memory that it
/// needs, and whether the fault fits the tooth.
///
/// Returns what deserves attention.
pub fn check(scenario: &Scenario) -> Result<Vec<ScenarioWarning>, ScenarioError> {
    let mut warnings = scenario.validate()?;
    fits_into_memory(scenario)?;
    let stages = meshtone::stages(scenario)?;
    if stages.time.kept_samples() == 0 {
        return Err(nothing_is_kept(&stages.scenario));
    }
    warnings.extend(scenario.ignored_by_convention());
    warnings.extend(stages.warnings());
    Ok(warnings)
}

fn fits_into_memory(scenario: &Scenario) -> Result<(), ScenarioError> {
    let Some(available) = memory::available_bytes() else {
        return Ok(());
    };
    match scenario.validate_within(available.min(MEMORY_LIMIT_BYTES)) {
        Ok(_) => Ok(()),
        Err(error) => Err(error.with_help(format!(
            "only {:.1} GiB of memory are free on this machine; lower solver.sampling_rate_hz or raise \
             operation.pinion_speed_hz",
            available as f64 / GIBIBYTE
        ))),
    }
}

fn nothing_is_kept(scenario: &Scenario) -> ScenarioError {
    let settle = scenario.solver.settle_fraction;
    let problem = "leaves no sample to keep; must be smaller";
    ScenarioError::new("solver.settle_fraction", format!("{settle:?}"), problem)
}
