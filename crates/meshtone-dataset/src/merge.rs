//! Merging the parts of a data set that were made separately.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use meshtone_io::own_file::Claim;
use meshtone_io::scenario_file::ReadScenarioError;

use crate::contents::{Contents, ShardFile};
use crate::draw::Sampler;
use crate::error::DatasetError;
use crate::finish;
use crate::generate::Generated;
use crate::manifest::{self, MANIFEST, ReadManifest};
use crate::plan::{Plan, PlanFile};
use crate::shard::Shards;
use crate::store::{Destination, Files};
use crate::verify::Check;

/// Merges the parts of a data set.
///
/// First all parts are examined, and no data are written where a shard is missing in all of them. Then the shards that the target
/// lacks are copied, and the documents are made for the whole. The manifest comes last, so that a merge that is interrupted can be
/// run again.
///
/// # Arguments
/// * `parts` - the places of the parts, which have the same plan
/// * `to` - the place of the whole data set, which may be that of a part
/// * `check` - how the shards that are already in `to` are checked
///
/// A shard that is copied is compared with the SHA-256 that was computed while it was made. Everything else is taken from the manifests
/// and lists of the parts. Of shards that are already in `to`, only the sizes are checked, unless `check` asks for their bytes.
///
/// # Errors
/// A place has no data set; the parts have different plans or versions; no part has an undamaged copy of some shard; another program is
/// merging there; or a file cannot be read or written.
pub fn merge(parts: &[Destination], to: &Destination, check: Check) -> Result<Generated, DatasetError> {
    let nothing =
        || DatasetError::refused("there are no parts to merge", "name the directories of the parts");
    let first = parts.first().ok_or_else(nothing)?;
    let plan = plan_of(first)?;
    let sampler = Sampler::new(&plan.content).map_err(|error| manifest::plan_error(&plan, error))?;
    let shards = Shards::new(&plan, &sampler);
    // The place is claimed before it is examined, so that it has to be examined only once.
    let claimed = if to.text(MANIFEST)?.is_some() { Some(claim(to)?) } else { None };
    let mut contents = Contents::default();
    let mut places = Vec::with_capacity(parts.len());
    for part in parts {
        let manifest = manifest::read_begun(part)?;
        let mut place = MergeSource::look(part, Some(manifest), &plan, &shards, &mut contents)?;
        if !is_same(part, to) {
            // The names are not needed any more; a million of them take a hundred megabytes.
            place.files.clear();
        }
        places.push(place);
    }
    let nowhere = |shard: &u64| !places.iter().any(|place| place.shards.contains_key(shard));
    let missing: Vec<u64> = (0..shards.count()).filter(nowhere).collect();
    if let Some(&shard) = missing.first() {
        return Err(no_part_has(shard, missing.len(), &shards, &places));
    }
    let mut merged = Generated {
        earlier_failures: contents.failures.values().cloned().collect(),
        complete: true,
        ..Generated::default()
    };
    let target = match places.iter().find(|place| is_same(place.at, to)) {
        Some(part) => part,
        None => &MergeSource::look(to, manifest::read(to)?, &plan, &shards, &mut Contents::default())?,
    };
    let was_complete = target.is_complete;
    if !was_complete {
        manifest::begin(&plan, to)?;
    }
    let _claimed = claimed.map_or_else(|| claim(to), Ok)?;
    to.remove_leftovers();
    for shard in 0..shards.count() {
        let name = shards.name(shard);
        let of_parts: Vec<Offer> =
            places.iter().filter_map(|place| Some((place.at, *place.shards.get(&shard)?))).collect();
        let file = match target.has(shard, &name, &of_parts, check)? {
            Some(file) => {
                merged.kept_shards += 1;
                file
            }
            None => {
                merged.written_shards += 1;
                merged.written_records += shards.len(shard);
                take_over(&name, &of_parts, to)?
            }
        };
        contents.choose(shard, file);
    }
    if !was_complete || merged.written_shards > 0 {
        finish::finish(&plan, &shards, to, contents)?;
    }
    Ok(merged)
}

/// A place that lists a shard, and the file that it lists.
type Offer<'p> = (&'p Destination, ShardFile);

/// Claims the place of the whole data set for this program alone.
fn claim(to: &Destination) -> Result<Option<Claim>, DatasetError> {
    to.claim("merge", "is merging parts in")
}

fn is_same(place: &Destination, other: &Destination) -> bool {
    place.to_string() == other.to_string()
}

/// Copies a shard from the first part that has an undamaged copy.
fn take_over(name: &str, of_parts: &[Offer], to: &Destination) -> Result<ShardFile, DatasetError> {
    for (at, file) in of_parts {
        // The copy in `to` has already been found missing or damaged.
        if !is_same(at, to) && to.take_over(at, name, &file.digest)? {
            return Ok(*file);
        }
    }
    let places: Vec<String> = of_parts.iter().map(|(at, _)| at.to_string()).collect();
    let places = places.join(" and in ");
    let problem = format!("{name} is damaged in {places}: its SHA-256 is not that of what was written");
    let help = "make it again: run `meshtone dataset PLAN.toml -o DIR --part I/N` there";
    Err(DatasetError::refused(problem, help))
}

