//! Experiments of the hybrid stage: the file that describes one, and the files that tuning writes.

mod enhanced;
mod indicator_table;
mod measured;
mod read;
mod recordings;
mod tuned;
mod tuning_json;

pub use enhanced::{EnhancedDraws, EnhancedRecord, enhance, write_enhanced};
pub use read::{ExperimentFile, read_experiment};
pub use tuned::{Tuned, read_tuned, write_tuned};
pub use tuning_json::{tuning_json, warnings};

/// A commented experiment file: every key with its meaning. It names files that a user has: `rig.toml` and recordings.
///
/// ```
/// assert!(meshtone_io::experiment::template().contains("[[case]]"));
/// ```
pub fn template() -> &'static str {
    include_str!("template.toml")
}
