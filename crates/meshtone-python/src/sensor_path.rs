//! The path to a sensor.

use meshtone::Error;
use meshtone::signal::GearTrain;
use meshtone::tuning::{self, ExperimentControl, PathError, PathEstimate, PathSettings, SensorRecording};
use meshtone_io::path_csv::path_csv;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::array::{Array, Signal, array, samples};
use crate::error::{scenario_error, value_error};
use crate::interrupt::interruptible;
use crate::phase::ShaftPhase;
use crate::process::stated_of_rig;
use crate::scenario::Scenario;

/// Frequencies, magnitude, lower and upper end, phase; the frequencies that were compared; the text of the CSV file; draws that failed, of the
/// path and of the drive.
type Estimated<'py> = ([Array<'py>; 5], [f64; 2], Drive, String, [usize; 2]);

/// Wander of the speed, share of the lines, factor of the random force: each with what else is known of it; and sidebands: shaft, order, levels, factor,
/// and whether the scenario has no cause for more of them than its wheels.
type Drive = (Option<[f64; 3]>, Option<[f64; 2]>, Option<[f64; 3]>, Vec<Sidebands>);

type Sidebands = (String, usize, [f64; 2], [f64; 3], bool);

/// A recording: values in g, rate, phase, and the name of the shaft that it is of; none of the pinion or the input.
pub type Recorded<'py> = (Signal<'py>, f64, PyRef<'py, ShaftPhase>, Option<String>);

/// Recordings of the healthy machine.
///
/// # Arguments
/// * `rig`, `train` - the machine
/// * `recordings` - as Python gives them
pub fn sensor_recordings(
    rig: &meshtone::scenario::Scenario,
    train: &GearTrain,
    recordings: &[Recorded<'_>],
) -> PyResult<Vec<SensorRecording>> {
    let healthy = |(values, sampling_rate_hz, phase, shaft): &Recorded<'_>| {
        let values_g = samples(values)?.to_vec();
        let (shaft, stated) = stated_of_rig(rig, train, phase, shaft.as_deref())?;
        let sampling_rate_hz = *sampling_rate_hz;
        Ok(SensorRecording { values_g, sampling_rate_hz, shaft, phase: phase.0.clone(), stated })
    };
    recordings.iter().map(healthy).collect()
}

/// The exception of an error.
pub fn path_error(error: PathError) -> PyErr {
    match &error {
        PathError::Simulation(Error::Scenario(error)) => scenario_error(error),
        PathError::Cancelled => PyRuntimeError::new_err(error.to_string()),
        _ => value_error(error),
    }
}

/// Estimates the path from recordings.
#[pyfunction]
pub fn estimate_path<'py>(
    py: Python<'py>,
    machine: PyRef<'py, Scenario>,
    recordings: Vec<Recorded<'py>>,
    draws: usize,
    seed: u64,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Estimated<'py>> {
    let (rig, settings) = (machine.0.clone(), PathSettings { draws, seed });
    let train = GearTrain::of_scenario(&rig).map_err(|error| scenario_error(&error))?;
    let healthy = sensor_recordings(&rig, &train, &recordings)?;
    let estimate = interruptible(py, progress, 0, |cancelled, report| {
        let progress = |finished: usize, all: usize| report(finished as u64, all as u64);
        tuning::estimate_path(
            &rig,
            &healthy,
            &settings,
            &ExperimentControl { progress: &progress, cancelled },
        )
    })?;
    let estimate = estimate.map_err(path_error)?;
    let text = path_csv(&estimate);
    let failed = [estimate.failed_draws, estimate.drive.failed];
    let PathEstimate { frequency_hz, magnitude_db, low_db, high_db, phase_deg, compared_hz, drive, .. } =
        estimate;
    let columns = [frequency_hz, magnitude_db, low_db, high_db, phase_deg].map(|column| array(py, column));
    let sidebands = drive.sidebands.into_iter().map(|of| {
        let is_unexplained = of.is_unexplained();
        (of.shaft, of.order, of.level, of.factor, is_unexplained)
    });
    let drive =
        (drive.speed_wander_percent, drive.line_share, drive.random_force_factor, sidebands.collect());
    Ok((columns, compared_hz, drive, text, failed))
}
