//! Reading signals back.

use std::fs::File;
use std::path::Path;

use meshtone::scenario::Scenario;
use meshtone::sensor::Channels;

use crate::ReadResultsError;
use crate::input_file::open_ordinary;
use crate::memory;
use crate::recording::parquet_check::is_sound;
use crate::run_identity::RunIdentity;
use crate::table::{FoundType, NumberType, TableReader};

use super::{GEARBOX_KEY, RATE_KEY, RUN_KEY, SCENARIO_KEY, TIME, VERSION_KEY};

/// A simulation's signals, read back.
#[derive(Debug, Clone, PartialEq)]
pub struct Recorded {
    /// What was simulated.
    pub scenario: Scenario,
    /// The signals.
    pub channels: Channels,
    /// Version of Meshtone that wrote the file.
    pub version: String,
    /// Identity of the run that wrote it.
    pub run: RunIdentity,
}

/// Reads what a [`super::SignalTable`] wrote.
///
/// # Arguments
/// * `path` - the Parquet file
///
/// # Errors
/// The file cannot be read, or it is none that Meshtone wrote; it lacks a signal of what was simulated.
pub fn read_signals(path: &Path) -> Result<Recorded, ReadResultsError> {
    let foreign = |problem: String| ReadResultsError::foreign(path, problem);
    let table = open(path)?;
    let text_of = |key: &str| table.text_of(key).ok_or_else(|| foreign(missing(key)));
    let toml = table.text_of(GEARBOX_KEY).map_or_else(|| text_of(SCENARIO_KEY), Ok)?;
    let version = text_of(VERSION_KEY)?.to_string();
    let run = text_of(RUN_KEY)?.parse::<RunIdentity>();
    let run = run.map_err(|error| foreign(format!("metadata {RUN_KEY}: {error}")))?;
    let sampling_rate_hz = rate(text_of(RATE_KEY)?).map_err(foreign)?;
    let scenario = Scenario::from_toml(toml).map_err(|error| ReadResultsError::scenario(path, &error))?;
    let start_s = numbers(&table, TIME).map_err(foreign)?.first().copied().unwrap_or(0.0);
    let mut signals = scenario.signals();
    for signal in &mut signals {
        signal.values = numbers(&table, &signal.name).map_err(foreign)?;
    }
    Ok(Recorded { scenario, channels: Channels::new(sampling_rate_hz, start_s, signals), version, run })
}

fn missing(key: &str) -> String {
    format!("has no metadata {key}, so `meshtone simulate` did not write it")
}

/// Opens a file of signals that fits into the memory.
fn open(path: &Path) -> Result<TableReader<File>, ReadResultsError> {
    let unreadable = |source| ReadResultsError::unreadable(path, source);
    let mut file = open_ordinary(path).map_err(unreadable)?;
    let foreign = |problem: String| ReadResultsError::foreign(path, problem);
    let file_bytes = file.metadata().map_err(unreadable)?.len();
    if !is_sound(&mut file, file_bytes).map_err(unreadable)? {
        return Err(foreign("is not a whole Parquet file: its metadata are damaged".to_owned()));
    }
    let table =
        TableReader::new(file).map_err(|error| foreign(format!("is not a whole Parquet file: {error}")))?;
    let rows = u64::try_from(table.metadata().file_metadata().num_rows()).unwrap_or(u64::MAX);
    let needed = rows.saturating_mul((size_of::<f64>() * table.columns().len()) as u64);
    match memory::limit().objection(needed) {
        Some(objection) => Err(foreign(format!("its {rows} rows {objection}; raise the memory limit"))),
        None => Ok(table),
    }
}

fn rate(text: &str) -> Result<f64, String> {
    let rate = text.parse().ok().filter(|rate: &f64| rate.is_finite() && *rate > 0.0);
    rate.ok_or_else(|| format!("metadata {RATE_KEY} is `{text}`; must be a number above 0"))
}

fn numbers(table: &TableReader<File>, name: &str) -> Result<Vec<f64>, String> {
    let column = table.column(name).ok_or_else(|| format!("has no column {name}"))?;
    let wrong = || format!("has a column {name} of {}; must be of Float64 without nulls", column.kind);
    if column.kind != FoundType::Number(NumberType::Float(64)) {
        return Err(wrong());
    }
    let numbers =
        table.numbers(column, 0).map_err(|error| format!("is not a whole Parquet file: {error}"))?;
    if numbers.first_empty.is_none() { Ok(numbers.values) } else { Err(wrong()) }
}
