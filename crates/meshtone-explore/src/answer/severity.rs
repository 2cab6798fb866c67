//! Indicators against the severity of one of the faults.

use std::sync::atomic::AtomicBool;

use meshtone::batch::{Control, KeepSimulation, simulate_many};
use meshtone::damage::damage_kinds;
use meshtone::scenario::Scenario;
use meshtone::signal::{ChainSettings, Shaft, SimulatedShafts};
use meshtone::wheel::WheelName;
use serde_json::{Value, json};

use super::wheel_signals::WheelSignals;
use super::{AnswerOptions, Detail, chosen};
use crate::packet::Packet;
use crate::question::memory_limit;
use crate::refusal::Refusal;

/// Steps from a sound tooth to the most severe damage: as many simulations as are solved side by side, beside the sound one.
const STEPS: u32 = 8;

/// Indicators over the severity of a fault.
#[derive(Debug, Clone, PartialEq)]
pub struct SeverityCurve {
    /// Which of the scenario's faults.
    pub fault: usize,
    /// The wheel whose indicators they are: the damaged one.
    pub wheel: WheelName,
    /// (-) The severities.
    pub severities: Vec<f64>,
    /// Name and unit of each indicator, with its value at each severity, NaN where it has none.
    pub indicators: Vec<(String, String, Vec<f64>)>,
}

impl SeverityCurve {
    /// The answer's bytes.
    pub fn packet(&self) -> Vec<u8> {
        let mut packet = Packet::default();
        let indicators: Vec<Value> = (self.indicators.iter())
            .map(|(name, unit, values)| {
                json!({ "name": name, "unit": unit, "values": packet.array(values.iter().copied()) })
            })
            .collect();
        let severities = packet.array(self.severities.iter().copied());
        packet.bytes(&json!({
            "fault": self.fault,
            "wheel": self.wheel.name(),
            "severities": severities,
            "indicators": indicators,
        }))
    }
}

/// Indicators over the severity of a fault, of simulations that are as short as those while a control moves.
///
/// # Arguments
/// * `scenario` - with the fault; those beside it stay
/// * `fault` - which, from 0
/// * `channel` - as of [`AnswerOptions`]
/// * `cancelled` - set to stop
///
/// # Errors
/// No such fault; a scenario that is refused whatever the severity; stopped. A severity that does not fit the tooth leaves a gap.
pub fn severity_curve(
    scenario: &Scenario,
    fault: usize,
    channel: Option<&str>,
    cancelled: &AtomicBool,
) -> Result<SeverityCurve, Refusal> {
    let chosen_fault = scenario.faults.get(fault).ok_or_else(|| {
        let faults = scenario.faults.len();
        Refusal::unfit(format!("fault {fault} is asked for; the scenario has {faults}, counted from 0"))
    })?;
    let short = Detail::Coarse.of(scenario);
    short.validate_within(memory_limit())?;
    let wheel = chosen_fault.wheel;
    let shaft = if wheel == WheelName::Pinion { Shaft::Pinion } else { Shaft::Gear };
    let severities = severities(chosen_fault.damage.kind());
    let at = |severity: &f64| {
        let mut other = short.clone();
        // A fault of severity 0 is none; a missing tooth has no other severity than 1.
        if *severity == 0.0 {
            other.faults.remove(fault);
        } else {
            other.faults[fault] = chosen_fault.clone().with_severity(*severity);
        }
        other
    };
    let scenarios: Vec<Scenario> = severities.iter().map(at).collect();
    let options = AnswerOptions { channel: channel.map(str::to_owned), detail: Detail::Coarse };
    let mut tables = Vec::with_capacity(severities.len());
    let control = Control { cancelled, ..Control::default() };
    simulate_many(scenarios, &KeepSimulation, &control, |_, simulation| {
        tables.push(simulation.ok().map(|simulation| {
            let channels = &simulation.channels;
            let channel = chosen(&channels.list(), options.channel.as_deref(), &channels.leading().0);
            let shafts = SimulatedShafts::of_channels(&simulation.stages.scenario, channels);
            let signal = channels.signal(&channel).unwrap_or_default();
            let record = shafts.process(signal, shaft, &ChainSettings::default());
            WheelSignals::new(record, shafts.teeth(shaft), Vec::new()).indicators(channel.unit())
        }));
    });
    if tables.len() < severities.len() {
        return Err(Refusal::Superseded);
    }
    let names = tables.iter().flatten().find(|table| !table.is_empty()).cloned().unwrap_or_default();
    let values = |row: usize| {
        let value = |table: &Option<Vec<_>>| {
            let entry: Option<&meshtone::signal::IndicatorValue> = table.as_ref()?.get(row);
            entry?.value
        };
        tables.iter().map(|table| value(table).unwrap_or(f64::NAN)).collect()
    };
    let indicators =
        names.iter().enumerate().map(|(row, entry)| (entry.name.clone(), entry.unit.clone(), values(row)));
    Ok(SeverityCurve { fault, wheel, indicators: indicators.collect(), severities })
}

/// (-) From none to the largest; of a damage without a size, these two.
fn severities(kind: &str) -> Vec<f64> {
    let graded = damage_kinds().iter().any(|known| known.name == kind && !known.sizes.is_empty());
    let steps = if graded { STEPS } else { 1 };
    (0..=steps).map(|step| f64::from(step) / f64::from(steps)).collect()
}
