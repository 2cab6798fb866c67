//! Shards: Parquet files of so many records each.
//!
//! Each row is a record. The key-value metadata of the file hold the plan's hash, the range of records, the records that failed
//! with the reasons, and a seal of the whole file. All bytes of a shard depend only on the plan and the shard's number.

mod columns;
mod metadata;
mod seal;
mod write;

pub(crate) use columns::{BETWEEN_CODES, Column, Topic, WARNINGS, column_name, columns, varied_keys};
pub use metadata::{FailedRecord, ShardMetadata};
pub(crate) use metadata::{ReadShard, Wanted, read};
pub(crate) use seal::{proven, seal};
pub(crate) use write::{Item, write, write_table};

use crate::draw::Sampler;
use crate::plan::{MOST_SHARD_RECORDS, Plan};
use crate::record::{kept_bytes, simulated_scenario};

/// (bytes) Size of a shard at most, approximately, unless the plan says how many records it has.
const SHARD_BYTES: f64 = (32 << 20) as f64;
/// (s) Time in which one core of a processor makes a shard at most, approximately, likewise: what is lost when a run is killed.
const SHARD_S: f64 = 30.0;
/// (s) Time that a core takes for one simulated sample of a pair, with all that is computed of the record (2026-11).
const PAIR_SAMPLE_S: f64 = 1e-7;
/// (s) Likewise of a gearbox of three shafts.
const GEARBOX_SAMPLE_S: f64 = 1e-6;
/// Number of records from which size and time are estimated.
const ESTIMATED_BY: u64 = 32;

/// The division of a plan's records into shards. A shard has records of one split only, in the order of their numbers, so that programs
/// find the splits by the names of the files.
#[derive(Debug, Clone)]
pub struct Shards<'a> {
    sampler: &'a Sampler<'a>,
    /// Records in a shard; the last one of each split may have fewer.
    pub records_per_shard: u64,
    /// All shards by their numbers: those of the first split, then those of the next.
    all: Vec<Shard>,
}

/// The records of one shard.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Shard {
    /// Number of the split.
    split: usize,
    /// Number of the first record.
    first: u64,
    /// Number of records, with those that fail.
    records: u64,
}

impl<'a> Shards<'a> {
    /// The division of a plan.
    ///
    /// # Arguments
    /// * `plan` - the plan
    /// * `sampler` - of the same plan
    pub fn new(plan: &Plan, sampler: &'a Sampler<'a>) -> Self {
        let records = plan.records();
        let records_per_shard = plan.content.keep.records_per_shard.unwrap_or_else(|| {
            // Parts of a shard that records are, by their size and by their time.
            let parts: Vec<f64> = (0..records.min(ESTIMATED_BY))
                .filter_map(|index| {
                    let record = sampler.record(index).ok()?;
                    let scenario = sampler.scenario(&record).ok()?;
                    let bytes = kept_bytes(&plan.content, &scenario.time_grid()) as f64;
                    let (simulated, _) = simulated_scenario(&plan.content.keep, &record, scenario).ok()?;
                    let time = simulated.time_grid();
                    let samples = (time.samples - time.first_simulated_sample) as f64;
                    let sample_s = if simulated.rig().is_some() { PAIR_SAMPLE_S } else { GEARBOX_SAMPLE_S };
                    Some((bytes / SHARD_BYTES).max(samples * sample_s / SHARD_S))
                })
                .collect();
            // A plan whose first records cannot be drawn is not divided into files of one record.
            let fitting = match parts.len() {
                0 => f64::INFINITY,
                count => count as f64 / parts.iter().sum::<f64>(),
            };
            // A power of two is a rounder number of records.
            (1 << (fitting.max(1.0) as u64).ilog2()).min(MOST_SHARD_RECORDS)
        });
        let mut of_splits = vec![Vec::<Shard>::new(); plan.content.splits.names().len()];
        for record in 0..records {
            let split = sampler.split(record);
            match of_splits[split].last_mut() {
                Some(last) if last.records < records_per_shard => last.records += 1,
                _ => of_splits[split].push(Shard { split, first: record, records: 1 }),
            }
        }
        Self { sampler, records_per_shard, all: of_splits.concat() }
    }

