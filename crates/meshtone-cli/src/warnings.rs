//! What can be simulated but deserves the user's attention.

use meshtone::scenario::{ScenarioWarning, line_of_key};
use meshtone::sensor::Channels;
use meshtone_io::scenario_file::ScenarioFile;

use crate::terminal::print_error_line;

/// (-) Part of the time that the mesh may pull without a warning.
const TOLERATED_TENSION: f64 = 0.01;

/// Whether the mesh pulls for longer than it should.
pub fn of_tension(channels: &Channels) -> Option<ScenarioWarning> {
    let fraction = channels.tension_fraction();
    (fraction > TOLERATED_TENSION).then(|| {
        let percent = 100.0 * fraction;
        let message = format!(
            "the mesh force is negative for {percent:.1} % of the time: this linear mesh pulls where real \
             teeth would part; a heavier load or better teeth bring it down"
        );
        ScenarioWarning::new("operation.brake_torque_nm", message)
    })
}

/// Prints a warning with its file and line.
pub fn print(file: &ScenarioFile, warning: &ScenarioWarning) {
    let line = line_of_key(&file.text, &warning.key).map(|line| format!("line {line}: ")).unwrap_or_default();
    print_error_line(format!("warning: {}: {line}{warning}", file.path.display()));
}
