//! Measured indicators from a table with the layout of the paper's: experiment, indicator, series, severity, log10_value.

use std::collections::BTreeSet;
use std::io::Read;

use csv::StringRecord;
use meshtone::tuning::{Case, Measurements};
use meshtone_toml::{ReadResult, TomlTable, TomlValue};

use super::measured::Wanted;
use super::read::Reading;
use crate::input_file::{MEMORY_PER_BYTE_OF_NUMBERS, open_stream};

/// The series that is read unless another is named.
const MEASURED: &str = "measured";

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
    let text = open_stream(&path, MEMORY_PER_BYTE_OF_NUMBERS)
        .map_err(|error| problem(format!("cannot be read: {error}")))?;
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text);
    let columns = Columns::new(&mut reader, [experiment.is_some(), series.is_some()]).map_err(&problem)?;
    let mut rows = Rows {
        columns,
        experiment,
        series: series.unwrap_or(MEASURED),
        values: vec![vec![Vec::new(); wanted.indicators.len()]; wanted.cases.len()],
        contents: Contents::default(),
    };
    for (row, record) in reader.records().enumerate() {
        let record = record.map_err(|error| problem(format!("cannot be read: {error}")))?;
        rows.take(row + 2, &record, wanted).map_err(&problem)?;
    }
    rows.check_complete(wanted).map_err(&problem)?;
    Measurements::from_compared(wanted.indicators.to_vec(), rows.values)
        .map_err(|error| problem(error.to_string()))
}

/// Places of the columns.
struct Columns {
    header: StringRecord,
    indicator: usize,
    severity: usize,
    value: usize,
    experiment: Option<usize>,
    series: Option<usize>,
}

impl Columns {
    /// # Arguments
    /// * `named` - whether an experiment and a series are named, whose columns are then needed
    fn new(reader: &mut csv::Reader<impl Read>, named: [bool; 2]) -> Result<Self, String> {
        let header = reader.headers().map_err(|error| format!("cannot be read: {error}"))?.clone();
        let column = |name: &str| header.iter().position(|column| column == name);
        let needed = |name: &str| {
            let listed = header.iter().collect::<Vec<_>>().join(", ");
            column(name).ok_or_else(|| format!("has no column {name}; its columns are {listed}"))
        };
        let perhaps = |name: &str, named: bool| if named { needed(name).map(Some) } else { Ok(column(name)) };
        Ok(Self {
            indicator: needed("indicator")?,
            severity: needed("severity")?,
            value: needed("log10_value")?,
            experiment: perhaps("experiment", named[0])?,
            series: perhaps("series", named[1])?,
            header,
        })
    }
}

/// The names and severities in a table, for messages about missing ones.
#[derive(Default)]
struct Contents {
    experiments: BTreeSet<String>,
    series: BTreeSet<String>,
    /// Of the experiment and series that are read: in the order of the numbers.
    severities: Vec<f64>,
    indicators: BTreeSet<String>,
}

struct Rows<'a> {
    columns: Columns,
    experiment: Option<&'a str>,
    series: &'a str,
    /// By case and indicator.
    values: Vec<Vec<Vec<f64>>>,
    contents: Contents,
}

impl Rows<'_> {
    fn take(&mut self, line: usize, record: &StringRecord, wanted: &Wanted) -> Result<(), String> {
        let Self { columns, experiment, series, values, contents } = self;
        let field = |at: usize| record.get(at).unwrap_or_default();
        let number = |at: usize| {
            let text = field(at);
            text.parse().ok().filter(|number: &f64| number.is_finite()).ok_or_else(|| {
                format!("line {line}: {} is '{text}', but must be a finite number", &columns.header[at])
            })
        };
        let of_experiment = columns.experiment.map(field);
        let of_series = columns.series.map(field);
        contents.experiments.extend(of_experiment.map(str::to_owned));
        contents.series.extend(of_series.map(str::to_owned));
        let other_experiment = experiment.is_some() && of_experiment != *experiment;
        if other_experiment || of_series.is_some_and(|of_row| of_row != *series) {
            return Ok(());
        }
        let severity = number(columns.severity)?;
        contents.indicators.insert(field(columns.indicator).to_owned());
        if let Err(place) = contents.severities.binary_search_by(|other| other.total_cmp(&severity)) {
            contents.severities.insert(place, severity);
        }
        let name = field(columns.indicator);
        let indicator = wanted.indicators.iter().position(|indicator| indicator.name() == name);
        let case = wanted.cases.iter().position(|case| case.severity == severity);
        if let (Some(indicator), Some(case)) = (indicator, case) {
            values[case][indicator].push(number(columns.value)?);
        }
        Ok(())
    }

    /// Refuses several experiments without a choice, and a case without records.
    fn check_complete(&self, wanted: &Wanted) -> Result<(), String> {
        if self.experiment.is_none() && self.contents.experiments.len() > 1 {
            let all = listed(&self.contents.experiments);
            return Err(format!(
                "contains more than one experiment; choose one with measured.experiment ({all})"
            ));
        }
        for (case, of_case) in wanted.cases.iter().zip(&self.values) {
            for (indicator, records) in wanted.indicators.iter().zip(of_case) {
                if records.is_empty() {
                    return Err(self.missing(indicator.name(), case));
                }
            }
        }
        Ok(())
    }

    fn missing(&self, indicator: &str, case: &Case) -> String {
        let Contents { experiments, series, severities, indicators } = &self.contents;
        let mut chosen = String::new();
        if let Some(experiment) = self.experiment {
            chosen.push_str(&format!(", experiment {experiment}"));
        }
        if self.columns.series.is_some() {
            chosen.push_str(&format!(", series {}", self.series));
        }
        let Case { severity, label, .. } = case;
        let mut text =
            format!("has no {indicator} of severity {severity} (case \"{label}\"{chosen}); it holds");
        for (name, names) in [("experiments", experiments), ("series", series)] {
            if !names.is_empty() {
                text.push_str(&format!(" the {name} {},", listed(names)));
            }
        }
        if severities.is_empty() {
            text.push_str(" and of this experiment and series no row");
        } else {
            let severities = severities.iter().map(f64::to_string).collect::<Vec<_>>().join(", ");
            text.push_str(&format!(
                " and of this experiment and series the indicators {} at the severities {severities}",
                listed(indicators)
            ));
        }
        text
    }
}

fn listed(names: &BTreeSet<String>) -> String {
    names.iter().map(String::as_str).collect::<Vec<_>>().join(", ")
}
