//! The contents of shards: what one shard contributes to its data set, and the sum over all shards.

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};

use meshtone::scenario::WarningKind;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::digest::Digest;
use crate::error::DatasetError;
use crate::manifest::ReadManifest;
use crate::part_list::PartList;
use crate::plan::Plan;
use crate::shard::{BETWEEN_CODES, Column, FailedRecord, ReadShard, Shards, WARNINGS, Wanted};
use crate::store::{Destination, Files};

/// Largest number of records that a preview shows.
const PREVIEWED: u64 = 4_000;
/// Shards that are read before their contents are added up, so that memory stays bounded.
pub(crate) const SHARDS_AT_A_TIME: usize = 1024;

/// Number of records by split, and in each split by label.
pub(crate) type Counts = BTreeMap<String, BTreeMap<String, u64>>;

/// Number of records by the kind of a warning.
pub(crate) type WarningCounts = BTreeMap<WarningKind, u64>;

/// The digest and the number of records that the file of a shard must have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct ShardFile {
    /// Digest of the file's bytes, computed while they were written.
    #[serde(flatten)]
    pub digest: Digest,
    /// Number of the shard's records, without those that failed.
    pub rows: u64,
}

/// The contribution of a shard to the contents of its data set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct ShardContents {
    #[serde(flatten)]
    pub file: ShardFile,
    pub counts: Counts,
    /// Lists of manifests before format 3 have no warnings.
    #[serde(default)]
    pub warnings: WarningCounts,
    pub failures: Vec<FailedRecord>,
}

/// A summary of the values of any number of shards. Adding the same shard twice changes nothing.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Summary {
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

    /// The values of a shard that its summary needs.
    pub fn wanted(&self) -> Wanted<'_> {
        Wanted::Columns(&self.plain)
    }

    /// The contents and the summary of a shard.
    ///
    /// # Arguments
    /// * `shard` - number of the shard
    /// * `read` - the shard, with the values that are [wanted](Self::wanted)
    /// * `digest` - digest of its file
    pub fn summarize(&self, shard: u64, read: ReadShard, digest: Digest) -> (ShardContents, Summary) {
        let (labels, splits) = (read.texts("label"), read.texts("split"));
        let mut summary = Summary::default();
        for (row, label) in labels.iter().enumerate() {
            summary.first.entry(label.clone()).or_insert((shard, row));
        }
        for &name in &self.plain {
            let finite = read.numbers(name).iter().copied().filter(|value| value.is_finite());
            let range = finite.map(|value| [value; 2]).reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]);
            summary.ranges.extend(range.map(|range| (name.to_owned(), range)));
        }
        for (row, &record) in read.numbers("record").iter().enumerate() {
            let record = record as u64;
            if record.is_multiple_of(self.every) {
                let value = |name: &&str| read.numbers(name).get(row).copied().unwrap_or(f64::NAN);
                let values = self.sampled.iter().map(value).collect();
                let (label, split) = (labels[row].clone(), splits[row].clone());
                summary.sampled.insert(record, SampledRecord { label, split, values });
            }
        }
        let mut warnings = WarningCounts::new();
        let codes = read.texts(WARNINGS).iter().flat_map(|codes| codes.split(BETWEEN_CODES));
        for kind in codes.filter_map(WarningKind::of_code) {
            *warnings.entry(kind).or_default() += 1;
        }
        let file = ShardFile { digest, rows: read.rows };
        let counts = count(&read);
        (ShardContents { file, counts, warnings, failures: read.metadata.failures }, summary)
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

/// Adds counts to a sum.
pub(crate) fn add_counts(sum: &mut Counts, counts: Counts) {
    for (split, labels) in counts {
        let of_split = sum.entry(split).or_default();
        labels.into_iter().for_each(|(label, count)| *of_split.entry(label).or_default() += count);
    }
}

