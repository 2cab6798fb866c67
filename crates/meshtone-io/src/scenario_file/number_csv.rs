//! Columns of numbers in a CSV file.

use std::path::Path;

use csv::{ErrorKind, ReaderBuilder, StringRecord, Trim};
use meshtone::scenario::FileProblem;

use super::unreadable;
use crate::input_file::{MEMORY_PER_BYTE_OF_NUMBERS, open_stream};

/// A CSV file of some columns of numbers.
pub(super) struct NumberCsv<const COLUMNS: usize> {
    /// Their names.
    pub(super) names: [&'static str; COLUMNS],
    /// How many of the names, from the first one on, a line of names must have in their places.
    pub(super) checked_names: usize,
    /// Whether the first line must name the columns.
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
        let mut columns = std::array::from_fn(|_| Vec::new());
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
                continue;
            }
            let row = self.numbers(&record).map_err(|what| self.problem(path, &what))?;
            columns
                .iter_mut()
                .zip(row)
                .for_each(|(column, number): (&mut Vec<f64>, f64)| column.push(number));
        }
        Ok(columns)
    }

    fn problem(&self, path: &Path, what: &str) -> FileProblem {
        FileProblem::new(format!("{} {what}", path.display()), self.help)
    }

    /// Columns in another order would otherwise be taken for wild numbers.
    fn check_names(&self, path: &Path, record: &StringRecord) -> Result<(), FileProblem> {
        const ORDINALS: [&str; 3] = ["first", "second", "third"];
        for (place, (name, ordinal)) in self.names.iter().zip(ORDINALS).take(self.checked_names).enumerate() {
            let found = record.get(place).unwrap_or_default();
            if found.trim_start_matches('\u{feff}') != *name {
                let what = format!("names its {ordinal} column `{found}`; it must be {name}");
                return Err(self.problem(path, &what));
            }
        }
        Ok(())
    }

    fn numbers(&self, record: &StringRecord) -> Result<[f64; COLUMNS], String> {
        let line = record.position().map_or(0, csv::Position::line);
        if record.len() != COLUMNS {
            return Err(format!("has {} columns in line {line}; must have {COLUMNS}", record.len()));
        }
        let mut numbers = [0.0; COLUMNS];
        for (number, field) in numbers.iter_mut().zip(record) {
            let parsed = field.parse::<f64>().ok().filter(|number| number.is_finite());
            *number =
                parsed.ok_or_else(|| format!("says `{field}` in line {line}; must be a finite number"))?;
        }
        Ok(numbers)
    }
}

fn is_header(record: &StringRecord) -> bool {
    record.iter().all(|field| field.parse::<f64>().is_err()) && record.len() > 1
}
