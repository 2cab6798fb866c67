//! Putting parts together that were made apart.

use crate::draw::Sampler;
use crate::error::DatasetError;
use crate::finish;
use crate::generate::Generated;
use crate::manifest::{self, Begun, MANIFEST};
use crate::plan::{Plan, PlanFile};
use crate::shard::{Shards, Wanted};
use crate::store::Destination;

/// Merges the parts of a data set.
///
/// # Arguments
/// * `parts` - where they are; all of the same plan
/// * `to` - where the whole is written to; it may be one of them
///
/// # Errors
/// A place without a data set; parts of different plans or versions; shards that no part has; what cannot be read or written.
pub fn merge(parts: &[Destination], to: &Destination) -> Result<Generated, DatasetError> {
    let Some(first) = parts.first() else {
        return Err(DatasetError::refused(
            "there are no parts to merge",
            "name the directories of the parts",
        ));
    };
    let plan = plan_of(first)?;
    for part in parts {
        if part.text(MANIFEST)?.is_none() {
            let help = "name the directories that `meshtone dataset` has written to";
            return Err(DatasetError::refused(format!("{part} is no data set: it has no {MANIFEST}"), help));
        }
        manifest::look(&plan, part)?;
    }
    let sampler = Sampler::new(&plan.content).map_err(|error| manifest::plan_error(&plan, error))?;
    let shards = Shards::new(&plan, &sampler);
    let hash = plan.hash();
    // The failures of a shard that a place has; none where it has it not.
    let failures = |place: &Destination, shard: u64| {
        let read = place.shard(&Shards::name(shard), Wanted::Nothing)?;
        read.metadata.is_of(&hash, &shards.range(shard)).then_some(read.metadata.failures)
    };
    let mut sources = Vec::new();
    let mut missing = Vec::new();
    let mut failed = Vec::new();
    for shard in 0..shards.count() {
        match parts.iter().find_map(|part| Some((part, failures(part, shard)?))) {
            Some((part, of_shard)) => {
                sources.push((shard, part));
                failed.extend(of_shard);
            }
            None => missing.push(shard),
        }
    }
    if let Some(shard) = missing.first() {
        let (count, all) = (missing.len(), shards.count());
        let problem = format!(
            "{count} of {all} shards are in none of the parts; the first is {}",
            Shards::name(*shard)
        );
        return Err(DatasetError::refused(
            problem,
            "make them: run `meshtone dataset PLAN.toml -o DIR --part I/N` again",
        ));
    }
    let mut merged = Generated {
        kept_shards: 0,
        written_shards: 0,
        written_records: 0,
        failures: Vec::new(),
        earlier_failures: failed,
        complete: true,
    };
    if manifest::begin(&plan, to)? == Begun::Complete {
        merged.kept_shards = shards.count();
        to.remove_leftovers();
        return Ok(merged);
    }
    for (shard, part) in sources {
        if failures(to, shard).is_some() {
            merged.kept_shards += 1;
        } else {
            to.take_over(part, &Shards::name(shard))?;
            merged.written_shards += 1;
            merged.written_records += shards.range(shard).count() as u64;
        }
    }
    merged.complete = finish::finish_if_complete(&plan, shards, to)?;
    to.remove_leftovers();
    Ok(merged)
}

/// The plan that a data set was made by, read from the copies beside its data.
fn plan_of(place: &Destination) -> Result<Plan, DatasetError> {
    let directory = tempfile::tempdir().map_err(DatasetError::write("a temporary directory"))?;
    for name in PlanFile::NAMES {
        if let Some(text) = place.text(name)? {
            let path = directory.path().join(name);
            std::fs::write(&path, text).map_err(DatasetError::write(path.display().to_string()))?;
        }
    }
    let path = directory.path().join(PlanFile::NAMES[0]);
    if !path.exists() {
        let help = "name the directories that `meshtone dataset` has written to";
        return Err(DatasetError::refused(
            format!("{place} is no data set: it has no {}", PlanFile::NAMES[0]),
            help,
        ));
    }
    Ok(Plan::read_copy(&path)?)
}
