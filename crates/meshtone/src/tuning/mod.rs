//! The hybrid stage: simulated difference signals that resemble those of a rig.
//!
//! | step | functions |
//! |---|---|
//! | a difference signal from a simulation | [`DifferenceChain`] |
//! | the three modifications | [`change_duration`], [`change_fault_to_harmonics_ratio`], [`add_noise`]; together [`Enhancement`] |
//! | what was measured | [`Measurements`], [`TuningIndicator`] |
//! | what an enhancement would show | [`SimulatedCases::predict`], by [`WindowMoments`] |
//! | the enhancement that fits best | [`fit`] |
//! | with intervals and leave-one-out errors | [`tune`] |
//! | a whole experiment, simulations included | [`run_experiment`] |
//!
//! Source: section 5 of arXiv:2410.05073.
//!
//! Beside it, [`estimate_path`] finds the path to a sensor from recordings of the healthy machine.

mod candidates;
mod difference;
mod envelopes;
mod error;
mod experiment;
mod indicator;
mod key_search;
mod measurements;
mod modify;
mod moments;
mod rice;
mod run;
mod search;
mod sensor_path;
mod simulated;
mod simulations;
mod tune;

pub use difference::{DifferenceChain, difference_signals};
pub use error::HybridError;
pub use experiment::{Case, Experiment, KeyRange, MOST_CANDIDATES, TunedKey};
pub use indicator::TuningIndicator;
pub use measurements::Measurements;
pub use modify::{Enhanced, Enhancement, add_noise, change_duration, change_fault_to_harmonics_ratio};
pub use moments::{JointMoments, Moments, WindowMoments};
pub use run::{ExperimentControl, ExperimentResult, TunedKeys, run_experiment};
pub use search::{EnhancementBounds, Fit, fit};
pub use sensor_path::{
    PathError, PathEstimate, PathSettings, RecordedDrive, RecordedSidebands, RecordingProblem,
    SensorRecording, SidebandCause, estimate_path,
};
pub use simulated::SimulatedCases;
pub use tune::{LeftOutCase, Tuning, TuningWarning, tune};
