//! Shards: Parquet files of so many records each.
//!
//! One row a record. What belongs to the shard stands in the file's key-value metadata: the plan's hash, the range of
//! records, and those that failed, with their reasons. A shard depends on the plan and its number alone, byte by byte.

mod columns;
mod metadata;
mod rows;
mod write;

pub(crate) use columns::column_name;
pub use columns::{Column, ColumnKind, columns};
pub use metadata::{FailedRecord, ShardMetadata};
pub(crate) use metadata::{ReadShard, Wanted, read};
pub(crate) use write::{Item, write};

use crate::draw::Sampler;
use crate::plan::{MOST_SHARD_RECORDS, Plan};
use crate::record::kept_bytes;

/// (bytes) About how large a shard is, unless the plan says how many records it has.
const SHARD_BYTES: usize = 32 << 20;
/// Records by which the size is estimated.
const ESTIMATED_BY: u64 = 32;

/// How a plan's records are divided into shards.
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
            // A power of two: round numbers of records are easier to think of.
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

    /// Name of a shard's file, from the data set's directory.
    ///
    /// # Arguments
    /// * `shard` - its number
    pub fn name(shard: u64) -> String {
        format!("{FOLDER}/records-{shard:06}.parquet")
    }
}

/// Folder of the shards.
pub(crate) const FOLDER: &str = "data";
