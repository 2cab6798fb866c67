//! Writing signals.

use std::io::{self, Write};

use meshtone::scenario::Scenario;
use meshtone::sensor::{Channel, Channels};
use parquet::basic::{Compression, Encoding};
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::schema::types::ColumnPath;

use crate::run_identity::RunIdentity;
use crate::table::{CellType, Cells, TableColumn, TableWriter};

use super::{RATE_KEY, RUN_KEY, SCENARIO_KEY, TIME, VERSION_KEY};

/// Rows of a group; a reader takes a group's column at once.
const GROUP_ROWS: usize = 1 << 20;

/// Writes signals as Parquet: the time, the sensors in their order, and the channels that every simulation has.
///
/// # Arguments
/// * `to` - where the file is written to; it needs no buffer
/// * `scenario` - what was simulated
/// * `channels` - the signals
///
/// # Errors
/// Those of `to`.
pub fn write_signals(to: impl Write + Send, scenario: &Scenario, channels: &Channels) -> io::Result<()> {
    let time = table_column(TIME, "s", "time since the start of the simulation");
    let listed = channels.list();
    let column = |channel: &Channel| table_column(&channel.name(), channel.unit(), channel.meaning());
    let signals = listed.iter().map(column);
    let mut table = TableWriter::new(to, std::iter::once(time).chain(signals).collect(), properties())?;
    table.add_metadata([
        (SCENARIO_KEY, scenario.to_toml()),
        (VERSION_KEY, env!("CARGO_PKG_VERSION").to_string()),
        (RUN_KEY, RunIdentity::of(scenario).to_string()),
        (RATE_KEY, format!("{:?}", channels.sampling_rate_hz)),
    ]);
    for start in (0..channels.len()).step_by(GROUP_ROWS) {
        let rows = start..channels.len().min(start + GROUP_ROWS);
        let times_s: Vec<f64> = rows.clone().map(|row| channels.time_s(row)).collect();
        let time = Cells::Signal(&times_s);
        let signals = listed.iter().filter_map(|channel| channels.signal(channel));
        let signals = signals.map(|signal| Cells::Signal(&signal[rows.clone()]));
        table.write_rows(std::iter::once(time).chain(signals).collect())?;
    }
    table.close()
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