impl Summary {
    /// Adds the summary of other shards.
    pub fn add(&mut self, other: Self) {
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
}

/// Adds numbers of records by the kinds of their warnings.
pub(crate) fn add_warnings(sum: &mut WarningCounts, warnings: WarningCounts) {
    warnings.into_iter().for_each(|(kind, count)| *sum.entry(kind).or_default() += count);
}

/// Everything that is known about the shards of a data set.
#[derive(Debug, Default)]
pub(crate) struct Contents {
    /// The digests and record counts that the shards' files must have, by the shards' numbers.
    pub files: BTreeMap<u64, ShardFile>,
    /// Counts of all shards that are not in `uncounted`.
    pub counts: Counts,
    /// Warnings of the same shards.
    pub warnings: WarningCounts,
    /// Records that failed, by their numbers.
    pub failures: BTreeMap<u64, FailedRecord>,
    /// Summary of the same shards.
    pub summary: Summary,
    /// Shards of which nothing is known but their entries in `files`.
    uncounted: BTreeSet<u64>,
    /// Other files that are listed of a shard: processors of different kinds write different bytes.
    conflicting: BTreeMap<u64, Vec<ShardFile>>,
}

impl Contents {
    /// Adds what the manifest of a place and the lists of its parts say. Returns the files that they list for the shards of that
    /// place.
    ///
    /// # Arguments
    /// * `plan` - plan of the data set
    /// * `place` - where the data set is, or a part of it
    /// * `files` - the files of the place
    /// * `manifest` - the manifest of the place
    pub fn add_place(
        &mut self,
        plan: &Plan,
        place: &Destination,
        files: &Files,
        manifest: Option<ReadManifest>,
    ) -> Result<BTreeMap<u64, ShardFile>, DatasetError> {
        let mut listed = BTreeMap::new();
        if let Some(manifest) = manifest {
            self.add_failures(manifest.failures);
            for (shard, file) in (0..).zip(&manifest.files) {
                listed.insert(shard, file.shard);
                if let Entry::Vacant(entry) = self.files.entry(shard) {
                    entry.insert(file.shard);
                    self.uncounted.insert(shard);
                }
            }
        }
        let hash = plan.hash();
        for name in PartList::names(files) {
            // Another part may have completed the data set meanwhile.
            if let Some(list) = PartList::read(place, name, hash)? {
                listed.extend(list.shards.iter().map(|(&shard, contents)| (shard, contents.file)));
                list.shards.into_iter().for_each(|(shard, contents)| self.add_shard(shard, contents));
                self.summary.add(list.summary);
            }
        }
        Ok(listed)
    }

    fn add_failures(&mut self, failures: Vec<FailedRecord>) {
        self.failures.extend(failures.into_iter().map(|failed| (failed.record, failed)));
    }

    fn add_shard(&mut self, shard: u64, contents: ShardContents) {
        let ShardContents { file, counts, warnings, failures } = contents;
        let known = *self.files.entry(shard).or_insert_with(|| {
            self.uncounted.insert(shard);
            file
        });
        if known != file {
            self.conflicting.entry(shard).or_default().push(file);
        }
        if self.uncounted.remove(&shard) {
            add_counts(&mut self.counts, counts);
            add_warnings(&mut self.warnings, warnings);
            self.add_failures(failures);
        }
    }

    /// Decides which of several files a shard is.
    pub fn choose(&mut self, shard: u64, file: ShardFile) {
        self.conflicting.remove(&shard);
        self.files.insert(shard, file);
    }

    /// Decides by its bytes which of several listed files each shard is.
    pub fn resolve_conflicts(&mut self, to: &Destination, shards: &Shards) -> Result<(), DatasetError> {
        for (shard, others) in std::mem::take(&mut self.conflicting) {
            let digest = to.digest(&shards.name(shard))?;
            let others = others.into_iter().find(|file| file.digest == digest);
            self.files.extend(others.map(|file| (shard, file)));
        }
        Ok(())
    }

    /// Reads the shards that are not counted yet.
    pub fn count_all(
        &mut self,
        columns: &SummaryColumns<'_>,
        shards: &Shards,
        to: &Destination,
    ) -> Result<(), DatasetError> {
        let uncounted: Vec<u64> = self.uncounted.iter().copied().collect();
        for some in uncounted.chunks(SHARDS_AT_A_TIME) {
            let read = some.par_iter().map(|&shard| {
                let name = shards.name(shard);
                let read = to.read_shard(&name, columns.wanted());
                let read = read.map_err(DatasetError::read(to.name_of(&name)))?;
                Ok((shard, columns.summarize(shard, read, self.files[&shard].digest)))
            });
            for (shard, (contents, summary)) in read.collect::<Result<Vec<_>, DatasetError>>()? {
                self.add_shard(shard, contents);
                self.summary.add(summary);
            }
        }
        Ok(())
    }

    /// Number of records, without those that failed.
    pub fn rows(&self) -> u64 {
        self.files.values().map(|file| file.rows).sum()
    }

    /// Says why the file of a shard is not the one that is listed; none where it is.
    ///
    /// # Arguments
    /// * `shard` - number of the shard
    /// * `size` - (bytes) size of its file
    /// * `digest` - computes the digest of its file
    pub fn objection(
        &self,
        shard: u64,
        size: u64,
        digest: impl FnOnce() -> Result<Digest, DatasetError>,
    ) -> Option<String> {
        let Some(known) = self.files.get(&shard) else {
            return Some("no list of this version has its SHA-256".to_owned());
        };
        let others = self.conflicting.get(&shard).into_iter().flatten();
        let listed: Vec<Digest> = [known].into_iter().chain(others).map(|file| file.digest).collect();
        if listed.iter().all(|listed| listed.bytes != size) {
            return Some(wrong_size(size, known.digest.bytes));
        }
        match digest() {
            Err(error) => Some(format!("it cannot be read: {error}")),
            Ok(digest) => (!listed.contains(&digest)).then(|| WRONG_BYTES.to_owned()),
        }
    }
}

/// The problem of a file whose SHA-256 differs, in words.
pub(crate) const WRONG_BYTES: &str = "its bytes are not those that were written: the SHA-256 differs";

/// Says that a file has another size than the expected one.
pub(crate) fn wrong_size(size: u64, expected: u64) -> String {
    format!("it has {size} bytes instead of {expected}")
}
