//! Vibration of a spur gear pair, sound or damaged.
#![deny(missing_docs)]

pub mod batch;
pub mod dynamics;
pub mod fault;
pub mod hybrid;
pub mod interpolation;
pub mod quality;
pub mod random;
pub mod sampling;
pub mod scenario;
pub mod signal;
mod simulate;
pub mod solver;
pub mod stiffness;
mod threads;
pub mod toml_reader;
pub mod tooth;
mod trace;
mod warnings;

pub use simulate::{Simulation, StageTime, Stages, simulate, stages};
pub use trace::{Trace, TraceField, stage_trace, trace, trace_at};
