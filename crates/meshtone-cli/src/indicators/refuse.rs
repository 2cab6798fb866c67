//! What is wrong with a recording, in the words of the command line.

use std::io::ErrorKind;
use std::path::Path;

use meshtone::signal::SignalError;
use meshtone_io::recording::ReadRecordingError;

use crate::failure::Failure;

/// What the library calls options, and what the command line does.
const OPTIONS: [(&str, &str); 9] = [
    ("option channels, or variable", "--channel or --variable"),
    ("option channels", "--channel"),
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
        if let ReadRecordingError::Unreadable { path, source } = &error {
            return match source.kind() {
                ErrorKind::NotFound => Self::bad_input(format!("there is no recording {}", path.display())),
                ErrorKind::IsADirectory => Self::bad_input(format!("{} is a directory", path.display()))
                    .with_help("name a file, or a directory that `meshtone simulate` wrote"),
                kind => Self::of_file(kind, error.to_string()),
            };
        }
        let message = error.to_string();
        Self::bad_input(OPTIONS.iter().fold(message, |message, (option, flag)| message.replace(option, flag)))
    }
}

/// Refuses a channel of a recording, or its phase.
pub fn refuse(path: &Path, what: &str, error: &SignalError) -> Failure {
    let failure = Failure::bad_input(format!("{}: {what}: {error}", path.display()));
    match help(error) {
        Some(help) => failure.with_help(help),
        None => failure,
    }
}

fn help(error: &SignalError) -> Option<&'static str> {
    use SignalError::{
        Constant, MeshOrderBeyondNyquist, NotFinite, PulseGap, SpeedMismatch, TooFew, TooFewRevolutions,
    };

    match error {
        NotFinite { .. } => {
            Some("cut the recording there, fill the gap, or choose another channel with --channel")
        }
        Constant { .. } => Some("choose another channel with --channel; was the sensor connected?"),
        TooFewRevolutions { .. } => {
            Some("record for longer, or check --shaft-hz, --pulses-per-rev and the sampling rate")
        }
        MeshOrderBeyondNyquist { .. } => Some("check --teeth and the speed, or record at a higher rate"),
        SpeedMismatch { .. } => {
            Some("check --shaft-hz (revolutions per second, not rpm) and --pulses-per-rev")
        }
        TooFew { what: "tachometer pulses", .. } | PulseGap { .. } => {
            Some("check --threshold, --hysteresis and --edge, and that the channel is the tachometer's")
        }
        _ => None,
    }
}
