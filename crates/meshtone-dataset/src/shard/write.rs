//! Writing a shard.

use std::fmt::Display;
use std::io::{self, Write};

use meshtone::tuning::{HybridError, SimulatedCases};
use meshtone_io::experiment::Tuned;
use meshtone_io::table::{TableColumn, TableWriter};
use parquet::basic::{Compression, Encoding, ZstdLevel};
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::schema::types::ColumnPath;

use super::{Column, FailedRecord, ShardMetadata};
use crate::plan::Content;
use crate::record::Record;

/// Higher levels hardly compress the noise-like digits of a vibration better.
const COMPRESSION_LEVEL: i32 = 1;
/// (bytes) Size of the signals, and number of the records, that are gathered before they are compressed: a reader of one record reads so much.
const GROUP_BYTES: usize = 8 << 20;
const GROUP_RECORDS: usize = 64;
/// (bytes) Size of a page; the default would make pages of signals too small.
const PAGE_BYTES: usize = 1 << 20;

/// An item that the simulations give to the writer, in the order of the records.
pub(crate) enum Item {
    /// A record.
    Record(Box<Record>),
    /// The next record's gears without the fault.
    HealthyTwin(Box<Record>),
    /// A record that could not be made.
    Failed(FailedRecord),
}

/// Writes a shard.
///
/// Records are written in groups of limited size, so that memory does not grow with the shard. A healthy twin comes right before its
/// record, whose enhanced signal is made with it, and is dropped then. Failed records have no row; the metadata, which is written at the
/// end, lists them.
///
/// # Arguments
/// * `to` - where it is written to; it needs no buffer
/// * `content` - of the plan
/// * `columns` - of the plan
/// * `metadata` - of the shard; its failures are those found while it is written
/// * `next` - gives the next item of the shard, none where generating has stopped
pub(crate) fn write(
    to: impl Write + Send,
    content: &Content,
    columns: &[Column],
    mut metadata: ShardMetadata,
    mut next: impl FnMut() -> Option<Item>,
) -> io::Result<ShardMetadata> {
    let mut table = table(to, columns)?;
    let mut records = Vec::new();
    let mut bytes = 0;
    let mut twin: Option<Box<Record>> = None;
    let mut finished = 0;
    while finished < metadata.records {
        let item = next().ok_or_else(|| io::Error::new(io::ErrorKind::Interrupted, "stopped"))?;
        match item {
            Item::HealthyTwin(record) => {
                twin = Some(record);
                continue;
            }
            Item::Failed(failed) => metadata.failures.push(failed),
            Item::Record(mut record) => {
                let healthy = twin.take().filter(|twin| twin.drawn.index == record.drawn.index);
                let is_faulty = !content.classes[record.drawn.class].faults.is_empty();
                match enhanced(content.tuned.as_ref(), &record, healthy.as_deref(), is_faulty) {
                    Ok(enhanced) => {
                        record.enhanced = enhanced;
                        bytes += record.signal_bytes();
                        records.push(*record);
                    }
                    Err(reason) => {
                        metadata.failures.push(FailedRecord { record: record.drawn.index, reason });
                    }
                }
            }
        }
        finished += 1;
        let is_last = finished == metadata.records;
        if !records.is_empty() && (is_last || bytes >= GROUP_BYTES || records.len() == GROUP_RECORDS) {
            table.write_rows(columns.iter().map(|column| (column.cells)(&records)).collect())?;
            records.clear();
            bytes = 0;
        }
    }
    table.add_metadata(metadata.key_values()?);
    table.close()?;
    Ok(metadata)
}

/// Writes records as a table.
///
/// # Arguments
/// * `to` - where it is written to
/// * `columns` - its columns
/// * `records` - its rows
pub(crate) fn write_table(to: impl Write + Send, columns: &[Column], records: &[Record]) -> io::Result<()> {
    let mut table = table(to, columns)?;
    table.write_rows(columns.iter().map(|column| (column.cells)(records)).collect())?;
    table.close()
}

fn table<W: Write + Send>(to: W, columns: &[Column]) -> io::Result<TableWriter<W>> {
    let level = ZstdLevel::try_new(COMPRESSION_LEVEL).map_err(io::Error::other)?;
    let mut builder = WriterProperties::builder()
        .set_compression(Compression::ZSTD(level))
        .set_statistics_enabled(EnabledStatistics::Chunk)
        .set_data_page_size_limit(PAGE_BYTES);
    for column in columns.iter().filter(|column| column.is_signal()) {
        // Hardly any number occurs twice, but signs and exponents are similar.
        let path = ColumnPath::new(TableColumn::list_path(&column.name));
        builder = builder
            .set_column_dictionary_enabled(path.clone(), false)
            .set_column_encoding(path.clone(), Encoding::BYTE_STREAM_SPLIT)
            .set_column_statistics_enabled(path, EnabledStatistics::None);
    }
    TableWriter::new(to, columns.iter().map(TableColumn::from).collect(), builder.build())
}

/// The enhanced difference signal of a record; empty where nothing is enhanced.
fn enhanced(
    tuned: Option<&Tuned>,
    record: &Record,
    twin: Option<&Record>,
    is_faulty: bool,
) -> Result<Vec<f32>, String> {
    let Some(tuned) = tuned else { return Ok(Vec::new()) };
    let refuse = |why: &dyn Display| format!("it cannot be enhanced: {why}");
    if is_faulty && twin.is_none() {
        return Err(refuse(&"the healthy pair of the same wheels could not be simulated"));
    }
    let difference = &record.clean_difference;
    // A healthy record is its own twin.
    let healthy = twin.map_or(difference, |twin| &twin.clean_difference);
    let signal = || {
        let centre_rev = match twin {
            Some(_) => SimulatedCases::new(vec![healthy.clone(), difference.clone()])?.centre_rev(),
            None => tuned.centre_rev,
        };
        let enhanced = tuned.enhancement.without_noise(difference, healthy, centre_rev)?;
        let rms = enhanced.healthy_rms * (1.0 + tuned.enhancement.noise_level.powi(2)).sqrt();
        let signal = enhanced.with_noise(record.drawn.seed, 0)?;
        Ok::<_, HybridError>(signal.iter().map(|value| (value / rms) as f32).collect())
    };
    signal().map_err(|error| refuse(&error))
}
