//! The hybrid stage.

use std::path::PathBuf;

use meshtone::tuning::{self, ExperimentControl};
use meshtone_io::experiment::{self, Tuned, read_experiment, read_tuned, tuning_json, write_tuned};
use numpy::PyArray2;
use pyo3::prelude::*;

use crate::array::{Array, Signal, array, matrix, samples};
use crate::error::{read_error, scenario_error, value_error};
use crate::interrupt::interruptible;
use crate::scenario::Scenario;

/// Changes the duration of the fault's response.
#[pyfunction]
pub fn change_duration<'py>(
    py: Python<'py>,
    signal: Signal<'py>,
    width_ratio: f64,
    centre_rev: f64,
) -> PyResult<Array<'py>> {
    let changed = tuning::change_duration(samples(&signal)?, width_ratio, centre_rev).map_err(value_error)?;
    Ok(array(py, changed))
}

/// Changes the ratio of the fault's response to what a healthy pair shows.
#[pyfunction]
pub fn change_fault_to_harmonics_ratio<'py>(
    py: Python<'py>,
    signal: Signal<'py>,
    healthy: Signal<'py>,
    fault_to_harmonics_ratio: f64,
) -> PyResult<Array<'py>> {
    let (signal, healthy) = (samples(&signal)?, samples(&healthy)?);
    let changed = tuning::change_fault_to_harmonics_ratio(signal, healthy, fault_to_harmonics_ratio);
    Ok(array(py, changed.map_err(value_error)?))
}

/// Adds white Gaussian noise.
#[pyfunction]
pub fn add_noise<'py>(
    py: Python<'py>,
    signal: Signal<'py>,
    noise_level: f64,
    healthy_rms: f64,
    seed: u64,
    draw: u64,
) -> PyResult<Array<'py>> {
    let noisy =
        tuning::add_noise(samples(&signal)?, noise_level, healthy_rms, seed, draw).map_err(value_error)?;
    Ok(array(py, noisy))
}

/// Runs an experiment file: the text of `tuning.json` and that of `tuned.toml`.
#[pyfunction]
pub fn tune(py: Python<'_>, path: PathBuf, progress: Option<Bound<'_, PyAny>>) -> PyResult<(String, String)> {
    let file = py.detach(|| read_experiment(&path)).map_err(|error| read_error(&path, &error))?;
    let experiment = &file.experiment;
    let result = interruptible(py, progress, 0, |cancelled, report| {
        let progress = |done, of| report(done as u64, of as u64);
        tuning::run_experiment(experiment, &ExperimentControl { progress: &progress, cancelled })
    })?;
    let result = result.map_err(|error| value_error(format!("{}: {error}", path.display())))?;
    let tuned = write_tuned(&Tuned::of(experiment, &result), &path.display().to_string());
    Ok((tuning_json(&file, &result).to_string(), tuned))
}

/// Enhanced difference signals of a scenario, a row a draw, relative to the healthy rms; and that rms in g.
#[pyfunction]
pub fn enhance<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    tuned: PathBuf,
    draws: u64,
    seed: u64,
) -> PyResult<(Bound<'py, PyArray2<f64>>, f64)> {
    let tuned_file = read_tuned(&tuned).map_err(|error| read_error(&tuned, &error))?;
    let scenario = tuned_file.apply(&scenario.0).map_err(|error| scenario_error(&error))?;
    let enhanced =
        py.detach(|| experiment::enhance(&scenario, &tuned_file, seed, draws)).map_err(value_error)?;
    let points = enhanced.records.first().map_or(0, |record| record.relative_difference.len());
    let rows = enhanced.records.len();
    let values: Vec<f64> =
        enhanced.records.into_iter().flat_map(|record| record.relative_difference).collect();
    Ok((matrix(py, values, [rows, points])?, enhanced.healthy_rms_g))
}
