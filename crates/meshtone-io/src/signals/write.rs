//! Writing signals.

use std::io::{self, Write};

use meshtone::scenario::Scenario;
use meshtone::signal::Channels;
use parquet::basic::{Compression, Encoding, ZstdLevel};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};

use crate::run_identity::RunIdentity;
use crate::table::{CellType, Cells, TableColumn, TableWriter};

use super::{Column, RATE_KEY, RUN_KEY, SCENARIO_KEY, TIME, VERSION_KEY, columns};

/// Rows of a group; a reader takes a group's column at once.
const GROUP_ROWS: usize = 1 << 20;
/// Higher levels hardly make the noise-like digits of a vibration smaller.
const COMPRESSION_LEVEL: i32 = 1;

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
    let properties = properties(scenario, channels).map_err(io::Error::other)?;
    let table = std::iter::once(TIME).chain(columns(channels).map(|(column, _)| column)).map(table_column);
    let mut table = TableWriter::new(to, table.collect(), properties)?;
    for start in (0..channels.len()).step_by(GROUP_ROWS) {
        let rows = start..channels.len().min(start + GROUP_ROWS);
        let time: Vec<f64> = rows.clone().map(|i| channels.time_s(i)).collect();
        let signals = columns(channels).map(|(_, signal)| Cells::Signal(&signal[rows.clone()]));
        table.write_rows(std::iter::once(Cells::Signal(&time)).chain(signals).collect())?;
    }
    table.close()
}

fn table_column(column: Column) -> TableColumn {
    let metadata = [("unit", column.unit), ("description", column.description)]
        .map(|(key, value)| (key.to_string(), value.to_string()));
    TableColumn {
        name: column.name.to_string(),
        cells: CellType::Float64,
        nullable: false,
        metadata: metadata.to_vec(),
    }
}

fn properties(
    scenario: &Scenario,
    channels: &Channels,
) -> Result<WriterProperties, parquet::errors::ParquetError> {
    let metadata = [
        (SCENARIO_KEY, scenario.to_toml()),
        (VERSION_KEY, env!("CARGO_PKG_VERSION").to_string()),
        (RUN_KEY, RunIdentity::of(scenario).to_string()),
        (RATE_KEY, format!("{:?}", channels.sampling_rate_hz)),
    ];
    let metadata = metadata.map(|(key, value)| KeyValue::new(key.to_string(), value));
    Ok(WriterProperties::builder()
        .set_compression(Compression::ZSTD(ZstdLevel::try_new(COMPRESSION_LEVEL)?))
        // Hardly a number occurs twice, but signs and exponents resemble each other.
        .set_dictionary_enabled(false)
        .set_encoding(Encoding::BYTE_STREAM_SPLIT)
        .set_statistics_enabled(EnabledStatistics::Chunk)
        .set_key_value_metadata(Some(metadata.to_vec()))
        .build())
}
