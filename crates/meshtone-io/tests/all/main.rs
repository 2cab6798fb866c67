//! The library, used as its users use it. One test program, because each is linked with all libraries.

mod atomic_file;
mod integrity;
mod parquet_help;
mod recording_binary;
mod recording_formats;
mod recording_help;
mod recording_mat;
mod recording_parquet;
mod recording_text;
mod recording_universal;
mod scenario_file;
mod signals;
mod tuned;
