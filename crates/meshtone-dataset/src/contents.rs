//! What shards hold: what each of them adds, and all together.

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};
use std::io;

use rayon::prelude::*;

use crate::digest::Digest;
use crate::error::DatasetError;
use crate::manifest::ReadManifest;
use crate::part_list::PartList;
use crate::plan::Plan;
use crate::shard::{BETWEEN_CODES, Column, ColumnKind, FailedRecord, ReadShard, Shards, WARNINGS, Wanted};
use crate::store::Destination;

/// Records that a preview shows at most.
const PREVIEWED: u64 = 4_000;
/// Indicators that a preview shows.
pub(crate) const INDICATORS: [&str; 4] = ["average_rms", "difference_rms", "fm4", "energy_ratio"];

/// Records by split and label.
pub(crate) type Counts = BTreeMap<(String, String), u64>;

/// Records by the code of a warning that is told of them.
pub(crate) type WarningCounts = BTreeMap<String, u64>;

/// What proves a shard's file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ShardFile {
    /// Of its bytes, taken while they were written.
    pub digest: Digest,
    /// Its records, without those that failed.
    pub rows: u64,
}

/// What a shard adds to the contents of its data set.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ShardContents {
    pub file: ShardFile,
    pub counts: Counts,
    /// Records that each warning is told of, by its code.
    pub warnings: WarningCounts,
    pub failures: Vec<FailedRecord>,
}

/// What is seen of any number of shards. Seen twice, a shard changes nothing.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Seen {
    /// Least and largest value of each column of numbers.
    pub ranges: BTreeMap<String, [f64; 2]>,
    /// Shard and row of the first record of each label.
    pub first: BTreeMap<String, (u64, usize)>,
    /// Some records, by their numbers.
    pub sampled: BTreeMap<u64, SampledRecord>,
}

/// A record of the preview.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SampledRecord {
    pub label: String,
    pub split: String,
    /// Of each of [`Looked::sampled`], NaN where it has none.
    pub values: Vec<f64>,
}

/// What is looked at in shards.
#[derive(Debug)]
pub(crate) struct Looked<'c> {
    /// Columns of one value a record.
    plain: Vec<&'c str>,
    /// Columns of which some records are sampled.
    pub sampled: Vec<&'c str>,
    /// Every so many records one is sampled.
    every: u64,
}

impl<'c> Looked<'c> {
    /// What is looked at in a plan's shards.
    pub fn new(columns: &'c [Column], shards: Shards) -> Self {
        let plain = columns.iter().filter(|column| !column.kind.is_signal());
        let sampled = columns.iter().filter(|column| is_previewed(column));
        Self {
            plain: plain.map(|column| column.name.as_str()).collect(),
            sampled: sampled.map(|column| column.name.as_str()).collect(),
            every: shards.records.div_ceil(PREVIEWED).max(1),
        }
    }

    /// What must be read of a shard for it.
    pub fn wanted(&self) -> Wanted<'_> {
        Wanted::Columns(&self.plain)
    }

    /// What a shard adds, and what is seen of it.
    ///
    /// # Arguments
    /// * `shard` - its number
    /// * `read` - the shard, with what is [wanted](Self::wanted)
    /// * `digest` - of its file
    pub fn shard(&self, shard: u64, read: ReadShard, digest: Digest) -> (ShardContents, Seen) {
        let (labels, splits) = (read.texts("label"), read.texts("split"));
        let mut seen = Seen::default();
        for (row, label) in labels.iter().enumerate() {
            seen.first.entry(label.clone()).or_insert((shard, row));
        }
        for &name in &self.plain {
            let finite = read.numbers(name).iter().filter(|value| value.is_finite());
            let range = finite.fold(None, |range, &value| {
                let [least, largest] = range.unwrap_or([value; 2]);
                Some([value.min(least), value.max(largest)])
            });
            seen.ranges.extend(range.map(|range| (name.to_owned(), range)));
        }
        for (row, &record) in read.numbers("record").iter().enumerate() {
            let record = record as u64;
            if record.is_multiple_of(self.every) {
                let value = |name: &&str| read.numbers(name).get(row).copied().unwrap_or(f64::NAN);
                let values = self.sampled.iter().map(value).collect();
                let (label, split) = (labels[row].clone(), splits[row].clone());
                seen.sampled.insert(record, SampledRecord { label, split, values });
            }
        }
        let file = ShardFile { digest, rows: read.rows };
        let (counts, warnings) = (count(&read), count_warnings(&read));
        (ShardContents { file, counts, warnings, failures: read.metadata.failures }, seen)
    }
}

