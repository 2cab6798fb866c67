//! Vibration of a spur gear pair, sound or damaged.
#![deny(missing_docs)]

pub mod batch;
pub mod damage;
mod error;
pub mod interpolation;
mod keys;
pub mod machine;
pub mod mesh;
mod model;
pub mod operation;
pub mod random;
pub mod scenario;
pub mod signal;
mod simd;
mod simulate;
pub mod solver;
pub mod stiffness;
mod trace;
pub mod tuning;
mod warnings;
pub mod wheel;

pub use error::Error;
pub use simd::InstructionSet;
pub use simulate::{Simulation, StageTime, Stages, simulate, stages};
pub use trace::{Trace, TraceField, stage_trace, trace, trace_at};
