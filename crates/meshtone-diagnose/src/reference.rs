//! Simulations of what may be.

use std::sync::atomic::Ordering;

use meshtone::batch::{Control, Keep, KeepChannels, Output, SignalRecorder, Signals, simulate_many};
use meshtone::scenario::{Scenario, ScenarioError};
use meshtone::sensor::Channel;
use meshtone::signal::{
    AngularSettings, ChainSettings, GearTrain, SeparationSettings, SignalError, SynchronousAverage,
    TrainRecording, TrainTurning, TrainWheel, synchronous_average,
};
use meshtone::wheel::WheelName;
use meshtone::{Error, Stages};
use meshtone_learn::{WheelLines, separations};
use rayon::prelude::*;

use crate::draw::{Drawn, DrawnFault, RECORDS_PER_UNIT};
use crate::prior::Prior;

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
    numbers: impl IntoParallelIterator<Item = u64>,
    control: &Control,
) -> Vec<ReferenceRecord> {
    // A record that cannot be drawn is one that cannot be simulated: neither is in the set.
    let drawn: Vec<(u64, Drawn)> = {
        let kinds = prior.kinds();
        let is_wanted = || !control.cancelled.load(Ordering::Relaxed);
        let draw = |number| {
            is_wanted().then(|| prior.draw_among(&kinds, number).ok()).flatten().map(|drawn| (number, drawn))
        };
        numbers.into_par_iter().filter_map(draw).collect()
    };
    let mut records = Vec::with_capacity(drawn.len());
    let take = |index: usize, kept: Result<Averages, Error>| {
        let (number, drawn): &(u64, Drawn) = &drawn[index];
        if let Ok(Ok(averages)) = kept {
            records.push(record(prior, *number, drawn, &averages));
        }
    };
    let scenarios: Vec<Scenario> = drawn.iter().map(|(_, drawn)| drawn.scenario.clone()).collect();
    simulate_many(scenarios, &KeepAverages(&prior.train), control, take);
    records
}

/// The average of each wheel of a simulation.
type Averages = Result<Vec<SynchronousAverage>, SignalError>;

/// A record of what was simulated: the lines of its averages behind the path to the sensor.
fn record(prior: &Prior, number: u64, drawn: &Drawn, averages: &[SynchronousAverage]) -> ReferenceRecord {
    let input_speed_hz = drawn.scenario.operation.pinion_speed_hz;
    let GearTrain { wheels, shafts, .. } = &prior.train;
    let of = |((average, separation), wheel): ((&SynchronousAverage, SeparationSettings), &TrainWheel)| {
        let mut of_wheel = WheelLines::of_average(average, separation);
        let shaft_hz = shafts[wheel.shaft].speed_ratio.value() * input_speed_hz;
        let gains = drawn.path_gains((0..of_wheel.lines.len()).map(|order| order as f64 * shaft_hz));
        of_wheel.lines.iter_mut().zip(gains).for_each(|(line, gain)| *line *= gain);
        of_wheel
    };
    let wheels = averages.iter().zip(separations(&prior.train)).zip(wheels).map(of).collect();
    ReferenceRecord { number, fault: drawn.fault.clone(), input_speed_hz, wheels }
}

/// Keeps the averages of all wheels over the first sensor of each of many simulations.
struct KeepAverages<'a>(&'a GearTrain);

/// The channel of the first sensor.
fn leading(scenario: &Scenario) -> KeepChannels {
    KeepChannels::new([Channel::leading(&scenario.all_sensors())])
}

impl Keep for KeepAverages<'_> {
    type Recorder = SignalRecorder;
    type Kept = Averages;

    fn outputs(&self, scenario: &Scenario) -> Result<Vec<Output>, ScenarioError> {
        leading(scenario).outputs(scenario)
    }

    fn recorder(&self, stages: &Stages) -> SignalRecorder {
        leading(&stages.scenario).recorder(stages)
    }

    fn keep(&self, _: usize, stages: Stages, recorder: SignalRecorder) -> Self::Kept {
        let Signals { start_s, channels, .. } = recorder.finish(&stages);
        let signal: Vec<f64> = channels.into_iter().flatten().map(f64::from).collect();
        averages(&stages, self.0, start_s, signal)
    }
}

