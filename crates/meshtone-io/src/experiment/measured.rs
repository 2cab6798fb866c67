//! What was measured: a table of indicators, difference signals, or recordings.

use meshtone::scenario::Scenario;
use meshtone::signal::GearTrain;
use meshtone::tuning::{Case, DifferenceChain, Measurements, TuningIndicator};
use meshtone_toml::{ReadResult, TomlError, TomlTable, TomlValue};

use super::read::Reading;
use super::{indicator_table, recordings};
use crate::recording::{RecordingOptions, TimeColumn, read_recording};

/// Files of one case, with the key and line that name them.
#[derive(Debug, Clone)]
pub(super) struct CaseFiles<'a> {
    pub(super) difference: Option<NamedFile<'a>>,
    pub(super) recordings: Vec<NamedFile<'a>>,
    /// What an error about the case itself starts from.
    place: TomlError,
}

/// A file's name, and the value that names it.
pub(super) type NamedFile<'a> = (&'a str, TomlValue<'a>);

fn named_file<'a>(value: &TomlValue<'a>) -> ReadResult<NamedFile<'a>> {
    Ok((value.string()?, value.clone()))
}

impl<'a> CaseFiles<'a> {
    pub(super) fn read(table: &TomlTable<'a>) -> ReadResult<Self> {
        let difference = table.read_optional("difference_file", named_file)?;
        let recordings =
            table.read_optional("recordings", |value| value.array()?.iter().map(named_file).collect())?;
        Ok(Self { difference, recordings: recordings.unwrap_or_default(), place: table.error("", "") })
    }

    /// An error about a case without the files that others have.
    pub(super) fn missing(&self, case: &Case, what: &str) -> TomlError {
        let mut error = self.place.clone();
        error.problem = format!("the case \"{}\" has no {what}, but others have", case.label);
        error
    }
}

/// What measurements are read for.
pub(super) struct Wanted<'a> {
    pub(super) cases: &'a [Case],
    pub(super) files: &'a [CaseFiles<'a>],
    pub(super) indicators: &'a [TuningIndicator],
    pub(super) chain: &'a DifferenceChain,
    pub(super) base: &'a Scenario,
    /// Its shafts and wheels.
    pub(super) train: GearTrain,
    /// Number of the wheel over whose revolutions is averaged.
    pub(super) wheel: usize,
}

/// Reads the measurements: exactly one of the three kinds must be there.
pub(super) fn read(
    table: &TomlTable<'_>,
    wanted: &Wanted,
    reading: &mut Reading,
) -> ReadResult<Measurements> {
    let by_table = table.optional("indicators_file");
    let by_difference = wanted.files.iter().any(|files| files.difference.is_some());
    let by_recording = wanted.files.iter().any(|files| !files.recordings.is_empty());
    match (by_table, by_difference, by_recording) {
        (Some(file), false, false) => indicator_table::read(table, &file, wanted, reading),
        (None, true, false) => difference_files(wanted, reading),
        (None, false, true) => {
            let signals = recordings::differences(table, wanted, reading)?;
            from_differences(wanted, &signals)
        }
        (None, false, false) => Err(table.error(
            "indicators_file",
            "no measurements are given; name a table of indicators here, or give every [[case]] a difference_file or recordings",
        )),
        _ => Err(table.error(
            "indicators_file",
            "measurements are given in more than one way; keep the table of indicators, or the cases' difference_file, or their recordings",
        )),
    }
}

fn from_differences(wanted: &Wanted, signals: &[Vec<Vec<f64>>]) -> ReadResult<Measurements> {
    Measurements::from_difference_signals(wanted.indicators.to_vec(), signals)
        .map_err(|error| TomlError::new("measured", "", error.to_string()))
}

/// One record per column, one file per case.
fn difference_files(wanted: &Wanted, reading: &mut Reading) -> ReadResult<Measurements> {
    // The rows are angles, not times, and have no sampling rate.
    let options = RecordingOptions {
        sampling_rate_hz: Some(1.0),
        time: TimeColumn::Absent,
        ..RecordingOptions::default()
    };
    let mut signals = Vec::new();
    for (case, files) in wanted.cases.iter().zip(wanted.files) {
        let named = files.difference.as_ref();
        let (name, value) = named.ok_or_else(|| files.missing(case, "difference_file"))?;
        let recording = read_recording(&reading.source(name), &options);
        let recording = recording.map_err(|error| value.error(error.to_string()))?;
        signals.push(recording.channels.into_iter().map(|channel| channel.samples).collect());
    }
    from_differences(wanted, &signals)
}
