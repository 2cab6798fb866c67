//! Errors about a recording, in the words of the command line.

use std::io::ErrorKind;
use std::path::Path;

use meshtone::signal::SignalError;
use meshtone_io::recording::ReadRecordingError;

use crate::failure::Failure;
use crate::other_kind::{or_other_kind, recording_within};

/// Name of the input.
const RECORDING: &str = "a recording";

/// The option that names the column which is processed.
const CHANNEL: &str = "--channel";
/// Names of options in the library and on the command line.
const OPTIONS: [(&str, &str); 10] = [
    ("option channels, or variable", "--channel or --variable"),
    ("option variable", "--variable"),
    ("option channels", CHANNEL),
    ("option sampling_rate_hz", "--sampling-rate-hz"),
    ("option text.decimal_sign", "--decimal-sign"),
    ("text.separator", "--separator"),
    ("option text.skip_lines", "--skip-lines"),
    ("option time", "--time-column"),
    ("text.decimal_sign", "--decimal-sign"),
    ("option --", "--"),
];

impl From<ReadRecordingError> for Failure {
    fn from(error: ReadRecordingError) -> Self {
        unreadable(error, CHANNEL)
    }
}

/// Refuses a file.
///
/// # Arguments
/// * `error` - what is wrong with it
/// * `option` - that names the column which is read
pub fn unreadable(error: ReadRecordingError, option: &str) -> Failure {
    if let ReadRecordingError::Unreadable { path, source } = &error {
        return match source.kind() {
            ErrorKind::NotFound => Failure::bad_input(format!("there is no recording {}", path.display())),
            ErrorKind::IsADirectory => {
                let help = match recording_within(path) {
                    Some(one) => {
                        format!("name the recordings in it, as `meshtone indicators {} …`", one.display())
                    }
                    None => "name a file, or a directory that `meshtone simulate` wrote".to_owned(),
                };
                let failure =
                    Failure::bad_input(format!("{} is a directory", path.display())).with_help(help);
                or_other_kind(path, RECORDING, failure)
            }
            kind => Failure::of_reading(kind, error.to_string()),
        };
    }
    let message = error.to_string();
    if let ReadRecordingError::UnknownFormat { path, .. } = &error {
        return or_other_kind(path, RECORDING, Failure::bad_input(message));
    }
    let message = OPTIONS.iter().fold(message, |message, (option, flag)| message.replace(option, flag));
    Failure::bad_input(message.replace(CHANNEL, option))
}

/// The input that is refused, on which the advice to the user depends.
#[derive(Debug, Clone, Copy)]
pub enum RefusedInput<'a> {
    /// The channel of a measurement.
    Measured {
        /// (Hz) Mean speed of the shaft.
        speed_hz: f64,
        /// Source of the phase, in words.
        by: &'a str,
    },
    /// The channel of a simulation.
    Simulated {
        /// Whether the recording is cut into segments.
        in_segments: bool,
    },
    /// The tachometer's waveform.
    Tachometer,
    /// The times of its pulses.
    PulseTimes,
    /// Any other source of the phase.
    Phase,
}

/// Refuses a channel of a recording, or its phase.
///
/// # Arguments
/// * `path` - the recording
/// * `what` - the channel, or the option that names it
/// * `subject` - what that is
/// * `error` - what is wrong with it
pub fn refuse(path: &Path, what: &str, subject: RefusedInput, error: &SignalError) -> Failure {
    let message = format!("{}: {what}: {error}", path.display());
    Failure { help: help(subject, error), ..Failure::bad_input(message) }
}

/// Returns what a user may do about an error, or nothing where the error already says it.
///
/// The same error of a signal has another cause in a tachometer, in pulse times, in a simulation and in a measured channel, so that the
/// help depends on both. It names options of the program, which the library's errors cannot.
fn help(subject: RefusedInput, error: &SignalError) -> Option<String> {
    use RefusedInput::{Measured, PulseTimes, Simulated, Tachometer};
    use SignalError::{
        Constant, MeshOrderBeyondNyquist, PulseGap, SpeedMismatch, TooFew, TooFewPassages, TooFewRevolutions,
    };

    let help = match (error, subject) {
        (Constant { .. }, Tachometer) => {
            "was the tachometer connected? Name its channel with --tach; without one, take --from-mesh-tone or --shaft-hz"
        }
        (Constant { .. }, Simulated { .. }) => {
            "this signal of the simulation does not change; leave out --channel for the first listed sensor or the \
             vertical acceleration, or name another"
        }
        (Constant { .. }, _) => "choose another channel with --channel; was the sensor connected?",
        (TooFewRevolutions { .. }, Simulated { in_segments: true }) => {
            "state fewer --revolutions: a simulation keeps as many revolutions of a wheel as its mate has teeth, or less"
        }
        (TooFewRevolutions { .. } | TooFewPassages { .. }, Simulated { in_segments: false }) => {
            "simulate for longer: raise solver.duration_s, or the revolutions under [solver], in the scenario"
        }
        (TooFewPassages { .. }, Simulated { .. }) => "state more --revolutions, or none",
        (TooFewRevolutions { .. } | TooFewPassages { .. }, _) => {
            "record for longer, or check --shaft-hz, --pulses-per-rev, --revolutions and the sampling rate"
        }
        (MeshOrderBeyondNyquist { .. }, Measured { speed_hz, by }) => {
            return Some(format!(
                "the shaft turns at {speed_hz:.4} Hz by the {by}: check that (revolutions per second, not rpm) and --teeth, or \
                 record at a higher rate"
            ));
        }
        (MeshOrderBeyondNyquist { .. }, _) => "simulate at a higher solver.sampling_rate_hz",
        (SpeedMismatch { .. }, _) => {
            "check --shaft-hz (revolutions per second, not rpm) and --pulses-per-rev"
        }
        (TooFew { what: "tachometer pulses", .. }, Tachometer) => {
            "record for longer: two revolutions are three pulses, more with --pulses-per-rev; or check --threshold, \
             --hysteresis and --edge, and that --tach names the tachometer's channel"
        }
        (TooFew { what: "tachometer pulses", .. }, PulseTimes) => {
            "record for longer: two revolutions are three pulses, more with --pulses-per-rev"
        }
        (PulseGap { .. }, Tachometer) => {
            "check --threshold, --hysteresis and --edge, and that --tach names the tachometer's channel"
        }
        _ => return None,
    };
    Some(help.to_string())
}
