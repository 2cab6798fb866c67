//! Reading a shard: its metadata and some of its values.

use std::collections::BTreeMap;
use std::io;

use meshtone_io::table::{FoundColumn, FoundType, SEAL, TableReader, UNKNOWN_HASH, into_io};
use parquet::file::metadata::KeyValue;
use parquet::file::reader::ChunkReader;
use serde::{Deserialize, Serialize};

const PLAN: &str = "meshtone.plan_sha256";
const VERSION: &str = "meshtone.version";
const FIRST: &str = "meshtone.first_record";
const RECORDS: &str = "meshtone.records";
const FAILURES: &str = "meshtone.failures";

/// A record that could not be made.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FailedRecord {
    /// Number of the record.
    pub record: u64,
    /// Why it could not be made.
    pub reason: String,
}

/// The metadata that a shard's file holds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ShardMetadata {
    /// Hash of the plan.
    pub plan: String,
    /// Number of the first record.
    pub first: u64,
    /// Number of the shard's records, including those that failed.
    pub records: u64,
    /// The records that failed.
    pub failures: Vec<FailedRecord>,
}

impl ShardMetadata {
    pub(super) fn key_values(&self) -> io::Result<Vec<(String, String)>> {
        let values = [
            (PLAN, self.plan.clone()),
            (VERSION, env!("CARGO_PKG_VERSION").to_owned()),
            (FIRST, self.first.to_string()),
            (RECORDS, self.records.to_string()),
            (FAILURES, serde_json::to_string(&self.failures)?),
            (SEAL, UNKNOWN_HASH.to_owned()),
        ];
        Ok(values.map(|(key, value)| (key.to_owned(), value)).to_vec())
    }

    /// The metadata and the seal.
    fn from_key_values(values: &[KeyValue]) -> Option<(Self, String)> {
        let text = |key: &str| values.iter().find(|value| value.key == key)?.value.as_deref();
        let metadata = Self {
            plan: text(PLAN)?.to_owned(),
            first: text(FIRST)?.parse().ok()?,
            records: text(RECORDS)?.parse().ok()?,
            failures: serde_json::from_str(text(FAILURES)?).ok()?,
        };
        Some((metadata, text(SEAL)?.to_owned()))
    }

    /// Returns whether a shard is the one that was to be made, whatever failed in it.
    pub(crate) fn is_of(&self, wanted: &Self) -> bool {
        (&self.plan, self.first, self.records) == (&wanted.plan, wanted.first, wanted.records)
    }
}

/// The parts of a shard that were read.
pub(crate) struct ReadShard {
    pub metadata: ShardMetadata,
    /// The seal that its footer states.
    pub seal: String,
    pub rows: u64,
    /// Names and types of the shard's columns.
    pub schema: Vec<FoundColumn>,
    numbers: BTreeMap<String, Vec<f64>>,
    texts: BTreeMap<String, Vec<String>>,
    /// The signal of one row.
    pub signal: Vec<f64>,
}

impl ReadShard {
    /// A column of numbers. An empty cell is NaN; a column that was not read has no values.
    pub fn numbers(&self, name: &str) -> &[f64] {
        self.numbers.get(name).map_or(&[], Vec::as_slice)
    }

    /// A column of text. An empty cell is an empty text; a column that was not read has no values.
    pub fn texts(&self, name: &str) -> &[String] {
        self.texts.get(name).map_or(&[], Vec::as_slice)
    }
}

/// The values of a shard that are read in addition to its metadata.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Wanted<'n> {
    /// Columns of numbers and text. A column that the shard lacks is skipped.
    Columns(&'n [&'n str]),
    /// The signal of one row: the signals of a whole shard may be large.
    Signal {
        /// Name of the column.
        column: &'n str,
        /// The row.
        row: usize,
    },
}

/// Reads the metadata of a shard and some of its values.
///
/// # Arguments
/// * `file` - the shard
/// * `wanted` - the values
pub(crate) fn read(file: impl ChunkReader + 'static, wanted: Wanted) -> io::Result<ReadShard> {
    let table = TableReader::new(file).map_err(into_io)?;
    let head = table.metadata().file_metadata();
    let metadata = head.key_value_metadata().and_then(|values| ShardMetadata::from_key_values(values));
    let (metadata, seal) = metadata.ok_or_else(|| io::Error::other("is no shard of a data set"))?;
    let rows = u64::try_from(head.num_rows()).unwrap_or(0);
    let expected = metadata.records.checked_sub(metadata.failures.len() as u64);
    if expected != Some(rows) {
        return Err(io::Error::other(format!("has {rows} rows, which is not what its metadata say")));
    }
    let (numbers, texts) = (BTreeMap::new(), BTreeMap::new());
    let schema = table.columns().to_vec();
    let mut read = ReadShard { metadata, seal, rows, schema, numbers, texts, signal: Vec::new() };
    match wanted {
        Wanted::Columns(names) => {
            for column in names.iter().filter_map(|name| table.column(name)) {
                let name = column.name.clone();
                if column.kind == FoundType::Text {
                    let texts = table.texts(column).map_err(into_io)?;
                    let texts = texts.into_iter().map(Option::unwrap_or_default);
                    read.texts.insert(name, texts.collect());
                } else {
                    read.numbers.insert(name, table.numbers(column, 0).map_err(into_io)?.values);
                }
            }
        }
        Wanted::Signal { column, row } => {
            let column = table.column(column).ok_or_else(|| io::Error::other("has no such column"))?;
            read.signal = table.list(column, row).map_err(into_io)?;
        }
    }
    Ok(read)
}
