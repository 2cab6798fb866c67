//! The summary of a simulation, as JSON.
//!
//! Every key of a number ends in its unit. A number that does not exist, such as the kurtosis of a constant
//! channel, is `null`.

mod gearbox;
mod json;

pub use gearbox::{GearboxSummary, MeshSummary, ShaftSummary, TransmissionError, WheelFault};
pub use json::write_json;

use std::path::Path;
use std::time::Duration;

use meshtone::damage::{QuantityValue, ToothPart, damages_of_fault};
use meshtone::scenario::{Fault, FaultyTeeth, Gears, ScenarioWarning};
use meshtone::sensor::{Channels, ContactFigures, NamedSignal, SignalSource};
use meshtone::signal::{ChainSettings, Indicators, SimulatedShafts, kurtosis, peak, rms};
use meshtone::wheel::WheelName;
use meshtone::{Simulation, StageTime, Stages};
use serde::Serialize;
use serde_json::Value;

use crate::ReadResultsError;
use crate::input_file::read_document;
use crate::run_identity::RunIdentity;

/// Version of the summary's format: it grows when a key changes its name or meaning.
pub const FORMAT_VERSION: u32 = 2;

/// What every summary begins with.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SummaryHead {
    /// [`FORMAT_VERSION`].
    pub format_version: u32,
    /// Version of Meshtone.
    pub meshtone_version: &'static str,
    /// Identity of the run, which all its files carry.
    #[serde(serialize_with = "json::run")]
    pub run: RunIdentity,
    /// Model, by its name in the scenario file.
    pub model: &'static str,
    /// Seed of the random draws.
    pub seed: u64,
    /// (S/s) Actual sampling rate.
    pub sampling_rate_hz: f64,
    /// Number of samples kept.
    pub samples: usize,
    /// (s) Time of the first sample kept, since the start of the simulation.
    pub start_s: f64,
}

/// What the summary of every simulation has of its computation.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SummaryEnd {
    /// Time that each stage took.
    #[serde(rename = "computing_time_ms", serialize_with = "json::times")]
    pub computing_time: Vec<(String, Duration)>,
    /// What deserves attention.
    #[serde(serialize_with = "json::warnings")]
    pub warnings: Vec<ScenarioWarning>,
}

impl SummaryEnd {
    fn new(timings: &[StageTime], warnings: &[ScenarioWarning]) -> Self {
        let times = timings.iter().map(|time| (time.stage.to_owned(), time.elapsed));
        Self { computing_time: times.collect(), warnings: warnings.to_vec() }
    }

    /// (s) Time that all stages took.
    pub fn total_time(&self) -> Duration {
        self.computing_time.iter().map(|(_, elapsed)| *elapsed).sum()
    }
}

/// The main numbers of a simulation.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Summary {
    /// What every summary begins with.
    #[serde(flatten)]
    pub head: SummaryHead,
    /// The faults; none of a healthy pair.
    pub faults: Vec<FaultSummary>,
    /// Samples per revolution of the pinion, at the nominal speed.
    pub samples_per_pinion_revolution: usize,
    /// (-) Contact ratio, of helical wheels in the transverse section.
    pub contact_ratio: f64,
    /// Overlap and thrust; only of helical wheels.
    pub helix: Option<HelixSummary>,
    /// (-) Face load factor K_Hβ of sound teeth under the nominal load; only under `contact`.
    pub face_load_factor: Option<f64>,
    /// (Hz) The natural frequencies at the mean mesh stiffness, rising: 13, under `contact` 17.
    pub natural_frequencies_hz: Vec<f64>,
    /// Over a revolution of the gear.
    pub mesh_stiffness: MeshStiffness,
    /// Over the samples kept.
    pub mesh_force: MeshForce,
    /// Indicators of each signal, by the name of its column; listed sensors first.
    #[serde(serialize_with = "json::channels")]
    pub channels: Vec<ChannelSummary>,
    /// Indicators of that signal, synchronously averaged on the shafts of pinion and gear; none where the kept signal holds no
    /// average.
    #[serde(serialize_with = "json::indicators")]
    pub indicators: [Option<Indicators>; 2],
    /// Computing time and warnings.
    #[serde(flatten)]
    pub end: SummaryEnd,
    /// The signal that [`Self::indicators`] are of: the first sensor's. Of a simulation without listed sensors they are the
    /// vertical acceleration's, as ever, and the file does not say so.
    #[serde(rename = "indicators_of", skip_serializing_if = "json::is_vertical")]
    pub averaged: String,
}

/// A fault: its kind and place, each as in the scenario file, and how severe it is.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct FaultSummary {
    /// Kind of damage.
    pub kind: &'static str,
    /// The damaged wheel.
    pub wheel: &'static str,
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

