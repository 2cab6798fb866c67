//! The summary of a simulation, as JSON: lists of shafts, wheels, meshes and bearings, whatever the form of the machine.
//!
//! Every key of a number ends in its unit. A number that does not exist, such as the kurtosis of a constant
//! channel, is `null`.

mod bearing;
mod json;
mod mesh;
mod planetary;

pub use bearing::BearingSummary;
pub use json::write_json;
pub use mesh::{HelixSummary, MeshForce, MeshStiffness, MeshSummary, TransmissionError};
pub use planetary::SetSummary;

use std::path::Path;
use std::time::Duration;

use meshtone::damage::{QuantityValue, ToothPart, damages_of_fault};
use meshtone::mesh::MeshCurve;
use meshtone::scenario::{Fault, FaultyTeeth, Ratio, ScenarioWarning};
use meshtone::sensor::{Channels, NamedSignal};
use meshtone::signal::{
    ChainSettings, GearTrain, Indicators, SimulatedShafts, TrainWheel, kurtosis, peak, rms,
};
use meshtone::wheel::WheelName;
use meshtone::{Simulation, Stages};
use serde::Serialize;
use serde_json::{Map, Value};

use crate::ReadResultsError;
use crate::input_file::read_document;
use crate::run_identity::RunIdentity;

/// Version of the summary's format: it grows when a key changes its name or meaning.
pub const FORMAT_VERSION: u32 = 2;

/// The main numbers of a simulation.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Summary {
    /// [`FORMAT_VERSION`].
    pub format_version: u32,
    /// Version of Meshtone.
    pub meshtone_version: &'static str,
    /// Version of the numbers that a scenario gives: [`meshtone::PHYSICS_VERSION`].
    pub physics_version: u32,
    /// Identity of the run, which all its files carry.
    #[serde(serialize_with = "json::run")]
    pub run: RunIdentity,
    /// (S/s) Actual sampling rate.
    pub sampling_rate_hz: f64,
    /// Number of samples kept.
    pub samples: usize,
    /// (s) Time of the first sample kept, since the start of the simulation.
    pub start_s: f64,
    /// What was simulated.
    #[serde(flatten)]
    pub machine: MachineSummary,
    /// The samples per revolution of the driving wheel and the numbers of the mesh, where there is one only.
    #[serde(flatten)]
    pub one_mesh: Map<String, Value>,
    /// Main numbers of each signal, by the name of its column; sensors first.
    #[serde(serialize_with = "json::channels")]
    pub channels: Vec<ChannelSummary>,
    /// Indicators of a pair's main signal.
    #[serde(flatten)]
    pub averaged: Option<AveragedSignal>,
    /// Time that each stage took.
    #[serde(rename = "computing_time_ms", serialize_with = "json::times")]
    pub computing_time: Vec<(String, Duration)>,
    /// What deserves attention.
    pub warnings: Vec<ScenarioWarning>,
}

/// The main numbers of a machine.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct MachineSummary {
    /// Model, by its name in the scenario file.
    pub model: &'static str,
    /// Seed of the random draws.
    pub seed: u64,
    /// The faults; none of healthy wheels.
    pub faults: Vec<FaultSummary>,
    /// Samples per revolution of the input, at the nominal speed.
    pub samples_per_input_revolution: usize,
    /// Revolutions of the input after which all teeth and shafts stand as at the start.
    pub cycle_input_revolutions: i64,
    /// The shafts, in the order of the file; of a pair the pinion's is the first.
    pub shafts: Vec<ShaftSummary>,
    /// The wheels, likewise.
    pub wheels: Vec<WheelSummary>,
    /// The meshes, in the order of the file.
    pub meshes: Vec<MeshSummary>,
    /// The rolling bearings, in the order of the file; none of a pair.
    pub bearings: Vec<BearingSummary>,
    /// The planetary sets, in the order of the file; the key is left out where there is none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub planetary: Vec<SetSummary>,
    /// (Hz) The natural frequencies at the mean mesh stiffness, rising: of a pair 13, under `contact` 17.
    pub natural_frequencies_hz: Vec<f64>,
    /// (Hz) Of each mode of shafts of beams without their meshes the natural frequency without and with gyroscopic moments; none of a rig.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub gyroscopic_modes_hz: Vec<[f64; 2]>,
}

