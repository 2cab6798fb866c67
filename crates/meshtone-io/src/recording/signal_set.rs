//! A recording of a data set in the schema of the Python package `bearing-datasets`, version 2: the table `metadata.parquet` has a row for
//! each signal, and says in which row of which file of the folder `signals` the samples are.

use std::fs::File;
use std::path::{Path, PathBuf};

use meshtone_toml::nearest_name;

use super::assemble::assemble;
use super::error::{Problem, names};
use super::label::Label;
use super::parquet_file::table;
use super::rate::StatedRate;
use super::selection::select;
use super::{Recording, RecordingOptions, memory_need};
use crate::input_file::open_ordinary;
use crate::memory;
use crate::table::{FoundColumn, TableReader};

const METADATA: &str = "metadata.parquet";
const SIGNALS: &str = "signals";
/// (bytes) Memory for a value of a group of rows while it is read, with its levels and its copy in a list.
const VALUE_BYTES: u64 = 20;
/// Units of numbers whose scale is unknown.
const UNKNOWN_UNITS: [&str; 3] = ["unknown", "counts", "normalized"];

/// The folder of a data set, if a path is one, or is its table.
pub(super) fn folder(path: &Path) -> Option<&Path> {
    let is_set = |folder: &&Path| folder.join(METADATA).is_file() && folder.join(SIGNALS).is_dir();
    if path.file_name().is_some_and(|name| name == METADATA) { path.parent() } else { Some(path) }
        .filter(is_set)
}

/// Reads a recording: its rows from the table, and of the channels that are chosen as in any file the samples.
///
/// # Arguments
/// * `folder` - of the data set
/// * `options` - of the recording; `variable` is its `recording_id`
pub(super) fn read(folder: &Path, options: &RecordingOptions) -> Result<Recording, Problem> {
    let metadata = table(open_ordinary(&folder.join(METADATA))?)?;
    let ids = texts(&metadata, "recording_id")?;
    let rows = rows_of(&ids, options.variable.as_deref())?;
    let of_rows =
        |values: Vec<String>| -> Vec<String> { rows.iter().map(|&row| values[row].clone()).collect() };
    let channels = of_rows(texts(&metadata, "channel")?);
    let files = of_rows(texts(&metadata, "signal_file")?);
    let units = match metadata.column("unit") {
        Some(_) => of_rows(texts(&metadata, "unit")?),
        None => vec![UNKNOWN_UNITS[0].to_owned(); rows.len()],
    };
    let number = |name: &str| numbers(&metadata, name).map(|all| rows.iter().map(|&row| all[row]).collect());
    let [rates, samples, groups, places]: [Vec<f64>; 4] =
        [number("fs")?, number("n_samples")?, number("signal_row_group")?, number("signal_row")?];
    let labels = channels.iter().zip(units).map(|(channel, unit)| {
        let unit = Some(unit).filter(|unit| !UNKNOWN_UNITS.contains(&unit.as_str()));
        Label { unit, ..Label::plain(channel) }
    });
    let labels: Vec<Label> = labels.collect();
    let selection = select(&labels, options)?;
    let open = |&index: &usize| {
        let signals = table(open_ordinary(&file_of(folder, &files[index])?)?)?;
        let column = signals.column("signal").ok_or_else(|| lacks(&files[index], "signal"))?.clone();
        Ok((index, signals, column))
    };
    let opened = selection.wanted.iter().map(open).collect::<Result<Vec<_>, Problem>>()?;
    // All signals of a group of rows are read at once.
    let values_of_group = opened.iter().filter_map(|(index, signals, column)| {
        let chunk = signals.chunks(column).nth(groups[*index] as usize)?;
        u64::try_from(chunk.num_values()).ok()
    });
    let group_bytes = values_of_group.max().unwrap_or(0).saturating_mul(VALUE_BYTES);
    memory_need::check(memory::limit(), options, &selection, |index| samples[index] as u64, group_bytes)?;
    let read = |(index, signals, column): (usize, TableReader<File>, FoundColumn)| {
        let lists = signals.lists(&column, groups[index] as usize).map_err(Problem::broken)?;
        let list = lists.into_iter().nth(places[index] as usize).unwrap_or_default();
        if list.len() as f64 == samples[index] {
            return Ok(list);
        }
        let (channel, found, stated) = (&channels[index], list.len(), samples[index]);
        Err(Problem::Refused(format!(
            "{channel} has {found} samples, and {METADATA} says {stated}; build the data set again"
        )))
    };
    let read = opened.into_iter().map(read).collect::<Result<_, _>>()?;
    let rate =
        |&index: &usize| StatedRate { by: format!("fs of {}", channels[index]), rate_hz: rates[index] };
    let stated: Vec<StatedRate> = selection.wanted.iter().map(rate).collect();
    assemble(&labels, &selection, read, &stated, options)
}

/// The rows of a recording.
fn rows_of(ids: &[String], wanted: Option<&str>) -> Result<Vec<usize>, Problem> {
    let mut present = ids.to_vec();
    present.dedup();
    let Some(wanted) = wanted.map(str::trim) else {
        return Err(Problem::Refused(format!(
            "is a data set of several recordings; choose one by its recording_id (option variable): {}",
            names(&present)
        )));
    };
    let rows: Vec<usize> = (0..ids.len()).filter(|&row| ids[row] == wanted).collect();
    if rows.is_empty() {
        let nearest = nearest_name(wanted, present.iter().map(String::as_str));
        return Err(Problem::absent(&format!("recording `{wanted}`"), nearest, &present));
    }
    Ok(rows)
}

/// The file of signals of a name. The name must not lead out of the folder.
fn file_of(folder: &Path, name: &str) -> Result<PathBuf, Problem> {
    if Path::new(name).file_name().is_none_or(|file| file != name) {
        return Err(Problem::Broken(format!("the signal_file {name:?} is no name of a file")));
    }
    Ok(folder.join(SIGNALS).join(name))
}

fn texts(table: &TableReader<File>, name: &str) -> Result<Vec<String>, Problem> {
    let column = table.column(name).ok_or_else(|| lacks(METADATA, name))?;
    let texts = table.texts(column).map_err(Problem::broken)?;
    Ok(texts.into_iter().map(Option::unwrap_or_default).collect())
}

fn numbers(table: &TableReader<File>, name: &str) -> Result<Vec<f64>, Problem> {
    let column = table.column(name).ok_or_else(|| lacks(METADATA, name))?;
    Ok(table.numbers(column, 0).map_err(Problem::broken)?.values)
}

fn lacks(file: &str, column: &str) -> Problem {
    Problem::Refused(format!(
        "has no column `{column}` in {file}; it must be a data set of bearing-datasets, schema version 2"
    ))
}
