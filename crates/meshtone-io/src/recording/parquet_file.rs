//! Parquet, of whatever program; that of `meshtone simulate` states units and rate in its metadata.

use std::fs::File;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use parquet::basic::Compression;
use parquet::file::metadata::{ColumnChunkMetaData, FileMetaData};

use super::assemble::{Parts, assemble};
use super::error::{broken, read_failed, unreadable};
use super::label::Label;
use super::parquet_check::check;
use super::parquet_depth::is_too_deep;
use super::rate::StatedRate;
use super::selection::select;
use super::{Position, ReadRecordingError, Recording, RecordingOptions, memory_need};
use crate::signals::SCENARIO_KEY;
use crate::table::{FoundColumn, FoundType, TableReader};

const FORMAT: &str = "Parquet";
/// Bytes of samples that a byte of a file may well stand for; memory for more is taken only as they come.
const USUAL_COMPRESSION: u64 = 16;

/// Reads a recording from Parquet.
///
/// The `parquet` crate panics where a page contradicts the metadata, which no check finds before it is decoded; so
/// its panics are caught. Nothing but what is dropped with them has changed by then.
pub(super) fn read(
    path: &Path,
    file: File,
    options: &RecordingOptions,
) -> Result<Recording, ReadRecordingError> {
    let result = catch_unwind(AssertUnwindSafe(|| decode(path, file, options)));
    result.unwrap_or_else(|panic| {
        let message = panic.downcast_ref::<String>().map(String::as_str);
        let message = message.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("unknown");
        Err(broken(path, FORMAT, format!("its pages cannot be decoded ({message})")))
    })
}

fn decode(path: &Path, mut file: File, options: &RecordingOptions) -> Result<Recording, ReadRecordingError> {
    let file_bytes = file.metadata().map_err(|source| unreadable(path, source))?.len();
    let too_deep = is_too_deep(&mut file, file_bytes).map_err(|error| read_failed(path, FORMAT, error))?;
    if too_deep {
        return Err(broken(path, FORMAT, "its list of columns is damaged, or nested more than 64 deep"));
    }
    let table = TableReader::new(file).map_err(|error| broken(path, FORMAT, error))?;
    check(table.metadata(), file_bytes).map_err(|problem| broken(path, FORMAT, problem))?;
    let head = table.metadata().file_metadata();
    let labels: Vec<Label> = table.columns().iter().map(label).collect();
    let stated = stated_rates(head);
    let scenario_toml = scenario(head);
    let selection = select(path, &labels, options)?;
    let wanted = selection.wanted();
    let rows = u64::try_from(head.num_rows()).unwrap_or(0);
    let chunks = || wanted.iter().flat_map(|index| table.chunks(&table.columns()[*index]));
    if let Some(foreign) = chunks().find(|chunk| !is_read(chunk.compression())) {
        return Err(foreign_codec(path, foreign));
    }
    // A page is there as a whole beside the numbers that it becomes, and is its whole chunk at most.
    let page_bytes = chunks().filter_map(|chunk| u64::try_from(chunk.uncompressed_size()).ok()).max();
    memory_need::check(path, options, &selection, wanted.iter().map(|_| rows), page_bytes.unwrap_or(0))?;
    let capacity = capacity(wanted.len(), head.num_rows(), file_bytes);
    let read = |index: &usize| {
        let column = &table.columns()[*index];
        let numbers = table.numbers(column, capacity).map_err(|error| broken(path, FORMAT, error))?;
        match numbers.first_empty {
            None => Ok(numbers.values),
            Some(row) => Err(gap(path, &labels[*index], row)),
        }
    };
    let columns = wanted.iter().map(read).collect::<Result<_, _>>()?;
    let parts = Parts { path, labels: &labels, selection: &selection, samples: columns, stated: &stated };
    let recording = assemble(parts, options)?;
    Ok(Recording { scenario_toml, ..recording })
}

fn label(column: &FoundColumn) -> Label {
    let said = |key: &str| column.metadata.iter().find(|(name, _)| name == key).map(|(_, value)| value);
    let unit = said("unit").or_else(|| said("units")).filter(|unit| !unit.is_empty());
    let mut label = Label::from_header(&column.name);
    if let Some(unit) = unit {
        label.name.clone_from(&label.raw);
        label.unit = Some(unit.clone());
    }
    match &column.kind {
        FoundType::Number(_) => {}
        FoundType::Moment(_) => label.unit = Some("s".to_string()),
        other => label.not_numeric = Some(other.to_string()),
    }
    label
}

/// Whether pages of a codec can be decompressed here.
fn is_read(codec: Compression) -> bool {
    use Compression::{GZIP, LZ4, LZ4_RAW, SNAPPY, UNCOMPRESSED, ZSTD};

    matches!(codec, UNCOMPRESSED | SNAPPY | GZIP(_) | LZ4 | LZ4_RAW | ZSTD(_))
}

fn foreign_codec(path: &Path, chunk: &ColumnChunkMetaData) -> ReadRecordingError {
    let codec = chunk.compression().to_string();
    let codec = codec.split('(').next().unwrap_or_default();
    let column = chunk.column_path().string();
    ReadRecordingError::Convert {
        path: path.to_path_buf(),
        what: format!("a Parquet file whose column {column} is compressed by {codec}"),
        how:
            "write it again uncompressed or with Snappy, gzip, LZ4 or Zstandard, for instance in Python with \
              `pandas.read_parquet('FILE').to_parquet('NEW', compression='zstd')`"
                .to_string(),
    }
}

fn stated_rates(metadata: &FileMetaData) -> Vec<StatedRate> {
    let entries = metadata.key_value_metadata().into_iter().flatten();
    let named = entries.filter_map(|entry| {
        let value = entry.value.as_deref()?.trim().parse().ok()?;
        StatedRate::from_named(&entry.key, value)
    });
    named.map(|rate| StatedRate { by: format!("metadata {}", rate.by), ..rate }).collect()
}

fn scenario(metadata: &FileMetaData) -> Option<String> {
    let mut entries = metadata.key_value_metadata().into_iter().flatten();
    let entry = entries.find(|entry| entry.key == SCENARIO_KEY)?;
    entry.value.clone()
}

/// Numbers of a column for which memory is taken beforehand.
fn capacity(columns: usize, rows: i64, file_bytes: u64) -> usize {
    let rows = u64::try_from(rows).unwrap_or(0);
    let bytes = rows.checked_mul(8 * columns as u64);
    let usual = bytes.is_some_and(|bytes| bytes <= file_bytes.saturating_mul(USUAL_COMPRESSION));
    if usual { rows as usize } else { 0 }
}

fn gap(path: &Path, label: &Label, row: usize) -> ReadRecordingError {
    ReadRecordingError::Gap {
        path: path.to_path_buf(),
        position: Position::Sample(row as u64 + 1),
        column: label.raw.clone(),
        what: "empty (null)".to_string(),
    }
}
