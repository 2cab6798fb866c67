//! Which columns are read.

use meshtone_toml::nearest_name;

use super::error::{Problem, names};
use super::label::Label;
use super::{ColumnChoice, RecordingOptions, TimeColumn};

/// The columns that are read, by their index in the file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Selection {
    /// In the order of the result.
    pub channels: Vec<usize>,
    /// The time column, if its times are needed, and (s) its unit.
    pub time: Option<(usize, f64)>,
    /// The time column and its unit where the options state the rate, to be compared with it.
    pub own_time: Option<(usize, f64)>,
    /// Channels and time column, rising.
    pub wanted: Vec<usize>,
}

/// Chooses columns.
pub(super) fn select(labels: &[Label], options: &RecordingOptions) -> Result<Selection, Problem> {
    let times = time_columns(labels, options)?;
    let channels = channels(labels, options, &times)?;
    for index in channels.iter().copied().chain(times.iter().map(|(index, _)| *index)) {
        check_numeric(&labels[index])?;
    }
    let (time, own_time) = match (options.sampling_rate_hz, &times[..]) {
        (None, times) => (times.first().copied(), None),
        (Some(_), [only]) => (None, Some(*only)),
        (Some(_), _) => (None, None),
    };
    let mut wanted = channels.clone();
    wanted.extend(time.map(|(index, _)| index));
    wanted.sort_unstable();
    wanted.dedup();
    Ok(Selection { channels, time, own_time, wanted })
}

fn check_numeric(label: &Label) -> Result<(), Problem> {
    let Some(kind) = &label.not_numeric else { return Ok(()) };
    // The only array of a file has no name.
    let column = if label.raw.is_empty() { "1" } else { &label.raw };
    Err(Problem::Refused(format!("column {column} holds {kind}; must be real numbers")))
}

/// The time column with its unit in seconds; several only where their times are not needed.
fn time_columns(labels: &[Label], options: &RecordingOptions) -> Result<Vec<(usize, f64)>, Problem> {
    match &options.time {
        TimeColumn::Absent => Ok(Vec::new()),
        TimeColumn::Chosen(choice) => {
            let [index] = matching(labels, choice)?[..] else {
                return Err(ambiguous(labels, &format!("{choice} is several columns; choose one")));
            };
            let problem = "has no known unit of time (h, min, s, ms, µs, ns)";
            let unit = labels[index].chosen_time_unit_s();
            Ok(vec![(index, unit.ok_or_else(|| Problem::time(&labels[index].raw, problem))?)])
        }
        TimeColumn::ByName => {
            let named = labels.iter().enumerate().filter(|(_, label)| label.not_numeric.is_none());
            // LabVIEW's time is the X_Value; beside a y_value it is a direction.
            let has_directions = labels.iter().any(|label| label.is_value_of("y"));
            let named = named.filter(|(_, label)| !(has_directions && label.is_value_of("x")));
            // Arrays of one file may have been sampled together or not: times belong to channels that are as long as they are.
            let lead =
                options.channels.first().and_then(|choice| matching(labels, choice).ok()?.first().copied());
            let lead = lead.map(|index| &labels[index]);
            let unit_s = |label: &Label| match lead {
                Some(lead) if label.samples != lead.samples => None,
                Some(lead) if label.samples.is_some() && label.is_time_of(lead) => label.chosen_time_unit_s(),
                _ => label.time_unit_s(),
            };
            let mut named: Vec<_> =
                named.filter_map(|(index, label)| Some((index, unit_s(label)?))).collect();
            if let (Some(lead), 2..) = (lead, named.len()) {
                let is_near = |label: &Label| label.is_time_of(lead) || label.parent() == lead.parent();
                let near: Vec<_> =
                    named.iter().copied().filter(|(index, _)| is_near(&labels[*index])).collect();
                named = if near.is_empty() { named } else { near };
            }
            if named.len() > 1 && options.sampling_rate_hz.is_none() {
                let problem = "has several columns that are named as time; choose one (option time)";
                return Err(ambiguous(labels, problem));
            }
            Ok(named)
        }
    }
}

