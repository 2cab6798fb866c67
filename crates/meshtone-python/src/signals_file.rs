//! Signals as files.

use std::path::{Path, PathBuf};

use meshtone::sensor::Channel;
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
    let named = signals.iter().map(|(name, signal)| {
        let channel = Channel::named(name).ok_or_else(|| value_error(format!("there is no channel {name}")));
        Ok((channel?, samples(signal)?))
    });
    let named = named.collect::<PyResult<Vec<_>>>()?;
    let scenario = scenario.map(|scenario| &scenario.0);
    let table = SignalTable::of_channels(scenario, rate_and_start, named);
    let table = table.map_err(|error| value_error(error.to_string()))?;
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
