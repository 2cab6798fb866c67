//! Vibration of a spur gear pair, sound or damaged.
#![deny(missing_docs)]

pub mod scenario;
pub mod toml_reader;
