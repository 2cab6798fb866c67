//! Adapting a data set to a machine of which only healthy recordings are known.
//!
//! The path to the sensor, the drive and the sidebands that the recordings tell are put into the machine's scenario. Simulations of it with every
//! class of damage are the data set. A classifier learns from them; its threshold is one that neither the healthy recordings nor healthy simulations exceed more
//! than once in twenty times; and simulated machines that differ from the scenario, as real ones do, say what may be expected.

mod detector;
mod plan;
mod rows;

use meshtone::scenario::Scenario;
use meshtone::signal::GearTrain;
use meshtone::tuning::{PathEstimate, SensorRecording};
use meshtone_learn::{area_under_curve, mean};
use serde_json::{Value, json};

pub use plan::{AdaptSettings, tooth_classes};

use crate::error::DatasetError;
use crate::generate::{GenerateControl, Generated, Part, generate};
use crate::like::rows_like;
use crate::manifest::ADAPTATION;
use crate::plan::Plan;
use crate::record::MachineRecording;
use crate::store::Destination;
use detector::{Detector, threshold};
use plan::Machine;
use rows::Rows;

/// Healthy records of each unit, and those of every other class.
const OF_UNIT: [u64; 2] = [3, 1];
/// Machines that say what may be expected, and their records: so many healthy ones that each is judged by a threshold of the others.
const HIDDEN_MACHINES: u64 = 8;
const OF_HIDDEN: [u64; 2] = [12, 2];
/// Windows that the longest recording is to be cut into, as long as a record; and revolutions of the slowest shaft that a record has at least.
const WINDOWS: f64 = 8.0;
const LEAST_REVOLUTIONS: f64 = 8.0;
/// (-) Part of the simulations that are as strange as a window, below which it is like none.
const LIKE_NONE: f64 = 0.01;
/// (-) How far a window's speed may be beyond those of the set.
const SPEED_MARGIN: f64 = 0.02;
/// Windows of the healthy recordings from which on they calibrate the threshold: each is judged beside the others.
const FEWEST_WINDOWS: usize = 3;

/// A machine, and what its healthy recordings tell.
#[derive(Debug, Clone, Copy)]
pub struct KnownMachine<'a> {
    /// Its scenario without faults; the first sensor recorded.
    pub scenario: &'a Scenario,
    /// The recordings.
    pub recordings: &'a [SensorRecording],
    /// The path to the sensor, estimated from them.
    pub estimate: &'a PathEstimate,
}

/// What may be expected of a diagnosis by the data set, from machines that differ from the scenario.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Expected {
    /// Machines that were simulated.
    pub machines: u64,
    /// (-) Area under the curve of damaged against healthy: the mean over the machines, the least and the largest.
    pub area: [f64; 3],
    /// (-) Balanced accuracy of detection, by a threshold of each machine's own healthy records; likewise.
    pub detection: [f64; 3],
    /// (-) Mean recall of all classes; likewise.
    pub recall: [f64; 3],
}

/// What the classifier of a data set says about a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged {
    /// (-) The probabilities of the classes for each window.
    pub probabilities: Vec<Vec<f64>>,
    /// (-) The part of the simulations that are as strange as each window, or stranger.
    pub p_values: Vec<f64>,
    /// (-) Probability of damage above which a window is called damaged, and a recording by the mean over its windows.
    pub threshold: f64,
}

/// A data set for a machine, and the classifier that was learnt from it.
pub struct Adaptation {
    /// The plan of the data set.
    pub plan: Plan,
    /// What was made of it.
    pub generated: Generated,
    /// (-) Probability of damage above which a window is called damaged.
    pub threshold: f64,
    /// (-) Probability of damage of each window of the healthy recordings at the set's speeds.
    pub healthy: Vec<f64>,
    /// What may be expected.
    pub expected: Expected,
    /// What is doubtful about the healthy recordings, in words.
    pub doubts: Vec<String>,
    detector: Detector,
    /// The machine's scenario.
    pub scenario: Scenario,
    /// Its shafts and wheels.
    pub train: GearTrain,
    known: Rows,
    /// (Hz) Least and largest speed of the input that the set has, with a margin.
    speeds_hz: [f64; 2],
}

