//! Parquet, of whatever program; that of `meshtone simulate` states units and rate in its metadata.

use std::fs::File;

use parquet::basic::Compression;
use parquet::file::metadata::{ColumnChunkMetaData, FileMetaData};

use super::assemble::assemble;
use super::catalogue::USUAL_COMPRESSION;
use super::error::Problem;
use super::label::Label;
use super::parquet_check::{check_depth, check_metadata};
use super::rate::{StatedRate, other_than_timed};
use super::selection::select;
use super::{Recording, RecordingOptions, memory_need};
use crate::memory;
use crate::signals::{GEARBOX_KEY, SCENARIO_KEY};
use crate::table::{FoundColumn, FoundType, TableReader};

/// Opens a table whose metadata are possible.
pub(super) fn table(mut file: File) -> Result<TableReader<File>, Problem> {
    let file_bytes = file.metadata()?.len();
    check_depth(&mut file, file_bytes)?;
    let table = TableReader::new(file).map_err(Problem::broken)?;
    check_metadata(table.metadata(), file_bytes).map_err(Problem::Broken)?;
    Ok(table)
}

/// Reads a recording from Parquet.
pub(super) fn read(file: File, options: &RecordingOptions) -> Result<Recording, Problem> {
    let file_bytes = file.metadata()?.len();
    let table = table(file)?;
    let head = table.metadata().file_metadata();
    let labels: Vec<Label> = table.columns().iter().map(label).collect();
    let selection = select(&labels, options)?;
    let rows = u64::try_from(head.num_rows()).unwrap_or(0);
    let chunks = || selection.wanted.iter().flat_map(|index| table.chunks(&table.columns()[*index]));
    if let Some(foreign) = chunks().find(|chunk| !is_read(chunk.compression())) {
        return Err(foreign_codec(foreign));
    }
    // A page is there as a whole beside the numbers that it becomes, and is its whole chunk at most.
    let page_bytes = chunks().filter_map(|chunk| u64::try_from(chunk.uncompressed_size()).ok()).max();
    memory_need::check(memory::limit(), options, &selection, |_| rows, page_bytes.unwrap_or(0))?;
    let bytes = rows.checked_mul(8 * selection.wanted.len() as u64);
    let is_usual = bytes.is_some_and(|bytes| bytes <= file_bytes.saturating_mul(USUAL_COMPRESSION));
    let capacity = if is_usual { rows as usize } else { 0 };
    let read = |index: &usize| {
        let numbers = table.numbers(&table.columns()[*index], capacity).map_err(Problem::broken)?;
        let gap = |row| Problem::gap(format!("sample {}", row + 1), &labels[*index].raw, "empty (null)");
        numbers.first_empty.map_or(Ok(numbers.values), |row| Err(gap(row)))
    };
    let samples = selection.wanted.iter().map(read).collect::<Result<_, _>>()?;
    let mut recording = assemble(&labels, &selection, samples, &stated_rates(head), options)?;
    recording.warnings.extend(other_than_timed(&labels, &selection, options, |column| read(&column)));
    let scenario_toml = table.text_of(SCENARIO_KEY).or_else(|| table.text_of(GEARBOX_KEY));
    Ok(Recording { scenario_toml: scenario_toml.map(str::to_owned), ..recording })
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
        FoundType::Moment { .. } => label.unit = Some("s".to_string()),
        other => label.not_numeric = Some(other.to_string()),
    }
    label
}

/// Whether pages of a codec can be decompressed here.
fn is_read(codec: Compression) -> bool {
    use Compression::{GZIP, LZ4, LZ4_RAW, SNAPPY, UNCOMPRESSED, ZSTD};

    matches!(codec, UNCOMPRESSED | SNAPPY | GZIP(_) | LZ4 | LZ4_RAW | ZSTD(_))
}

fn foreign_codec(chunk: &ColumnChunkMetaData) -> Problem {
    let codec = chunk.compression().to_string();
    let codec = codec.split('(').next().unwrap_or_default();
    let column = chunk.column_path().string();
    Problem::convert(
        &format!("a Parquet file whose column {column} is compressed by {codec}"),
        "write it again uncompressed or with Snappy, gzip, LZ4 or Zstandard, for instance in Python with \
         `pandas.read_parquet('FILE').to_parquet('NEW', compression='zstd')`",
    )
}

fn stated_rates(metadata: &FileMetaData) -> Vec<StatedRate> {
    let entries = metadata.key_value_metadata().into_iter().flatten();
    let named = entries.filter_map(|entry| {
        let value = entry.value.as_deref()?.trim().parse().ok()?;
        StatedRate::from_named(&entry.key, value)
    });
    named.map(|rate| StatedRate { by: format!("metadata {}", rate.by), ..rate }).collect()
}
