//! Sampling rates that a file states.

use std::path::Path;

use super::time::Timing;
use super::{ReadRecordingError, RecordingOptions};

/// Two statements of one rate may differ by this part, for instance by the digits that were written.
const AGREEMENT: f64 = 1e-6;

/// A sampling rate, and where the file states it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct StatedRate {
    pub by: String,
    pub rate_hz: f64,
}

impl StatedRate {
    /// From a number whose name says that it is a sampling rate or interval, whatever stands before the last dot.
    pub(super) fn from_named(name: &str, value: f64) -> Option<StatedRate> {
        let last = name.rsplit('.').next().unwrap_or(name);
        let word: String = last.chars().filter(|c| c.is_alphanumeric()).collect::<String>().to_lowercase();
        let (word, scale) = match word.strip_suffix("khz") {
            Some(start) => (start, 1e3),
            None => (word.strip_suffix("hz").unwrap_or(&word), 1.0),
        };
        let rate_hz = match word {
            "fs" | "samplingrate" | "samplerate" | "samplingfrequency" | "samplefrequency"
            | "samplingfreq" | "samplefreq" | "abtastrate" | "abtastfrequenz" => value * scale,
            "dt" | "dts" | "samplinginterval" | "samplingintervals" | "sampleinterval"
            | "sampleintervals" | "samplingperiod" | "samplingperiods" => 1.0 / value,
            _ => return None,
        };
        Some(StatedRate { by: name.to_string(), rate_hz })
    }
}

/// The rate and the time of the first sample, from all that says something about them.
pub(super) fn decide(
    path: &Path,
    stated: &[StatedRate],
    timing: Option<(String, Timing)>,
    options: &RecordingOptions,
    present: impl Fn() -> Vec<String>,
) -> Result<(f64, f64), ReadRecordingError> {
    if let Some(rate_hz) = options.sampling_rate_hz {
        return Ok((rate_hz, 0.0));
    }
    let refuse = |problem: String| ReadRecordingError::Rate { path: path.to_path_buf(), problem };
    let Some(first) = stated.first() else {
        let no_rate = || ReadRecordingError::NoRate { path: path.to_path_buf(), present: present() };
        return timing.map(|(_, timing)| (timing.rate_hz, timing.start_s)).ok_or_else(no_rate);
    };
    for other in stated {
        if !(other.rate_hz.is_finite() && other.rate_hz > 0.0) {
            let StatedRate { by, rate_hz } = other;
            return Err(refuse(format!("{by} says a sampling rate of {rate_hz} S/s; must be above 0")));
        }
        if (other.rate_hz / first.rate_hz - 1.0).abs() > AGREEMENT {
            return Err(refuse(format!(
                "{} says a sampling rate of {} S/s, but {} says {} S/s",
                first.by, first.rate_hz, other.by, other.rate_hz
            )));
        }
    }
    let Some((column, timing)) = timing else { return Ok((first.rate_hz, 0.0)) };
    if (timing.rate_hz / first.rate_hz - 1.0).abs() > timing.uncertainty + AGREEMENT {
        return Err(refuse(format!(
            "{} says a sampling rate of {} S/s, but time column {column} says {} S/s",
            first.by, first.rate_hz, timing.rate_hz
        )));
    }
    Ok((first.rate_hz, timing.start_s))
}
