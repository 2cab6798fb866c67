//! Writing signals.

use std::collections::HashMap;
use std::io::{self, Write};
use std::sync::Arc;

use arrow::array::{ArrayRef, Float64Array};
use arrow::datatypes::{DataType, Field, Schema};
use arrow::record_batch::RecordBatch;
use meshtone::scenario::Scenario;
use meshtone::signal::Channels;
use parquet::arrow::ArrowWriter;
use parquet::basic::{Compression, Encoding};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::schema::types::ColumnPath;

use crate::run_identity::RunIdentity;

use super::{Column, RATE_KEY, RUN_KEY, SCENARIO_KEY, TIME, VERSION_KEY, columns};

/// Rows that are handed over at once: a compromise of memory and overhead.
const ROWS_AT_ONCE: usize = 1 << 16;
/// Writes signals as Parquet.
///
/// # Arguments
/// * `to` - where the file is written to; it needs no buffer
/// * `scenario` - what was simulated
/// * `channels` - the signals
///
/// # Errors
/// Those of `to`.
pub fn write_signals(to: impl Write + Send, scenario: &Scenario, channels: &Channels) -> io::Result<()> {
    let schema = schema(channels);
    let properties = properties(scenario, channels);
    let mut writer = ArrowWriter::try_new(to, schema.clone(), Some(properties)).map_err(io::Error::other)?;
    for start in (0..channels.len()).step_by(ROWS_AT_ONCE) {
        let rows = start..channels.len().min(start + ROWS_AT_ONCE);
        let time: ArrayRef =
            Arc::new(Float64Array::from_iter_values(rows.clone().map(|i| channels.time_s(i))));
        let signals = columns(channels).map(|(_, signal)| -> ArrayRef {
            Arc::new(Float64Array::from_iter_values(signal[rows.clone()].iter().copied()))
        });
        let arrays = std::iter::once(time).chain(signals).collect();
        let batch = RecordBatch::try_new(schema.clone(), arrays).map_err(io::Error::other)?;
        writer.write(&batch).map_err(io::Error::other)?;
    }
    writer.close().map_err(io::Error::other)?;
    Ok(())
}

fn schema(channels: &Channels) -> Arc<Schema> {
    let field = |column: Column| {
        let metadata = [("unit", column.unit), ("description", column.description)]
            .map(|(key, value)| (key.to_string(), value.to_string()));
        Field::new(column.name, DataType::Float64, false).with_metadata(HashMap::from(metadata))
    };
    let signals = columns(channels).map(|(column, _)| field(column));
    Arc::new(Schema::new(std::iter::once(field(TIME)).chain(signals).collect::<Vec<_>>()))
}

fn properties(scenario: &Scenario, channels: &Channels) -> WriterProperties {
    let metadata = [
        (SCENARIO_KEY, scenario.to_toml()),
        (VERSION_KEY, env!("CARGO_PKG_VERSION").to_string()),
        (RUN_KEY, RunIdentity::of(scenario).to_string()),
        (RATE_KEY, format!("{:?}", channels.sampling_rate_hz)),
    ];
    let metadata = metadata.map(|(key, value)| KeyValue::new(key.to_string(), value));
    WriterProperties::builder()
        // Zstandard makes the noise-like digits of a vibration 7 % smaller and takes twice as long.
        .set_compression(Compression::SNAPPY)
        // Hardly a number occurs twice, but signs and exponents resemble each other.
        .set_dictionary_enabled(false)
        .set_encoding(Encoding::BYTE_STREAM_SPLIT)
        // Rows are looked up by their time; the extremes of a signal are found in every part of it.
        .set_statistics_enabled(EnabledStatistics::None)
        .set_column_statistics_enabled(ColumnPath::from(TIME.name), EnabledStatistics::Chunk)
        .set_key_value_metadata(Some(metadata.to_vec()))
        .build()
}