/// Makes a data set for a machine, and learns from it.
///
/// First come the simulations, of the machine and of those from which the expectation is. Then each window of the healthy recordings, as long as
/// a record, is judged beside the other windows: so it is as strange as the next recording of the healthy machine.
///
/// # Arguments
/// * `machine` - the machine
/// * `settings` - classes, units, seed
/// * `to` - directory of the data set
/// * `control` - progress and cancellation
///
/// # Errors
/// Those of [`generate`]; a class that the machine cannot have.
pub fn adapt(
    machine: &KnownMachine,
    settings: &AdaptSettings,
    to: &Destination,
    control: &GenerateControl,
) -> Result<Adaptation, DatasetError> {
    let KnownMachine { scenario, recordings, estimate } = *machine;
    let refuse =
        |problem: String| DatasetError::refused(problem, "`meshtone simulate` says more of the scenario");
    let train = GearTrain::of_scenario(scenario).map_err(|error| refuse(error.to_string()))?;
    let mut adapted = estimate.adapted(scenario, &train);
    shorten(&mut adapted, &train, recordings);
    let rates = recordings.iter().map(|recording| recording.sampling_rate_hz);
    let simulated =
        Machine { scenario: &adapted, estimate, recorded_rate_hz: rates.fold(f64::INFINITY, f64::min) };
    let plan = simulated.plan(settings, "known-rig", OF_UNIT)?;
    let seed = settings.seed.wrapping_add(1);
    let hidden = AdaptSettings { units: HIDDEN_MACHINES, seed, ..settings.clone() };
    let hidden = simulated.plan(&hidden, "unknown-rig", OF_HIDDEN)?;
    let all = plan.records() + hidden.records();
    let simulate = |plan: &Plan, to: &Destination, before: u64| {
        let progress = |done: u64, _: u64| (control.progress)(before + done, all);
        generate(
            plan,
            to,
            Part::WHOLE,
            &GenerateControl { progress: &progress, cancelled: control.cancelled },
        )
    };
    let generated = simulate(&plan, to, 0)?;
    let folder = tempfile::TempDir::new().map_err(DatasetError::write("simulations"))?;
    let beside = Destination::directory(folder.path().join("hidden"));
    simulate(&hidden, &beside, plan.records())?;
    let set = Rows::of_set(&plan, to)?;
    let speeds_hz = set.speeds_hz(SPEED_MARGIN);
    let known = windows(&plan, scenario, &train, recordings, speeds_hz);
    let mut hidden = Rows::of_set(&hidden, &beside)?;
    hidden.units.iter_mut().for_each(|unit| *unit += settings.units);
    // Without a window nothing can be compared with it.
    let detector = Detector::learn(&set, &hidden, known.len() > 0)?;
    let healthy = of_damage(&detector.probabilities(&detector.features(&known, &|_| true)));
    let (expected, hidden_healthy) = expected(&detector, &hidden);
    // The recordings may be of one load and one speed; the simulated machines scatter.
    let own = if healthy.len() < FEWEST_WINDOWS { 0.0 } else { threshold(&healthy) };
    let threshold = own.max(threshold(&hidden_healthy));
    let doubts = doubts(recordings, &known, speeds_hz);
    let scenario = scenario.clone();
    let adaptation = Adaptation {
        plan,
        generated,
        threshold,
        healthy,
        expected,
        doubts,
        detector,
        scenario,
        train,
        known,
        speeds_hz,
    };
    to.write_bytes(ADAPTATION, format!("{:#}\n", adaptation.to_json()).as_bytes())?;
    Ok(adaptation)
}

impl Adaptation {
    /// The classes, the healthy one first.
    pub fn classes(&self) -> &[String] {
        &self.detector.labels
    }

    /// What the classifier says about each window of a recording of the machine, beside its healthy recordings.
    ///
    /// # Arguments
    /// * `recording` - by the first sensor
    ///
    /// # Errors
    /// Those of [`rows_like`]; a speed beside those of the set.
    pub fn judge(&self, recording: &SensorRecording) -> Result<Judged, DatasetError> {
        let now = of_recording(&self.plan, (&self.scenario, &self.train), recording)?;
        let [slowest, fastest] = self.speeds_hz;
        if let Some(hz) = now.speed_hz.iter().find(|hz| !(slowest..=fastest).contains(*hz)) {
            return Err(DatasetError::refused(
                format!(
                    "the input turns at {hz:.3} Hz, in the simulations at {slowest:.3} to {fastest:.3} Hz"
                ),
                "adapt a set with the scenario at the recording's speed",
            ));
        }
        let count = now.len();
        let all = now.with(&self.known);
        let mut features = self.detector.features(&all, &|row| row >= count);
        features.truncate(count);
        let probabilities = self.detector.probabilities(&features);
        Ok(Judged { probabilities, p_values: self.detector.p_values(&features), threshold: self.threshold })
    }

