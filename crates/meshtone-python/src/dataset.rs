//! Data sets.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use meshtone_dataset::generate::{self, GenerateControl, Part};
use meshtone_dataset::merge::merge;
use meshtone_dataset::plan::{Plan, PlanFile, template};
use meshtone_dataset::record::MachineRecording;
use meshtone_dataset::store::Destination;
use meshtone_dataset::verify::{Check, verify};
use meshtone_dataset::{DatasetError, rows_like as rows_like_of};
use pyo3::PyErr;
use pyo3::exceptions::{PyBlockingIOError, PyKeyboardInterrupt, PyRuntimeError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use toml::Table;

use crate::array::{Signal, samples};
use crate::error::{os_error, read_error, value_error, with_help};
use crate::interrupt::interruptible;
use crate::phase::ShaftPhase;
use crate::process::{TypedWarning, typed};
use crate::scenario::Scenario;
use crate::value::table;

/// The commented plan.
#[pyfunction]
pub fn dataset_template() -> &'static str {
    template()
}

/// Refuses a plan that is wrong.
#[pyfunction]
pub fn check_plan(py: Python<'_>, plan: PathBuf) -> PyResult<()> {
    py.detach(|| Plan::read(&plan)).map(drop).map_err(|error| read_error(&plan, &error))
}

/// Files that were made again, and why; warnings about the plan.
type Made = (Vec<(String, String)>, Vec<String>);

/// Makes a data set, or a part of it, or goes on with one.
#[pyfunction]
pub fn generate_dataset(
    py: Python<'_>,
    plan: &Bound<'_, PyAny>,
    records: Option<u32>,
    to: &str,
    jobs: Option<usize>,
    part: u64,
    of: u64,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<Made> {
    if part < 1 || part > of {
        return Err(value_error(format!("part = ({part}, {of}): must be (i, n) with i from 1 to n")));
    }
    if jobs == Some(0) {
        return Err(value_error("jobs = 0: must be at least 1"));
    }
    let read = plan_of(py, plan, records)?;
    let doubts = read.warnings();
    let to = destination(to)?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(jobs.unwrap_or(0)).build();
    let pool = pool.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    let generated = interruptible(py, progress, 0, |cancelled, progress| {
        let control = GenerateControl { progress, cancelled };
        pool.install(|| generate::generate(&read, &to, Part { number: part, of }, &control))
    })?;
    let remade = generated.map_err(dataset_error)?.remade.into_iter();
    Ok((remade.map(|remade| (remade.file, remade.reason)).collect(), doubts))
}

/// Reads a plan: a file, or a dictionary, of which the names of files are relative to the working directory.
///
/// # Arguments
/// * `records` - instead of the plan's number
fn plan_of(py: Python<'_>, plan: &Bound<'_, PyAny>, records: Option<u32>) -> PyResult<Plan> {
    let (mut table, path) = if let Ok(dictionary) = plan.cast::<PyDict>() {
        (table(dictionary)?, PathBuf::from("plan.toml"))
    } else {
        let path: PathBuf = plan.extract()?;
        let read = py.detach(|| Plan::read(&path)).map_err(|error| read_error(&path, &error))?;
        let plan = read.files.iter().find(|file| records.is_some() && file.name == PlanFile::NAMES[0]);
        let text = plan.map(|plan| plan.text.parse::<Table>());
        let Some(Ok(table)) = text else { return Ok(read) };
        (table, path)
    };
    if let Some(records) = records {
        table.insert("records".to_owned(), i64::from(records).into());
    }
    py.detach(|| Plan::read_text(table.to_string(), &path)).map_err(|error| read_error(&path, &error))
}

/// Puts parts together.
#[pyfunction]
pub fn merge_datasets(py: Python<'_>, parts: Vec<String>, to: &str, verify: bool) -> PyResult<()> {
    let parts = parts.iter().map(|part| destination(part)).collect::<PyResult<Vec<_>>>()?;
    let to = destination(to)?;
    py.detach(|| merge(&parts, &to, check(verify))).map(drop).map_err(dataset_error)
}

/// Shards that are there, shards that are missing, what is wrong by files.
type Found = (Vec<String>, Vec<String>, BTreeMap<String, String>);

/// Looks at names, sizes and counts of a data set, or at every byte.
#[pyfunction]
pub fn verify_dataset(py: Python<'_>, path: &str, bytes: bool) -> PyResult<Found> {
    let place = destination(path)?;
    let found = py.detach(|| verify(&place, check(bytes))).map_err(dataset_error)?;
    Ok((found.shards, found.missing, found.problems))
}

/// The channels of a recording by their names, none of the analysed one, and the phase of a shaft.
type Recorded<'py> = (Vec<(Option<String>, Signal<'py>)>, PyRef<'py, ShaftPhase>);

/// Takes recordings to records like those of the data set of a plan: a Parquet file, and what is doubtful.
#[pyfunction]
pub fn rows_like<'py>(
    py: Python<'py>,
    plan: PathBuf,
    recordings: Vec<Recorded<'py>>,
    machine: PyRef<'py, Scenario>,
    sampling_rate_hz: f64,
    shaft: Option<&str>,
) -> PyResult<(Bound<'py, PyBytes>, Vec<TypedWarning>)> {
    let read = py.detach(|| Plan::read_copy(&plan)).map_err(|error| read_error(&plan, &error))?;
    let analysed = read.content.keep.analysed.name().into_owned();
    let single = |(name, signal): &(Option<String>, Signal<'py>)| {
        let name = name.as_ref().unwrap_or(&analysed);
        Ok((name.clone(), samples(signal)?.iter().map(|&value| value as f32).collect()))
    };
    let channels = recordings.iter().map(|(channels, _)| channels.iter().map(single).collect());
    let channels = channels.collect::<PyResult<Vec<Vec<(String, Vec<f32>)>>>>()?;
    let machine = machine.0.clone();
    let phases: Vec<_> = recordings.iter().map(|(_, phase)| &phase.0).collect();
    let rows = py.detach(|| {
        let recordings = channels.iter().zip(phases).map(|(channels, phase)| MachineRecording {
            channels,
            sampling_rate_hz,
            machine: &machine,
            shaft,
            phase,
        });
        rows_like_of(&read, &recordings.collect::<Vec<_>>())
    });
    let rows = rows.map_err(dataset_error)?;
    Ok((PyBytes::new(py, &rows.parquet), typed(&rows.warnings)))
}

fn check(bytes: bool) -> Check {
    if bytes { Check::Bytes } else { Check::Sizes }
}

fn destination(to: &str) -> PyResult<Destination> {
    Destination::parse(to).map_err(dataset_error)
}

/// The exception of an error.
pub fn dataset_error(error: DatasetError) -> PyErr {
    match error {
        DatasetError::Plan(error) => read_error(Path::new("."), &error),
        DatasetError::Refused { problem, help } => with_help(problem, Some(&help)),
        DatasetError::Stopped => PyKeyboardInterrupt::new_err("stopped"),
        DatasetError::NoRecord { .. } => value_error(error),
        DatasetError::Busy { .. } => PyBlockingIOError::new_err(error.to_string()),
        DatasetError::File { doing, name, source } => os_error(doing, name, &source),
        DatasetError::Preview(_) => PyRuntimeError::new_err(error.to_string()),
    }
}