/// Times that a train's simulation of one cycle is repeated, so that the ends that resampling needs are outside whole cycles.
const REPEATED: usize = 3;

/// The averages of a signal.
///
/// Where the simulation of a train is one cycle, after which the same teeth meet again, it is repeated and averaged over whole cycles: then the
/// lines of each shaft are free of the others'. The revolutions of two wheels that start together have whole numbers of samples, and need no
/// resampling.
fn averages(stages: &Stages, train: &GearTrain, start_s: f64, mut signal: Vec<f64>) -> Averages {
    let cycle = train.revolutions_of_a_cycle(train.input());
    let is_cycle = stages.is_steady() && signal.len() == cycle * stages.time.samples_per_pinion_revolution;
    let mut turning = TrainTurning::of_simulated(&stages.scenario, start_s, signal.len())?;
    if let TrainTurning::SimulatedPair(shafts) = turning {
        let average = |shaft: WheelName| shafts.average(&signal, shaft, &ChainSettings::default());
        return WheelName::BOTH.into_iter().map(average).collect();
    }
    if is_cycle {
        signal = signal.repeat(REPEATED);
        turning = TrainTurning::of_simulated(&stages.scenario, start_s, signal.len())?;
    }
    let sampling_rate_hz = stages.time.sampling_rate_hz;
    let recording = TrainRecording { signal: &signal, sampling_rate_hz, train, turning: &turning };
    let average = |wheel: usize| {
        let mut angular = recording.angular(wheel, &AngularSettings::default())?;
        if is_cycle {
            let cycle = train.revolutions_of_a_cycle(train.wheels[wheel].shaft).max(1);
            let whole = angular.revolutions() / cycle * cycle;
            angular.values.truncate(whole * angular.points_per_revolution);
        }
        synchronous_average(&angular)
    };
    (0..train.wheels.len()).map(average).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observation::Observation;
    use crate::synthetic::gearbox_prior;

    // What is kept of one cycle of a gearbox is what a recording of many cycles shows, behind the same path.
    #[test]
    fn a_cycle_of_a_gearbox_is_a_long_recording_of_it() {
        let prior = gearbox_prior();
        let record = build_reference(&prior, 2..3, &Control::default()).remove(0);
        let drawn = prior.draw(2).unwrap();
        let mut gearbox = drawn.scenario.clone();
        let solver = &mut gearbox.solver;
        let cycle = solver.pinion_revolutions.unwrap();
        let settled = cycle * solver.settle_fraction / (1.0 - solver.settle_fraction);
        solver.pinion_revolutions = Some(5.0 * cycle);
        solver.settle_fraction = settled / (settled + 5.0 * cycle);
        let simulation = meshtone::simulate(&gearbox).unwrap();
        let channels = &simulation.channels;
        let signal = &channels.signals[0].values;
        let turning = TrainTurning::of_simulated(&gearbox, channels.start_s, signal.len()).unwrap();
        let (sampling_rate_hz, train) = (channels.sampling_rate_hz, &prior.train);
        let recording = TrainRecording { signal, sampling_rate_hz, train, turning: &turning };
        let observed = Observation::of_recording(&recording).unwrap();
        assert_eq!(observed.mismatch, None);
        assert!((observed.input_speed_hz.unwrap() / record.input_speed_hz - 1.0).abs() < 1e-6);
        for (wheel, (kept, seen)) in record.wheels.iter().zip(&observed.wheels).enumerate() {
            let seen = seen.as_ref().unwrap();
            let shaft = &train.shafts[train.wheels[wheel].shaft];
            let shaft_hz = shaft.speed_ratio.value() * record.input_speed_hz;
            let count = kept.lines.len().min(seen.lines.len());
            let gains = drawn.path_gains((0..count).map(|order| order as f64 * shaft_hz));
            let lines = || kept.lines.iter().zip(&seen.lines).zip(gains.iter()).skip(1);
            let apart: f64 = lines().map(|((kept, seen), gain)| (kept - seen * gain).norm_sqr()).sum();
            let energy: f64 = lines().map(|((kept, _), _)| kept.norm_sqr()).sum();
            // At so coarse a rate two ways of averaging differ by some 2 %, of healthy wheels too.
            assert!((apart / energy).sqrt() < 0.03, "wheel {wheel}: {}", (apart / energy).sqrt());
        }
    }
}
