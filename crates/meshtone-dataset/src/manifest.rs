//! The manifest: what a data set is, and whether it is complete.

use std::collections::BTreeMap;
use std::fmt;
use std::io::{self, BufWriter, Write};

use meshtone_io::scenario_file::ReadScenarioError;
use serde::de::{Deserialize, Deserializer, Error as _, MapAccess, Visitor};
use serde_json::{Map, Value, json};

use crate::contents::{Contents, Counts, ShardFile};
use crate::digest::{Digest, Hash};
use crate::error::DatasetError;
use crate::part_list;
use crate::plan::{Plan, PlanFile};
use crate::sealed;
use crate::shard::{FOLDER, FailedRecord, Shards};
use crate::store::Destination;

pub(crate) const MANIFEST: &str = "manifest.json";
pub(crate) const CARD: &str = "README.md";
pub(crate) const CROISSANT: &str = "croissant.json";
pub(crate) const PREVIEW: [&str; 2] = ["preview.svg", "preview.png"];
/// Since 2 a shard's SHA-256 is that of the bytes that were to be written; of a data set of format 1 it was taken from the disk.
/// Since 3 records have the columns of [`crate::shard::WARNINGS`] and of the time in which the teeth do not push.
pub(crate) const FORMAT_VERSION: u64 = 3;

/// What was there when a run began.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Begun {
    /// Nothing, or a part of this data set.
    Incomplete,
    /// All of it.
    Complete,
}

/// Begins a data set or goes on with one.
pub(crate) fn begin(plan: &Plan, to: &Destination) -> Result<(), DatasetError> {
    to.check_writable()?;
    write_plan(plan, to)?;
    let mut manifest = Vec::new();
    let written = sealed::write(&mut manifest, &head(plan, false), |_| Ok(()));
    written.map_err(DatasetError::write(MANIFEST))?;
    // Last: what has a manifest is a data set that was begun.
    write_new(to, MANIFEST, &String::from_utf8_lossy(&manifest))
}

/// Copies a plan and what it was read with, unless that is there.
pub(crate) fn write_plan(plan: &Plan, to: &Destination) -> Result<(), DatasetError> {
    plan.files.iter().try_for_each(|file| write_new(to, file.name, &file.text))
}

/// Whether this plan's data set may be written there; nothing is written.
pub(crate) fn look(plan: &Plan, shards: Shards, to: &Destination) -> Result<Begun, DatasetError> {
    look_at(plan, shards, to, &to.files()?, read(to)?.as_ref())
}

/// As [`look`], where what is there is known.
pub(crate) fn look_at(
    plan: &Plan,
    shards: Shards,
    to: &Destination,
    there: &BTreeMap<String, u64>,
    manifest: Option<&ReadManifest>,
) -> Result<Begun, DatasetError> {
    if let Some(name) = there.keys().find(|name| !is_of_a_data_set(name)) {
        let help = match manifest {
            Some(_) => "move that file elsewhere: in the data set's folders, programs read whatever there is",
            None => "name a directory that is empty or does not exist with -o",
        };
        return Err(DatasetError::refused(format!("{to} has another file in it: {name}"), help));
    }
    let Some(manifest) = manifest else {
        // Killed between its first file and its manifest, a run has left nothing but what it would write again.
        let data = there.keys().find(|name| name.starts_with(FOLDER));
        return match data {
            None => Ok(Begun::Incomplete),
            Some(name) => Err(DatasetError::refused(
                format!("{to} has {name}, but no {MANIFEST}"),
                "put it back from a copy, or name another directory with -o",
            )),
        };
    };
    check_same(plan, to, manifest)?;
    let foreign = |name: &&String| name.starts_with(FOLDER) && shards.number(name).is_none();
    if let Some(name) = there.keys().find(foreign) {
        return Err(DatasetError::refused(
            format!("{to} has a shard that is none of this data set: {name}"),
            "move it elsewhere, or name another directory with -o",
        ));
    }
    Ok(if manifest.complete { Begun::Complete } else { Begun::Incomplete })
}

fn check_same(plan: &Plan, to: &Destination, manifest: &ReadManifest) -> Result<(), DatasetError> {
    let version = env!("CARGO_PKG_VERSION");
    if manifest.version != version {
        let problem = format!(
            "the data set in {to} was begun by version {} of Meshtone; this is {version}",
            manifest.version
        );
        return Err(DatasetError::refused(
            problem,
            "go on with that version, or name another directory with -o",
        ));
    }
    if !manifest.complete {
        manifest.check_columns(to)?;
    }
    if manifest.plan != plan.hash().to_string() {
        let problem = format!("the data set in {to} was begun with another plan");
        let help =
            format!("{} there is that plan; name another directory for this one with -o", PlanFile::NAMES[0]);
        return Err(DatasetError::refused(problem, help));
    }
    Ok(())
}