    /// What was found, for programs.
    pub fn to_json(&self) -> Value {
        let range =
            |[mean, least, largest]: [f64; 3]| json!({ "mean": mean, "least": least, "largest": largest });
        json!({
            "classes": self.classes(),
            "records": self.plan.records(),
            "threshold": self.threshold,
            "healthy_windows": self.healthy,
            "warnings": self.doubts,
            "expected": {
                "machines": self.expected.machines,
                "area_under_curve": range(self.expected.area),
                "detection_balanced_accuracy": range(self.expected.detection),
                "recall": range(self.expected.recall),
            },
        })
    }
}

impl Judged {
    /// (-) Probability of damage, the mean over the windows.
    pub fn damaged(&self) -> f64 {
        mean(&of_damage(&self.probabilities))
    }

    /// What is doubtful about the recording, in words: windows that are like no simulation.
    pub fn doubt(&self) -> Option<String> {
        let (all, unlike) = (self.p_values.len(), self.p_values.iter().filter(|p| **p < LIKE_NONE).count());
        (2 * unlike > all).then(|| {
            format!(
                "{unlike} of {all} windows differ from the healthy recordings more than in any simulation: check unit, sampling rate, speed, load and mounting; noise, or \
                 damage of another kind, is also possible"
            )
        })
    }
}

/// Shortens what is simulated of a machine, so that the longest recording has several windows of that length; but not below some revolutions.
fn shorten(scenario: &mut Scenario, train: &GearTrain, recordings: &[SensorRecording]) {
    let length_s = |of: &SensorRecording| of.values_g.len() as f64 / of.sampling_rate_hz;
    let longest_s = recordings.iter().map(length_s).fold(0.0, f64::max);
    let grid = scenario.time_grid();
    let own_s = grid.kept_samples() as f64 / grid.sampling_rate_hz;
    let slowest = train.shafts.iter().map(|shaft| shaft.speed_ratio.value()).fold(f64::INFINITY, f64::min);
    let least_s = LEAST_REVOLUTIONS / (slowest * scenario.operation.pinion_speed_hz);
    let wanted_s = (longest_s / WINDOWS).max(least_s);
    if wanted_s < own_s {
        let settling_s = grid.first_kept_sample as f64 / grid.sampling_rate_hz;
        scenario.solver.discard_and_keep(settling_s, wanted_s);
    }
}

/// What is doubtful about healthy recordings.
fn doubts(recordings: &[SensorRecording], known: &Rows, [slowest, fastest]: [f64; 2]) -> Vec<String> {
    let mut doubts = Vec::new();
    if known.len() == 0 {
        doubts.push(format!(
            "no part of a healthy recording is as long as a record at one speed of the simulations (input at {slowest:.3} to {fastest:.3} Hz), with which recordings could be \
             compared: they are judged as they are, which is less certain; add a longer one at such a speed"
        ));
    }
    if !recordings.iter().any(|of| of.phase.is_run_up(of.sampling_rate_hz)) {
        doubts.push(
            "the healthy recordings are at one speed, which does not tell damage from the path: whether the machine is healthy was not checked; add a run-up".to_owned(),
        );
    }
    doubts
}

/// (-) The probabilities of damage.
fn of_damage(probabilities: &[Vec<f64>]) -> Vec<f64> {
    probabilities.iter().map(|of| 1.0 - of[0]).collect()
}

/// Windows of the healthy recordings at one speed, if the set has that speed, as long as a record; all of one machine. A recording that is too
/// short has none.
fn windows(
    plan: &Plan,
    scenario: &Scenario,
    train: &GearTrain,
    recordings: &[SensorRecording],
    [slowest, fastest]: [f64; 2],
) -> Rows {
    let mut all = Rows::default();
    let steady = recordings.iter().filter(|recording| !recording.phase.is_run_up(recording.sampling_rate_hz));
    for recording in steady {
        if let Ok(rows) = of_recording(plan, (scenario, train), recording) {
            let at_speed = rows.filter(|row| (slowest..=fastest).contains(&rows.speed_hz[row]));
            all = all.with(&at_speed);
        }
    }
    all.units.iter_mut().for_each(|unit| *unit = 0);
    all
}

