//! The contents of shards: what one shard contributes to its data set, and the sum over all shards.

use std::collections::BTreeMap;

use meshtone::scenario::WarningKind;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::error::DatasetError;
use crate::plan::Plan;
use crate::shard::{BETWEEN_CODES, Column, FailedRecord, ReadShard, Shards, WARNINGS, Wanted};
use crate::store::{Destination, Files};

/// Largest number of records that a preview shows.
const PREVIEWED: u64 = 4_000;
/// Shards that are read before their contents are added up, so that memory stays bounded.
pub(crate) const SHARDS_AT_A_TIME: u64 = 1024;

/// Number of records by split, and in each split by label.
pub(crate) type Counts = BTreeMap<String, BTreeMap<String, u64>>;

/// Number of records by the kind of a warning.
pub(crate) type WarningCounts = BTreeMap<WarningKind, u64>;

/// The file of a shard, as a manifest lists it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct ShardFile {
    /// (bytes) Size.
    pub bytes: u64,
    /// The seal in its footer.
    pub seal: String,
    /// Number of the shard's records, without those that failed.
    pub rows: u64,
}

/// Everything that is known about some shards of a data set, or about one.
#[derive(Debug, Default)]
pub(crate) struct Contents {
    /// The files by the shards' numbers.
    pub files: BTreeMap<u64, ShardFile>,
    pub counts: Counts,
    pub warnings: WarningCounts,
    /// Records that failed, by their numbers.
    pub failures: BTreeMap<u64, FailedRecord>,
    /// Least and largest value of each column of numbers.
    pub ranges: BTreeMap<String, [f64; 2]>,
    /// Shard and row of the first record of each label.
    pub first: BTreeMap<String, (u64, usize)>,
    /// The records that the preview shows, by their numbers.
    pub sampled: BTreeMap<u64, SampledRecord>,
}

/// A record that the preview shows.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SampledRecord {
    pub label: String,
    pub split: String,
    /// Values of the columns [`SummaryColumns::sampled`]; NaN where the record has no value.
    pub values: Vec<f64>,
}

/// The columns that shards are summarised by.
#[derive(Debug)]
pub(crate) struct SummaryColumns<'c> {
    /// Columns of one value a record.
    plain: Vec<&'c str>,
    /// Columns that the preview shows.
    pub sampled: Vec<&'c str>,
    /// One record of so many is sampled.
    every: u64,
}

impl<'c> SummaryColumns<'c> {
    /// Selects them from the columns of a plan.
    pub fn new(columns: &'c [Column], shards: &Shards) -> Self {
        let named = |wanted: fn(&Column) -> bool| {
            columns.iter().filter(|column| wanted(column)).map(|column| column.name.as_str()).collect()
        };
        Self {
            plain: named(|column| !column.is_signal()),
            sampled: named(Column::is_previewed),
            every: shards.all_records().div_ceil(PREVIEWED).max(1),
        }
    }

    /// The contents of a shard whose plain columns were read.
    fn of_shard(&self, shard: u64, bytes: u64, read: ReadShard) -> Contents {
        let (labels, splits) = (read.texts("label"), read.texts("split"));
        let mut contents =
            Contents { counts: count(&read), warnings: warnings(&read), ..Contents::default() };
        contents.files.insert(shard, ShardFile { bytes, seal: read.seal.clone(), rows: read.rows });
        for (row, label) in labels.iter().enumerate() {
            contents.first.entry(label.clone()).or_insert((shard, row));
        }
        for &name in &self.plain {
            let finite = read.numbers(name).iter().copied().filter(|value| value.is_finite());
            let range = finite.map(|value| [value; 2]).reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]);
            contents.ranges.extend(range.map(|range| (name.to_owned(), range)));
        }
        for (row, &record) in read.numbers("record").iter().enumerate() {
            let record = record as u64;
            if record.is_multiple_of(self.every) {
                let value = |name: &&str| read.numbers(name).get(row).copied().unwrap_or(f64::NAN);
                let values = self.sampled.iter().map(value).collect();
                let (label, split) = (labels[row].clone(), splits[row].clone());
                contents.sampled.insert(record, SampledRecord { label, split, values });
            }
        }
        let failures = read.metadata.failures.into_iter();
        contents.failures.extend(failures.map(|failed| (failed.record, failed)));
        contents
    }
}