/// Whether a data set may have a file of a name.
pub(crate) fn is_of_a_data_set(name: &str) -> bool {
    let known = [MANIFEST, CARD, CROISSANT].into_iter().chain(PREVIEW).chain(PlanFile::NAMES);
    known.into_iter().any(|known| known == name) || Shards::is_name(name) || part_list::is_list(name)
}

/// Writes a file unless one with the same content is there.
fn write_new(to: &Destination, name: &str, text: &str) -> Result<(), DatasetError> {
    if to.text(name)?.as_deref() == Some(text) { Ok(()) } else { to.write_bytes(name, text.as_bytes()) }
}

/// What a manifest says.
#[derive(Debug)]
pub(crate) struct ReadManifest {
    pub format: u64,
    pub plan: String,
    pub version: String,
    pub complete: bool,
    /// Records of the plan.
    pub records: u64,
    pub counts: Counts,
    pub failures: Vec<FailedRecord>,
    /// All shards, in their order.
    pub files: Vec<NamedShard>,
    /// The other files, by their names.
    pub documents: BTreeMap<String, Digest>,
    /// Whether the manifest itself is as it was written.
    pub is_whole: bool,
}

impl ReadManifest {
    /// Whether what it says of shards can be relied on: it is as it was written, or its shards' own hashes are all that is taken from
    /// it. Nothing else proves which records failed and why.
    pub fn can_be_relied_on(&self) -> bool {
        self.is_whole || self.failures.is_empty()
    }

    /// Refuses to add records to a data set whose records have other columns.
    pub fn check_columns(&self, place: &Destination) -> Result<(), DatasetError> {
        if self.format == FORMAT_VERSION {
            return Ok(());
        }
        let problem = format!(
            "the data set in {place} has the format {}, whose records have other columns than those of format {FORMAT_VERSION}",
            self.format
        );
        Err(DatasetError::refused(problem, "name another directory with -o, and make all of it there"))
    }
}

/// A shard of a manifest.
#[derive(Debug)]
pub(crate) struct NamedShard {
    pub name: String,
    pub shard: ShardFile,
}

/// Reads the manifest of a place; none where there is none.
///
/// # Errors
/// What cannot be read; a manifest that is none of Meshtone, or of a format that this version does not know.
pub(crate) fn read(place: &Destination) -> Result<Option<ReadManifest>, DatasetError> {
    place.text(MANIFEST)?.map(|text| parse(&text, place)).transpose()
}

fn parse(text: &str, place: &Destination) -> Result<ReadManifest, DatasetError> {
    const HELP: &str = "put it back from a copy, or name another directory";
    let Entries { files, rest } = serde_json::from_str(text).map_err(|error| {
        DatasetError::refused(format!("{place}/{MANIFEST} is damaged, or not one of Meshtone: {error}"), HELP)
    })?;
    let format = rest.get("format_version").and_then(Value::as_u64);
    let version = rest.get("meshtone_version").and_then(Value::as_str).unwrap_or("unknown").to_owned();
    match format {
        Some(1..=FORMAT_VERSION) => {}
        Some(other) => {
            let problem = format!(
                "{place}/{MANIFEST} has the format {other}; this version of Meshtone knows those up to {FORMAT_VERSION}"
            );
            return Err(DatasetError::refused(problem, format!("use version {version} of Meshtone for it")));
        }
        None => {
            let problem =
                format!("{place}/{MANIFEST} is damaged, or not one of Meshtone: it has no format_version");
            return Err(DatasetError::refused(problem, HELP));
        }
    }
    let read = || {
        let failures = rest.get("failures").and_then(Value::as_array).into_iter().flatten();
        let documents = rest.get("documents").and_then(Value::as_array).into_iter().flatten();
        let document = |value: &Value| {
            let sha256 = Hash::parse(value["sha256"].as_str()?)?;
            Some((value["name"].as_str()?.to_owned(), Digest { bytes: value["bytes"].as_u64()?, sha256 }))
        };
        Some(ReadManifest {
            format: format?,
            plan: rest.get("plan_sha256")?.as_str()?.to_owned(),
            version,
            complete: rest.get("complete")?.as_bool()?,
            records: rest.get("records")?.as_u64()?,
            counts: rest.get("counts").map_or_else(|| Some(Counts::new()), read_counts)?,
            failures: failures.map(FailedRecord::from_json).collect::<Option<_>>()?,
            files,
            documents: documents.map(document).collect::<Option<_>>()?,
            is_whole: format == Some(1) || sealed::is_whole(text),
        })
    };
    read().ok_or_else(|| {
        DatasetError::refused(
            format!("{place}/{MANIFEST} is damaged, or not one of Meshtone: it lacks what each of them has"),
            HELP,
        )
    })
}

