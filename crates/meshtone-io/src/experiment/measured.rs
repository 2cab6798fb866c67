//! What was measured: a table of indicators, difference signals, or recordings.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use meshtone::hybrid::{Case, DifferenceChain, Measurements, TuningIndicator};
use meshtone::scenario::{Scenario, ScenarioError};
use meshtone::toml_reader::{ReadResult, TomlTable, TomlValue};

use super::recordings;
use crate::recording::{ColumnChoice, RecordingOptions, TimeColumn, read_recording};

/// Files of one case, with the key and line that name them.
#[derive(Debug, Clone, Default)]
pub(super) struct CaseFiles {
    pub(super) difference: Option<Named>,
    pub(super) recordings: Vec<Named>,
    /// Of the case itself.
    pub(super) place: Option<ScenarioError>,
}

/// A file's name, and what an error about it starts from.
#[derive(Debug, Clone)]
pub(super) struct Named {
    pub(super) name: String,
    place: ScenarioError,
}

impl Named {
    fn read(value: &TomlValue<'_>) -> ReadResult<Self> {
        Ok(Self { name: value.string()?.to_owned(), place: value.error("") })
    }

    pub(super) fn error(&self, problem: impl std::fmt::Display) -> ScenarioError {
        ScenarioError { problem: problem.to_string(), ..self.place.clone() }
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
) -> ReadResult<Measurements> {
    let by_table = table.optional("indicators_file");
    let by_difference = wanted.files.iter().any(|files| files.difference.is_some());
    let by_recording = wanted.files.iter().any(|files| !files.recordings.is_empty());
    match (by_table, by_difference, by_recording) {
        (Some(file), false, false) => indicator_table(table, &file, wanted, sources),
        (None, true, false) => difference_files(wanted, sources),
        (None, false, true) => {
            let signals = recordings::differences(table, wanted, sources)?;
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
        .map_err(|error| ScenarioError::new("measured", "", error.to_string()))
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

pub(super) fn missing(files: &CaseFiles, problem: String) -> ScenarioError {
    let place = files.place.clone().unwrap_or_else(|| ScenarioError::new("case", "", ""));
    ScenarioError { problem, ..place }
}

/// The layout of the paper's table: experiment, indicator, series, severity, log10_value.
fn indicator_table(
    table: &TomlTable<'_>,
    file: &TomlValue<'_>,
    wanted: &Wanted,
    sources: &mut Vec<PathBuf>,
) -> ReadResult<Measurements> {
    let path = wanted.directory.join(file.string()?);
    let experiment = table.optional("experiment").map(|value| value.string()).transpose()?;
    let named_series = table.optional("series").map(|value| value.string()).transpose()?;
    let series = named_series.unwrap_or("measured");
    let problem = |problem: String| file.error(format!("{}: {problem}", path.display()));
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .from_path(&path)
        .map_err(|error| problem(format!("cannot be read: {error}")))?;
    sources.push(path.clone());
    let header = reader.headers().map_err(|error| problem(format!("cannot be read: {error}")))?.clone();
    let column = |name: &str| header.iter().position(|column| column == name);
    let needed = |name: &str| {
        let listed = header.iter().collect::<Vec<_>>().join(", ");
        column(name).ok_or_else(|| problem(format!("has no column {name}; its columns are {listed}")))
    };
    let (indicator_at, severity_at) = (needed("indicator")?, needed("severity")?);
    let value_at = needed("log10_value")?;
    let experiment_at = experiment.map(|_| needed("experiment")).transpose()?;
    named_series.map(|_| needed("series")).transpose()?;
    let unnamed_experiment = if experiment.is_none() { column("experiment") } else { None };
    let mut experiments = BTreeSet::new();
    let mut values = vec![vec![Vec::new(); wanted.indicators.len()]; wanted.cases.len()];
    for (row, record) in reader.records().enumerate() {
        let record = record.map_err(|error| problem(format!("cannot be read: {error}")))?;
        let field = |at: usize| record.get(at).unwrap_or_default();
        let number = |at: usize| -> ReadResult<f64> {
            let text = field(at);
            text.parse().ok().filter(|number: &f64| number.is_finite()).ok_or_else(|| {
                let (line, name) = (row + 2, &header[at]);
                problem(format!("line {line}: {name} is '{text}', but must be a finite number"))
            })
        };
        let other_series = column("series").is_some_and(|at| field(at) != series);
        if other_series || experiment_at.is_some_and(|at| Some(field(at)) != experiment) {
            continue;
        }
        experiments.extend(unnamed_experiment.map(|at| field(at).to_owned()));
        if experiments.len() > 1 {
            let all = experiments.into_iter().collect::<Vec<_>>().join(", ");
            let which = "holds more than one experiment; say which with measured.experiment";
            return Err(problem(format!("{which} ({all})")));
        }
        let indicator =
            wanted.indicators.iter().position(|indicator| indicator.name() == field(indicator_at));
        let severity = number(severity_at)?;
        let case = wanted.cases.iter().position(|case| case.severity == severity);
        if let (Some(indicator), Some(case)) = (indicator, case) {
            values[case][indicator].push(number(value_at)?);
        }
    }
    for (case, of_case) in wanted.cases.iter().zip(&values) {
        for (indicator, records) in wanted.indicators.iter().zip(of_case) {
            if records.is_empty() {
                let of = experiment.map_or(String::new(), |name| format!(", experiment {name}"));
                return Err(problem(format!(
                    "has no {} of severity {} (case \"{}\"{of}, series {series})",
                    indicator.name(),
                    case.severity,
                    case.label
                )));
            }
        }
    }
    Measurements::from_compared(wanted.indicators.to_vec(), values)
        .map_err(|error| problem(error.to_string()))
}

/// Columns to be read: one by name or number.
pub(super) fn column(name: &str) -> ColumnChoice {
    ColumnChoice::parse(name)
}