impl FaultSummary {
    /// Those of a simulation.
    fn all(stages: &Stages) -> Vec<Self> {
        let faults = stages.scenario.faults.iter().zip(&stages.fault_severities).enumerate();
        let summary = |(number, (fault, &severity)): (usize, (&Fault, &f64))| Self {
            kind: fault.damage.kind(),
            wheel: fault.wheel.name(),
            tooth: fault.tooth.clone(),
            severity,
            pitted_teeth: damages_of_fault(&stages.damaged, number)
                .into_iter()
                .filter(|(_, damage)| damage.part == ToothPart::FlankSpots)
                .map(|(tooth, damage)| (tooth, damage.quantities.clone()))
                .collect(),
        };
        faults.map(summary).collect()
    }
}

/// What only helical wheels have.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct HelixSummary {
    /// (-) Overlap ratio ε_β.
    pub overlap_ratio: f64,
    /// (-) Total contact ratio ε_γ.
    pub total_contact_ratio: f64,
    /// (N) Force along the shafts under the nominal torque, on the driving wheel; positive towards positive z where it turns about that.
    pub axial_force_n: f64,
}

impl HelixSummary {
    /// Of two wheels; none of spur wheels.
    fn of(gears: &Gears, static_force_n: f64) -> Option<Self> {
        gears.is_helical().then(|| Self {
            overlap_ratio: gears.overlap_ratio(),
            total_contact_ratio: gears.total_contact_ratio(),
            axial_force_n: static_force_n * gears.thrust(),
        })
    }
}

/// Stiffness of the mesh over a revolution of the gear.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct MeshStiffness {
    /// (N/mm) Smallest.
    pub min_n_per_mm: f64,
    /// (N/mm) Mean.
    pub mean_n_per_mm: f64,
    /// (N/mm) Largest.
    pub max_n_per_mm: f64,
}

/// Force along the line of action.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct MeshForce {
    /// (N) Smallest; negative where the mesh pulls.
    pub min_n: f64,
    /// (N) Mean.
    pub mean_n: f64,
    /// (N) Largest.
    pub max_n: f64,
    /// (-) Part of the time in which the mesh pulls; none under `contact`, whose teeth never do.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tension_fraction: Option<f64>,
    /// How the teeth touched; only under `contact`.
    #[serde(flatten)]
    pub contact: Option<ContactFigures>,
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

impl Summary {
    /// Sums up a simulation.
    ///
    /// What can be computed from the signals is taken from them as they are written, not from the simulation's inner state, so that a
    /// reader of the files finds the same numbers. Indicators are those of the leading channel; they are none where the signal is too short
    /// for an average.
    ///
    /// # Arguments
    /// * `simulation` - its stages and signals
    /// * `run` - the run's identity
    /// * `warnings` - what deserves attention
    pub fn new(simulation: &Simulation, run: RunIdentity, warnings: &[ScenarioWarning]) -> Self {
        let (stages, channels) = (&simulation.stages, &simulation.channels);
        let shafts = SimulatedShafts::of_channels(&stages.scenario, channels);
        let mesh = stages.mesh_curves().into_iter().next();
        let [min_n_per_mm, mean_n_per_mm, max_n_per_mm] =
            extremes(mesh.as_ref().map_or(&[], |mesh| &mesh.stiffness_n_per_mm));
        let force_n = channels.of(SignalSource::MeshForce(0));
        let [min_n, mean_n, max_n] = extremes(force_n);
        let figures = ContactFigures::of_force(force_n);
        let contact = simulation.contact_figures();
        let leading = channels.leading();
        let signal = leading.map_or(&[][..], |signal| &signal.values);
        Self {
            head: SummaryHead {
                format_version: FORMAT_VERSION,
                meshtone_version: env!("CARGO_PKG_VERSION"),
                run,
                model: stages.scenario.model.name(),
                seed: stages.scenario.seed,
                sampling_rate_hz: channels.sampling_rate_hz,
                samples: channels.len(),
                start_s: channels.start_s,
            },
            faults: FaultSummary::all(stages),
            samples_per_pinion_revolution: stages.time.samples_per_pinion_revolution,
            contact_ratio: stages.teeth.contact.contact_ratio,
            helix: HelixSummary::of(&stages.scenario.gears, stages.static_force_n()),
            face_load_factor: mesh.and_then(|mesh| mesh.face_load_factor),
            natural_frequencies_hz: stages.natural_frequencies_hz(),
            mesh_stiffness: MeshStiffness { min_n_per_mm, mean_n_per_mm, max_n_per_mm },
            mesh_force: MeshForce {
                min_n,
                mean_n,
                max_n,
                tension_fraction: contact.is_none().then_some(figures.back_flank_fraction),
                contact,
            },
            channels: ChannelSummary::all(channels),
            averaged: leading.map_or_else(String::new, |signal| signal.name.to_string()),
            indicators: WheelName::BOTH.map(|shaft| {
                let record = shafts.process(signal, shaft, &ChainSettings::default());
                Some(record.ok()?.indicators)
            }),
            end: SummaryEnd::new(&simulation.timings, warnings),
        }
    }
}

/// Smallest value, mean and largest value.
fn extremes(values: &[f64]) -> [f64; 3] {
    [
        values.iter().copied().fold(f64::INFINITY, f64::min),
        values.iter().sum::<f64>() / values.len() as f64,
        values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    ]
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
