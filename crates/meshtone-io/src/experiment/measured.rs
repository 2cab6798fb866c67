//! What was measured: a table of indicators, difference signals, or recordings.

use std::path::{Path, PathBuf};

use meshtone::scenario::Scenario;
use meshtone::tuning::{Case, DifferenceChain, Measurements, TuningIndicator};
use meshtone_toml::{ReadResult, TomlError, TomlTable, TomlValue};

use super::{indicator_table, recordings};
use crate::recording::{ColumnChoice, RecordingOptions, TimeColumn, read_recording};

/// Files of one case, with the key and line that name them.
#[derive(Debug, Clone, Default)]
pub(super) struct CaseFiles {
    pub(super) difference: Option<Named>,
    pub(super) recordings: Vec<Named>,
    /// Of the case itself.
    pub(super) place: Option<TomlError>,
}

/// A file's name, and what an error about it starts from.
#[derive(Debug, Clone)]
pub(super) struct Named {
    pub(super) name: String,
    place: TomlError,
}

impl Named {
    fn read(value: &TomlValue<'_>) -> ReadResult<Self> {
        Ok(Self { name: value.string()?.to_owned(), place: value.error("") })
    }

    pub(super) fn error(&self, problem: impl std::fmt::Display) -> TomlError {
        with_problem(self.place.clone(), problem.to_string())
    }
}

impl CaseFiles {
    pub(super) fn read(table: &TomlTable<'_>) -> ReadResult<Self> {
        let difference = table.optional("difference_file").map(|value| Named::read(&value)).transpose()?;
        let recordings = match table.optional("recordings") {
            None => Vec::new(),
            Some(value) => value.array()?.iter().map(Named::read).collect::<ReadResult<_>>()?,
        };
        Ok(Self { difference, recordings, place: Some(table.error("", "")) })
    }
}

/// What measurements are read for.
pub(super) struct Wanted<'a> {
    pub(super) directory: &'a Path,
    pub(super) cases: &'a [Case],
    pub(super) files: &'a [CaseFiles],
    pub(super) indicators: &'a [TuningIndicator],
    pub(super) chain: &'a DifferenceChain,
    pub(super) base: &'a Scenario,
}

/// Reads the measurements: exactly one of the three kinds must be there.
pub(super) fn read(
    table: &TomlTable<'_>,
    wanted: &Wanted,
    sources: &mut Vec<PathBuf>,
    warnings: &mut Vec<String>,
) -> ReadResult<Measurements> {
    let by_table = table.optional("indicators_file");
    let by_difference = wanted.files.iter().any(|files| files.difference.is_some());
    let by_recording = wanted.files.iter().any(|files| !files.recordings.is_empty());
    match (by_table, by_difference, by_recording) {
        (Some(file), false, false) => indicator_table::read(table, &file, wanted, sources),
        (None, true, false) => difference_files(wanted, sources),
        (None, false, true) => {
            let signals = recordings::differences(table, wanted, sources, warnings)?;
            from_differences(wanted, &signals)
        }
        (None, false, false) => Err(table.error(
            "indicators_file",
            "nothing measured is given; name a table of indicators here, or give every [[case]] a difference_file or recordings",
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
fn difference_files(wanted: &Wanted, sources: &mut Vec<PathBuf>) -> ReadResult<Measurements> {
    let mut signals = Vec::new();
    for (case, files) in wanted.cases.iter().zip(wanted.files) {
        let Some(named) = &files.difference else {
            return Err(missing(
                files,
                format!("the case \"{}\" has no difference_file, but others have", case.label),
            ));
        };
        let path = wanted.directory.join(&named.name);
        // Angles, not times: no rate.
        let options = RecordingOptions {
            sampling_rate_hz: Some(1.0),
            time: TimeColumn::Absent,
            ..RecordingOptions::default()
        };
        let recording = read_recording(&path, &options).map_err(|error| named.error(error))?;
        sources.push(path);
        signals.push(recording.channels.into_iter().map(|channel| channel.samples).collect());
    }
    from_differences(wanted, &signals)
}

pub(super) fn missing(files: &CaseFiles, problem: String) -> TomlError {
    let place = files.place.clone().unwrap_or_else(|| TomlError::new("case", "", ""));
    with_problem(place, problem)
}

/// The same error with what is wrong.
fn with_problem(mut error: TomlError, problem: String) -> TomlError {
    error.problem = problem;
    error
}

/// Columns to be read: one by name or number.
pub(super) fn column(name: &str) -> ColumnChoice {
    ColumnChoice::parse(name)
}
