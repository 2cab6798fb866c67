//! Pulses and speeds out of files, in whatever unit they are stated.

use std::path::Path;

use meshtone_io::recording::{Channel, RecordingOptions, TimeColumn, read_recording};

use crate::failure::Failure;

/// A file of numbers that is no recording: it has no sampling rate.
fn columns(path: &Path) -> Result<Vec<Channel>, Failure> {
    let time = TimeColumn::Absent;
    let options = RecordingOptions { time, sampling_rate_hz: Some(1.0), ..RecordingOptions::default() };
    Ok(read_recording(path, &options)?.channels)
}

/// The times of pulses.
pub fn one_column(path: &Path) -> Result<Channel, Failure> {
    let mut columns = columns(path)?;
    match (columns.len(), columns.pop()) {
        (1, Some(column)) => Ok(column),
        (count, _) => {
            let problem = format!("--pulse-times {}: has {count} columns", path.display());
            Err(Failure::bad_input(problem + "; must be one, the times of the pulses in s"))
        }
    }
}

/// The times and speeds of a speed profile.
pub fn profile(path: &Path) -> Result<(Channel, Channel), Failure> {
    let mut columns = columns(path)?;
    let count = columns.len();
    match (count, columns.pop(), columns.pop()) {
        (2, Some(speed), Some(time)) => Ok((time, speed)),
        _ => {
            let problem = format!("--speed-profile {}: has {count} columns", path.display());
            Err(Failure::bad_input(problem + "; must be two, time in s and speed in Hz or rpm"))
        }
    }
}

/// (s) Times since the recording's first sample.
pub fn times_s(times: Channel, start_s: f64) -> Vec<f64> {
    let second = match times.unit.as_deref() {
        Some("ms") => 1e-3,
        Some("µs" | "us") => 1e-6,
        _ => 1.0,
    };
    times.samples.into_iter().map(|time| time * second - start_s).collect()
}

/// (Hz) A speed in whatever unit it is stated.
pub fn hertz(path: &Path, speed: Channel) -> Result<Vec<f64>, Failure> {
    let named = if speed.name.to_lowercase().ends_with("rpm") { "rpm" } else { "Hz" };
    let unit = speed.unit.as_deref().unwrap_or(named).trim().to_lowercase();
    let in_hertz = match unit.as_str() {
        "hz" | "1/s" | "rev/s" | "rps" => 1.0,
        "rpm" | "1/min" | "min-1" | "rev/min" | "r/min" | "u/min" => 1.0 / 60.0,
        _ => {
            let problem = format!("{}: {} is in {unit}; must be Hz or rpm", path.display(), speed.name);
            return Err(
                Failure::bad_input(problem).with_help("name the unit in brackets behind the column's name")
            );
        }
    };
    Ok(speed.samples.into_iter().map(|value| value * in_hertz).collect())
}
