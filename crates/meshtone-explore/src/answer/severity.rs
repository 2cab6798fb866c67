//! Indicators against the severity of one of the faults.

use std::sync::atomic::AtomicBool;

use meshtone::batch::{Control, KeepSimulation, simulate_many};
use meshtone::damage::damage_kinds;
use meshtone::scenario::Scenario;
use meshtone::signal::IndicatorValue;
use serde_json::{Value, json};

use super::{Detail, wheel_signals};
use crate::packet::Packet;
use crate::question::memory_limit;
use crate::refusal::Refusal;

/// Steps from a sound tooth to the most severe damage: as many simulations as are solved side by side, beside the sound one.
const STEPS: u32 = 8;

/// The answer's bytes: indicators over the severity of a fault, of simulations that are as short as those while a control moves.
///
/// All severities are simulated side by side, with the scenario's other faults as they are; of each simulation only the indicators
/// of the damaged wheel are kept, by whose names the values are put together at the end, NaN where there is none.
///
/// # Arguments
/// * `scenario` - with the fault; those beside it stay
/// * `fault` - which, from 0
/// * `channel` - as of [`super::AnswerOptions`]
/// * `cancelled` - set to stop
///
/// # Errors
/// No such fault; a scenario that is refused whatever the severity; stopped. A severity that does not fit the tooth leaves a gap.
pub fn severity_curve(
    scenario: &Scenario,
    fault: usize,
    channel: Option<&str>,
    cancelled: &AtomicBool,
) -> Result<Vec<u8>, Refusal> {
    let chosen_fault = scenario.faults.get(fault).ok_or_else(|| {
        let faults = scenario.faults.len();
        Refusal::unfit(format!("fault {fault} is asked for; the scenario has {faults}, counted from 0"))
    })?;
    let short = Detail::Coarse.of(scenario);
    short.validate_within(memory_limit())?;
    let wheel = chosen_fault.side();
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
    let mut tables = Vec::with_capacity(severities.len());
    let control = Control { cancelled, ..Control::default() };
    simulate_many(scenarios, &KeepSimulation, &control, |_, simulation| {
        tables.push(simulation.ok().map(|simulation| {
            let (signal, of_wheel) = wheel_signals(&simulation, channel);
            of_wheel(wheel).indicators(simulation.channels.signals[signal].unit)
        }));
    });
    if tables.len() < severities.len() {
        return Err(Refusal::Superseded);
    }
    let names = tables.iter().flatten().find(|table| !table.is_empty()).cloned().unwrap_or_default();
    let value = |table: &Option<Vec<IndicatorValue>>, row: usize| table.as_ref()?.get(row)?.value;
    let mut packet = Packet::default();
    let indicator = |(row, IndicatorValue { name, unit, .. }): (usize, &IndicatorValue)| {
        let values = tables.iter().map(|table| value(table, row).unwrap_or(f64::NAN));
        json!({ "name": name, "unit": unit, "values": packet.array(values) })
    };
    let indicators: Vec<Value> = names.iter().enumerate().map(indicator).collect();
    let severities = packet.array(severities);
    let said = json!({
        "fault": fault,
        "wheel": wheel.name(),
        "severities": severities,
        "indicators": indicators,
    });
    Ok(packet.bytes(&said))
}

/// (-) From none to the largest; of a damage without a size, these two.
fn severities(kind: &str) -> Vec<f64> {
    let graded = damage_kinds().iter().any(|known| known.name == kind && !known.sizes.is_empty());
    let steps = if graded { STEPS } else { 1 };
    (0..=steps).map(|step| f64::from(step) / f64::from(steps)).collect()
}
