//! Signals of a simulation as files: Apache Parquet, and the formats that other programs read.
//!
//! [`SignalTable`] holds what is written: the time, one column of double precision per signal with its unit in its name, the sampling
//! rate. Parquet alone carries the whole question in its key-value metadata: the scenario as TOML that needs no other file
//! ([`SCENARIO_KEY`]), the version of Meshtone ([`VERSION_KEY`]), the identity of the run ([`RUN_KEY`]) and the
//! sampling rate ([`RATE_KEY`]); each column's unit and meaning stand in the metadata of its Arrow field. Nothing depends on when or
//! where the file is written: the same simulation gives the same bytes.

mod format;
mod read;
mod signal_table;

pub use format::SignalFormat;
pub(crate) use format::wav::{WavChannel, WavComment};
pub use read::{Recorded, read_signals};
pub use signal_table::SignalTable;

/// The first column: (s) time since the start of the simulation. The others are the [channels](meshtone::sensor::Channels), sensors first.
pub const TIME: &str = "time_s";
/// Metadata key of the scenario, as TOML.
pub const SCENARIO_KEY: &str = "meshtone.scenario";
/// Metadata key of a gearbox, as TOML, in place of [`SCENARIO_KEY`].
pub const GEARBOX_KEY: &str = "meshtone.gearbox";
/// Metadata key of the version of Meshtone that wrote the file.
pub const VERSION_KEY: &str = "meshtone.version";
/// Metadata key of the run's [identity](crate::run_identity::RunIdentity).
pub const RUN_KEY: &str = "meshtone.run";
/// (S/s) Metadata key of the sampling rate.
pub const RATE_KEY: &str = "meshtone.sampling_rate_hz";
/// (S/s) Name of the sampling rate in formats that hold variables.
const RATE: &str = "sampling_rate_hz";
