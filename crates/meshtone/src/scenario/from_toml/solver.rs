//! The section `[solver]`.

use super::super::Solver;
use crate::toml_reader::{ReadResult, TomlTable};

pub(super) fn read(table: &TomlTable<'_>) -> ReadResult<Solver> {
    let default = Solver::default();
    let state = |key| table.optional(key).map(|value| value.exactly()).transpose();
    Ok(Solver {
        sampling_rate_hz: table.number_or("sampling_rate_hz", default.sampling_rate_hz)?,
        settle_tolerance: table.number_or("settle_tolerance", default.settle_tolerance)?,
        settle_fraction: table.number_or("settle_fraction", default.settle_fraction)?,
        initial_displacement: state("initial_displacement")?,
        initial_velocity: state("initial_velocity")?,
    })
}
