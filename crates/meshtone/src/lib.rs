//! Vibration of a spur gear pair, sound or damaged.
//!
//! A [scenario](scenario::Scenario) says what is simulated; [`simulate()`] gives the [channels](sensor::Channels) and every stage on the
//! way to them.
//!
//! ```
//! use meshtone::scenario::{Fault, GearPair, Scenario, ToothBreakage};
//!
//! let mut scenario = Scenario::new(GearPair {
//!     module_mm: 3.0, pinion_teeth: 17, gear_teeth: 38, face_width_mm: 15.0,
//!     pinion_speed_hz: 40.0, brake_torque_nm: 10.0,
//! });
//! let chip = ToothBreakage { chip_height_mm: 5.0, chip_width_mm: 12.0, tip_loss_mm: 0.0 };
//! scenario.faults = vec![Fault::on_first_gear_tooth(chip)];
//! let simulation = meshtone::simulate(&scenario)?;
//! assert_eq!(simulation.channels["vertical_g"].len(), 95_608);
//! # Ok::<(), meshtone::Error>(())
//! ```
//!
//! * What is asked for: [`scenario`], with the keys of [`wheel`], [`damage`] and [`operation`].
//! * Simulating: [`simulate()`], many at once with [`batch`], every stage's numbers by name with [`trace()`].
//! * From a signal, simulated or measured, to indicators: [`signal`].
//! * Making simulated signals resemble a rig's: [`tuning`].
//!
//! The stages between the scenario and the channels are [`mesh`] and those behind it; they are documented in the source.
#![deny(missing_docs)]

pub mod batch;
pub mod bearing;
mod checks;
pub mod damage;
mod error;
mod error_table;
mod keys;
mod known;
pub mod mesh;
mod model;
pub mod operation;
pub mod random;
pub mod scenario;
pub mod sensor;
pub mod signal;
mod simd;
mod simulate;
mod threads;
mod trace;
mod trace_fields;
pub mod tuning;
mod warnings;
pub mod wheel;

// Public only for the project's own tests and benchmarks. Declared without a macro, since rustfmt does not look into macros for files.
#[cfg(feature = "internals")]
pub mod interpolation;
#[cfg(not(feature = "internals"))]
mod interpolation;
#[cfg(feature = "internals")]
pub mod machine;
#[cfg(not(feature = "internals"))]
mod machine;
#[cfg(feature = "internals")]
pub mod published;
#[cfg(not(feature = "internals"))]
mod published;
#[cfg(feature = "internals")]
pub mod solver;
#[cfg(not(feature = "internals"))]
mod solver;
#[cfg(feature = "internals")]
pub mod stiffness;
#[cfg(not(feature = "internals"))]
mod stiffness;

/// Version of the numbers that a scenario gives. It grows with every change of the simulation that changes them, whatever the version of
/// the program: what is kept of an older one, as a data set that is continued or a set of reference simulations, is made anew.
pub const PHYSICS_VERSION: u32 = 11;

/// The program and the numbers by which a file was made, as a data card states them.
///
/// ```
/// assert!(meshtone::made_by().starts_with("Meshtone 0."));
/// ```
pub fn made_by() -> String {
    format!("Meshtone {}, physics version {PHYSICS_VERSION}", env!("CARGO_PKG_VERSION"))
}

/// The text of a scenario file that is written out: what made it stands in its first line.
///
/// # Arguments
/// * `toml` - the scenario, as [`scenario::Scenario::to_toml`] has it
pub fn written_out(toml: &str) -> String {
    format!("# Made by {}.\n{toml}", made_by())
}

pub use error::Error;
pub use simd::{InstructionSet, NoSuchInstructionSet};
#[cfg(feature = "internals")]
pub use simulate::{AssembledMachine, Equations};
pub use simulate::{MeshedPair, Simulation, StageTime, Stages, simulate, stages, stages_within};
pub use trace::{Trace, TraceField, stage_trace, trace, trace_at, trace_of};
pub use warnings::{GyroscopicShift, Observer, StepJudgement, stages_and_warnings};
