//! Which columns are read.

use std::path::Path;

use meshtone_toml::nearest_name;

use super::label::Label;
use super::{ColumnChoice, ReadRecordingError, RecordingOptions, TimeColumn};

/// The columns that are read, by their index in the file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Selection {
    /// In the order of the result.
    pub channels: Vec<usize>,
    /// The time column, if its times are needed, and (s) its unit.
    pub time: Option<(usize, f64)>,
}

impl Selection {
    /// Every column that is read, rising.
    pub(super) fn wanted(&self) -> Vec<usize> {
        let mut wanted = self.channels.clone();
        wanted.extend(self.time.map(|(index, _)| index));
        wanted.sort_unstable();
        wanted.dedup();
        wanted
    }
}

/// Chooses columns.
pub(super) fn select(
    path: &Path,
    labels: &[Label],
    options: &RecordingOptions,
) -> Result<Selection, ReadRecordingError> {
    let times = time_columns(path, labels, options)?;
    let channels = channels(path, labels, options, &times)?;
    for index in channels.iter().copied().chain(times.iter().map(|(index, _)| *index)) {
        check_numeric(path, &labels[index])?;
    }
    let time = if options.sampling_rate_hz.is_some() { None } else { times.first().copied() };
    Ok(Selection { channels, time })
}

fn check_numeric(path: &Path, label: &Label) -> Result<(), ReadRecordingError> {
    let Some(kind) = &label.not_numeric else { return Ok(()) };
    Err(ReadRecordingError::NotNumeric {
        path: path.to_path_buf(),
        // The only array of a file has no name.
        column: if label.raw.is_empty() { "1".to_string() } else { label.raw.clone() },
        kind: kind.clone(),
    })
}

/// The time column with its unit in seconds; several only where their times are not needed.
fn time_columns(
    path: &Path,
    labels: &[Label],
    options: &RecordingOptions,
) -> Result<Vec<(usize, f64)>, ReadRecordingError> {
    match &options.time {
        TimeColumn::Absent => Ok(Vec::new()),
        TimeColumn::Chosen(choice) => {
            let index = one(path, labels, choice)?;
            let unit = labels[index].chosen_time_unit_s();
            let unit = unit.ok_or_else(|| ReadRecordingError::Time {
                path: path.to_path_buf(),
                column: labels[index].raw.clone(),
                problem: "is in no unit of time that is known here (h, min, s, ms, µs, ns)".to_string(),
            })?;
            Ok(vec![(index, unit)])
        }
        TimeColumn::ByName => {
            let named = labels.iter().enumerate().filter(|(_, label)| label.not_numeric.is_none());
            let named: Vec<_> =
                named.filter_map(|(index, label)| Some((index, label.time_unit_s()?))).collect();
            match named.len() {
                0 | 1 => Ok(named),
                _ if options.sampling_rate_hz.is_some() => Ok(named),
                _ => Err(ambiguous(
                    path,
                    labels,
                    "has several columns that are named as time; choose one (option time)",
                )),
            }
        }
    }
}

fn channels(
    path: &Path,
    labels: &[Label],
    options: &RecordingOptions,
    times: &[(usize, f64)],
) -> Result<Vec<usize>, ReadRecordingError> {
    let is_time = |index: usize| times.iter().any(|(time, _)| *time == index);
    if options.channels.is_empty() {
        let is_read = |index: &usize| {
            let label = &labels[*index];
            label.not_numeric.is_none() && !label.is_zero_twin && !is_time(*index)
        };
        let all: Vec<usize> = (0..labels.len()).filter(is_read).collect();
        if all.is_empty() && times.is_empty() {
            labels.iter().try_for_each(|label| check_numeric(path, label))?;
        }
        let problem =
            if times.is_empty() { "holds no numbers" } else { "has no column of numbers besides time" };
        return if all.is_empty() {
            Err(ReadRecordingError::Empty { path: path.to_path_buf(), problem: problem.to_string() })
        } else {
            Ok(all)
        };
    }
    let mut chosen = Vec::new();
    for choice in &options.channels {
        let matching = matching(path, labels, choice)?;
        if let [index] = matching[..]
            && is_time(index)
        {
            let problem =
                format!("column `{}` is the time; choose another (option channels)", labels[index].raw);
            return Err(ambiguous(path, labels, &problem));
        }
        for index in matching.into_iter().filter(|index| !is_time(*index)) {
            if chosen.contains(&index) {
                let problem = format!("column `{}` is chosen twice", labels[index].raw);
                return Err(ambiguous(path, labels, &problem));
            }
            chosen.push(index);
        }
    }
    Ok(chosen)
}

