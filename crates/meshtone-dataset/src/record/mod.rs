//! From a simulation to what is kept of it.

mod chain;
mod noise;
mod path;
mod start;

pub use start::Start;

use meshtone::batch::{Keep as BatchKeep, KeepObserved, ObservedRecorder, Output};
use meshtone::operation::TimeGrid;
use meshtone::scenario::{Fault, Scenario, ScenarioError, WarningKind, WheelName};
use meshtone::signal::{IndicatorValue, OctaveBand};
use meshtone::{Stages, StepJudgement};

use crate::draw::DrawnRecord;
use crate::plan::Content;

/// What is kept of one record.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// What it is.
    pub drawn: DrawnRecord,
    /// Its faults; none of a healthy one.
    pub faults: Vec<RecordFault>,
    /// (rev) Angle of the gear at the first sample, from where tooth 1 comes into contact. 0 at constant speed.
    pub gear_angle_rev: f64,
    /// Teeth of pinion and gear.
    pub teeth: [u32; 2],
    /// (Hz) Mean speed of the pinion's shaft.
    pub pinion_speed_hz: f64,
    /// (N m) Brake torque.
    pub brake_torque_nm: f64,
    /// What is doubtful about its simulation, each once.
    pub warnings: Vec<WarningKind>,
    /// (-) Part of the simulated time in which the teeth do not push: under `contact` in which none touch, else in which the mesh pulls.
    pub slack_fraction: f64,
    /// Raw channels, those of the plan.
    pub channels: Vec<Vec<f32>>,
    /// Synchronous average of the analysed channel over the revolutions of the plan's wheel.
    pub average: Vec<f32>,
    /// Its difference signal.
    pub difference: Vec<f32>,
    /// Its indicators.
    pub indicators: Vec<IndicatorValue>,
    /// Octaves of mesh orders of its difference signal.
    pub octaves: Vec<OctaveBand>,
    /// (S/s) Sampling rate of the raw channels; over the angle their mean one.
    pub sampling_rate_hz: f64,
    /// (s) Simulated time that it was made of.
    pub simulated_s: f64,
    /// Difference signal without the added noise, to be enhanced; empty where nothing is.
    pub clean_difference: Vec<f64>,
}

/// A fault of a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RecordFault {
    /// Kind of damage, by its name in the scenario file.
    pub kind: &'static str,
    /// The damaged wheel.
    pub wheel: WheelName,
    /// Number of the damaged tooth, counted from 1 in the order in which its wheel's teeth come into contact from the start of
    /// the record on; none where it is several.
    pub tooth: Option<u32>,
    /// (-) How severe it is, from 0, none, to 1, the largest that the tooth allows.
    pub severity: f64,
    /// (%) Part of the flank that its pits take, of the worst tooth; none of other kinds.
    pub area_percent: Option<f64>,
}

/// What a simulation is for.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Role {
    /// It is the record.
    Record(DrawnRecord),
    /// It shows what the record's pair would be like without its faults, which say where it begins.
    HealthyTwin(DrawnRecord, Vec<Fault>),
}

/// What is kept of each of many simulations.
pub(crate) struct KeepRecords<'a, F> {
    pub content: &'a Content,
    /// What a simulation is for, by its number.
    pub role: F,
}

impl<F> KeepRecords<'_, F> {
    /// The simulated channels, in single precision.
    fn channels(&self) -> KeepObserved {
        KeepObserved::new(self.content.keep.simulated())
    }
}

impl<F: Fn(usize) -> Option<Role> + Sync> BatchKeep for KeepRecords<'_, F> {
    type Recorder = ObservedRecorder;
    type Kept = Result<Box<Record>, String>;

    fn outputs(&self, scenario: &Scenario) -> Result<Vec<Output>, ScenarioError> {
        self.channels().outputs(scenario)
    }

    fn kept_bytes(&self, scenario: &Scenario) -> usize {
        kept_bytes(self.content, &scenario.time_grid())
    }

    fn recorder(&self, stages: &Stages) -> ObservedRecorder {
        self.channels().recorder(stages)
    }

    fn keep(&self, index: usize, stages: Stages, recorder: ObservedRecorder) -> Self::Kept {
        match (self.role)(index) {
            Some(Role::Record(drawn)) => {
                // A second simulation of every record in doubt would make three times the work.
                let observed = recorder.finish(&stages, StepJudgement::Estimated);
                chain::record(self.content, drawn, &stages, observed)
            }
            Some(Role::HealthyTwin(drawn, faults)) => {
                let samples = recorder.signals(&stages).channels;
                chain::twin(self.content, drawn, &faults, &stages, &samples)
            }
            None => Err("it was not asked for".to_owned()),
        }
        .map(Box::new)
    }
}

/// (bytes) About how large a record is.
pub(crate) fn kept_bytes(content: &Content, time: &TimeGrid) -> usize {
    let keep = &content.keep;
    let rate = (keep.sampling_rate_hz / time.sampling_rate_hz).min(1.0);
    let period = time.kept_samples() as f64 * rate;
    let raw = match (keep.over_angle, keep.duration_s) {
        (Some(angle), _) => angle.values() as f64,
        (None, Some(seconds)) => seconds * keep.sampling_rate_hz,
        (None, None) => period,
    };
    // An average's length is the next power of two above a revolution's.
    let turns = time.kept_samples() as f64 / time.samples_per_pinion_revolution as f64;
    let average = match keep.over_angle {
        Some(angle) => angle.points_per_revolution as f64,
        None => 4.0 * period / turns.max(1.0),
    };
    let averages = f64::from(u8::from(keep.average) + u8::from(keep.difference)) * average;
    let enhanced = if content.tuned.is_some() { 3.0 * average } else { 0.0 };
    (4.0 * (raw * keep.channels.len() as f64 + averages + enhanced)) as usize + 1000
}