/// Indicators of a pair's main signal, synchronously averaged on either shaft.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct AveragedSignal {
    /// Of the shafts of pinion and gear; none where the kept signal holds no average.
    #[serde(serialize_with = "json::indicators")]
    pub indicators: [Option<Indicators>; 2],
    /// The signal that they are of: the first sensor's. Of a simulation without listed sensors they are the
    /// vertical acceleration's, as ever, and the file does not say so.
    #[serde(rename = "indicators_of", skip_serializing_if = "json::is_vertical")]
    pub name: String,
}

/// A fault: its kind and place, each as in the scenario file, and how severe it is.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct FaultSummary {
    /// Kind of damage.
    pub kind: &'static str,
    /// The damaged wheel.
    pub wheel: String,
    /// Which of its teeth, by their numbers from 1.
    #[serde(serialize_with = "json::tooth")]
    pub tooth: FaultyTeeth,
    /// (-) How severe it is, from 0, none, to 1, the largest that the tooth allows.
    pub severity: f64,
    /// What it has done to each of its teeth; only of a fault that takes spots of their flanks.
    #[serde(skip_serializing_if = "Vec::is_empty", serialize_with = "json::pitted_teeth")]
    pub pitted_teeth: Vec<PittedTooth>,
}

/// Number of a tooth, from 1, and the quantities of the damage there, by their names.
pub type PittedTooth = (u32, Vec<(&'static str, QuantityValue)>);

/// A shaft.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ShaftSummary {
    /// Its name; of a pair that of its wheel.
    pub name: String,
    /// (rev/s) Its nominal speed.
    pub speed_hz: f64,
    /// Its speed over that of the input as a fraction; negative where it turns against the input.
    pub speed_ratio: String,
}

/// A wheel.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct WheelSummary {
    /// Its name.
    pub name: String,
    /// Name of its shaft.
    pub shaft: String,
    /// Tooth count.
    pub teeth: u32,
}

impl ShaftSummary {
    fn new(name: &str, ratio: Ratio, input_hz: f64) -> Self {
        let speed_hz = ratio.value().abs() * input_hz;
        Self { name: name.to_owned(), speed_hz, speed_ratio: ratio.to_string() }
    }
}

impl FaultSummary {
    /// The faults of teeth.
    fn all(stages: &Stages, train: &GearTrain) -> Vec<Self> {
        let faults = stages.scenario.placed_faults().into_iter().zip(&stages.fault_severities).enumerate();
        // A wheel is damaged alike in all its meshes.
        let pitted = |wheel: usize, number: usize| -> Vec<PittedTooth> {
            let Some((mesh, _)) = stages.layout.mesh_of(wheel) else { return Vec::new() };
            damages_of_fault(&stages.pairs[mesh].damaged, number)
                .into_iter()
                .filter(|(_, damage)| damage.part == ToothPart::FlankSpots)
                .map(|(tooth, damage)| (tooth, damage.quantities.clone()))
                .collect()
        };
        let summary = |(number, ((wheel, fault), &severity)): (usize, ((usize, &Fault), &f64))| Self {
            kind: fault.damage.kind(),
            wheel: train.wheels[wheel].name.clone(),
            tooth: fault.tooth.clone(),
            severity,
            pitted_teeth: pitted(wheel, number),
        };
        faults.map(summary).collect()
    }
}

/// Indicators of one signal.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ChannelSummary {
    /// The signal's column.
    pub name: String,
    /// Unit of rms and peak.
    pub unit: &'static str,
    /// Root mean square, mean included.
    pub rms: f64,
    /// Largest absolute value.
    pub peak: f64,
    /// (-) Kurtosis, 3 for Gaussian noise; none for a constant.
    pub kurtosis: Option<f64>,
}

impl ChannelSummary {
    /// The main numbers of all signals.
    fn all(channels: &Channels) -> Vec<Self> {
        let summary = |signal: &NamedSignal| Self {
            name: signal.name.to_string(),
            unit: signal.unit,
            rms: rms(&signal.values),
            peak: peak(&signal.values),
            kurtosis: kurtosis(&signal.values),
        };
        channels.signals.iter().map(summary).collect()
    }
}

impl AveragedSignal {
    /// None where nothing was kept, and of a gearbox.
    fn of(stages: &Stages, channels: &Channels) -> Option<Self> {
        let leading = channels.leading().filter(|_| stages.scenario.rig().is_some())?;
        let shafts = SimulatedShafts::of_stages(stages, channels.start_s, channels.len());
        let indicators = WheelName::BOTH.map(|shaft| {
            let record = shafts.process(&leading.values, shaft, &ChainSettings::default());
            Some(record.ok()?.indicators)
        });
        Some(Self { indicators, name: leading.name.to_string() })
    }
}

