//! Many simulations: side by side in vector registers inside a thread, and in threads outside.
//!
//! Scenarios may differ in everything. Those of one kind are gathered into groups of eight that are stepped together; what comes
//! out of each is the same, bit by bit, as alone. Results are handed out in the order of the scenarios.
//!
//! The work is done in the current thread pool of [`rayon`]: install another to use more or fewer threads. Scenarios come from an iterator and
//! results are handed out one after the other, so that neither has to fit into memory; a thread needs at most 60 MB.

mod group;
mod keep;
mod observed;
mod plan;
mod run;

pub use crate::machine::Axis;
pub use crate::solver::{Block, Output, Recorder, SteppedAlone};
pub use keep::{Keep, KeepChannels, KeepOf, KeepSimulation, SignalRecorder, Signals};
pub use observed::{KeepObserved, Observation, ObservedRecorder, ObservedSignals};
pub use run::{Control, simulate_many};
