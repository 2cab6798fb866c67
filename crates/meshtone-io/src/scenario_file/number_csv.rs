//! Columns of numbers in a CSV file.

use std::path::Path;

use csv::{ErrorKind, ReaderBuilder, StringRecord, Trim};
use meshtone::scenario::FileProblem;

use super::unreadable;
use crate::input_file::{MEMORY_PER_BYTE_OF_NUMBERS, open_stream};

/// A quantity against time.
pub(super) const PROFILE: NumberCsv<2> = NumberCsv {
    names: ["time_s", "value"],
    needs_names: false,
    help: "write two columns separated by a comma, time_s and value, with a point as decimal sign; the first line may name them",
};

/// A frequency response.
pub(super) const FREQUENCY_RESPONSE: NumberCsv<3> = NumberCsv {
    names: ["frequency_hz", "magnitude", "phase_deg"],
    // Real and imaginary parts, decibels or radians would otherwise be taken for magnitude and phase.
    needs_names: true,
    help: "write three columns separated by a comma, with a point as decimal sign; the first line must be \
           frequency_hz,magnitude,phase_deg",
};

/// A CSV file of some columns of numbers.
pub(super) struct NumberCsv<const COLUMNS: usize> {
    /// Their names.
    pub(super) names: [&'static str; COLUMNS],
    /// Whether the first line must name the columns; further ones may then follow, which are not read. Otherwise it may name them, and the
    /// columns behind the first may have any names.
    pub(super) needs_names: bool,
    /// What the user can do.
    pub(super) help: &'static str,
}

impl<const COLUMNS: usize> NumberCsv<COLUMNS> {
    /// The columns of a file.
    pub(super) fn read(&self, path: &Path) -> Result<[Vec<f64>; COLUMNS], FileProblem> {
        let file = open_stream(path, MEMORY_PER_BYTE_OF_NUMBERS).map_err(|error| unreadable(path, &error))?;
        let mut reader = ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .trim(Trim::All)
            .comment(Some(b'#'))
            .from_reader(file);
        let mut columns = [const { Vec::new() }; COLUMNS];
        let mut width = COLUMNS;
        for (index, record) in reader.records().enumerate() {
            let record = record.map_err(|error| {
                let words = error.to_string();
                match error.into_kind() {
                    ErrorKind::Io(error) => unreadable(path, &error),
                    _ => self.problem(path, &format!("is not a CSV file: {words}")),
                }
            })?;
            if index == 0 && (self.needs_names || is_header(&record)) {
                self.check_names(path, &record)?;
                width = if self.needs_names { record.len().max(COLUMNS) } else { COLUMNS };
                continue;
            }
            append(&record, width, &mut columns).map_err(|what| self.problem(path, &what))?;
        }
        Ok(columns)
    }

    fn problem(&self, path: &Path, what: &str) -> FileProblem {
        FileProblem::new(format!("{} {what}", path.display()), self.help)
    }

    /// Columns in another order would otherwise be taken for wild numbers.
    fn check_names(&self, path: &Path, record: &StringRecord) -> Result<(), FileProblem> {
        const ORDINALS: [&str; 3] = ["first", "second", "third"];
        let checked = if self.needs_names { COLUMNS } else { 1 };
        for (place, (name, ordinal)) in self.names.iter().zip(ORDINALS).take(checked).enumerate() {
            let found = record.get(place).unwrap_or_default();
            if found.trim_start_matches('\u{feff}') != *name {
                let what = format!("names its {ordinal} column `{found}`; it must be {name}");
                return Err(self.problem(path, &what));
            }
        }
        Ok(())
    }
}

/// Appends the fields of a line to the columns.
fn append<const COLUMNS: usize>(
    record: &StringRecord,
    width: usize,
    columns: &mut [Vec<f64>; COLUMNS],
) -> Result<(), String> {
    let line = record.position().map_or(0, csv::Position::line);
    if record.len() != width {
        return Err(format!("has {} columns in line {line}; must have {width}", record.len()));
    }
    for (column, field) in columns.iter_mut().zip(record) {
        let number = field.parse().ok().filter(|number: &f64| number.is_finite());
        column.push(number.ok_or_else(|| format!("has `{field}` in line {line}; must be a finite number"))?);
    }
    Ok(())
}

fn is_header(record: &StringRecord) -> bool {
    record.iter().all(|field| field.parse::<f64>().is_err()) && record.len() > 1
}
