//! Recordings as records like those of a data set.

use meshtone::signal::SignalWarning;

use crate::error::DatasetError;
use crate::plan::Plan;
use crate::record::{MachineRecording, Record, records};
use crate::shard::{columns, write_table};

/// Records of recordings in the columns of a data set.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedRows {
    /// A Parquet file with a row for each window, in the columns of the data set that a recording has values of.
    pub parquet: Vec<u8>,
    /// What is doubtful about the averages, each once.
    pub warnings: Vec<SignalWarning>,
}

/// Takes recordings to records like those of a data set: the same channels, sampling rate or points per revolution, windows and columns.
///
/// The columns are those that a recording has values of: speeds and tooth counts, indicators, channels, averages, and the plan's varied keys
/// by the values of the machine.
///
/// # Arguments
/// * `plan` - of the data set
/// * `recordings` - the recordings
///
/// # Errors
/// A recording that does not fit the plan, or that the signal chain refuses.
pub fn rows_like(plan: &Plan, recordings: &[MachineRecording<'_>]) -> Result<RecordedRows, DatasetError> {
    let mut all: Vec<Record> = Vec::new();
    for (number, recording) in recordings.iter().enumerate() {
        let of_recording = records(&plan.content, recording, number as u64, all.len() as u64);
        all.extend(of_recording.map_err(|problem| {
            let help =
                "a recording needs the channels, the wheels and the length of a record of the data set";
            DatasetError::refused(format!("recording {number}: {problem}"), help)
        })?);
    }
    let mut warnings: Vec<SignalWarning> = Vec::new();
    for warning in all.iter().flat_map(|record| &record.averages).flat_map(|average| &average.warnings) {
        if !warnings.contains(warning) {
            warnings.push(warning.clone());
        }
    }
    let mut columns = columns(plan);
    columns.retain(|column| column.is_of_recording);
    let mut parquet = Vec::new();
    write_table(&mut parquet, &columns, &all).map_err(DatasetError::write("the table of recordings"))?;
    Ok(RecordedRows { parquet, warnings })
}
