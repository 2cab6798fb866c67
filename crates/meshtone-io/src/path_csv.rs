//! An estimated path to a sensor as a CSV file.

use std::fmt::Write;

use meshtone::tuning::PathEstimate;

/// The text of a file that `frequency_response = { file = … }` takes: the three columns that it reads, and behind them the magnitude and
/// its interval in decibels.
///
/// # Arguments
/// * `path` - the estimate
pub fn path_csv(path: &PathEstimate) -> String {
    let response = path.frequency_response();
    let mut text = String::from("frequency_hz,magnitude,phase_deg,magnitude_db,low_db,high_db\n");
    for (at, hz) in path.frequency_hz.iter().enumerate() {
        let (magnitude, phase_deg) = (response.magnitude[at], path.phase_deg[at]);
        let [db, low, high] = [&path.magnitude_db, &path.low_db, &path.high_db].map(|values| values[at]);
        // Writing to a text cannot fail.
        let _ = writeln!(text, "{hz:.3},{magnitude:.6e},{phase_deg:.3},{db:.3},{low:.3},{high:.3}");
    }
    text
}