/// The place of a part, or of the whole data set, and the files that are there.
struct MergeSource<'p> {
    at: &'p Destination,
    /// Whether the whole data set is there.
    is_complete: bool,
    /// All files, with their sizes.
    files: Files,
    /// Shards that were made there and have the sizes that are listed.
    shards: BTreeMap<u64, ShardFile>,
    /// Other shards that are there.
    doubtful: Vec<u64>,
}

impl<'p> MergeSource<'p> {
    /// Examines a place. This is done only once for each place, since listing very many names takes seconds.
    ///
    /// # Arguments
    /// * `contents` - receives what the place's manifest and lists say
    fn look(
        at: &'p Destination,
        manifest: Option<ReadManifest>,
        plan: &Plan,
        shards: &Shards,
        contents: &mut Contents,
    ) -> Result<Self, DatasetError> {
        let files = at.files()?;
        let is_complete = manifest::check_place(plan, shards, at, &files, manifest.as_ref())?;
        let mut listed = contents.add_place(plan, at, &files, manifest)?;
        let there: BTreeMap<u64, u64> =
            files.iter().filter_map(|(name, &bytes)| Some((shards.number(name)?, bytes))).collect();
        listed.retain(|shard, file| there.get(shard) == Some(&file.digest.bytes));
        let doubtful = there.into_keys().filter(|shard| !listed.contains_key(shard)).collect();
        Ok(Self { at, is_complete, files, shards: listed, doubtful })
    }

    /// The shard if it is there already and undamaged. A shard that is not listed there may come from a merge that was stopped.
    fn has(
        &self,
        shard: u64,
        name: &str,
        of_parts: &[Offer],
        check: Check,
    ) -> Result<Option<ShardFile>, DatasetError> {
        let own = self.shards.get(&shard).copied();
        if own.is_some() && check == Check::Sizes {
            return Ok(own);
        }
        if !self.files.contains_key(name) {
            return Ok(None);
        }
        let digest = self.at.digest(name)?;
        let mut known = own.into_iter().chain(of_parts.iter().map(|(_, file)| *file));
        Ok(known.find(|file| file.digest == digest))
    }
}

