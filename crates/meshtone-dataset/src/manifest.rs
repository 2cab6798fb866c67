//! The manifest: it says what a data set is and whether it is complete.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::contents::{Counts, ShardFile};
use crate::digest::Digest;
use crate::error::DatasetError;
use crate::finish::Finished;
use crate::plan::{Plan, PlanFile};
use crate::shard::{FOLDER, FailedRecord, Shards};
use crate::store::{Destination, Files};

pub(crate) const MANIFEST: &str = "manifest.json";
pub(crate) const CARD: &str = "README.md";
pub(crate) const CROISSANT: &str = "croissant.json";
/// What a set that is adapted to a machine says beside its records.
pub(crate) const ADAPTATION: &str = "adaptation.json";
pub(crate) const PREVIEW: [&str; 2] = ["preview.svg", "preview.png"];
/// In format 5, a shard has its own seal in its footer. Earlier formats were those of versions before the first release.
pub(crate) const FORMAT_VERSION: u64 = 5;

/// Begins a data set or goes on with one.
pub(crate) fn begin(plan: &Plan, to: &Destination) -> Result<(), DatasetError> {
    to.check_writable()?;
    plan.files.iter().try_for_each(|file| to.write_unless_there(file.name, file.text.as_bytes()))?;
    // The manifest is written last: it marks a data set that was begun.
    to.write_unless_there(MANIFEST, sealed(&head(plan, false), "").as_bytes())
}

/// Checks that the data set of a plan may be written to a place. Returns whether all of it is there already, and the files of the
/// place. Nothing is written.
pub(crate) fn check_place(
    plan: &Plan,
    shards: &Shards,
    to: &Destination,
) -> Result<(bool, Files), DatasetError> {
    let (there, manifest) = (to.files()?, read(to)?);
    if let Some(name) = there.keys().find(|name| !is_of_a_data_set(name)) {
        let help = match manifest {
            Some(_) => "move that file elsewhere: in the data set's folders, programs read whatever there is",
            None => "name a directory that is empty or does not exist with -o",
        };
        return Err(DatasetError::refused(format!("{to} has another file in it: {name}"), help));
    }
    let Some(manifest) = manifest else {
        // A run that was killed between its first file and its manifest has left only files that it would write again.
        let Some(data) = there.keys().find(|name| name.starts_with(FOLDER)) else {
            return Ok((false, there));
        };
        let problem = format!("{to} has {data}, but no {MANIFEST}");
        let help = "put it back from a copy, or name another directory with -o";
        return Err(DatasetError::refused(problem, help));
    };
    check_same(plan, to, &manifest)?;
    let foreign = |name: &&String| name.starts_with(FOLDER) && shards.number(name).is_none();
    if let Some(name) = there.keys().find(foreign) {
        let problem = format!("{to} has a shard that is none of this data set: {name}");
        let help = "move it elsewhere, or name another directory with -o";
        return Err(DatasetError::refused(problem, help));
    }
    Ok((manifest.complete, there))
}

fn check_same(plan: &Plan, to: &Destination, manifest: &ReadManifest) -> Result<(), DatasetError> {
    let version = env!("CARGO_PKG_VERSION");
    if manifest.version != version {
        let problem = format!(
            "the data set in {to} was begun by version {} of Meshtone; this is {version}",
            manifest.version
        );
        let help = "go on with that version, or name another directory with -o";
        return Err(DatasetError::refused(problem, help));
    }
    if manifest.plan != plan.hash() {
        let problem = format!(
            "the data set in {to} was begun with another plan, or by a Meshtone whose simulations gave other numbers"
        );
        let help =
            format!("{} there is that plan; name another directory for this one with -o", PlanFile::NAMES[0]);
        return Err(DatasetError::refused(problem, help));
    }
    Ok(())
}

/// Returns whether a name is that of a file of a data set.
pub(crate) fn is_of_a_data_set(name: &str) -> bool {
    let known = [MANIFEST, CARD, CROISSANT, ADAPTATION].into_iter().chain(PREVIEW).chain(PlanFile::NAMES);
    known.into_iter().any(|known| known == name) || Shards::is_name(name)
}

/// The content of a manifest.
#[derive(Debug, Deserialize)]
pub(crate) struct ReadManifest {
    #[serde(rename = "plan_sha256")]
    pub plan: String,
    #[serde(rename = "meshtone_version", default = "unknown")]
    pub version: String,
    pub complete: bool,
    /// Number of records of the plan.
    pub records: u64,
    #[serde(default)]
    pub counts: Counts,
    #[serde(default)]
    pub failures: Vec<FailedRecord>,
    /// All shards in their order.
    #[serde(default)]
    pub files: Vec<NamedShard>,
    /// The other files.
    #[serde(default)]
    pub documents: Vec<Document>,
    /// Whether the manifest itself is as it was written.
    #[serde(skip)]
    pub is_whole: bool,
}

fn unknown() -> String {
    "unknown".to_owned()
}

impl ReadManifest {
    /// Names of those documents that are there but are not as they were written.
    ///
    /// # Arguments
    /// * `place` - the place of the manifest
    /// * `files` - the files of the place
    pub fn changed_documents(&self, place: &Destination, files: &Files) -> Result<Vec<&str>, DatasetError> {
        let there = self.documents.iter().filter(|document| files.contains_key(&document.name));
        let changed = there.filter_map(|Document { name, digest }| match place.digest(name) {
            Ok(found) => (found != *digest).then_some(Ok(name.as_str())),
            Err(error) => Some(Err(error)),
        });
        changed.collect()
    }
}