/// The records of a shard by split and label.
pub(crate) fn count(read: &ReadShard) -> Counts {
    let mut counts = Counts::new();
    for (label, split) in read.texts("label").iter().zip(read.texts("split")) {
        *counts.entry((split.clone(), label.clone())).or_default() += 1;
    }
    counts
}

/// The records of a shard by the warnings that are told of them; none of a data set of an earlier format.
fn count_warnings(read: &ReadShard) -> WarningCounts {
    let mut counts = WarningCounts::new();
    for code in read.texts(WARNINGS).iter().flat_map(|codes| codes.split(BETWEEN_CODES)) {
        if !code.is_empty() {
            *counts.entry(code.to_owned()).or_default() += 1;
        }
    }
    counts
}

/// Whether a preview shows a column of numbers, unless it is the same everywhere.
fn is_previewed(column: &Column) -> bool {
    is_drawn(column)
        || matches!(&column.kind, ColumnKind::Indicator(name) if INDICATORS.contains(&name.as_str()))
}

/// Whether a column is one of what a record is drawn with.
pub(crate) fn is_drawn(column: &Column) -> bool {
    matches!(
        column.kind,
        ColumnKind::Key(_)
            | ColumnKind::PinionSpeed
            | ColumnKind::BrakeTorque
            | ColumnKind::PinionTeeth
            | ColumnKind::GearTeeth
            | ColumnKind::Severity
            | ColumnKind::Age
    )
}

impl Seen {
    /// Adds what was seen of others.
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

/// What is known of a data set's shards.
#[derive(Debug, Default)]
pub(crate) struct Contents {
    /// By the shards' numbers.
    pub files: BTreeMap<u64, ShardFile>,
    /// Of those that are counted.
    pub counts: Counts,
    /// Of those that are counted.
    pub warnings: WarningCounts,
    /// Records that failed, with the reasons.
    pub failures: BTreeMap<u64, String>,
    /// Of those that are counted.
    pub seen: Seen,
    /// Shards of which nothing is known but what proves their files.
    uncounted: BTreeSet<u64>,
    /// Shards that different files are listed of, as processors of different kinds write them.
    doubtful: BTreeMap<u64, Vec<ShardFile>>,
}

impl Contents {
    /// Adds what a place's manifest and the lists of its parts say. Returns what proves the shards of that place.
    ///
    /// # Arguments
    /// * `plan` - of the data set
    /// * `place` - where it is, or a part of it
    /// * `files` - those of the place
    /// * `manifest` - of the place
    pub fn add_place(
        &mut self,
        plan: &Plan,
        place: &Destination,
        files: &BTreeMap<String, u64>,
        manifest: Option<ReadManifest>,
    ) -> Result<BTreeMap<u64, ShardFile>, DatasetError> {
        let mut listed = BTreeMap::new();
        if let Some(manifest) = manifest {
            self.failures.extend(manifest.failures.into_iter().map(|f| (f.record, f.reason)));
            for (shard, file) in (0..).zip(&manifest.files) {
                listed.insert(shard, file.shard);
                if let Entry::Vacant(entry) = self.files.entry(shard) {
                    entry.insert(file.shard);
                    self.uncounted.insert(shard);
                }
            }
        }
        let hash = plan.hash().to_string();
        for name in PartList::names(files) {
            // Another part may have completed the data set meanwhile.
            let list = place.text(name)?.and_then(|text| PartList::parse(&text, &hash));
            if let Some(list) = list {
                listed.extend(list.shards.iter().map(|(&shard, of_shard)| (shard, of_shard.file)));
                list.shards.into_iter().for_each(|(shard, of_shard)| self.add_shard(shard, of_shard));
                self.seen.add(list.seen);
            }
        }
        Ok(listed)
    }