/// Windows of a recording by the first sensor, as long as a record.
fn of_recording(
    plan: &Plan,
    (scenario, train): (&Scenario, &GearTrain),
    recording: &SensorRecording,
) -> Result<Rows, DatasetError> {
    let SensorRecording { values_g, sampling_rate_hz, shaft, phase, .. } = recording;
    let name = plan.content.keep.analysed.name().into_owned();
    let channels = [(name, values_g.iter().map(|&value| value as f32).collect())];
    let recording = MachineRecording {
        channels: &channels,
        sampling_rate_hz: *sampling_rate_hz,
        machine: scenario,
        shaft: Some(&train.shafts[*shaft].name),
        phase,
    };
    Rows::of_recordings(plan, rows_like(plan, &[recording])?.parquet)
}

/// What a detector finds on machines that differ from its scenario.
///
/// Each machine is judged by a threshold like that of the machine itself: of its other healthy records, and of those of the other machines. Machines of which too
/// many simulations failed are left out. The second result are the probabilities of damage of all healthy records.
fn expected(detector: &Detector, hidden: &Rows) -> (Expected, Vec<f64>) {
    let is_healthy = |row: usize| hidden.is_healthy(row);
    let probabilities = detector.probabilities(&detector.features(hidden, &is_healthy));
    let scores = of_damage(&probabilities);
    let mut units = hidden.units.clone();
    units.sort_unstable();
    units.dedup();
    let of_units: Vec<[f64; 3]> = units
        .iter()
        .filter_map(|&unit| {
            let rows: Vec<usize> = (0..hidden.len()).filter(|&row| hidden.units[row] == unit).collect();
            let damaged: Vec<bool> = rows.iter().map(|&row| !is_healthy(row)).collect();
            // Simulations may have failed.
            if damaged.iter().filter(|is| !**is).count() < FEWEST_WINDOWS || !damaged.contains(&true) {
                return None;
            }
            let of_others = (0..hidden.len()).filter(|&row| hidden.units[row] != unit && is_healthy(row));
            let of_others: Vec<f64> = of_others.map(|row| scores[row]).collect();
            let pooled = if of_others.is_empty() { 0.0 } else { threshold(&of_others) };
            let own: Vec<f64> = rows.iter().map(|&row| scores[row]).collect();
            let share = |of: bool, is_right: &dyn Fn(usize) -> bool| {
                let asked: Vec<usize> = (0..rows.len()).filter(|&at| damaged[at] == of).collect();
                asked.iter().filter(|&&at| is_right(at)).count() as f64 / asked.len().max(1) as f64
            };
            let limit_without = |at: usize| {
                let others = (0..rows.len()).filter(|&other| other != at && !damaged[other]);
                threshold(&others.map(|other| own[other]).collect::<Vec<f64>>()).max(pooled)
            };
            let alarms = [
                share(false, &|at| own[at] <= limit_without(at)),
                share(true, &|at| own[at] > limit_without(at)),
            ];
            let recalls = detector.labels.iter().enumerate().map(|(class, label)| {
                let of_label = rows.iter().filter(|&&row| hidden.labels[row].as_ref() == Some(label));
                let named = |row: &usize| {
                    let most = (0..detector.labels.len())
                        .max_by(|a, b| probabilities[*row][*a].total_cmp(&probabilities[*row][*b]));
                    most == Some(class)
                };
                let of_label: Vec<usize> = of_label.copied().collect();
                of_label.iter().filter(|row| named(row)).count() as f64 / of_label.len().max(1) as f64
            });
            let recall = recalls.sum::<f64>() / detector.labels.len() as f64;
            let group = |of: bool| own.iter().zip(&damaged).filter(move |(_, is)| **is == of);
            let [healthy, broken] =
                [false, true].map(|of| group(of).map(|(score, _)| *score).collect::<Vec<f64>>());
            Some([area_under_curve(&healthy, &broken)?, (alarms[0] + alarms[1]) / 2.0, recall])
        })
        .collect();
    let of = |which: usize| {
        let values: Vec<f64> = of_units.iter().map(|of| of[which]).collect();
        let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
        [mean, values.iter().copied().fold(1.0, f64::min), values.iter().copied().fold(0.0, f64::max)]
    };
    let healthy = (0..hidden.len()).filter(|&row| is_healthy(row)).map(|row| scores[row]).collect();
    let machines = of_units.len() as u64;
    (Expected { machines, area: of(0), detection: of(1), recall: of(2) }, healthy)
}
