//! Experiments of the hybrid stage: the file that describes one, and the files that tuning writes.

mod enhanced;
mod indicator_table;
mod measured;
mod read;
mod recordings;
mod template;
mod tuned;
mod tuning_json;

pub use enhanced::{EnhancedDraws, EnhancedHead, EnhancedRecord, enhance, write_enhanced};
pub use read::{ExperimentFile, read_experiment};
pub use template::template;
pub use tuned::{Tuned, read_tuned, write_tuned};
pub use tuning_json::{tuning_json, warnings};
