//! Signals as files.

use std::path::{Path, PathBuf};

use meshtone::sensor::{Channel, Channels, NamedSignal, SignalSource};
use meshtone_io::atomic_file::write_atomically;
use meshtone_io::signals::{SignalFormat, SignalTable};
use pyo3::prelude::*;

use crate::array::{Signal, samples};
use crate::error::{os_error, value_error};
use crate::scenario::Scenario;

/// Writes signals of a pair in the format that the file's ending says; the scenario only where they are what it gives.
#[pyfunction]
pub fn write_signals(
    py: Python<'_>,
    path: PathBuf,
    scenario: Option<&Scenario>,
    rate_and_start: [f64; 2],
    signals: Vec<(String, Signal<'_>)>,
) -> PyResult<()> {
    let named = signals.iter().enumerate().map(|(number, (name, signal))| {
        let mut named = match Channel::named(name) {
            Some(Channel::Fixed(kind)) => NamedSignal::from(kind),
            Some(_) => NamedSignal::new(name.clone(), SignalSource::Sensor(number)),
            None => return Err(value_error(format!("there is no channel {name}"))),
        };
        named.values = samples(signal)?.to_vec();
        Ok(named)
    });
    let [sampling_rate_hz, start_s] = rate_and_start;
    let channels = Channels::new(sampling_rate_hz, start_s, named.collect::<PyResult<Vec<_>>>()?);
    let table = match scenario {
        Some(scenario) => SignalTable::of_scenario(&scenario.0, &channels),
        None => SignalTable::without_scenario(&channels),
    };
    table.check_lengths().map_err(|error| value_error(error.to_string()))?;
    py.detach(|| write(&path, &table))
}

/// Writes a file whole or not at all.
pub fn write(path: &Path, table: &SignalTable) -> PyResult<()> {
    let format = SignalFormat::of_path(path).ok_or_else(|| {
        let endings = SignalFormat::ALL.map(|format| format!(".{}", format.name())).join(", ");
        value_error(format!("{}: the file's name must end in one of {endings}", path.display()))
    })?;
    write_atomically(path, |file| table.write(file, format)).map_err(|error| {
        let name = error.path.to_string_lossy().into_owned();
        os_error("write", name, &error.source)
    })
}
