//! Rules for `[solver]`.

use super::super::Solver;
use super::rules::{Check, finite, positive, require};

pub(super) fn check(solver: &Solver) -> Check {
    positive("solver.sampling_rate_hz", solver.sampling_rate_hz, "S/s")?;
    let settle = solver.settle_fraction;
    require(
        "solver.settle_fraction",
        settle,
        (0.0..1.0).contains(&settle),
        "must be from 0 to less than 1, the part of the simulation that is discarded",
    )?;
    let tolerance = solver.settle_tolerance;
    require(
        "solver.settle_tolerance",
        tolerance,
        (0.0..1.0).contains(&tolerance),
        "must be from 0 (the whole settling is simulated) to less than 1",
    )?;
    state("solver.initial_displacement", solver.initial_displacement.as_ref())?;
    state("solver.initial_velocity", solver.initial_velocity.as_ref())
}

fn state(key: &str, state: Option<&[f64; 13]>) -> Check {
    let values = state.into_iter().flatten().enumerate();
    values.into_iter().try_for_each(|(index, value)| finite(&format!("{key}[{index}]"), *value))
}
