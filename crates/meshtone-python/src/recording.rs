//! Recordings.

use std::path::PathBuf;

use meshtone_io::recording::{
    self, Calibration, ColumnChoice, ReadRecordingError, RecordingOptions, TimeColumn,
};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::array::array;
use crate::error::{file_error, value_error};

/// A column's name or number.
#[derive(FromPyObject)]
pub enum Column {
    Number(usize),
    Name(String),
}

impl From<Column> for ColumnChoice {
    fn from(column: Column) -> Self {
        match column {
            Column::Number(number) => Self::Number(number),
            Column::Name(name) => Self::Name(name),
        }
    }
}

/// Reads a recording: a dictionary of its parts.
///
/// Python's arguments become the options of the library, which checks them. The file is read without the interpreter's lock, so that other
/// threads go on meanwhile.
#[pyfunction]
pub fn read_recording<'py>(
    py: Python<'py>,
    path: PathBuf,
    channels: Vec<Column>,
    sampling_rate_hz: Option<f64>,
    variable: Option<String>,
    time: Option<Column>,
    calibrations: Vec<(Column, Option<f64>, Option<String>)>,
) -> PyResult<Bound<'py, PyDict>> {
    let calibrations = calibrations
        .into_iter()
        .map(|(channel, sensitivity_v_per_unit, unit)| Calibration {
            channel: channel.into(),
            sensitivity_v_per_unit,
            unit,
        })
        .collect();
    let options = RecordingOptions {
        channels: channels.into_iter().map(ColumnChoice::from).collect(),
        sampling_rate_hz,
        variable,
        time: time.map_or_else(TimeColumn::default, |column| TimeColumn::Chosen(column.into())),
        calibrations,
        ..RecordingOptions::default()
    };
    let read = py.detach(|| recording::read_recording(&path, &options)).map_err(|error| {
        let source = match &error {
            ReadRecordingError::Unreadable { source, .. } => Some(source),
            _ => None,
        };
        file_error(&path, source, &error)
    })?;
    let all = PyDict::new(py);
    all.set_item("sampling_rate_hz", read.sampling_rate_hz)?;
    all.set_item("start_s", read.start_s)?;
    all.set_item("scenario_toml", read.scenario_toml)?;
    let doubtful = read.warnings.iter().map(|warning| (warning.to_string(), warning.code()));
    all.set_item("warnings", doubtful.collect::<Vec<_>>())?;
    let channels = read.channels.into_iter();
    let channels = channels.map(|channel| (channel.name, channel.unit, array(py, channel.samples)));
    all.set_item("channels", channels.collect::<Vec<_>>())?;
    Ok(all)
}

/// Recordings of simulated machines, to try things on: the name of each file and what is in it.
#[pyfunction]
pub fn recording_files(py: Python<'_>) -> PyResult<Vec<(String, Bound<'_, PyBytes>)>> {
    let files = py.detach(meshtone_io::recording_files::recording_files).map_err(value_error)?;
    Ok(files.into_iter().map(|(name, bytes)| (name, PyBytes::new(py, &bytes))).collect())
}
