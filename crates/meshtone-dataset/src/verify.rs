//! Verifying that the files of a data set are as they were written.

use std::collections::BTreeMap;

use meshtone_io::table::FoundColumn;
use rayon::prelude::*;

use crate::contents::{Counts, SHARDS_AT_A_TIME, ShardFile, WRONG_BYTES, add_counts, count};
use crate::error::DatasetError;
use crate::manifest::{self, CARD, Document, MANIFEST, PREVIEW, ReadManifest};
use crate::shard::{FOLDER, ReadShard, Shards};
use crate::store::{Destination, Files};
use crate::words::counted;

/// Shards by the names of their files.
type ListedFiles = BTreeMap<String, ShardFile>;

/// The thoroughness with which files are checked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Check {
    /// Names, sizes, counts and the metadata of shards are compared.
    Sizes,
    /// Every byte is compared, by the SHA-256 of each file.
    Bytes,
}

/// The result of verifying a data set.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Verified {
    /// Whether the manifest calls the data set complete.
    pub complete: bool,
    /// Names of the shards that are listed and there.
    pub shards: Vec<String>,
    /// Number of records in the shards that are there.
    pub rows: u64,
    /// (bytes) Total size of the shards that are there.
    pub bytes: u64,
    /// Names of the shards that are listed but missing.
    pub missing: Vec<String>,
    /// Problems by the names of the files.
    pub problems: BTreeMap<String, String>,
}

/// Checks all files of a data set, or of a part of one, in the threads of the current rayon pool. Nothing is written.
///
/// # Arguments
/// * `place` - the place of the data set
/// * `check` - how thoroughly files are checked
///
/// # Errors
/// The place has no data set, or its manifest cannot be read or has another format.
pub fn verify(place: &Destination, check: Check) -> Result<Verified, DatasetError> {
    let manifest = manifest::read_begun(place)?;
    let files = place.files()?;
    let mut verified = Verified { complete: manifest.complete, ..Verified::default() };
    if !manifest.is_whole {
        verified.object(MANIFEST, "it is not as it was written: its own SHA-256 differs");
    }
    let listed = if manifest.complete {
        verified.check_counts(&manifest);
        manifest.files.iter().map(|file| (file.name.clone(), file.shard.clone())).collect()
    } else {
        verified.read_footers(place, &files)
    };
    verified.check_names(&files, &listed);
    let shards = verified.check_sizes(&files, &listed, &manifest);
    if check == Check::Bytes {
        for name in manifest.changed_documents(place, &files)? {
            verified.object(name, WRONG_BYTES);
        }
    }
    // The metadata of other shards have been read already.
    if manifest.complete || check == Check::Bytes {
        verified.check_shards(place, &shards, &manifest, check);
    }
    Ok(verified)
}

impl Verified {
    /// Returns whether all files are there as they were written.
    pub fn is_good(&self) -> bool {
        self.missing.is_empty() && self.problems.is_empty()
    }

    /// Records a problem with a file. Only the first problem of a file is kept: it explains the others.
    fn object(&mut self, name: &str, problem: impl Into<String>) {
        self.problems.entry(name.to_owned()).or_insert_with(|| problem.into());
    }

    /// Checks that the counts in the manifest agree with each other.
    fn check_counts(&mut self, manifest: &ReadManifest) {
        let of_files: u64 = manifest.files.iter().map(|file| file.shard.rows).sum();
        let of_labels: u64 = manifest.counts.values().flat_map(BTreeMap::values).sum();
        let of_plan = manifest.records.saturating_sub(manifest.failures.len() as u64);
        if of_labels != of_files || of_plan != of_files {
            let problem = format!(
                "its counts disagree: {} by files, {of_labels} by split and label, {of_plan} of the plan without those that \
                 failed",
                counted(of_files, "record"),
            );
            self.object(MANIFEST, problem);
        }
    }