/// The one column of a choice.
pub(super) fn one(path: &Path, labels: &[Label], choice: &ColumnChoice) -> Result<usize, ReadRecordingError> {
    match matching(path, labels, choice)?[..] {
        [index] => Ok(index),
        _ => Err(ambiguous(path, labels, &format!("{choice} is several columns; choose one"))),
    }
}

/// The columns of a choice, at least one; several only for the columns of one array.
pub(super) fn matching(
    path: &Path,
    labels: &[Label],
    choice: &ColumnChoice,
) -> Result<Vec<usize>, ReadRecordingError> {
    let name = match choice {
        ColumnChoice::Number(number) if (1..=labels.len()).contains(number) => return Ok(vec![number - 1]),
        ColumnChoice::Number(_) => return Err(no_column(path, labels, choice, None)),
        ColumnChoice::Name(name) => name.trim(),
    };
    // By a name, the twins that hold something are meant.
    let last_part = |array: &String| array.rsplit('.').next() == Some(name);
    let by = |matches: &dyn Fn(&Label) -> bool| -> Vec<usize> {
        (0..labels.len()).filter(|index| !labels[*index].is_zero_twin && matches(&labels[*index])).collect()
    };
    let exact = by(&|label| label.name == name || label.raw == name);
    if !exact.is_empty() {
        return only(path, labels, choice, exact);
    }
    let of_array = by(&|label| label.array.as_deref() == Some(name));
    if !of_array.is_empty() {
        return Ok(of_array);
    }
    let by_last_part = by(&|label| label.array.is_none() && label.last_part() == name);
    if !by_last_part.is_empty() {
        return only(path, labels, choice, by_last_part);
    }
    let of_last_part = by(&|label| label.array.as_ref().is_some_and(last_part));
    if let Some(first) = of_last_part.first() {
        let same = of_last_part.iter().all(|index| labels[*index].array == labels[*first].array);
        let several = || ambiguous(path, labels, &format!("{choice} is the name of several arrays"));
        return if same { Ok(of_last_part) } else { Err(several()) };
    }
    let nearest = nearest_name(name, labels.iter().map(|label| label.name.as_str()));
    Err(no_column(path, labels, choice, nearest.map(str::to_string)))
}

fn only(
    path: &Path,
    labels: &[Label],
    choice: &ColumnChoice,
    found: Vec<usize>,
) -> Result<Vec<usize>, ReadRecordingError> {
    if found.len() == 1 {
        return Ok(found);
    }
    let numbers: Vec<String> = found.iter().map(|index| (index + 1).to_string()).collect();
    let numbers = numbers.join(" and ");
    Err(ambiguous(
        path,
        labels,
        &format!("{choice} is the name of columns {numbers}; choose one by its number"),
    ))
}

fn no_column(
    path: &Path,
    labels: &[Label],
    choice: &ColumnChoice,
    nearest: Option<String>,
) -> ReadRecordingError {
    let path = path.to_path_buf();
    ReadRecordingError::NoColumn { path, wanted: choice.to_string(), nearest, present: present(labels) }
}

fn ambiguous(path: &Path, labels: &[Label], problem: &str) -> ReadRecordingError {
    let path = path.to_path_buf();
    ReadRecordingError::Ambiguous { path, problem: problem.to_string(), present: present(labels) }
}

/// The columns as messages list them.
pub(super) fn present(labels: &[Label]) -> Vec<String> {
    labels.iter().map(|label| label.raw.clone()).collect()
}
