//! A quantity against time, from two columns of a CSV file.

use std::path::Path;

use meshtone::scenario::{FileProblem, Profile};

use super::number_csv::NumberCsv;

const FILE: NumberCsv<2> = NumberCsv {
    names: ["time_s", "value"],
    // The second column may have any name.
    checked_names: 1,
    needs_names: false,
    help: "write two columns separated by a comma, time_s and value, with a point as decimal sign; \
           the first line may name them",
};

pub(super) fn read(path: &Path) -> Result<Profile, FileProblem> {
    FILE.read(path).map(|[time_s, value]| Profile { time_s, value })
}
