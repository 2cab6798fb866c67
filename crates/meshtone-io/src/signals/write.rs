//! Writing signals.

use std::io::{self, Write};

use meshtone::scenario::{Gearbox, Scenario};
use meshtone::sensor::{Channel, Channels};
use meshtone::{GearboxChannels, GearboxSignal};
use parquet::basic::{Compression, Encoding};
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::schema::types::ColumnPath;

use crate::run_identity::RunIdentity;
use crate::table::{CellType, Cells, TableColumn, TableWriter};

use super::{GEARBOX_KEY, RATE_KEY, RUN_KEY, SCENARIO_KEY, TIME, VERSION_KEY};

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
    let listed = channels.list();
    let column = |channel: &Channel| {
        let values = channels.signal(channel)?;
        Some(SignalColumn {
            name: channel.name().into_owned(),
            unit: channel.unit(),
            meaning: channel.meaning(),
            values,
        })
    };
    let columns: Vec<SignalColumn> = listed.iter().filter_map(column).collect();
    write_columns(
        to,
        [SCENARIO_KEY, &scenario.to_toml()],
        [channels.sampling_rate_hz, channels.start_s],
        &columns,
    )
}

/// Writes the signals of a gearbox as Parquet, in the same form.
///
/// # Arguments
/// * `to` - where the file is written to; it needs no buffer
/// * `gearbox` - what was simulated
/// * `channels` - the signals
///
/// # Errors
/// Those of `to`.
pub fn write_gearbox_signals(
    to: impl Write + Send,
    gearbox: &Gearbox,
    channels: &GearboxChannels,
) -> io::Result<()> {
    let column = |signal: &'_ GearboxSignal| {
        let meaning = match signal.unit {
            "N" => "force along the line of action of the mesh; negative where coast flanks touch",
            "µm" => {
                "how far the wheels of the mesh have turned against one another, along the line of action"
            }
            "Hz" => "revolutions of the shaft per second",
            _ => "what the sensor shows, over 9.81 m/s²",
        };
        (signal.name.clone(), signal.unit, meaning)
    };
    let columns: Vec<SignalColumn> = (channels.signals.iter())
        .map(|signal| {
            let (name, unit, meaning) = column(signal);
            SignalColumn { name, unit, meaning, values: &signal.values }
        })
        .collect();
    write_columns(
        to,
        [GEARBOX_KEY, &gearbox.to_toml()],
        [channels.sampling_rate_hz, channels.start_s],
        &columns,
    )
}

/// A column of signals.
struct SignalColumn<'a> {
    name: String,
    unit: &'a str,
    meaning: &'a str,
    values: &'a [f64],
}

/// Writes columns behind the time, with what was simulated in the metadata.
fn write_columns(
    to: impl Write + Send,
    [key, toml]: [&str; 2],
    [sampling_rate_hz, start_s]: [f64; 2],
    columns: &[SignalColumn],
) -> io::Result<()> {
    let time = table_column(TIME, "s", "time since the start of the simulation");
    let signals = columns.iter().map(|column| table_column(&column.name, column.unit, column.meaning));
    let mut table = TableWriter::new(to, std::iter::once(time).chain(signals).collect(), properties())?;
    table.add_metadata([
        (key, toml.to_owned()),
        (VERSION_KEY, env!("CARGO_PKG_VERSION").to_string()),
        (RUN_KEY, RunIdentity::of_toml(toml).to_string()),
        (RATE_KEY, format!("{sampling_rate_hz:?}")),
    ]);
    let samples = columns.first().map_or(0, |column| column.values.len());
    for start in (0..samples).step_by(GROUP_ROWS) {
        let rows = start..samples.min(start + GROUP_ROWS);
        let times_s: Vec<f64> = rows.clone().map(|row| start_s + row as f64 / sampling_rate_hz).collect();
        let time = Cells::Signal(&times_s);
        let signals = columns.iter().map(|column| Cells::Signal(&column.values[rows.clone()]));
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
