//! Warnings: they concern input that can be simulated or processed but deserves the user's attention.

use std::fmt::Display;
use std::path::Path;

use meshtone::scenario::{ScenarioWarning, line_of_key};
use meshtone::signal::SignalWarning;
use meshtone_io::indicators::WarningEntry;
use meshtone_io::scenario_file::ScenarioFile;

use crate::terminal::warn;

/// Prints warnings about a scenario with its file and line.
pub fn print(file: &ScenarioFile, warnings: &[ScenarioWarning]) {
    for warning in warnings {
        let line = line_of_key(&file.text, &warning.key);
        let line = line.map(|line| format!("line {line}: ")).unwrap_or_default();
        warn(format_args!("{}: {line}{warning}", file.path.display()));
    }
}

/// A warning about a recording.
pub fn about(source: &Path, message: impl Display) -> WarningEntry {
    WarningEntry { source: Some(source.to_path_buf()), message: message.to_string(), kind: None }
}

/// A warning about the signal of a recording, with the options that help.
pub fn about_signal(source: &Path, warning: &SignalWarning) -> WarningEntry {
    let options = match warning.code() {
        "varying_speed" => " (--tach, --pulse-times, --speed-channel, --speed-profile or --from-mesh-tone)",
        "nothing-synchronous" => " (--sampling-rate-hz, --shaft-hz, --pulses-per-rev, --teeth, --mate-teeth)",
        "not-averaged" => " (--bearing-separation)",
        _ => "",
    };
    WarningEntry { kind: Some(warning.clone()), ..about(source, format_args!("{warning}{options}")) }
}

/// A warning with the recording that it is about.
pub fn in_words(warning: &WarningEntry) -> String {
    let source = warning.source.as_ref().map(|source| format!("{}: ", source.display())).unwrap_or_default();
    format!("{source}{}", warning.message)
}
