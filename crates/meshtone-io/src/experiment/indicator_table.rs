//! Measured indicators from a table with the layout of the paper's: experiment, indicator, series, severity, log10_value.

use std::collections::BTreeSet;

use meshtone::tuning::Measurements;
use meshtone_toml::{ReadResult, TomlTable, TomlValue};
use serde::Deserialize;

use super::measured::Wanted;
use super::read::Reading;
use crate::input_file::{MEMORY_PER_BYTE_OF_NUMBERS, open_stream};

/// The series that is read unless another is named.
const MEASURED: &str = "measured";

/// One value of a record. A table of one experiment or series needs no column for it.
#[derive(Deserialize)]
struct Row {
    experiment: Option<String>,
    series: Option<String>,
    indicator: String,
    severity: f64,
    log10_value: f64,
}

/// Reads the rows of one experiment and series.
///
/// # Arguments
/// * `table` - `[measured]`
/// * `file` - the name of the file
/// * `wanted` - cases and indicators
/// * `reading` - gets the file's path
pub(super) fn read(
    table: &TomlTable<'_>,
    file: &TomlValue<'_>,
    wanted: &Wanted,
    reading: &mut Reading,
) -> ReadResult<Measurements> {
    let path = reading.source(file.string()?);
    let experiment = table.read_optional("experiment", TomlValue::string)?;
    let series = table.read_optional("series", TomlValue::string)?;
    let problem = |problem: String| file.error(format!("{}: {problem}", path.display()));
    let unreadable = |error: &dyn std::fmt::Display| problem(format!("cannot be read: {error}"));
    let text = open_stream(&path, MEMORY_PER_BYTE_OF_NUMBERS).map_err(|error| unreadable(&error))?;
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text);
    let mut values = vec![vec![Vec::new(); wanted.indicators.len()]; wanted.cases.len()];
    // What the table holds, for the message about what it lacks.
    let (mut experiments, mut held) = (BTreeSet::new(), BTreeSet::new());
    for (line, row) in (2..).zip(reader.deserialize()) {
        let row: Row = row.map_err(|error| unreadable(&error))?;
        if !(row.severity.is_finite() && row.log10_value.is_finite()) {
            let Row { severity, log10_value, .. } = row;
            return Err(problem(format!(
                "line {line}: severity and log10_value are {severity} and {log10_value}, but must be finite numbers"
            )));
        }
        let is_named = experiment.is_none_or(|name| row.experiment.as_deref() == Some(name));
        let of_series = row.series.as_deref().is_none_or(|of_row| of_row == series.unwrap_or(MEASURED));
        if is_named && of_series {
            let indicator = wanted.indicators.iter().position(|known| known.name() == row.indicator);
            let case = wanted.cases.iter().position(|case| case.severity == row.severity);
            if let (Some(indicator), Some(case)) = (indicator, case) {
                values[case][indicator].push(row.log10_value);
            }
        }
        let [experiment, series] = [row.experiment, row.series].map(Option::unwrap_or_default);
        held.insert([experiment.clone(), series, row.indicator, row.severity.to_string()].join(" "));
        experiments.insert(experiment);
    }
    if experiment.is_none() && experiments.len() > 1 {
        let all = experiments.into_iter().collect::<Vec<_>>().join(", ");
        return Err(problem(format!(
            "contains more than one experiment; choose one with measured.experiment ({all})"
        )));
    }
    for (case, of_case) in wanted.cases.iter().zip(&values) {
        if let Some(lacking) = of_case.iter().position(Vec::is_empty) {
            let (indicator, severity, label) =
                (wanted.indicators[lacking].name(), case.severity, &case.label);
            let held = match held.len() {
                0 => "no row".to_owned(),
                _ => held.into_iter().collect::<Vec<_>>().join(", "),
            };
            return Err(problem(format!(
                "has no {indicator} of severity {severity} (case \"{label}\"); it holds {held}"
            )));
        }
    }
    Measurements::from_compared(wanted.indicators.to_vec(), values)
        .map_err(|error| problem(error.to_string()))
}
