//! Printing what can be simulated but deserves the user's attention.

use meshtone::scenario::{ScenarioWarning, line_of_key};
use meshtone_io::scenario_file::ScenarioFile;

use crate::terminal::print_error_line;

/// Prints a warning with its file and line.
pub fn print(file: &ScenarioFile, warning: &ScenarioWarning) {
    let line = line_of_key(&file.text, &warning.key).map(|line| format!("line {line}: ")).unwrap_or_default();
    print_error_line(format!("warning: {}: {line}{warning}", file.path.display()));
}
