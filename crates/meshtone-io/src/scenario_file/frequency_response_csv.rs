//! A frequency response, from three columns of a CSV file.

use std::path::Path;

use meshtone::scenario::{FileProblem, FrequencyResponse};

use super::number_csv::NumberCsv;

const FILE: NumberCsv<3> = NumberCsv {
    names: ["frequency_hz", "magnitude", "phase_deg"],
    checked_names: 3,
    // Real and imaginary parts, decibels or radians would otherwise be taken for magnitude and phase.
    needs_names: true,
    help: "write three columns separated by a comma, with a point as decimal sign; the first line must be \
           frequency_hz,magnitude,phase_deg",
};

pub(super) fn read(path: &Path) -> Result<FrequencyResponse, FileProblem> {
    let columns = FILE.read(path)?;
    let [frequency_hz, magnitude, phase_deg] = columns;
    Ok(FrequencyResponse { frequency_hz, magnitude, phase_deg })
}
