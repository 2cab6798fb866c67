//! Parquet, of whatever program; that of `meshtone simulate` states units and rate in its metadata.

use std::fs::File;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use arrow::array::{Array, ArrayRef, AsArray};
use arrow::datatypes::{
    ArrowPrimitiveType, DataType, DurationMicrosecondType, DurationMillisecondType, DurationNanosecondType,
    DurationSecondType, Field, Float32Type, Float64Type, Int8Type, Int16Type, Int32Type, Int64Type, TimeUnit,
    TimestampMicrosecondType, TimestampMillisecondType, TimestampNanosecondType, TimestampSecondType,
    UInt8Type, UInt16Type, UInt32Type, UInt64Type,
};
use parquet::arrow::ProjectionMask;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use parquet::file::metadata::FileMetaData;

use super::assemble::{Parts, assemble};
use super::error::{broken, read_failed, unreadable};
use super::label::Label;
use super::parquet_check::check;
use super::parquet_depth::is_too_deep;
use super::rate::StatedRate;
use super::selection::select;
use super::{Position, ReadRecordingError, Recording, RecordingOptions};
use crate::signals::SCENARIO_KEY;

const FORMAT: &str = "Parquet";
/// Rows that are decoded at once.
const ROWS_AT_ONCE: usize = 1 << 14;
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
    let builder =
        ParquetRecordBatchReaderBuilder::try_new(file).map_err(|error| broken(path, FORMAT, error))?;
    check(builder.metadata(), file_bytes).map_err(|problem| broken(path, FORMAT, problem))?;
    let labels: Vec<Label> = builder.schema().fields().iter().map(|field| label(field)).collect();
    let stated = stated_rates(builder.metadata().file_metadata());
    let scenario_toml = scenario(builder.metadata().file_metadata());
    let selection = select(path, &labels, options)?;
    let wanted = selection.wanted();
    let rows = builder.metadata().file_metadata().num_rows();
    let mut columns = reserved(wanted.len(), rows, file_bytes);
    let mut first_times: Vec<Option<i64>> = vec![None; wanted.len()];
    let projection = ProjectionMask::roots(builder.parquet_schema(), wanted.iter().copied());
    let reader = builder.with_projection(projection).with_batch_size(ROWS_AT_ONCE).build();
    for batch in reader.map_err(|error| broken(path, FORMAT, error))? {
        let batch = batch.map_err(|error| broken(path, FORMAT, error))?;
        for (slot, column) in batch.columns().iter().enumerate().take(wanted.len()) {
            let label = &labels[wanted[slot]];
            check_nulls(path, label, column, columns[slot].len())?;
            append(column, &mut columns[slot], &mut first_times[slot]);
        }
    }
    let parts = Parts { path, labels: &labels, selection: &selection, samples: columns, stated: &stated };
    let recording = assemble(parts, options)?;
    Ok(Recording { scenario_toml, ..recording })
}

fn label(field: &Field) -> Label {
    let metadata = field.metadata();
    let unit = metadata.get("unit").or_else(|| metadata.get("units")).filter(|unit| !unit.is_empty());
    let mut label = Label::from_header(field.name());
    if let Some(unit) = unit {
        label.name.clone_from(&label.raw);
        label.unit = Some(unit.clone());
    }
    if is_moment(field.data_type()) {
        label.unit = Some("s".to_string());
    }
    if !is_numeric(field.data_type()) && !is_moment(field.data_type()) {
        label.not_numeric = Some(field.data_type().to_string());
    }
    label
}

fn is_numeric(kind: &DataType) -> bool {
    use DataType::{Float32, Float64};
    kind.is_integer() || matches!(kind, Float32 | Float64)
}

fn is_moment(kind: &DataType) -> bool {
    matches!(kind, DataType::Timestamp(..) | DataType::Duration(_))
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
    entries.find(|entry| entry.key == SCENARIO_KEY).and_then(|entry| entry.value.clone())
}

