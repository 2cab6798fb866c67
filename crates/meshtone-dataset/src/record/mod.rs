//! Records: what a data set keeps of each simulation.

mod chain;
mod kept;
mod noise;
mod path;
mod recorded;
mod start;
mod turning;
mod window;

pub use recorded::MachineRecording;
pub(crate) use recorded::records;
pub(crate) use turning::{Turning, TurningWheel};
pub(crate) use window::{Window, simulated_scenario};

use meshtone::batch::{Keep as BatchKeep, KeepObserved, ObservedRecorder, Output};
use meshtone::bearing::Spall;
use meshtone::operation::TimeGrid;
use meshtone::scenario::{Scenario, ScenarioError, WarningKind};
use meshtone::signal::{IndicatorValue, SignalWarning};
use meshtone::{Simulation, Stages, StepJudgement};

use crate::draw::DrawnRecord;
use crate::plan::Content;
use chain::View;

/// The signals and values that are kept of one record.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Record {
    /// The values and numbers that it was drawn with.
    pub drawn: DrawnRecord,
    /// The faults; empty for a healthy record.
    pub faults: Vec<RecordFault>,
    /// The wheels: pinion and gear, or those of the gearbox in its order.
    pub wheels: Vec<RecordWheel>,
    /// (Hz) Nominal speed of the pinion's shaft, or of a gearbox's input.
    pub input_speed_hz: f64,
    /// (N m) Brake torque.
    pub brake_torque_nm: f64,
    /// Kinds of warnings about the simulation, each once.
    pub warnings: Vec<WarningKind>,
    /// (-) Part of the simulated time in which the teeth of each mesh do not push: with the model `contact`, in which no teeth touch; with
    /// the others, in which the mesh pulls.
    pub slack_fractions: Vec<f64>,
    /// The raw channels that the plan keeps.
    pub channels: Vec<Vec<f32>>,
    /// What the analysed channel shows over the revolutions of each of the plan's averaged wheels.
    pub averages: Vec<RecordAverage>,
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
        let averages = self.averages.iter().map(|of| of.average.len() + of.difference.len()).sum::<usize>();
        4 * (channels + averages + self.enhanced.len())
    }
}

/// What a channel shows over the revolutions of a wheel; empty of what is not kept.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RecordAverage {
    /// Synchronous average.
    pub average: Vec<f32>,
    /// Difference signal of the average.
    pub difference: Vec<f32>,
    /// Indicators of the average.
    pub indicators: Vec<IndicatorValue>,
    /// What is doubtful about the average.
    pub warnings: Vec<SignalWarning>,
}

/// A wheel of a record.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RecordWheel {
    /// Number of its teeth.
    pub teeth: u32,
    /// (Hz) Nominal speed of its shaft.
    pub speed_hz: f64,
    /// (rev) Its angle at the first sample, from where its tooth 1 comes into contact. 0 of a pair at constant speed.
    pub angle_rev: f64,
}

/// A fault of a record.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RecordFault {
    /// Kind of damage: of teeth by its name in the scenario file, of a bearing `outer-race`, `inner-race` or `rolling-element`.
    pub kind: &'static str,
    /// Name of the damaged wheel; none of a bearing.
    pub wheel: Option<String>,
    /// Number of the damaged tooth, counted from 1 in the order in which its wheel's teeth come into contact from the start of
    /// the record on; none where it is several.
    pub tooth: Option<u32>,
    /// (-) How severe it is, from 0, none, to 1, the largest that the tooth allows; of a bearing the width over the diameter of an element.
    pub severity: f64,
    /// (%) Part of the worst tooth's flank that pits cover; none for other kinds of damage.
    pub area_percent: Option<f64>,
    /// The spall of a bearing; none of teeth.
    pub spall: Option<RecordSpall>,
}

/// A spall of a record's bearing.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordSpall {
    /// Name of the bearing: its shaft and place, such as `input:0`.
    pub bearing: String,
    /// Its sizes.
    pub sizes: Spall,
    /// Order of the first line of the defect in revolutions of the bearing's shaft, without slip.
    pub order: f64,
}

/// The purpose of a simulation.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Role {
    /// The record that it is for.
    pub drawn: DrawnRecord,
    pub window: Window,
    /// Whether it simulates the record's gears without the faults, and not the record itself.
    pub is_twin: bool,
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

    fn check(&self, stages: &Stages, recorder: &ObservedRecorder) -> Result<(), meshtone::Error> {
        recorder.check(stages)
    }

    fn keep(&self, index: usize, stages: Stages, recorder: ObservedRecorder) -> Self::Kept {
        let Role { drawn, window, is_twin } = (self.role)(index).ok_or("it was not asked for")?;
        let view = View::new(self.content, window, &stages);
        let record = if is_twin {
            view.twin(drawn, recorder.into_signals()).map_err(Into::into)
        } else {
            // The error is only estimated: simulating doubtful records again would triple the work.
            let observation = recorder.observation(&stages, StepJudgement::Estimated);
            view.record_of_pair(drawn, observation, recorder.into_signals())
        };
        record.map(Box::new).map_err(|error| error.to_string())
    }
}

impl<F: Fn(usize) -> Option<Role> + Sync> KeepRecords<'_, F> {
    /// Makes the record of a simulation of a train.
    ///
    /// # Arguments
    /// * `index` - number of the simulation
    /// * `simulation` - with all its signals
    pub fn of_train(&self, index: usize, simulation: Simulation) -> Result<Box<Record>, String> {
        // A train has no twins: nothing of it is enhanced.
        let Role { drawn, window, .. } = (self.role)(index).ok_or("it was not asked for")?;
        let record = View::new(self.content, window, &simulation.stages).record_of_train(drawn, &simulation);
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
    let averages = averages * keep.wheel.all().len() as f64;
    let enhanced = if content.tuned.is_some() { 3.0 * average } else { 0.0 };
    (4.0 * (raw * keep.channels.len() as f64 + averages + enhanced)) as usize + 1000
}
