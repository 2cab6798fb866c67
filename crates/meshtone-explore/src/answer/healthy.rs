//! The same gears without damage, to compare with.

use meshtone::scenario::Scenario;
use meshtone::signal::{ChainSettings, IndicatorValue, Shaft, SimulatedShafts};
use serde_json::Value;

use super::wheel_signals::{WheelSignals, indicators_json};
use super::{AnswerOptions, chosen};
use crate::question::memory_limit;
use crate::refusal::Refusal;

/// Indicators of both wheels without damage.
#[derive(Debug, Clone, PartialEq)]
pub struct HealthyIndicators {
    /// The pinion's and the gear's.
    pub wheels: [Vec<IndicatorValue>; 2],
}

impl HealthyIndicators {
    /// As JSON.
    pub fn json(&self) -> Value {
        self.wheels.iter().map(|wheel| indicators_json(wheel)).collect()
    }
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
    let channels = &simulation.channels;
    let channel = chosen(&channels.list(), options.channel.as_deref(), &channels.leading().0);
    let signal = channels.signal(&channel).unwrap_or_default();
    let shafts = SimulatedShafts::of_channels(&simulation.stages.scenario, channels);
    let of_wheel = |shaft| {
        let record = shafts.process(signal, shaft, &ChainSettings::default());
        WheelSignals::new(record, shafts.teeth(shaft), Vec::new()).indicators(channel.unit())
    };
    Ok(HealthyIndicators { wheels: Shaft::BOTH.map(of_wheel) })
}
