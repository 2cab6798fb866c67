//! What a shard says about itself.

use std::collections::BTreeMap;
use std::io;

use meshtone_io::table::{FoundColumn, FoundType, TableReader, into_io};
use parquet::file::metadata::KeyValue;
use parquet::file::reader::ChunkReader;
use serde_json::{Value, json};

const PLAN: &str = "meshtone.plan_sha256";
const VERSION: &str = "meshtone.version";
const FIRST: &str = "meshtone.first_record";
const RECORDS: &str = "meshtone.records";
const FAILURES: &str = "meshtone.failures";

/// A record that could not be made.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FailedRecord {
    /// Its number.
    pub record: u64,
    /// Why.
    pub reason: String,
}

impl FailedRecord {
    /// Reads one as manifests and shards have it.
    pub(crate) fn from_json(value: &Value) -> Option<Self> {
        Some(Self { record: value["record"].as_u64()?, reason: value["reason"].as_str()?.to_owned() })
    }
}

/// What a shard says about itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ShardMetadata {
    /// Hash of the plan.
    pub plan: String,
    /// Its records, those that failed included.
    pub records: std::ops::Range<u64>,
    /// Those that failed.
    pub failures: Vec<FailedRecord>,
}

impl ShardMetadata {
    pub(super) fn key_values(&self) -> Vec<(String, String)> {
        let failures: Vec<Value> = self
            .failures
            .iter()
            .map(|failed| json!({ "record": failed.record, "reason": failed.reason }))
            .collect();
        [
            (PLAN, self.plan.clone()),
            (VERSION, env!("CARGO_PKG_VERSION").to_owned()),
            (FIRST, self.records.start.to_string()),
            (RECORDS, (self.records.end - self.records.start).to_string()),
            (FAILURES, Value::from(failures).to_string()),
        ]
        .map(|(key, value)| (key.to_owned(), value))
        .to_vec()
    }

    fn from_key_values(values: &[KeyValue]) -> Option<Self> {
        let text = |key: &str| values.iter().find(|value| value.key == key)?.value.clone();
        let first: u64 = text(FIRST)?.parse().ok()?;
        let count: u64 = text(RECORDS)?.parse().ok()?;
        let failures: Value = serde_json::from_str(&text(FAILURES)?).ok()?;
        Some(Self {
            plan: text(PLAN)?,
            records: first..first.checked_add(count)?,
            failures: failures.as_array()?.iter().map(FailedRecord::from_json).collect::<Option<_>>()?,
        })
    }
}

/// What was read of a shard.
pub(crate) struct ReadShard {
    pub metadata: ShardMetadata,
    pub rows: u64,
    /// Its columns.
    pub schema: Vec<FoundColumn>,
    numbers: BTreeMap<String, Vec<f64>>,
    texts: BTreeMap<String, Vec<String>>,
    /// The signal of one row.
    pub signal: Vec<f32>,
}

impl ReadShard {
    /// A column of numbers, NaN where a cell is empty; nothing where no such column was read.
    pub fn numbers(&self, name: &str) -> &[f64] {
        self.numbers.get(name).map_or(&[], Vec::as_slice)
    }

    /// A column of text; nothing where no such column was read.
    pub fn texts(&self, name: &str) -> &[String] {
        self.texts.get(name).map_or(&[], Vec::as_slice)
    }
}

/// What is read of a shard besides what it says about itself.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Wanted<'n> {
    /// No values.
    Nothing,
    /// Columns of numbers and text, those of them that there are.
    Columns(&'n [&'n str]),
    /// The signal of one row; those of a whole shard may be large.
    Signal {
        /// Name of the column.
        column: &'n str,
        /// The row.
        row: usize,
    },
}

/// Reads what a shard says about itself, and some of its values.
///
/// # Arguments
/// * `file` - the shard
/// * `wanted` - the values
pub(crate) fn read(file: impl ChunkReader + 'static, wanted: Wanted) -> io::Result<ReadShard> {
    let table = TableReader::new(file).map_err(into_io)?;
    let head = table.metadata().file_metadata();
    let metadata = head.key_value_metadata().and_then(|values| ShardMetadata::from_key_values(values));
    let metadata = metadata.ok_or_else(|| io::Error::other("is no shard of a data set"))?;
    let rows = u64::try_from(head.num_rows()).unwrap_or(0);
    let expected =
        (metadata.records.end - metadata.records.start).checked_sub(metadata.failures.len() as u64);
    if expected != Some(rows) {
        return Err(io::Error::other(format!("has {rows} rows, which is not what its metadata say")));
    }
    let (numbers, texts) = (BTreeMap::new(), BTreeMap::new());
    let schema = table.columns().to_vec();
    let mut read = ReadShard { metadata, rows, schema, numbers, texts, signal: Vec::new() };
    match wanted {
        Wanted::Nothing => {}
        Wanted::Columns(names) => {
            for column in names.iter().filter_map(|name| table.column(name)) {
                let name = column.name.clone();
                if column.kind == FoundType::Text {
                    let texts = table.texts(column).map_err(into_io)?;
                    read.texts.insert(name, texts.into_iter().flatten().collect());
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