fn read_counts(value: &Value) -> Option<Counts> {
    let mut counts = Counts::new();
    for (split, labels) in value.as_object()? {
        for (label, count) in labels.as_object()? {
            counts.insert((split.clone(), label.clone()), count.as_u64()?);
        }
    }
    Some(counts)
}

/// A manifest's entries. There may be a million shards, so those are never held as what JSON makes of them.
struct Entries {
    files: Vec<NamedShard>,
    rest: Map<String, Value>,
}

impl<'de> Deserialize<'de> for Entries {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OfManifest;

        impl<'de> Visitor<'de> for OfManifest {
            type Value = Entries;

            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("an object")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Entries, A::Error> {
                let (mut files, mut rest) = (Vec::new(), Map::new());
                while let Some(key) = map.next_key::<String>()? {
                    if key == "files" {
                        files = map.next_value()?;
                    } else {
                        rest.insert(key, map.next_value()?);
                    }
                }
                Ok(Entries { files, rest })
            }
        }

        deserializer.deserialize_map(OfManifest)
    }
}

impl<'de> Deserialize<'de> for NamedShard {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let entry = Map::deserialize(deserializer)?;
        let read = || {
            let sha256 = Hash::parse(entry.get("sha256")?.as_str()?)?;
            let digest = Digest { bytes: entry.get("bytes")?.as_u64()?, sha256 };
            let shard = ShardFile { digest, rows: entry.get("rows")?.as_u64()? };
            Some(Self { name: entry.get("name")?.as_str()?.to_owned(), shard })
        };
        read().ok_or_else(|| D::Error::custom("a file lacks its name, bytes, sha256 or rows"))
    }
}

fn head(plan: &Plan, complete: bool) -> Map<String, Value> {
    let head = json!({
        "format_version": FORMAT_VERSION,
        "meshtone_version": env!("CARGO_PKG_VERSION"),
        "title": plan.about.title,
        "licence": plan.about.licence,
        "plan_sha256": plan.hash().to_string(),
        "seed": plan.content.seed,
        "records": plan.records(),
        "units": plan.content.units,
        "complete": complete,
    });
    head.as_object().cloned().unwrap_or_default()
}

/// Counts by split, and in each of them by label.
pub(crate) fn counts_table(counts: &Counts) -> Value {
    let mut splits: Map<String, Value> = Map::new();
    for ((split, label), count) in counts {
        let entry = splits.entry(split.clone()).or_insert_with(|| Value::Object(Map::new()));
        if let Value::Object(labels) = entry {
            labels.insert(label.clone(), json!(count));
        }
    }
    Value::Object(splits)
}

/// Writes the manifest of a complete data set.
///
/// # Arguments
/// * `to` - where it is written to; it needs no buffer
/// * `units_of_split` - by the splits' names
/// * `documents` - all files but the shards and the manifest
pub(crate) fn write_complete(
    to: impl Write,
    plan: &Plan,
    shards: Shards,
    contents: &Contents,
    units_of_split: &BTreeMap<String, u64>,
    documents: &BTreeMap<&str, Digest>,
) -> io::Result<()> {
    let mut manifest = head(plan, true);
    manifest.insert("records_per_shard".into(), json!(shards.records_per_shard));
    manifest.insert("split_by".into(), json!(plan.content.splits.by.name()));
    manifest.insert("units_of_split".into(), json!(units_of_split));
    manifest.insert("counts".into(), counts_table(&contents.counts));
    manifest.insert("warnings".into(), json!(contents.warnings));
    let failures =
        contents.failures.iter().map(|(record, reason)| json!({ "record": record, "reason": reason }));
    manifest.insert("failures".into(), failures.collect());
    let documents = documents.iter().map(
        |(name, digest)| json!({ "name": name, "bytes": digest.bytes, "sha256": digest.sha256.to_string() }),
    );
    manifest.insert("documents".into(), documents.collect());
    sealed::write(BufWriter::new(to), &manifest, |to| {
        write!(to, ",\n  \"files\": [")?;
        for (&shard, file) in &contents.files {
            let Digest { bytes, sha256 } = file.digest;
            let comma = if shard == 0 { "" } else { "," };
            let name = shards.name(shard);
            write!(
                to,
                "{comma}\n    {{\"name\": \"{name}\", \"bytes\": {bytes}, \"sha256\": \"{sha256}\", \"rows\": {}}}",
                file.rows
            )?;
        }
        write!(to, "\n  ]")
    })
}

/// An error of a plan that was found after reading it.
pub(crate) fn plan_error(plan: &Plan, error: impl Into<meshtone_toml::TomlError>) -> DatasetError {
    let path = plan.sources.first().cloned().unwrap_or_default();
    let text = plan.files.first().map(|file| file.text.clone()).unwrap_or_default();
    DatasetError::Plan(ReadScenarioError::Invalid { path, text, error: Box::new(error.into()) })
}
