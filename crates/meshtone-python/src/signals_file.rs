//! Signals as files.

use std::path::{Path, PathBuf};

use meshtone::sensor::Channels;
use meshtone_io::atomic_file::write_atomically;
use meshtone_io::signals::{SignalFormat, SignalTable};
use pyo3::prelude::*;

use crate::array::{Signal, samples};
use crate::error::{os_error, value_error};
use crate::scenario::Scenario;

/// Writes some of a simulation's signals in the format that the file's ending says; the scenario only where they are what it gives.
#[pyfunction]
pub fn write_signals(
    py: Python<'_>,
    path: PathBuf,
    scenario: &Scenario,
    is_resampled: bool,
    rate_and_start: [f64; 2],
    signals: Vec<(String, Signal<'_>)>,
) -> PyResult<()> {
    let channels = named_channels(&scenario.0, rate_and_start, &signals)?;
    let table = if is_resampled {
        SignalTable::without_scenario(&channels)
    } else {
        SignalTable::of_scenario(&scenario.0, &channels)
    };
    table.check_lengths().map_err(|error| value_error(error.to_string()))?;
    py.detach(|| write(&path, &table))
}

/// Signals that Python has by their names, as the library has them.
pub fn named_channels(
    scenario: &meshtone::scenario::Scenario,
    [sampling_rate_hz, start_s]: [f64; 2],
    signals: &[(String, Signal<'_>)],
) -> PyResult<Channels> {
    let known = scenario.signals();
    let named = signals.iter().map(|(name, values)| {
        let named = known.iter().find(|signal| signal.name == *name);
        let named = named.ok_or_else(|| value_error(format!("there is no channel {name}")))?;
        let mut named = named.clone();
        named.values = samples(values)?.to_vec();
        Ok(named)
    });
    Ok(Channels::new(sampling_rate_hz, start_s, named.collect::<PyResult<Vec<_>>>()?))
}

/// Writes a file whole or not at all.
fn write(path: &Path, table: &SignalTable) -> PyResult<()> {
    let format = SignalFormat::of_path(path).ok_or_else(|| {
        let endings = SignalFormat::ALL.map(|format| format!(".{}", format.name())).join(", ");
        value_error(format!("{}: the file's name must end in one of {endings}", path.display()))
    })?;
    write_atomically(path, |file| table.write(file, format)).map_err(|error| {
        let name = error.path.to_string_lossy().into_owned();
        os_error("write", name, &error.source)
    })
}
