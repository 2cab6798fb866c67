//! What a shard says about itself.

use std::io;

use arrow::array::RecordBatch;
use parquet::arrow::ProjectionMask;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use parquet::file::metadata::KeyValue;
use parquet::file::reader::ChunkReader;
use serde_json::{Value, json};

use crate::plan::PlanHash;

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
    pub(super) fn key_values(&self) -> Vec<KeyValue> {
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
        .map(|(key, value)| KeyValue::new(key.to_owned(), value))
        .to_vec()
    }

    fn from_key_values(values: &[KeyValue]) -> Option<Self> {
        let text = |key: &str| values.iter().find(|value| value.key == key)?.value.clone();
        let first: u64 = text(FIRST)?.parse().ok()?;
        let count: u64 = text(RECORDS)?.parse().ok()?;
        let failures: Value = serde_json::from_str(&text(FAILURES)?).ok()?;
        let failed = |value: &Value| {
            Some(FailedRecord {
                record: value["record"].as_u64()?,
                reason: value["reason"].as_str()?.to_owned(),
            })
        };
        Some(Self {
            plan: text(PLAN)?,
            records: first..first.checked_add(count)?,
            failures: failures.as_array()?.iter().map(failed).collect::<Option<_>>()?,
        })
    }

    /// Whether it is the shard of a plan and a range.
    ///
    /// # Arguments
    /// * `plan` - hash of the plan
    /// * `records` - the range
    pub fn is_of(&self, plan: &PlanHash, records: &std::ops::Range<u64>) -> bool {
        self.plan == plan.to_string() && self.records == *records
    }
}

/// A shard that was read, without its signals.
pub(crate) struct ReadShard {
    pub metadata: ShardMetadata,
    pub rows: u64,
    pub batches: Vec<RecordBatch>,
}

/// What is read of a shard besides what it says about itself.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Wanted<'n> {
    /// Names of columns.
    pub columns: &'n [&'n str],
    /// The row that is read; all where there is none. The signals of a whole shard may be large.
    pub row: Option<usize>,
}

impl<'n> Wanted<'n> {
    /// No values.
    pub const NOTHING: Wanted<'static> = Wanted { columns: &[], row: None };

    /// All rows of some columns.
    pub fn columns(columns: &'n [&'n str]) -> Self {
        Self { columns, row: None }
    }
}

/// Reads what a shard says about itself, and some of its values.
///
/// # Arguments
/// * `file` - the shard
/// * `wanted` - the values
pub(crate) fn read(file: impl ChunkReader + 'static, wanted: Wanted) -> io::Result<ReadShard> {
    let builder = ParquetRecordBatchReaderBuilder::try_new(file).map_err(io::Error::other)?;
    let head = builder.metadata().file_metadata();
    let metadata = head.key_value_metadata().and_then(|values| ShardMetadata::from_key_values(values));
    let metadata = metadata.ok_or_else(|| io::Error::other("is no shard of a data set"))?;
    let rows = u64::try_from(head.num_rows()).unwrap_or(0);
    let expected =
        (metadata.records.end - metadata.records.start).checked_sub(metadata.failures.len() as u64);
    if expected != Some(rows) {
        return Err(io::Error::other(format!("has {rows} rows, which is not what its metadata say")));
    }
    if wanted.columns.is_empty() {
        return Ok(ReadShard { metadata, rows, batches: Vec::new() });
    }
    let mask = ProjectionMask::columns(builder.parquet_schema(), wanted.columns.iter().copied());
    let builder = builder.with_projection(mask);
    let builder = match wanted.row {
        Some(row) => builder.with_offset(row).with_limit(1),
        None => builder,
    };
    let reader = builder.build().map_err(io::Error::other)?;
    let batches = reader.collect::<Result<_, _>>().map_err(io::Error::other)?;
    Ok(ReadShard { metadata, rows, batches })
}