    fn add_shard(&mut self, shard: u64, of_shard: ShardContents) {
        let ShardContents { file, counts, warnings, failures } = of_shard;
        let is_new = match self.files.get(&shard) {
            None => true,
            Some(known) => {
                if *known != file {
                    self.doubtful.entry(shard).or_default().push(file);
                }
                self.uncounted.remove(&shard)
            }
        };
        if is_new {
            self.files.entry(shard).or_insert(file);
            counts.into_iter().for_each(|(key, count)| *self.counts.entry(key).or_default() += count);
            warnings.into_iter().for_each(|(code, count)| *self.warnings.entry(code).or_default() += count);
            self.failures.extend(failures.into_iter().map(|failed| (failed.record, failed.reason)));
        }
    }

    /// Decides which of several files a shard is.
    pub fn choose(&mut self, shard: u64, file: ShardFile) {
        self.doubtful.remove(&shard);
        self.files.insert(shard, file);
    }

    /// Decides by its bytes which of several files a doubtful shard is.
    pub fn settle(&mut self, to: &Destination, shards: Shards) -> Result<(), DatasetError> {
        for (shard, others) in std::mem::take(&mut self.doubtful) {
            let digest = to.digest(&shards.name(shard))?;
            let others = others.into_iter().find(|file| file.digest == digest);
            self.files.extend(others.map(|file| (shard, file)));
        }
        Ok(())
    }

    /// Reads the shards that are not counted yet.
    pub fn count_all(
        &mut self,
        looked: &Looked<'_>,
        shards: Shards,
        to: &Destination,
    ) -> Result<(), DatasetError> {
        let uncounted: Vec<(u64, ShardFile)> =
            self.uncounted.iter().filter_map(|shard| Some((*shard, *self.files.get(shard)?))).collect();
        // Some at a time, so that memory stays bounded.
        for some in uncounted.chunks(1024) {
            let read = some.par_iter().map(|&(shard, file)| {
                let name = shards.name(shard);
                let read =
                    to.read_shard(&name, looked.wanted()).map_err(DatasetError::read(to.name_of(&name)))?;
                Ok((shard, looked.shard(shard, read, file.digest)))
            });
            for (shard, (of_shard, seen)) in read.collect::<Result<Vec<_>, DatasetError>>()? {
                self.add_shard(shard, of_shard);
                self.seen.add(seen);
            }
        }
        Ok(())
    }

    /// (records) Without those that failed.
    pub fn rows(&self) -> u64 {
        self.files.values().map(|file| file.rows).sum()
    }

    /// What a place's shard is not, of what is known of it; none where it is.
    ///
    /// # Arguments
    /// * `shard` - its number
    /// * `size` - (bytes) of its file
    /// * `digest` - of its file, taken if it is asked for
    pub fn objection(
        &self,
        shard: u64,
        size: u64,
        digest: impl FnOnce() -> io::Result<Digest>,
    ) -> Option<String> {
        let Some(known) = self.files.get(&shard) else {
            return Some("no list of this version has its SHA-256".to_owned());
        };
        let others = self.doubtful.get(&shard).into_iter().flatten();
        let mut fitting =
            [known].into_iter().chain(others).filter(|file| file.digest.bytes == size).peekable();
        if fitting.peek().is_none() {
            return Some(wrong_size(size, known.digest.bytes));
        }
        match digest() {
            Err(error) => Some(format!("it cannot be read: {error}")),
            Ok(digest) if fitting.any(|file| file.digest == digest) => None,
            Ok(_) => Some(WRONG_BYTES.to_owned()),
        }
    }
}

/// Of a file whose SHA-256 is another one.
pub(crate) const WRONG_BYTES: &str = "its bytes are not those that were written: the SHA-256 differs";

/// Of a file of another size.
pub(crate) fn wrong_size(size: u64, expected: u64) -> String {
    format!("it has {size} bytes instead of {expected}")
}