/// The number of a shard's records by split and label.
pub(crate) fn count(read: &ReadShard) -> Counts {
    let mut counts = Counts::new();
    for (label, split) in read.texts("label").iter().zip(read.texts("split")) {
        *counts.entry(split.clone()).or_default().entry(label.clone()).or_default() += 1;
    }
    counts
}

/// The number of a shard's records by the kinds of their warnings.
pub(crate) fn warnings(read: &ReadShard) -> WarningCounts {
    let mut warnings = WarningCounts::new();
    let codes = read.texts(WARNINGS).iter().flat_map(|codes| codes.split(BETWEEN_CODES));
    for kind in codes.filter_map(WarningKind::of_code) {
        *warnings.entry(kind).or_default() += 1;
    }
    warnings
}

/// Adds counts to a sum.
pub(crate) fn add_counts(sum: &mut Counts, counts: Counts) {
    for (split, labels) in counts {
        let of_split = sum.entry(split).or_default();
        labels.into_iter().for_each(|(label, count)| *of_split.entry(label).or_default() += count);
    }
}

/// Adds numbers of records by the kinds of their warnings.
pub(crate) fn add_warnings(sum: &mut WarningCounts, warnings: WarningCounts) {
    warnings.into_iter().for_each(|(kind, count)| *sum.entry(kind).or_default() += count);
}

impl Contents {
    /// Reads the footers and the values of all shards of a data set.
    ///
    /// # Arguments
    /// * `plan`, `columns`, `shards` - of the data set
    /// * `to` - where it is
    /// * `files` - the files there
    ///
    /// # Errors
    /// A shard cannot be read, or is another one than its name says.
    pub fn scan(
        plan: &Plan,
        columns: &SummaryColumns<'_>,
        shards: &Shards,
        to: &Destination,
        files: &Files,
    ) -> Result<Self, DatasetError> {
        let of_shard = |shard: u64| {
            let name = shards.name(shard);
            let read = to.read_shard(&name, Wanted::Columns(&columns.plain));
            let read = read.map_err(DatasetError::read(to.name_of(&name)))?;
            if !read.metadata.is_of(&shards.metadata(plan.hash(), shard)) {
                let help = "remove it and run the command that made the data set: it makes the shard again";
                return Err(DatasetError::refused(format!("{} {OTHER_SHARD}", to.name_of(&name)), help));
            }
            Ok(columns.of_shard(shard, files.get(&name).copied().unwrap_or(0), read))
        };
        let mut contents = Self::default();
        for first in (0..shards.count()).step_by(SHARDS_AT_A_TIME as usize) {
            let some = first..(first + SHARDS_AT_A_TIME).min(shards.count());
            let read = some.into_par_iter().map(of_shard).collect::<Result<Vec<_>, DatasetError>>()?;
            read.into_iter().for_each(|of_shard| contents.add(of_shard));
        }
        Ok(contents)
    }

    /// Adds the contents of other shards.
    fn add(&mut self, other: Self) {
        self.files.extend(other.files);
        add_counts(&mut self.counts, other.counts);
        add_warnings(&mut self.warnings, other.warnings);
        self.failures.extend(other.failures);
        for (name, [least, largest]) in other.ranges {
            let range = self.ranges.entry(name).or_insert([least, largest]);
            *range = [range[0].min(least), range[1].max(largest)];
        }
        for (label, place) in other.first {
            let first = self.first.entry(label).or_insert(place);
            *first = place.min(*first);
        }
        self.sampled.extend(other.sampled);
    }

    /// Number of records, without those that failed.
    pub fn rows(&self) -> u64 {
        self.files.values().map(|file| file.rows).sum()
    }
}

/// The problem of a file whose bytes are not those that were written, in words.
pub(crate) const WRONG_BYTES: &str = "its bytes are not those that were written: the SHA-256 differs";

/// The problem of a shard under the name of another one.
pub(crate) const OTHER_SHARD: &str = "is of another plan, or another shard of it";
