//! Pulses and speeds out of files, in whatever unit they are stated.

use std::path::Path;

use meshtone_io::indicators::WarningEntry;
use meshtone_io::recording::{
    Channel, ColumnChoice, ReadRecordingError, Recording, RecordingOptions, RecordingWarning, TimeColumn,
    read_recording,
};

use super::reading::warnings_of;
use crate::failure::Failure;
use crate::terminal::warn;

/// The columns of a file of numbers that is no recording, as it has no sampling rate, and what is doubtful about the file.
///
/// # Arguments
/// * `path` - the file
/// * `option` - the option that names it
/// * `expected` - how many columns it must have, and what is in them
pub fn columns<const N: usize>(
    path: &Path,
    option: &str,
    expected: &str,
) -> Result<([Channel; N], Vec<WarningEntry>), Failure> {
    let recording = numbers(path, Vec::new()).map_err(|error| {
        let mut failure = Failure::from(error);
        // There are none to choose from.
        failure.message = failure.message.replace(", or choose other columns (--channel)", "");
        failure
    })?;
    let warnings = warnings_of(&recording);
    let columns = <[Channel; N]>::try_from(recording.channels).map_err(|columns| {
        let problem =
            format!("{option} {}: has {} columns; must be {expected}", path.display(), columns.len());
        Failure::bad_input(problem)
    })?;
    Ok((columns, warnings))
}

/// The pulses of a file of its own, or where there is none of such a name, of an array of the recording's file.
///
/// # Arguments
/// * `source` - the recording
/// * `choice` - the name of a file or an array
pub fn pulse_times(source: &Path, choice: &Path) -> Result<(Channel, Vec<WarningEntry>), Failure> {
    if !choice.exists() {
        let array = ColumnChoice::parse(&choice.to_string_lossy());
        if let Ok(mut recording) = numbers(source, vec![array])
            && recording.channels.len() == 1
        {
            let warnings = warnings_of(&recording);
            return Ok((recording.channels.swap_remove(0), warnings));
        }
    }
    let ([times], warnings) = columns(choice, "--pulse-times", "one, the times of the pulses in s")?;
    Ok((times, warnings))
}

/// Numbers that are no samples.
fn numbers(path: &Path, channels: Vec<ColumnChoice>) -> Result<Recording, ReadRecordingError> {
    let time = TimeColumn::Absent;
    let options =
        RecordingOptions { channels, time, sampling_rate_hz: Some(1.0), ..RecordingOptions::default() };
    let mut recording = read_recording(path, &options)?;
    // No rate is stated in truth.
    recording.warnings.retain(|warning| !matches!(warning, RecordingWarning::OtherRate { .. }));
    Ok(recording)
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
    let lower = speed.name.to_lowercase();
    let named = if lower.ends_with("rpm") { "rpm" } else { "Hz" };
    if speed.unit.is_none() && named == "Hz" && !lower.ends_with("hz") {
        let name = &speed.name;
        warn(format_args!(
            "{}: {name} has no unit and is taken in Hz; of rpm call it {name} [rpm]",
            path.display()
        ));
    }
    let unit = speed.unit.as_deref().unwrap_or(named).trim().to_lowercase();
    let in_hertz = match unit.as_str() {
        "hz" | "1/s" | "rev/s" | "rps" => 1.0,
        "rpm" | "1/min" | "min-1" | "rev/min" | "r/min" | "u/min" => 1.0 / 60.0,
        _ => {
            let problem = format!("{}: {} is in {unit}; must be Hz or rpm", path.display(), speed.name);
            return Failure::refuse(problem, "name the unit in brackets behind the column's name");
        }
    };
    Ok(speed.samples.into_iter().map(|value| value * in_hertz).collect())
}