/// A shard that a manifest lists.
#[derive(Debug, Deserialize)]
pub(crate) struct NamedShard {
    pub name: String,
    #[serde(flatten)]
    pub shard: ShardFile,
}

/// A file of a data set that is neither a shard nor the manifest.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Document {
    pub name: String,
    #[serde(flatten)]
    pub digest: Digest,
}

/// Reads the manifest of a place; none where there is none.
///
/// # Errors
/// The manifest cannot be read, is not one of Meshtone, or has a format that this version does not know.
pub(crate) fn read(place: &Destination) -> Result<Option<ReadManifest>, DatasetError> {
    place.text(MANIFEST)?.map(|text| parse(&text, place)).transpose()
}

/// Reads the manifest of a place that has one.
///
/// # Errors
/// The place has no manifest, or the errors of [`read`].
pub(crate) fn read_begun(place: &Destination) -> Result<ReadManifest, DatasetError> {
    read(place)?.ok_or_else(|| no_data_set(place, MANIFEST))
}

/// The error of a place that lacks a file of a data set.
pub(crate) fn no_data_set(place: &Destination, file: &str) -> DatasetError {
    let problem = format!("{place} is no data set: it has no {file}");
    DatasetError::refused(problem, "name a directory that `meshtone dataset` has written to")
}

fn parse(text: &str, place: &Destination) -> Result<ReadManifest, DatasetError> {
    /// The entries that manifests of all formats have.
    #[derive(Deserialize)]
    struct AnyFormat {
        format_version: Option<u64>,
        #[serde(default = "unknown")]
        meshtone_version: String,
    }
    let damaged = |what: String| {
        let problem = format!("{place}/{MANIFEST} is damaged, or not one of Meshtone: {what}");
        DatasetError::refused(problem, "put it back from a copy, or name another directory")
    };
    let any: AnyFormat = serde_json::from_str(text).map_err(|error| damaged(error.to_string()))?;
    match any.format_version {
        Some(FORMAT_VERSION) => {}
        Some(other) => {
            let problem = format!(
                "{place}/{MANIFEST} has the format {other}; this version of Meshtone knows format {FORMAT_VERSION}"
            );
            let help = format!("use version {} of Meshtone for it", any.meshtone_version);
            return Err(DatasetError::refused(problem, help));
        }
        None => return Err(damaged("it has no format_version".to_owned())),
    }
    let manifest: ReadManifest = serde_json::from_str(text).map_err(|error| damaged(error.to_string()))?;
    Ok(ReadManifest { is_whole: is_whole(text), ..manifest })
}

/// The entries that manifests of complete and of incomplete data sets have in common.
fn head(plan: &Plan, complete: bool) -> Value {
    json!({
        "format_version": FORMAT_VERSION,
        "meshtone_version": env!("CARGO_PKG_VERSION"),
        "title": plan.about.title,
        "licence": plan.about.licence,
        "plan_sha256": plan.hash(),
        "seed": plan.content.seed,
        "records": plan.records(),
        "units": plan.content.units,
        "complete": complete,
    })
}

/// The manifest of a complete data set.
///
/// # Arguments
/// * `documents` - all files but the shards and the manifest
pub(crate) fn complete(set: &Finished, documents: &[Document]) -> String {
    let Finished { plan, shards, contents, .. } = *set;
    let mut manifest = head(plan, true);
    manifest["records_per_shard"] = json!(shards.records_per_shard);
    manifest["split_by"] = json!(plan.content.splits.by.name());
    manifest["units_of_split"] = json!(BTreeMap::from_iter(plan.content.units_of_split()));
    manifest["counts"] = json!(contents.counts);
    manifest["warnings"] = json!(contents.warnings);
    manifest["failures"] = contents.failures.values().map(|failed| json!(failed)).collect();
    manifest["documents"] = json!(documents);
    // A line a shard: there may be a million of them.
    let line = |(&shard, file): (&u64, &ShardFile)| {
        let (name, ShardFile { bytes, seal, rows }) = (shards.name(shard), file);
        format!("    {{\"name\": \"{name}\", \"bytes\": {bytes}, \"seal\": \"{seal}\", \"rows\": {rows}}}")
    };
    let files: Vec<String> = contents.files.iter().map(line).collect();
    sealed(&manifest, &format!(",\n  \"files\": [\n{}\n  ]", files.join(",\n")))
}

/// The text of an object with further entries, of which the last one is the SHA-256 of the text before it.
fn sealed(head: &Value, rest: &str) -> String {
    let text = format!("{head:#}");
    let text = text.strip_suffix("\n}").unwrap_or(&text).to_owned() + rest;
    let seal = seal(&text);
    text + &seal
}

fn seal(before: &str) -> String {
    format!(",\n  \"sha256\": \"{}\"\n}}\n", Digest::of(before.as_bytes()).sha256)
}

/// Returns whether a manifest is as it was written.
fn is_whole(text: &str) -> bool {
    let place = text.len().checked_sub(seal("").len()).filter(|&place| text.is_char_boundary(place));
    place.is_some_and(|place| text[place..] == seal(&text[..place]))
}
