//! Signals as Apache Parquet.

use std::io::{self, Write};

use parquet::basic::{Compression, Encoding};
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::schema::types::ColumnPath;

use super::super::signal_table::SignalTable;
use super::super::{RATE_KEY, RUN_KEY, TIME, VERSION_KEY};
use crate::run_identity::RunIdentity;
use crate::table::{CellType, Cells, TableColumn, TableWriter};

/// Rows of a group; a reader takes a group's column at once.
const GROUP_ROWS: usize = 1 << 20;

/// Writes columns behind the time, with what was simulated in the metadata.
pub fn write(table: &SignalTable, to: impl Write + Send) -> io::Result<()> {
    let columns = &table.channels.signals;
    let time = table_column(TIME, "s", "time since the start of the simulation");
    let signals = columns.iter().map(|column| table_column(&column.name, column.unit, column.meaning));
    let mut writer = TableWriter::new(to, std::iter::once(time).chain(signals).collect(), properties())?;
    if let Some((key, toml)) = &table.scenario {
        writer.add_metadata([
            (*key, toml.clone()),
            (VERSION_KEY, env!("CARGO_PKG_VERSION").to_string()),
            (RUN_KEY, RunIdentity::of_toml(toml).to_string()),
        ]);
    }
    writer.add_metadata([(RATE_KEY, format!("{:?}", table.channels.sampling_rate_hz))]);
    let samples = table.channels.len();
    for start in (0..samples).step_by(GROUP_ROWS) {
        let rows = start..samples.min(start + GROUP_ROWS);
        let times_s: Vec<f64> = rows.clone().map(|row| table.channels.time_s(row)).collect();
        let time = Cells::Signal(&times_s);
        let signals = columns.iter().map(|column| Cells::Signal(&column.values[rows.clone()]));
        writer.write_rows(std::iter::once(time).chain(signals).collect())?;
    }
    writer.close()
}

fn table_column(name: &str, unit: &str, description: &str) -> TableColumn {
    let column = TableColumn::new(name, CellType::Float64);
    column.with_metadata([("unit", unit), ("description", description)])
}

fn properties() -> WriterProperties {
    WriterProperties::builder()
        // Zstandard makes the noise-like digits of a vibration 7 % smaller and takes twice as long.
        .set_compression(Compression::SNAPPY)
        // Hardly a number occurs twice, but signs and exponents resemble each other.
        .set_dictionary_enabled(false)
        .set_encoding(Encoding::BYTE_STREAM_SPLIT)
        // Rows are looked up by their time; the extremes of a signal are found in every part of it.
        .set_statistics_enabled(EnabledStatistics::None)
        .set_column_statistics_enabled(ColumnPath::from(TIME), EnabledStatistics::Chunk)
        .build()
}
