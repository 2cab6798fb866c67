//! Records: what a data set keeps of each simulation.

mod chain;
mod noise;
mod path;
mod start;
mod window;

pub use start::Start;
pub(crate) use window::simulated_scenario;

use meshtone::batch::{Keep as BatchKeep, KeepObserved, ObservedRecorder, Output};
use meshtone::operation::TimeGrid;
use meshtone::scenario::{Fault, Scenario, ScenarioError, WarningKind, WheelName};
use meshtone::signal::{IndicatorValue, OctaveBand};
use meshtone::{Stages, StepJudgement};

use crate::draw::DrawnRecord;
use crate::plan::Content;

/// The signals and values that are kept of one record.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Record {
    /// The values and numbers that it was drawn with.
    pub drawn: DrawnRecord,
    /// The faults; empty for a healthy record.
    pub faults: Vec<RecordFault>,
    /// (rev) Angle of the gear at the first sample, from where tooth 1 comes into contact. 0 at constant speed.
    pub gear_angle_rev: f64,
    /// Teeth of pinion and gear.
    pub teeth: [u32; 2],
    /// (Hz) Mean speed of the pinion's shaft.
    pub pinion_speed_hz: f64,
    /// (N m) Brake torque.
    pub brake_torque_nm: f64,
    /// Kinds of warnings about the simulation, each once.
    pub warnings: Vec<WarningKind>,
    /// (-) Part of the simulated time in which the teeth do not push: with the model `contact`, in which no teeth touch; with the others,
    /// in which the mesh pulls.
    pub slack_fraction: f64,
    /// The raw channels that the plan keeps.
    pub channels: Vec<Vec<f32>>,
    /// Synchronous average of the analysed channel over the revolutions of the plan's wheel.
    pub average: Vec<f32>,
    /// Difference signal of the average.
    pub difference: Vec<f32>,
    /// Indicators of the average.
    pub indicators: Vec<IndicatorValue>,
    /// The difference signal in octaves of mesh orders.
    pub octaves: Vec<OctaveBand>,
    /// (S/s) Sampling rate of the raw channels; the mean rate, if they are over the angle.
    pub sampling_rate_hz: f64,
    /// (s) Simulated time that the average is computed from.
    pub simulated_s: f64,
    /// Difference signal without the added noise, which is enhanced; empty if nothing is enhanced.
    pub clean_difference: Vec<f64>,
    /// Enhanced difference signal; empty where nothing is enhanced.
    pub enhanced: Vec<f32>,
}

impl Record {
    /// (bytes) Size of the signals that are kept.
    pub(crate) fn signal_bytes(&self) -> usize {
        let channels = self.channels.iter().map(Vec::len).sum::<usize>();
        4 * (channels + self.average.len() + self.difference.len() + self.enhanced.len())
    }
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
    /// (%) Part of the worst tooth's flank that pits cover; none for other kinds of damage.
    pub area_percent: Option<f64>,
}

/// The purpose of a simulation.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Role {
    /// It simulates the record itself.
    Record(DrawnRecord),
    /// It simulates the record's gears without the faults. The faults are given because they decide where the record begins.
    HealthyTwin(DrawnRecord, Vec<Fault>),
}

/// Makes a record of each of many simulations.
pub(crate) struct KeepRecords<'a, F> {
    pub content: &'a Content,
    /// The purpose of a simulation, by its number.
    pub role: F,
}

impl<F: Fn(usize) -> Option<Role> + Sync> BatchKeep for KeepRecords<'_, F> {
    type Recorder = ObservedRecorder;
    type Kept = Result<Box<Record>, String>;

    fn outputs(&self, scenario: &Scenario) -> Result<Vec<Output>, ScenarioError> {
        KeepObserved::new(self.content.keep.simulated()).outputs(scenario)
    }

    fn kept_bytes(&self, scenario: &Scenario) -> usize {
        kept_bytes(self.content, &scenario.time_grid())
    }

    fn recorder(&self, stages: &Stages) -> ObservedRecorder {
        KeepObserved::new(self.content.keep.simulated()).recorder(stages)
    }

    fn keep(&self, index: usize, stages: Stages, recorder: ObservedRecorder) -> Self::Kept {
        let record = match (self.role)(index).ok_or("it was not asked for")? {
            Role::Record(drawn) => {
                // The error is only estimated: simulating doubtful records again would triple the work.
                let observation = recorder.observation(&stages, StepJudgement::Estimated);
                chain::record(self.content, drawn, &stages, observation, recorder.into_signals())
            }
            Role::HealthyTwin(drawn, faults) => {
                chain::twin(self.content, drawn, &faults, &stages, recorder.into_signals())
                    .map_err(Into::into)
            }
        };
        record.map(Box::new).map_err(|error| error.to_string())
    }
}

/// (bytes) Approximate size of a record.
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
