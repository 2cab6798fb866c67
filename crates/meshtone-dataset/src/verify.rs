//! Whether a data set is what was written.

use std::collections::BTreeMap;
use std::fmt::Display;

use meshtone_io::table::FoundColumn;
use rayon::prelude::*;

use crate::contents::{Counts, ShardFile, WRONG_BYTES, count, wrong_size};
use crate::error::DatasetError;
use crate::manifest::{self, CARD, MANIFEST, PREVIEW, ReadManifest};
use crate::part_list::PartList;
use crate::shard::{FOLDER, Shards, Wanted};
use crate::store::Destination;
use crate::words::counted;

/// Shards that are looked at before what was found is added up.
const AT_A_TIME: usize = 1024;

/// How thoroughly files are looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Check {
    /// Names, sizes and counts.
    Sizes,
    /// Every byte.
    Bytes,
}

/// What was found.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Verified {
    /// Whether the manifest calls the data set complete.
    pub complete: bool,
    /// Format of the manifest. Of format 1 the hashes are of what was on the disk in the end, not of what was written.
    pub format: u64,
    /// Shards that are listed and there, by their names.
    pub shards: Vec<String>,
    /// Records in those.
    pub rows: u64,
    /// (bytes) Of those.
    pub bytes: u64,
    /// Shards that are listed and not there, by their names.
    pub missing: Vec<String>,
    /// What is wrong, by the files that it is wrong with.
    pub problems: BTreeMap<String, String>,
}

/// Looks at all files of a data set, or of a part of one, in the threads of the current rayon pool. Nothing is written.
///
/// # Arguments
/// * `place` - where it is
/// * `check` - how
///
/// # Errors
/// A place without a data set; a manifest that cannot be read, or of a later format.
pub fn verify(place: &Destination, check: Check) -> Result<Verified, DatasetError> {
    let Some(manifest) = manifest::read(place)? else {
        let problem = format!("{place} is no data set: it has no {MANIFEST}");
        return Err(DatasetError::refused(
            problem,
            "name a directory that `meshtone dataset` has written to",
        ));
    };
    let files = place.files()?;
    let mut verified =
        Verified { complete: manifest.complete, format: manifest.format, ..Verified::default() };
    if !manifest.is_whole {
        verified.object(MANIFEST, "it is not as it was written: its own SHA-256 differs");
    }
    let listed = if manifest.complete {
        verified.check_counts(&manifest);
        manifest.files.iter().map(|file| (file.name.clone(), file.shard)).collect()
    } else {
        verified.read_lists(place, &files, &manifest.plan)?
    };
    verified.check_names(&files, &listed);
    let shards = verified.check_sizes(&files, &listed, &manifest);
    if check == Check::Bytes {
        for (name, digest) in manifest.documents.iter().filter(|(name, _)| files.contains_key(*name)) {
            if place.digest(name)? != *digest {
                verified.object(name, WRONG_BYTES);
            }
        }
        verified.check_shards(place, &shards, &manifest);
    }
    Ok(verified)
}

impl Verified {
    /// Whether all is there as it was written.
    pub fn is_good(&self) -> bool {
        self.missing.is_empty() && self.problems.is_empty()
    }

    /// The first objection to a file is the plainest.
    fn object(&mut self, name: &str, problem: impl Into<String>) {
        self.problems.entry(name.to_owned()).or_insert_with(|| problem.into());
    }

    /// The manifest agrees with itself.
    fn check_counts(&mut self, manifest: &ReadManifest) {
        let of_files: u64 = manifest.files.iter().map(|file| file.shard.rows).sum();
        let of_labels: u64 = manifest.counts.values().sum();
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

    /// The shards that the lists of parts name. How many shards there are to be is not known from those, nor how many digits
    /// their names have: only what is there is found.
    fn read_lists(
        &mut self,
        place: &Destination,
        files: &BTreeMap<String, u64>,
        plan: &str,
    ) -> Result<BTreeMap<String, ShardFile>, DatasetError> {
        let mut shards = BTreeMap::new();
        for name in PartList::names(files) {
            match place.text(name)?.and_then(|text| PartList::parse(&text, plan)) {
                Some(list) => shards.extend(list.shards.into_iter().map(|(shard, of)| (shard, of.file))),
                None => self.object(name, "it is not as it was written, or of another plan"),
            }
        }
        let listed =
            files.keys().filter_map(|name| Some((name.clone(), *shards.get(&Shards::number_of(name)?)?)));
        Ok(listed.collect())
    }

    /// No shard is there that is not listed, and all that belongs to a complete data set.
    fn check_names(&mut self, files: &BTreeMap<String, u64>, listed: &BTreeMap<String, ShardFile>) {
        // Other files beside the folders are the user's own, but in the folders programs read whatever there is.
        let in_folder = |name: &&String| name.starts_with(FOLDER) && !listed.contains_key(*name);
        for name in files.keys().filter(in_folder) {
            self.object(name, "no manifest or list of a part names it");
        }
        if self.complete {
            let absent = [CARD].into_iter().chain(PREVIEW).filter(|name| !files.contains_key(*name));
            absent.for_each(|name| self.object(name, "it is missing"));
        }
    }

    /// Returns the shards that have their sizes.
    fn check_sizes<'l>(
        &mut self,
        files: &BTreeMap<String, u64>,
        listed: &'l BTreeMap<String, ShardFile>,
        manifest: &ReadManifest,
    ) -> Vec<(&'l String, ShardFile)> {
        for (name, digest) in &manifest.documents {
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
            if size == file.digest.bytes {
                of_size.push((name, *file));
            } else {
                self.object(name, wrong_size(size, file.digest.bytes));
            }
        }
        of_size
    }

    /// Bytes, rows, columns and counts.
    fn check_shards(
        &mut self,
        place: &Destination,
        shards: &[(&String, ShardFile)],
        manifest: &ReadManifest,
    ) {
        let read = |(name, _): &(&String, ShardFile)| place.read_shard(name, Wanted::Nothing).ok();
        let schema = shards.iter().find_map(read).map(|read| read.schema).unwrap_or_default();
        let mut counts = Counts::new();
        for some in shards.chunks(AT_A_TIME) {
            let looked = some
                .par_iter()
                .map(|(name, file)| (name, look_at(place, name, file, &schema, &manifest.plan)));
            for (name, looked) in looked.collect::<Vec<_>>() {
                match looked {
                    Ok(of_shard) => {
                        of_shard.into_iter().for_each(|(key, n)| *counts.entry(key).or_default() += n);
                    }
                    Err(problem) => self.object(name, problem),
                }
            }
        }
        if manifest.complete && self.is_good() && counts != manifest.counts {
            self.object(MANIFEST, "its counts by split and label are not those of the shards");
        }
    }
}

/// The records of a shard by split and label, or what is wrong with it.
fn look_at(
    place: &Destination,
    name: &str,
    file: &ShardFile,
    schema: &[FoundColumn],
    plan: &str,
) -> Result<Counts, String> {
    let unreadable = |error: &dyn Display| format!("it cannot be read: {error}");
    if place.digest(name).map_err(|error| unreadable(&error))? != file.digest {
        return Err(WRONG_BYTES.to_owned());
    }
    let wanted = Wanted::Columns(&["label", "split"]);
    let read = place.read_shard(name, wanted).map_err(|error| unreadable(&error))?;
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