    /// Number of shards.
    pub fn count(&self) -> u64 {
        self.all.len() as u64
    }

    /// Number of records of all shards.
    pub fn all_records(&self) -> u64 {
        self.sampler.records()
    }

    /// Number of records of a shard, with those that fail.
    ///
    /// # Arguments
    /// * `shard` - its number
    pub fn len(&self, shard: u64) -> u64 {
        self.all[shard as usize].records
    }

    /// The metadata of a shard before its records are made.
    ///
    /// # Arguments
    /// * `plan` - hash of the plan
    /// * `shard` - its number
    pub(crate) fn metadata(&self, plan: &str, shard: u64) -> ShardMetadata {
        let Shard { first, records, .. } = self.all[shard as usize];
        ShardMetadata { plan: plan.to_owned(), first, records, failures: Vec::new() }
    }

    /// Numbers of the records of a shard.
    ///
    /// # Arguments
    /// * `shard` - its number
    pub fn records(&self, shard: u64) -> impl Iterator<Item = u64> {
        let Shard { split, first, records } = self.all[shard as usize];
        let of_split = (first..self.all_records()).filter(move |&record| self.sampler.split(record) == split);
        of_split.take(records as usize)
    }

    /// Name of a shard's file, from the data set's directory, such as `data/train-000007.parquet`. More than a thousand of them stand in
    /// folders of a thousand each, `data/000/train-000007.parquet`.
    ///
    /// # Arguments
    /// * `shard` - its number
    pub fn name(&self, shard: u64) -> String {
        let digits = self.digits();
        let file =
            format!("{}-{shard:0digits$}{ENDING}", self.sampler.split_name(self.all[shard as usize].split));
        if self.is_flat() {
            return format!("{FOLDER}/{file}");
        }
        let (folder, of_folder) = (shard / FOLDER_SHARDS, digits - FOLDER_DIGITS);
        format!("{FOLDER}/{folder:0of_folder$}/{file}")
    }

    /// Number of digits of a shard's number in its name.
    fn digits(&self) -> usize {
        ((self.count() - 1).max(1).ilog10() as usize + 1).max(LEAST_DIGITS)
    }

    /// Returns whether all shards stand in one folder.
    fn is_flat(&self) -> bool {
        self.count() <= FOLDER_SHARDS
    }

    /// A pattern that matches the names of the shards of a split and nothing else.
    ///
    /// # Arguments
    /// * `split` - name of the split, or `*` for all shards
    pub fn pattern(&self, split: &str) -> String {
        let folder = if self.is_flat() { "" } else { "*/" };
        // All digits are listed, because the name of another split may be `test-2` beside `test`.
        let number = if split == "*" { String::new() } else { format!("-{}", "[0-9]".repeat(self.digits())) };
        format!("{FOLDER}/{folder}{split}{number}{ENDING}")
    }

    /// The number of the shard of a name; none where no shard has it.
    ///
    /// # Arguments
    /// * `name` - from the data set's directory
    pub fn number(&self, name: &str) -> Option<u64> {
        let number = number_in(name)?.parse().ok()?;
        (number < self.count() && self.name(number) == name).then_some(number)
    }

    /// Returns whether a shard of some data set may have a name.
    pub(crate) fn is_name(name: &str) -> bool {
        name.starts_with(FOLDER) && number_in(name).is_some()
    }
}

/// The digits in a shard's name.
fn number_in(name: &str) -> Option<&str> {
    let (_, number) = name.strip_suffix(ENDING)?.rsplit_once('-')?;
    (!number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit())).then_some(number)
}

/// Shards in a folder at most, unless they are all in one.
const FOLDER_SHARDS: u64 = 1000;
/// Their digits.
const FOLDER_DIGITS: usize = 3;
/// Digits of a shard's number in its name.
const LEAST_DIGITS: usize = 6;
const ENDING: &str = ".parquet";
/// Folder of the shards.
pub(crate) const FOLDER: &str = "data";