impl MachineSummary {
    fn new(simulation: &Simulation) -> Self {
        let Simulation { stages, .. } = simulation;
        let (scenario, layout, train) = (&stages.scenario, &stages.layout, GearTrain::of_stages(stages));
        let input_hz = scenario.operation.pinion_speed_hz;
        let curves = stages.mesh_curves();
        let mesh = |(number, curve): (usize, &MeshCurve)| MeshSummary::new(simulation, &train, number, curve);
        let shafts = train.shafts.iter().zip(&layout.ratios);
        let wheel = |wheel: &TrainWheel| WheelSummary {
            name: wheel.name.clone(),
            shaft: train.shafts[wheel.shaft].name.clone(),
            teeth: wheel.teeth,
        };
        let bearings = stages.bearings.iter().zip(&train.bearings);
        Self {
            model: scenario.model.name(),
            seed: scenario.seed,
            faults: FaultSummary::all(stages, &train),
            samples_per_input_revolution: stages.time.samples_per_pinion_revolution,
            cycle_input_revolutions: layout.cycle_revolutions(),
            shafts: shafts.map(|(shaft, ratio)| ShaftSummary::new(&shaft.name, *ratio, input_hz)).collect(),
            wheels: train.wheels.iter().map(wheel).collect(),
            meshes: curves.iter().enumerate().map(mesh).collect(),
            bearings: bearings
                .map(|((_, bearing), (name, _))| BearingSummary::new(name.clone(), bearing))
                .collect(),
            planetary: scenario.planetary().iter().map(SetSummary::new).collect(),
            natural_frequencies_hz: stages.natural_frequencies_hz(),
            gyroscopic_modes_hz: (stages.gyroscopic_shifts(input_hz).into_iter())
                .map(|mode| [mode.frequency_hz, mode.shifted_hz])
                .collect(),
        }
    }
}

impl Summary {
    /// Sums up a simulation.
    ///
    /// What can be computed from the signals is taken from them as they are written, not from the simulation's inner state, so that a
    /// reader of the files finds the same numbers. Indicators are those of a pair's leading channel; they are none where the signal is too
    /// short for an average.
    ///
    /// # Arguments
    /// * `simulation` - its stages and signals
    /// * `run` - the run's identity
    /// * `warnings` - what deserves attention
    pub fn new(simulation: &Simulation, run: RunIdentity, warnings: &[ScenarioWarning]) -> Self {
        let Simulation { stages, channels, timings, .. } = simulation;
        let machine = MachineSummary::new(simulation);
        Self {
            format_version: FORMAT_VERSION,
            meshtone_version: env!("CARGO_PKG_VERSION"),
            physics_version: meshtone::PHYSICS_VERSION,
            run,
            sampling_rate_hz: channels.sampling_rate_hz,
            samples: channels.len(),
            start_s: channels.start_s,
            one_mesh: mesh::of_one_mesh(&machine.meshes, machine.samples_per_input_revolution),
            machine,
            channels: ChannelSummary::all(channels),
            averaged: AveragedSignal::of(stages, channels),
            computing_time: timings.iter().map(|time| (time.stage.to_owned(), time.elapsed)).collect(),
            warnings: warnings.to_vec(),
        }
    }

    /// Time that all stages took.
    pub fn total_time(&self) -> Duration {
        self.computing_time.iter().map(|(_, elapsed)| *elapsed).sum()
    }
}

/// The identity of the run that a summary is of.
///
/// # Arguments
/// * `path` - what [`write_json`] wrote
///
/// # Errors
/// The file cannot be read, or it is no summary.
///
/// ```
/// use meshtone_io::summary::read_run;
///
/// let directory = tempfile::tempdir()?;
/// let path = directory.path().join("summary.json");
/// std::fs::write(&path, r#"{ "run": "00000000000000ff" }"#)?;
/// assert_eq!(read_run(&path)?.number(), 255);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_run(path: &Path) -> Result<RunIdentity, ReadResultsError> {
    let text = read_document(path).map_err(|source| ReadResultsError::unreadable(path, source))?;
    let foreign = |problem: String| ReadResultsError::foreign(path, problem);
    let summary: Value =
        serde_json::from_slice(&text).map_err(|error| foreign(format!("is not whole JSON: {error}")))?;
    let run = summary.get("run").and_then(Value::as_str);
    let run =
        run.ok_or_else(|| foreign("has no `run`, so `meshtone simulate` did not write it".to_string()))?;
    run.parse().map_err(|error| foreign(format!("run: {error}")))
}
