//! Reading signals back.

use std::fs::File;
use std::path::Path;

use meshtone::scenario::{Gearbox, Scenario};
use meshtone::sensor::{ChannelKind, Channels, SensorSignal};

use crate::ReadResultsError;
use crate::input_file::open_ordinary;
use crate::memory;
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

/// The signals of a gearbox, read back.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedGearbox {
    /// What was simulated.
    pub gearbox: Gearbox,
    /// (S/s) Sampling rate.
    pub sampling_rate_hz: f64,
    /// The signals by their names, in the file's order.
    pub signals: Vec<(String, Vec<f64>)>,
    /// Version of Meshtone that wrote the file.
    pub version: String,
    /// Identity of the run that wrote it.
    pub run: RunIdentity,
}

/// A file of signals with the metadata that each has.
struct SignalsFile<'p> {
    path: &'p Path,
    table: TableReader<File>,
    version: String,
    run: RunIdentity,
    sampling_rate_hz: f64,
}

impl SignalsFile<'_> {
    fn foreign(&self, problem: String) -> ReadResultsError {
        ReadResultsError::foreign(self.path, problem)
    }

    fn numbers(&self, name: &str) -> Result<Vec<f64>, ReadResultsError> {
        numbers(&self.table, name).map_err(|problem| self.foreign(problem))
    }
}

/// Reads what a [`super::SignalTable::of_gearbox`] wrote.
///
/// # Arguments
/// * `path` - the Parquet file
///
/// # Returns
/// None of a file that is not of a gearbox.
///
/// # Errors
/// Those of [`read_signals`].
pub fn read_gearbox_signals(path: &Path) -> Result<Option<RecordedGearbox>, ReadResultsError> {
    let file = open(path)?;
    let Some(toml) = file.table.text_of(GEARBOX_KEY) else { return Ok(None) };
    let gearbox = Gearbox::from_toml(toml).map_err(|error| ReadResultsError::scenario(path, &error))?;
    let names: Vec<String> = file.table.columns().iter().map(|column| column.name.clone()).collect();
    let names = names.into_iter().filter(|name| name != TIME);
    let signals = names.map(|name| Ok((name.clone(), file.numbers(&name)?))).collect::<Result<_, _>>()?;
    let SignalsFile { version, run, sampling_rate_hz, .. } = file;
    Ok(Some(RecordedGearbox { gearbox, sampling_rate_hz, signals, version, run }))
}

/// Reads what a [`super::SignalTable::of_pair`] wrote.
///
/// # Arguments
/// * `path` - the Parquet file
///
/// # Errors
/// The file cannot be read, or it is none that Meshtone wrote; it is of a gearbox.
pub fn read_signals(path: &Path) -> Result<Recorded, ReadResultsError> {
    let file = open(path)?;
    let Some(toml) = file.table.text_of(SCENARIO_KEY) else {
        return Err(file.foreign(match file.table.text_of(GEARBOX_KEY) {
            Some(_) => "is of a gearbox, and one pair of gears is expected here".to_owned(),
            None => missing(SCENARIO_KEY),
        }));
    };
    let scenario = Scenario::from_toml(toml).map_err(|error| ReadResultsError::scenario(path, &error))?;
    let mut channels = Channels::default();
    channels.sampling_rate_hz = file.sampling_rate_hz;
    channels.start_s = file.numbers(TIME)?.first().copied().unwrap_or(0.0);
    for kind in ChannelKind::ALL {
        *channels.get_mut(kind) = file.numbers(kind.name())?;
    }
    for sensor in &scenario.sensors {
        channels
            .sensors
            .push(SensorSignal { name: sensor.name(), values_g: file.numbers(&sensor.channel())? });
    }
    let SignalsFile { version, run, .. } = file;
    Ok(Recorded { scenario, channels, version, run })
}

fn missing(key: &str) -> String {
    format!("has no metadata {key}, so `meshtone simulate` did not write it")
}

/// Opens a file of signals, of one pair or of a gearbox.
fn open(path: &Path) -> Result<SignalsFile<'_>, ReadResultsError> {
    let file = open_ordinary(path).map_err(|source| ReadResultsError::unreadable(path, source))?;
    let foreign = |problem: String| ReadResultsError::foreign(path, problem);
    let broken = |error: &dyn std::fmt::Display| foreign(format!("is not a whole Parquet file: {error}"));
    let table = TableReader::new(file).map_err(|error| broken(&error))?;
    let rows = u64::try_from(table.metadata().file_metadata().num_rows()).unwrap_or(u64::MAX);
    let needed = rows.saturating_mul((size_of::<f64>() * table.columns().len()) as u64);
    if let Some(objection) = memory::limit().objection(needed) {
        return Err(foreign(format!("its {rows} rows {objection}; raise the memory limit")));
    }
    let text_of = |key: &str| table.text_of(key).ok_or_else(|| foreign(missing(key)));
    if table.text_of(GEARBOX_KEY).is_none() {
        text_of(SCENARIO_KEY)?;
    }
    let version = text_of(VERSION_KEY)?.to_string();
    let run = text_of(RUN_KEY)?.parse::<RunIdentity>();
    let run = run.map_err(|error| foreign(format!("metadata {RUN_KEY}: {error}")))?;
    let sampling_rate_hz = rate(text_of(RATE_KEY)?).map_err(foreign)?;
    Ok(SignalsFile { path, table, version, run, sampling_rate_hz })
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
