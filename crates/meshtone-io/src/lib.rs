//! Files of Meshtone: scenarios, profile errors, profiles and recordings in; signals, indicators, summaries and traces out.
//! All are written through [`atomic_file`], so that no half-written file ever stands under a result's name.
#![deny(missing_docs)]

pub mod atomic_file;
pub mod channel_name;
pub mod experiment;
pub mod indicators;
mod input_file;
pub mod memory;
pub mod npz;
pub mod own_file;
pub mod path_csv;
pub mod printable;
mod read_results;
pub mod recording;
pub mod recording_files;
pub mod run_identity;
pub mod scenario_file;
pub mod signals;
pub mod summary;
pub mod table;
pub mod trace_npz;

pub use read_results::ReadResultsError;
