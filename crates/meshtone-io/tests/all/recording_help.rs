//! What the tests of recordings share.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use std::fs;

use meshtone_io::recording::{ReadRecordingError, Recording, RecordingOptions, read_recording};

/// Reads bytes as a file of a name.
pub fn read(name: &str, bytes: &[u8], options: &RecordingOptions) -> Result<Recording, ReadRecordingError> {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join(name);
    fs::write(&path, bytes).unwrap();
    read_recording(&path, options)
}

/// The message about a file that is refused, without the path before the file's name.
pub fn refused(name: &str, bytes: &[u8], options: &RecordingOptions) -> String {
    let message = read(name, bytes, options).expect_err("must be refused").to_string();
    message.split_once(name).map_or(message.clone(), |(_, behind)| format!("{name}{behind}"))
}

/// Options with a sampling rate.
pub fn rate(sampling_rate_hz: f64) -> RecordingOptions {
    RecordingOptions { sampling_rate_hz: Some(sampling_rate_hz), ..RecordingOptions::default() }
}
