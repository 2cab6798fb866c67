//! A quantity against time, from two columns of a CSV file.

use std::fs::File;
use std::path::Path;

use csv::{ReaderBuilder, StringRecord, Trim};
use meshtone::scenario::{FileProblem, Profile};

use super::unreadable;

const HELP: &str = "write two columns separated by a comma, time_s and value, with a point as decimal sign; \
                    the first line may name them";

pub(super) fn read(path: &Path) -> Result<Profile, FileProblem> {
    let file = File::open(path).map_err(|error| unreadable(path, &error))?;
    let mut reader = ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .trim(Trim::All)
        .comment(Some(b'#'))
        .from_reader(file);
    let mut profile = Profile { time_s: Vec::new(), value: Vec::new() };
    for (index, record) in reader.records().enumerate() {
        let record = record.map_err(|error| problem(path, &format!("is not a CSV file: {error}")))?;
        if index == 0 && is_header(&record) {
            check_header(path, &record)?;
            continue;
        }
        let [time, value] = two_numbers(&record).map_err(|what| problem(path, &what))?;
        profile.time_s.push(time);
        profile.value.push(value);
    }
    Ok(profile)
}

fn problem(path: &Path, what: &str) -> FileProblem {
    FileProblem::new(format!("{} {what}", path.display()), HELP)
}

fn is_header(record: &StringRecord) -> bool {
    record.iter().all(|field| field.parse::<f64>().is_err()) && record.len() > 1
}

/// Columns the other way round would otherwise be taken for a wild profile.
fn check_header(path: &Path, record: &StringRecord) -> Result<(), FileProblem> {
    match record.get(0) {
        Some("time_s" | "\u{feff}time_s") => Ok(()),
        first => {
            let first = first.unwrap_or_default();
            Err(problem(path, &format!("names its first column `{first}`; it must be time_s")))
        }
    }
}

fn two_numbers(record: &StringRecord) -> Result<[f64; 2], String> {
    let line = record.position().map_or(0, csv::Position::line);
    if record.len() != 2 {
        return Err(format!("has {} columns in line {line}; must have 2", record.len()));
    }
    let number = |field: &str| {
        let parsed = field.parse::<f64>().ok().filter(|number| number.is_finite());
        parsed.ok_or_else(|| format!("says `{field}` in line {line}; must be a finite number"))
    };
    Ok([number(&record[0])?, number(&record[1])?])
}
