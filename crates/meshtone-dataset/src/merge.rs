//! Merging the parts of a data set that were made separately.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use meshtone_io::own_file::Claim;
use meshtone_io::scenario_file::ReadScenarioError::{Invalid, NotText, Unreadable};

use crate::draw::Sampler;
use crate::error::DatasetError;
use crate::finish;
use crate::generate::Generated;
use crate::manifest::{self, MANIFEST};
use crate::plan::{Plan, PlanFile};
use crate::shard::{ReadShard, Shards};
use crate::store::Destination;
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
/// A shard that is copied is compared with the SHA-256 in its footer, which was computed while it was made. Of shards that are already in
/// `to`, only the footers are read, unless `check` asks for their bytes.
///
/// # Errors
/// A place has no data set; the parts have different plans or versions; no part has an undamaged copy of some shard; another program is
/// merging there; or a file cannot be read or written.
pub fn merge(parts: &[Destination], to: &Destination, check: Check) -> Result<Generated, DatasetError> {
    let nothing =
        || DatasetError::refused("there are no parts to merge", "name the directories of the parts");
    let first = parts.first().ok_or_else(nothing)?;
    let plan = plan_of(first)?;
    let sampler = Sampler::of_plan(&plan)?;
    let shards = Shards::new(&plan, &sampler);
    // The place is claimed before it is examined, so that it has to be examined only once.
    let claimed = if to.text(MANIFEST)?.is_some() { Some(claim(to)?) } else { None };
    let mut places = Vec::with_capacity(parts.len());
    for part in parts {
        manifest::read_begun(part)?;
        places.push(MergeSource::look(part, &plan, &shards)?);
    }
    let nowhere = |shard: &u64| !places.iter().any(|place| place.shards.contains(shard));
    let missing: Vec<u64> = (0..shards.count()).filter(nowhere).collect();
    if let Some(&shard) = missing.first() {
        let (all, name) = (shards.count(), shards.name(shard));
        let problem =
            format!("{} of {all} shards are in none of the parts; the first is {name}", missing.len());
        let help = "make them: run `meshtone dataset PLAN.toml -o DIR --part I/N` again";
        return Err(DatasetError::refused(problem, help));
    }
    let target = MergeSource::look(to, &plan, &shards)?;
    if !target.is_complete {
        manifest::begin(&plan, to)?;
    }
    let _claimed = claimed.map_or_else(|| claim(to), Ok)?;
    to.remove_leftovers();
    let mut merged = Generated { complete: true, ..Generated::default() };
    for shard in 0..shards.count() {
        let name = shards.name(shard);
        let metadata = shards.metadata(plan.hash(), shard);
        let is_it = |read: ReadShard| read.metadata.is_of(&metadata);
        if target.shards.contains(&shard) && to.checked_shard(&name, &[], check).is_ok_and(is_it) {
            merged.kept_shards += 1;
            continue;
        }
        take_over(shard, &name, &places, to)?;
        merged.written_shards += 1;
        merged.written_records += shards.len(shard);
    }
    merged.earlier_failures = if target.is_complete && merged.written_shards == 0 {
        manifest::read_begun(to)?.failures
    } else {
        finish::finish(&plan, &shards, to, &to.files()?)?.failures.into_values().collect()
    };
    Ok(merged)
}

/// Claims the place of the whole data set for this program alone.
fn claim(to: &Destination) -> Result<Option<Claim>, DatasetError> {
    to.claim("merge", "is merging parts in")
}

/// Copies a shard from the first part that has an undamaged copy.
fn take_over(shard: u64, name: &str, places: &[MergeSource], to: &Destination) -> Result<(), DatasetError> {
    let having: Vec<&MergeSource> = places.iter().filter(|place| place.shards.contains(&shard)).collect();
    for place in &having {
        // The copy in `to` has already been found missing or damaged.
        if place.at.to_string() != to.to_string() && to.take_over(place.at, name)? {
            return Ok(());
        }
    }
    let places = having.iter().map(|place| place.at.to_string()).collect::<Vec<_>>().join(" and in ");
    let problem = format!("{name} is damaged in {places}: its SHA-256 is not that of what was written");
    let help = "make it again: run `meshtone dataset PLAN.toml -o DIR --part I/N` there";
    Err(DatasetError::refused(problem, help))
}

/// The place of a part, or of the whole data set, and the shards that are there.
struct MergeSource<'p> {
    at: &'p Destination,
    /// Whether the whole data set is there.
    is_complete: bool,
    /// Numbers of the shards.
    shards: BTreeSet<u64>,
}

impl<'p> MergeSource<'p> {
    /// Examines a place. This is done only once for each place, since listing very many names takes seconds.
    fn look(at: &'p Destination, plan: &Plan, shards: &Shards) -> Result<Self, DatasetError> {
        let (is_complete, files) = manifest::check_place(plan, shards, at)?;
        Ok(Self { at, is_complete, shards: files.keys().filter_map(|name| shards.number(name)).collect() })
    }
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
    let mut plan = Plan::read_copy(&path).map_err(|mut error| {
        let (Unreadable { path, .. } | NotText { path, .. } | Invalid { path, .. }) = &mut error;
        *path = named(path);
        error
    })?;
    plan.sources.iter_mut().for_each(|source| *source = named(source));
    Ok(plan)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use std::fs;

    use super::*;

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
}
