//! Sampling rates that a file states.

use super::error::{Problem, names};
use super::label::Label;
use super::selection::Selection;
use super::time::{Timing, readable, timing};
use super::{RecordingOptions, RecordingWarning};

/// Two statements of one rate may differ by this part, for instance by the digits that were written.
const AGREEMENT: f64 = 1e-6;
/// How far the mean rate of times that have none of their own may be from a stated one: they are coarse, or have gaps.
const ROUGH_AGREEMENT: f64 = 0.02;

/// (S/s) Least number under a short name that is a sampling rate.
const LEAST_OF_SHORT_NAME: f64 = 1000.0;

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
            "fs" | "fsamp" | "fsample" | "fsampling" | "samplingrate" | "samplerate" | "samprate"
            | "smprate" | "samplingfrequency" | "samplefrequency" | "sampfrequency" | "samplingfreq"
            | "samplefreq" | "sampfreq" | "sfreq" | "freqsampling" | "acquisitionrate" | "acqrate"
            | "scanrate" | "daqrate" | "samplespersecond" | "sps" | "abtastrate" | "abtastfrequenz" => {
                value * scale
            }
            // Some mean the rate of the shaft by it.
            "sr" | "srate" if value >= LEAST_OF_SHORT_NAME => value * scale,
            "dt" | "dts" | "samplinginterval" | "samplingintervals" | "sampleinterval"
            | "sampleintervals" | "samplingperiod" | "samplingperiods" | "timestep" | "deltat"
            | "xincrement" | "wfincrement" => 1.0 / value,
            "increment" if name.ends_with("x_values.increment") => 1.0 / value,
            _ => return None,
        };
        Some(StatedRate { by: name.to_string(), rate_hz })
    }
}

/// The rate, with what says it, and the time of the first sample, from all statements about them.
///
/// # Arguments
/// * `stated` - rates that the file states
/// * `timing` - the name of the time column and what it says
/// * `options` - of the recording
/// * `present` - the columns of the file, for messages
pub(super) fn decide(
    stated: &[StatedRate],
    timing: Option<(&str, Timing)>,
    options: &RecordingOptions,
    present: impl Fn() -> Vec<String>,
) -> Result<(StatedRate, f64), Problem> {
    if let Some(rate_hz) = options.sampling_rate_hz {
        return Ok((StatedRate { by: "the stated rate".to_owned(), rate_hz }, 0.0));
    }
    let by_time = |column: &str| format!("time column {column}");
    let Some(first) = stated.first() else {
        let (column, Timing { rate_hz, start_s, .. }) = timing.ok_or_else(|| no_rate(&present()))?;
        return Ok((StatedRate { by: by_time(column), rate_hz }, start_s));
    };
    for StatedRate { by, rate_hz } in stated {
        if !(rate_hz.is_finite() && *rate_hz > 0.0) {
            let problem = format!("{by} states a sampling rate of {rate_hz} S/s; must be above 0");
            return Err(Problem::rate(&problem));
        }
        if (rate_hz / first.rate_hz - 1.0).abs() > AGREEMENT {
            return Err(contradiction(first, by, *rate_hz));
        }
    }
    let Some((column, timing)) = timing else { return Ok((first.clone(), 0.0)) };
    if (timing.rate_hz / first.rate_hz - 1.0).abs() > timing.uncertainty + AGREEMENT {
        return Err(contradiction(first, &by_time(column), timing.rate_hz));
    }
    Ok((first.clone(), timing.start_s))
}

/// The warning that the file states another rate than the options.
pub(super) fn other_than_stated(
    stated: &[StatedRate],
    options: &RecordingOptions,
) -> Option<RecordingWarning> {
    let own = stated.iter().find(|own| own.rate_hz.is_finite() && own.rate_hz > 0.0)?;
    other(&own.by, own.rate_hz, AGREEMENT, options)
}

/// The warning that the file's own time column gives another rate than the options. Without a unit it may be in ms or µs. It is compared
/// only: where it cannot be read, the stated rate counts all the same.
///
/// # Arguments
/// * `labels`, `selection`, `options` - of the recording
/// * `read` - reads a column
pub(super) fn other_than_timed(
    labels: &[Label],
    selection: &Selection,
    options: &RecordingOptions,
    read: impl FnOnce(usize) -> Result<Vec<f64>, Problem>,
) -> Option<RecordingWarning> {
    let (column, unit_s) = selection.own_time?;
    let label = &labels[column];
    let times = read(column).ok().filter(|times| times.iter().all(|time| time.is_finite()))?;
    let (rate_hz, uncertainty) = match timing(&label.raw, &times, unit_s) {
        Ok(Timing { rate_hz, uncertainty, .. }) => (rate_hz, uncertainty),
        // Times with a gap have no rate, but so many samples in their span.
        Err(_) => {
            let mean_hz = (times.len() as f64 - 1.0) / (unit_s * (times.last()? - times.first()?));
            (readable(mean_hz), ROUGH_AGREEMENT)
        }
    };
    if !(rate_hz.is_finite() && rate_hz > 0.0) {
        return None;
    }
    let units = if label.states_time_unit() { &[1.0][..] } else { &[1.0, 1e3, 1e6] };
    let by = format!("time column {}", label.raw);
    let own = units.iter().map(|unit| other(&by, rate_hz * unit, uncertainty + AGREEMENT, options));
    own.collect::<Option<Vec<_>>>()?.into_iter().next()
}

fn other(by: &str, own_hz: f64, uncertainty: f64, options: &RecordingOptions) -> Option<RecordingWarning> {
    let stated_hz = options.sampling_rate_hz?;
    let differs = (own_hz / stated_hz - 1.0).abs() > uncertainty;
    differs.then(|| RecordingWarning::OtherRate { stated_hz, own_hz, by: by.to_owned() })
}

fn contradiction(first: &StatedRate, other: &str, other_hz: f64) -> Problem {
    let StatedRate { by, rate_hz } = first;
    Problem::rate(&format!("{by} states a sampling rate of {rate_hz} S/s, but {other} says {other_hz} S/s"))
}

/// A file that does not state its sampling rate. A single column is hardly the time.
fn no_rate(present: &[String]) -> Problem {
    let rest = match present {
        [_] => ", and has one column alone; give the sampling rate (option sampling_rate_hz)".to_owned(),
        _ => format!(
            ", and no column is named as time; give the sampling rate (option sampling_rate_hz) or say which column holds the \
             time (option time); it has {}",
            names(present)
        ),
    };
    Problem::NoRate(format!("does not state its sampling rate{rest}"))
}

#[cfg(test)]
mod tests {
    use super::StatedRate;

    #[test]
    fn rates_are_known_by_the_names_that_files_give_them() {
        let rate = |name: &str, value: f64| StatedRate::from_named(name, value).map(|stated| stated.rate_hz);
        for name in
            ["Head_1.SampFreq", "Fs", "bearing.sr", "SampleRate_Hz", "Header.Sampling_Frequency", "acq_rate"]
        {
            assert_eq!(rate(name, 20_000.0), Some(20_000.0), "{name}");
        }
        assert_eq!(rate("Signal_1.x_values.increment", 5e-5), Some(20_000.0));
        assert_eq!(rate("dt", 5e-5), Some(20_000.0));
        // The speed of the shaft, and the step of something else.
        assert_eq!(rate("shaft.sr", 25.0), None);
        assert_eq!(rate("load.increment", 0.5), None);
    }
}