fn no_part_has(shard: u64, count: usize, shards: &Shards, places: &[MergeSource<'_>]) -> DatasetError {
    let (all, name) = (shards.count(), shards.name(shard));
    let mut problem = format!("{count} of {all} shards are in none of the parts; the first is {name}");
    if let Some(place) = places.iter().find(|place| place.doubtful.contains(&shard)) {
        problem += &format!(" (that of {} is of another size than listed, or not listed)", place.at);
    }
    DatasetError::refused(problem, "make them: run `meshtone dataset PLAN.toml -o DIR --part I/N` again")
}

/// Reads the plan that a data set was made by from the copies beside its data.
pub(crate) fn plan_of(place: &Destination) -> Result<Plan, DatasetError> {
    let directory = tempfile::tempdir().map_err(DatasetError::write("a temporary directory"))?;
    for name in PlanFile::NAMES {
        if let Some(text) = place.text(name)? {
            let path = directory.path().join(name);
            std::fs::write(&path, text).map_err(DatasetError::write(path.display().to_string()))?;
        }
    }
    let path = directory.path().join(PlanFile::NAMES[0]);
    if !path.exists() {
        return Err(manifest::no_data_set(place, PlanFile::NAMES[0]));
    }
    // Messages name the files of the data set: the temporary directory is gone when the user reads them.
    let named = |path: &Path| {
        let name = path.file_name().map(|name| name.to_string_lossy());
        PathBuf::from(name.map_or_else(|| place.to_string(), |name| place.name_of(&name)))
    };
    let mut plan = Plan::read_copy(&path).map_err(|error| with_path(error, named))?;
    plan.sources.iter_mut().for_each(|source| *source = named(source));
    Ok(plan)
}

/// Changes the name of the file that an error is about.
fn with_path(error: ReadScenarioError, named: impl Fn(&Path) -> PathBuf) -> ReadScenarioError {
    use ReadScenarioError::{Invalid, NotText, Unreadable};

    match error {
        Unreadable { path, source } => Unreadable { path: named(&path), source },
        NotText { path, line, byte } => NotText { path: named(&path), line, byte },
        Invalid { path, text, error } => Invalid { path: named(&path), text, error },
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use std::fs::{self, File};

    use super::*;
    use crate::contents::{Counts, ShardContents, WarningCounts};
    use crate::digest::Digest;
    use crate::generate::Part;
    use crate::part_list::Listing;
    use crate::verify::verify;

    const PLAN: &str = r#"
        records = 100
        units = 4
        [scenario.gears]
        module_mm = 3.0
        pinion_teeth = 20
        gear_teeth = 40
        face_width_mm = 15.0
        [scenario.operation]
        pinion_speed_hz = 40.0
        brake_torque_nm = 10.0
        [scenario.quality]
        din_grade = 7
        [[class]]
        label = "healthy"
        [keep]
        records_per_shard = 100
    "#;

    /// (MB) The most memory that this program has had.
    fn peak_mb() -> f64 {
        let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
        let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:")?.trim().strip_suffix(" kB"));
        peak.map_or(f64::NAN, |kilobytes| kilobytes.trim().parse::<f64>().unwrap() / 1e3)
    }

    #[test]
    fn an_error_names_the_parts_own_files() {
        let directory = tempfile::tempdir().unwrap();
        let part = Destination::directory(directory.path().join("part"));
        let to = Destination::directory(directory.path().join("whole"));
        let plan = Plan::read_text(PLAN.to_owned(), Path::new("plan.toml")).unwrap();
        manifest::begin(&plan, &part).unwrap();
        assert_eq!(plan_of(&part).unwrap().sources[0], directory.path().join("part/plan.toml"));
        for (name, damaged) in [("plan.toml", "units = 4"), ("scenario.toml", "module_mm = 3.0")] {
            let path = directory.path().join("part").join(name);
            let text = fs::read_to_string(&path).unwrap();
            assert!(text.contains(damaged), "{text}");
            fs::write(&path, text.replace(damaged, &format!("{damaged}\nwrong = 1"))).unwrap();
            let error = merge(std::slice::from_ref(&part), &to, Check::Sizes).unwrap_err().to_string();
            assert!(error.starts_with(&path.display().to_string()), "{error}");
            assert!(error.contains("wrong"), "{error}");
            fs::write(&path, text).unwrap();
        }
    }

    /// (s) Processor time that this program has taken, where the system says so.
    fn processor_s() -> f64 {
        const TICKS_PER_S: f64 = 100.0;
        let stat = fs::read_to_string("/proc/self/stat").unwrap_or_default();
        let ticks = stat.rsplit(") ").next().unwrap_or_default().split(' ').skip(11).take(2);
        ticks.filter_map(|ticks| ticks.parse::<f64>().ok()).sum::<f64>() / TICKS_PER_S
    }

    /// Parts of very many shards that were made in one place. Only their names, sizes and lists are there: merging reads no data.
    ///
    /// `MESHTONE_SHARDS=1000000 cargo test --release -p meshtone-dataset very_many -- --nocapture` prints time and memory.
    #[test]
    fn very_many_shards_are_merged_without_being_read() {
        let shards = std::env::var("MESHTONE_SHARDS").map_or(3_000, |shards| shards.parse().unwrap());
        let text = PLAN.replacen("records = 100", &format!("records = {}", 100 * shards), 1);
        let plan = Plan::read_text(text, std::path::Path::new("plan.toml")).unwrap();
        let sampler = Sampler::new(&plan.content).unwrap();
        let start = processor_s();
        let all = Shards::new(&plan, &sampler);
        println!(
            "{} records divided into shards in {:.1} s of the processor",
            plan.records(),
            processor_s() - start
        );
        let shards = all.count();
        let directory = tempfile::tempdir().unwrap();
        let to = Destination::directory(directory.path());
        manifest::begin(&plan, &to).unwrap();
        let start = processor_s();
        for number in 1..=64 {
            let part = Part { number, of: 64 };
            let mut listing = Listing::new(&to, plan.hash().to_owned(), part);
            let made = (0..shards).filter(|&shard| part.has(shard)).map(|shard| {
                let name = all.name(shard);
                let digest = Digest { bytes: 1000 + shard % 7, ..Digest::of(name.as_bytes()) };
                let path = directory.path().join(&name);
                fs::create_dir_all(path.parent().unwrap()).unwrap();
                File::create(path).unwrap().set_len(digest.bytes).unwrap();
                let counts =
                    Counts::from([("train".to_owned(), [("healthy".to_owned(), all.len(shard))].into())]);
                let file = ShardFile { digest, rows: all.len(shard) };
                let (warnings, failures) = (WarningCounts::new(), Vec::new());
                (shard, ShardContents { file, counts, warnings, failures })
            });
            listing.add_all(made).unwrap();
        }
        println!("{shards} shards listed in {:.1} s of the processor", processor_s() - start);
        let start = processor_s();
        let merged = merge(std::slice::from_ref(&to), &to, Check::Sizes).unwrap();
        assert_eq!((merged.kept_shards, merged.written_shards, merged.complete), (shards, 0, true));
        println!("merged in {:.1} s of the processor, {:.0} MB at most", processor_s() - start, peak_mb());
        let start = processor_s();
        let found = verify(&to, Check::Sizes).unwrap();
        assert!(found.is_good() && found.complete && found.rows == plan.records(), "{:?}", found.problems);
        println!(
            "names, sizes and counts in {:.1} s of the processor, {:.0} MB at most",
            processor_s() - start,
            peak_mb()
        );
        // A name says its shard's number, and no folder has more than a thousand.
        assert!((0..shards).all(|shard| all.number(&all.name(shard)) == Some(shard)));
        let folders =
            fs::read_dir(directory.path().join("data")).unwrap().map(|folder| folder.unwrap().path());
        assert!(folders.into_iter().all(|folder| fs::read_dir(folder).unwrap().count() <= 1000));
        assert!(!directory.path().join("parts").exists());
    }
}