fn channels(
    labels: &[Label],
    options: &RecordingOptions,
    times: &[(usize, f64)],
) -> Result<Vec<usize>, Problem> {
    let is_time = |index: usize| times.iter().any(|(time, _)| *time == index);
    if options.channels.is_empty() {
        let is_read = |index: &usize| {
            let label = &labels[*index];
            label.not_numeric.is_none() && !label.is_zero_twin && !is_time(*index)
        };
        let all: Vec<usize> = (0..labels.len()).filter(is_read).collect();
        if !all.is_empty() {
            return Ok(all);
        }
        if !times.is_empty() {
            return Err(Problem::Refused("has no column of numbers besides time".to_string()));
        }
        labels.iter().try_for_each(check_numeric)?;
        return Err(Problem::Refused("holds no numbers".to_string()));
    }
    let mut chosen = Vec::new();
    for choice in &options.channels {
        let matching = matching(labels, choice)?;
        if let [index] = matching[..]
            && is_time(index)
        {
            let column = &labels[index].raw;
            let problem = format!("column `{column}` is the time; choose another (option channels)");
            return Err(ambiguous(labels, &problem));
        }
        for index in matching.into_iter().filter(|index| !is_time(*index)) {
            if chosen.contains(&index) {
                return Err(ambiguous(labels, &format!("column `{}` is chosen twice", labels[index].raw)));
            }
            chosen.push(index);
        }
    }
    Ok(chosen)
}

/// The columns of a choice, at least one; several only for the columns of one array.
///
/// A name is compared with whole names of columns, with those of arrays, and then with the last parts of both. Columns that are 0
/// throughout beside another of the same name are chosen by their number only.
pub(super) fn matching(labels: &[Label], choice: &ColumnChoice) -> Result<Vec<usize>, Problem> {
    let absent = |nearest| Problem::absent(&format!("column {choice}"), nearest, &present(labels));
    let name = match choice {
        ColumnChoice::Number(number) if (1..=labels.len()).contains(number) => return Ok(vec![number - 1]),
        ColumnChoice::Number(_) => return Err(absent(None)),
        ColumnChoice::Name(name) => name.trim(),
    };
    let ways: [&dyn Fn(&Label) -> bool; 4] = [
        &|label| label.name == name || label.raw == name,
        &|label| label.array.as_deref() == Some(name),
        &|label| label.array.is_none() && label.last_part() == name,
        &|label| label.array.as_ref().is_some_and(|array| array.rsplit('.').next() == Some(name)),
    ];
    for matches in ways {
        let is_meant = |index: &usize| !labels[*index].is_zero_twin && matches(&labels[*index]);
        let found: Vec<usize> = (0..labels.len()).filter(is_meant).collect();
        let Some(first) = found.first() else { continue };
        let array = &labels[*first].array;
        if found.len() == 1 || array.is_some() && found.iter().all(|index| labels[*index].array == *array) {
            return Ok(found);
        }
        if array.is_some() {
            return Err(ambiguous(labels, &format!("{choice} is the name of several arrays")));
        }
        let numbers: Vec<String> = found.iter().map(|index| (index + 1).to_string()).collect();
        let numbers = numbers.join(" and ");
        let problem = format!("{choice} is the name of columns {numbers}; choose one by its number");
        return Err(ambiguous(labels, &problem));
    }
    Err(absent(nearest_name(name, labels.iter().map(|label| label.name.as_str()))))
}

fn ambiguous(labels: &[Label], problem: &str) -> Problem {
    Problem::Refused(format!("{problem}; it has {}", names(&present(labels))))
}

/// The columns as messages list them.
pub(super) fn present(labels: &[Label]) -> Vec<String> {
    labels.iter().map(|label| label.raw.clone()).collect()
}
