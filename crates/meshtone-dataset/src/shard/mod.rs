//! Shards: Parquet files of so many records each.
//!
//! Each row is a record. The key-value metadata of the file hold the plan's hash, the range of records, and the records that failed
//! with the reasons. All bytes of a shard depend only on the plan and the shard's number.

mod columns;
mod metadata;
mod write;

pub(crate) use columns::{BETWEEN_CODES, Column, Topic, WARNINGS, column_name, columns, varied_keys};
pub use metadata::{FailedRecord, ShardMetadata};
pub(crate) use metadata::{ReadShard, Wanted, read};
pub(crate) use write::{Item, write, write_table};

use crate::draw::Sampler;
use crate::plan::{MOST_SHARD_RECORDS, Plan};
use crate::record::kept_bytes;

/// (bytes) Approximate size of a shard, unless the plan says how many records it has.
const SHARD_BYTES: usize = 32 << 20;
/// Number of records from which the size is estimated.
const ESTIMATED_BY: u64 = 32;

/// The division of a plan's records into shards.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shards {
    /// Records of all shards.
    pub records: u64,
    /// Records in a shard; the last may have fewer.
    pub records_per_shard: u64,
}

impl Shards {
    /// The division of a plan.
    ///
    /// # Arguments
    /// * `plan` - the plan
    /// * `sampler` - of the same plan
    pub fn new(plan: &Plan, sampler: &Sampler) -> Self {
        let records = plan.records();
        let records_per_shard = plan.content.keep.records_per_shard.unwrap_or_else(|| {
            let bytes: Vec<usize> = (0..records.min(ESTIMATED_BY))
                .filter_map(|index| sampler.scenario(&sampler.record(index).ok()?).ok())
                .map(|scenario| kept_bytes(&plan.content, &scenario.time_grid()))
                .collect();
            let mean = bytes.iter().sum::<usize>() / bytes.len().max(1);
            let fitting = (SHARD_BYTES / mean.max(1)).max(1) as u64;
            // A power of two is a rounder number of records.
            (1 << fitting.ilog2()).clamp(1, MOST_SHARD_RECORDS)
        });
        Self { records, records_per_shard }
    }

    /// Number of shards.
    pub fn count(&self) -> u64 {
        self.records.div_ceil(self.records_per_shard)
    }

    /// Records of a shard.
    ///
    /// # Arguments
    /// * `shard` - its number
    ///
    /// ```
    /// use meshtone_dataset::shard::Shards;
    ///
    /// let shards = Shards { records: 10, records_per_shard: 4 };
    /// assert_eq!((shards.count(), shards.range(2)), (3, 8..10));
    /// ```
    pub fn range(&self, shard: u64) -> std::ops::Range<u64> {
        let start = shard.saturating_mul(self.records_per_shard).min(self.records);
        start..start.saturating_add(self.records_per_shard).min(self.records)
    }

    /// Name of a shard's file, from the data set's directory. More than a thousand of them stand in folders of a thousand each. The
    /// names sort as their numbers do.
    ///
    /// # Arguments
    /// * `shard` - its number
    ///
    /// ```
    /// use meshtone_dataset::shard::Shards;
    ///
    /// let name = |records| Shards { records, records_per_shard: 10 }.name(7);
    /// assert_eq!(name(10_000), "data/records-000007.parquet");
    /// assert_eq!(name(10_001), "data/000/records-000007.parquet");
    /// assert_eq!(name(10_000_001), "data/0000/records-0000007.parquet");
    /// ```
    pub fn name(&self, shard: u64) -> String {
        let last = self.count().saturating_sub(1);
        let digits = last.checked_ilog10().map_or(1, |log| log as usize + 1).max(LEAST_DIGITS);
        if self.is_flat() {
            return format!("{FOLDER}/{FILE}{shard:0digits$}{ENDING}");
        }
        let (folder, of_folder) = (shard / FOLDER_SHARDS, digits - FOLDER_DIGITS);
        format!("{FOLDER}/{folder:0of_folder$}/{FILE}{shard:0digits$}{ENDING}")
    }

    /// Returns whether all shards stand in one folder.
    pub fn is_flat(&self) -> bool {
        self.count() <= FOLDER_SHARDS
    }

    /// A pattern that matches the names of all shards and nothing else.
    pub fn pattern(&self) -> &'static str {
        if self.is_flat() { "data/*.parquet" } else { "data/*/*.parquet" }
    }

    /// The number of the shard of a name; none where no shard has it.
    ///
    /// # Arguments
    /// * `name` - from the data set's directory
    pub fn number(&self, name: &str) -> Option<u64> {
        let number = Self::number_of(name)?;
        (number < self.count() && self.name(number) == name).then_some(number)
    }

    /// The number in the name of a shard of some data set.
    pub(crate) fn number_of(name: &str) -> Option<u64> {
        number_in(name)?.parse().ok()
    }

    /// Returns whether a shard of some data set may have a name.
    pub(crate) fn is_name(name: &str) -> bool {
        name.starts_with(FOLDER) && number_in(name).is_some()
    }
}

/// The digits in a shard's name.
fn number_in(name: &str) -> Option<&str> {
    let (_, file) = name.rsplit_once('/')?;
    let number = file.strip_prefix(FILE)?.strip_suffix(ENDING)?;
    (!number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit())).then_some(number)
}

/// Shards in a folder at most, unless they are all in one.
const FOLDER_SHARDS: u64 = 1000;
/// Their digits.
const FOLDER_DIGITS: usize = 3;
/// Digits of a shard's number in its name.
const LEAST_DIGITS: usize = 6;
const FILE: &str = "records-";
const ENDING: &str = ".parquet";
/// Folder of the shards.
pub(crate) const FOLDER: &str = "data";
