//! The same gears without damage, to compare with.

use meshtone::scenario::Scenario;
use meshtone::signal::IndicatorValue;
use meshtone::wheel::WheelName;
use serde_json::Value;

use super::wheel_signals::indicators_json;
use super::{AnswerOptions, wheel_signals};
use crate::question::memory_limit;
use crate::refusal::Refusal;

/// Indicators of the pinion and of the gear without damage.
pub type HealthyIndicators = [Vec<IndicatorValue>; 2];

/// Indicators without damage as JSON.
pub fn healthy_json(healthy: &HealthyIndicators) -> Value {
    healthy.iter().map(|wheel| indicators_json(wheel)).collect()
}

/// Indicators of the same gears, on the same rig and under the same load, without damage.
///
/// # Arguments
/// * `scenario`, `options`, `is_wanted` - as for [`super::answer`]
///
/// # Errors
/// As [`super::answer`].
pub fn healthy_indicators(
    scenario: &Scenario,
    options: &AnswerOptions,
    is_wanted: &dyn Fn() -> bool,
) -> Result<HealthyIndicators, Refusal> {
    let healthy = options.detail.of(scenario).with_faults(Vec::new());
    let stages = meshtone::stages_within(&healthy, memory_limit())?;
    let simulation = stages.simulate_while(is_wanted)?.ok_or(Refusal::Superseded)?;
    let (signal, of_wheel) = wheel_signals(&simulation, options.channel.as_deref());
    Ok(WheelName::BOTH.map(|shaft| of_wheel(shaft).indicators(simulation.channels.signals[signal].unit)))
}
