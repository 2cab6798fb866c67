//! Simulations of what may be.

use meshtone::Stages;
use meshtone::batch::{Control, Keep, KeepChannels, Output, SignalRecorder, Signals, simulate_many};
use meshtone::scenario::{Scenario, ScenarioError};
use meshtone::sensor::Channel;
use meshtone::signal::{ChainSettings, SignalError, SimulatedShafts};
use meshtone::wheel::WheelName;

use crate::observation::WheelLines;
use crate::prior::{Drawn, DrawnFault, Prior, RECORDS_PER_UNIT};
use crate::rig::rig_wheels;

/// A simulation of a reference set.
#[derive(Debug, Clone, PartialEq)]
pub struct ReferenceRecord {
    /// Its number in the prior.
    pub number: u64,
    /// The damage; none of a healthy record.
    pub fault: Option<DrawnFault>,
    /// (Hz) Speed of the shaft that drives.
    pub input_speed_hz: f64,
    /// The average of each wheel of the rig, behind the path to the sensor.
    pub wheels: Vec<WheelLines>,
}

impl ReferenceRecord {
    /// Number of the record's pair of wheels.
    pub(crate) fn unit(&self) -> u64 {
        self.number / RECORDS_PER_UNIT
    }
}

/// Simulations of what may be.
#[derive(Debug, Clone, PartialEq)]
pub struct ReferenceSet {
    /// Prior from which they were drawn.
    pub prior: Prior,
    /// Those that could be simulated, in the order of their numbers.
    pub records: Vec<ReferenceRecord>,
}

impl ReferenceSet {
    /// The healthy record of a record's pair of wheels that all others of the pair are compared with, where it could be simulated.
    ///
    /// # Arguments
    /// * `record` - one of the set
    pub fn healthy_of(&self, record: &ReferenceRecord) -> Option<&ReferenceRecord> {
        let number = record.unit() * RECORDS_PER_UNIT;
        let at = self.records.binary_search_by_key(&number, |other| other.number).ok()?;
        Some(&self.records[at])
    }
}

/// Simulates records of a prior.
///
/// # Arguments
/// * `prior` - what may be
/// * `numbers` - of the records
/// * `control` - progress, cancellation
///
/// Returns those that could be simulated, in their order; fewer where it was cancelled.
pub fn build_reference(
    prior: &Prior,
    numbers: std::ops::Range<u64>,
    control: &Control,
) -> Vec<ReferenceRecord> {
    // A record that cannot be drawn is one that cannot be simulated: neither is in the set.
    let drawn: Vec<(u64, Drawn)> = {
        use rayon::prelude::*;
        let kinds = prior.kinds();
        let draw = |number| Some((number, prior.draw_among(&kinds, number).ok()?));
        numbers.into_par_iter().filter_map(draw).collect()
    };
    let scenarios: Vec<Scenario> = drawn.iter().map(|(_, drawn)| drawn.scenario.clone()).collect();
    let keep = KeepWheels { channel: KeepChannels::new([Channel::leading(&prior.base.sensors)]) };
    let (mut records, rig) = (Vec::with_capacity(drawn.len()), rig_wheels(&prior.base));
    simulate_many(scenarios, &keep, control, |index, kept| {
        let (number, drawn) = &drawn[index];
        if let Ok(Ok(mut wheels)) = kept {
            let input_speed_hz = drawn.scenario.operation.pinion_speed_hz;
            for (wheel, of_rig) in wheels.iter_mut().zip(&rig) {
                let shaft_hz = of_rig.speed_ratio * input_speed_hz;
                let gains = drawn.path_gains((0..wheel.lines.len()).map(|order| order as f64 * shaft_hz));
                wheel.lines.iter_mut().zip(gains).for_each(|(line, gain)| *line *= gain);
            }
            let fault = drawn.fault.clone();
            records.push(ReferenceRecord { number: *number, fault, input_speed_hz, wheels });
        }
    });
    records
}

/// Keeps the wheels' averages of each of many simulations.
struct KeepWheels {
    channel: KeepChannels,
}

impl Keep for KeepWheels {
    type Recorder = SignalRecorder;
    type Kept = Result<Vec<WheelLines>, SignalError>;

    fn outputs(&self, scenario: &Scenario) -> Result<Vec<Output>, ScenarioError> {
        self.channel.outputs(scenario)
    }

    fn recorder(&self, stages: &Stages) -> SignalRecorder {
        self.channel.recorder(stages)
    }

    fn keep(&self, _: usize, stages: Stages, recorder: SignalRecorder) -> Self::Kept {
        let Signals { start_s, channels, .. } = recorder.finish(&stages);
        let signal: Vec<f64> = channels.into_iter().flatten().map(f64::from).collect();
        let shafts = SimulatedShafts::new(&stages.scenario, start_s, signal.len());
        let lines = |shaft: WheelName| {
            let average = shafts.average(&signal, shaft, &ChainSettings::default())?;
            Ok(WheelLines::of_average(&average, shafts.teeth(shaft)))
        };
        WheelName::BOTH.into_iter().map(lines).collect()
    }
}