fn reserved(columns: usize, rows: i64, file_bytes: u64) -> Vec<Vec<f64>> {
    let rows = u64::try_from(rows).unwrap_or(0);
    let bytes = rows.checked_mul(8 * columns as u64);
    let usual = bytes.is_some_and(|bytes| bytes <= file_bytes.saturating_mul(USUAL_COMPRESSION));
    (0..columns).map(|_| Vec::with_capacity(if usual { rows as usize } else { 0 })).collect()
}

fn check_nulls(
    path: &Path,
    label: &Label,
    column: &ArrayRef,
    before: usize,
) -> Result<(), ReadRecordingError> {
    if column.logical_null_count() == 0 {
        return Ok(());
    }
    let index = (0..column.len()).find(|index| column.is_null(*index)).unwrap_or(0);
    Err(ReadRecordingError::Gap {
        path: path.to_path_buf(),
        position: Position::Sample((before + index) as u64 + 1),
        column: label.raw.clone(),
        what: "empty (null)".to_string(),
    })
}

/// Appends numbers as they are, and moments as seconds since the first.
fn append(column: &ArrayRef, to: &mut Vec<f64>, first: &mut Option<i64>) {
    match column.data_type() {
        DataType::Float64 => to.extend_from_slice(column.as_primitive::<Float64Type>().values()),
        DataType::Float32 => numbers::<Float32Type>(column, to, f64::from),
        DataType::Int8 => numbers::<Int8Type>(column, to, f64::from),
        DataType::Int16 => numbers::<Int16Type>(column, to, f64::from),
        DataType::Int32 => numbers::<Int32Type>(column, to, f64::from),
        DataType::Int64 => numbers::<Int64Type>(column, to, |number| number as f64),
        DataType::UInt8 => numbers::<UInt8Type>(column, to, f64::from),
        DataType::UInt16 => numbers::<UInt16Type>(column, to, f64::from),
        DataType::UInt32 => numbers::<UInt32Type>(column, to, f64::from),
        DataType::UInt64 => numbers::<UInt64Type>(column, to, |number| number as f64),
        DataType::Timestamp(unit, _) => match unit {
            TimeUnit::Second => moments::<TimestampSecondType>(column, to, first, 1.0),
            TimeUnit::Millisecond => moments::<TimestampMillisecondType>(column, to, first, 1e3),
            TimeUnit::Microsecond => moments::<TimestampMicrosecondType>(column, to, first, 1e6),
            TimeUnit::Nanosecond => moments::<TimestampNanosecondType>(column, to, first, 1e9),
        },
        DataType::Duration(unit) => match unit {
            TimeUnit::Second => moments::<DurationSecondType>(column, to, first, 1.0),
            TimeUnit::Millisecond => moments::<DurationMillisecondType>(column, to, first, 1e3),
            TimeUnit::Microsecond => moments::<DurationMicrosecondType>(column, to, first, 1e6),
            TimeUnit::Nanosecond => moments::<DurationNanosecondType>(column, to, first, 1e9),
        },
        // Columns of other types are refused before they are read.
        _ => {}
    }
}

fn numbers<T: ArrowPrimitiveType>(column: &ArrayRef, to: &mut Vec<f64>, number: impl Fn(T::Native) -> f64) {
    to.extend(column.as_primitive::<T>().values().iter().map(|value| number(*value)));
}

fn moments<T: ArrowPrimitiveType<Native = i64>>(
    column: &ArrayRef,
    to: &mut Vec<f64>,
    first: &mut Option<i64>,
    per_second: f64,
) {
    let values = column.as_primitive::<T>().values();
    let Some(start) = values.first().map(|value| *first.get_or_insert(*value)) else { return };
    // In 128 bits, as two moments may be farther apart than fits into 64.
    to.extend(values.iter().map(|value| (i128::from(*value) - i128::from(start)) as f64 / per_second));
}