    /// The shards that are there of a data set that is not complete. Missing ones are not found: it is not said how many it will have.
    fn read_footers(&mut self, place: &Destination, files: &Files) -> ListedFiles {
        let mut listed = BTreeMap::new();
        for (name, &bytes) in files.iter().filter(|(name, _)| Shards::is_name(name)) {
            match place.checked_shard(name, &[], Check::Sizes) {
                Ok(ReadShard { seal, rows, .. }) => {
                    listed.insert(name.clone(), ShardFile { bytes, seal, rows });
                }
                Err(problem) => self.object(name, problem),
            }
        }
        listed
    }

    /// Checks that every shard is listed, and that a complete data set has its documents.
    fn check_names(&mut self, files: &Files, listed: &ListedFiles) {
        // Files beside the folders may be the user's own. In the folders, programs read every file that is there.
        let in_folder = |name: &&String| name.starts_with(FOLDER) && !listed.contains_key(*name);
        for name in files.keys().filter(in_folder) {
            self.object(name, "the manifest does not name it");
        }
        if self.complete {
            let absent = [CARD].into_iter().chain(PREVIEW).filter(|name| !files.contains_key(*name));
            absent.for_each(|name| self.object(name, "it is missing"));
        }
    }

    /// Checks the sizes of all files. Returns the shards that have the listed size.
    fn check_sizes<'l>(
        &mut self,
        files: &Files,
        listed: &'l ListedFiles,
        manifest: &ReadManifest,
    ) -> Vec<(&'l String, &'l ShardFile)> {
        for Document { name, digest } in &manifest.documents {
            match files.get(name) {
                None => self.object(name, "it is missing"),
                Some(&size) if size != digest.bytes => self.object(name, wrong_size(size, digest.bytes)),
                Some(_) => {}
            }
        }
        let mut of_size = Vec::new();
        for (name, file) in listed {
            let Some(&size) = files.get(name) else {
                self.missing.push(name.clone());
                continue;
            };
            self.rows += file.rows;
            self.bytes += size;
            self.shards.push(name.clone());
            if size == file.bytes {
                of_size.push((name, file));
            } else {
                self.object(name, wrong_size(size, file.bytes));
            }
        }
        of_size
    }

    /// Checks the metadata of shards, or all of their bytes, rows, columns and counts.
    fn check_shards(
        &mut self,
        place: &Destination,
        shards: &[(&String, &ShardFile)],
        manifest: &ReadManifest,
        check: Check,
    ) {
        // Of a damaged shard the columns may be others.
        let read = |(name, _): &(&String, &ShardFile)| place.checked_shard(name, &[], check).ok();
        let schema = shards.iter().find_map(read).map(|read| read.schema).unwrap_or_default();
        let mut counts = Counts::new();
        for some in shards.chunks(SHARDS_AT_A_TIME as usize) {
            let checked = some
                .par_iter()
                .map(|(name, file)| (name, check_shard(place, name, file, &schema, &manifest.plan, check)));
            for (name, counts_of_shard) in checked.collect::<Vec<_>>() {
                match counts_of_shard {
                    Ok(of_shard) => add_counts(&mut counts, of_shard),
                    Err(problem) => self.object(name, problem),
                }
            }
        }
        if manifest.complete && check == Check::Bytes && self.is_good() && counts != manifest.counts {
            self.object(MANIFEST, "its counts by split and label are not those of the shards");
        }
    }
}

/// The records of a shard by split and label where all of its bytes are checked, or what is wrong with it.
fn check_shard(
    place: &Destination,
    name: &str,
    file: &ShardFile,
    schema: &[FoundColumn],
    plan: &str,
    check: Check,
) -> Result<Counts, String> {
    let counted_by: &[&str] = if check == Check::Bytes { &["label", "split"] } else { &[] };
    let read = place.checked_shard(name, counted_by, check)?;
    if read.seal != file.seal {
        return Err(WRONG_BYTES.to_owned());
    }
    if read.rows != file.rows {
        return Err(format!("it has {} instead of {}", counted(read.rows, "record"), file.rows));
    }
    if read.metadata.plan != plan {
        return Err("it is of another plan".to_owned());
    }
    if read.schema != schema {
        return Err("its columns are not those of the first shard".to_owned());
    }
    Ok(count(&read))
}

/// Says that a file has another size than the expected one.
fn wrong_size(size: u64, expected: u64) -> String {
    format!("it has {size} bytes instead of {expected}")
}
