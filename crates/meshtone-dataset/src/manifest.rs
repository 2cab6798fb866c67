//! The manifest: what a data set is, and whether it is complete.

use std::collections::BTreeMap;

use meshtone_io::scenario_file::ReadScenarioError;
use serde_json::{Map, Value, json};

use crate::error::DatasetError;
use crate::finish::Contents;
use crate::plan::{Plan, PlanFile};
use crate::shard::{FOLDER, Shards};
use crate::store::Destination;

pub(crate) const MANIFEST: &str = "manifest.json";
pub(crate) const CARD: &str = "README.md";
pub(crate) const PREVIEW: [&str; 2] = ["preview.svg", "preview.png"];
const FORMAT_VERSION: u32 = 1;

/// What was there when a run began.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Begun {
    /// Nothing, or a part of this data set.
    Incomplete,
    /// All of it.
    Complete,
}

/// Begins a data set or goes on with one, unless something else is there.
pub(crate) fn begin(plan: &Plan, to: &Destination) -> Result<Begun, DatasetError> {
    let begun = look(plan, to)?;
    if begun == Begun::Incomplete {
        to.check_writable()?;
        for file in &plan.files {
            write_new(to, file.name, &file.text)?;
        }
        // Last: what has a manifest is a data set that was begun.
        write_new(to, MANIFEST, &text(&head(plan, false)))?;
    }
    Ok(begun)
}

/// Whether this plan's data set may be written there; nothing is written.
pub(crate) fn look(plan: &Plan, to: &Destination) -> Result<Begun, DatasetError> {
    let there = names(to)?;
    if let Some(name) = there.iter().find(|name| !is_of_a_data_set(name)) {
        return Err(DatasetError::refused(
            format!("{to} has another file in it: {name}"),
            "name a directory that is empty or does not exist with -o",
        ));
    }
    let Some(text) = to.text(MANIFEST)? else {
        // Killed between its first file and its manifest, a run has left nothing but what it would write again.
        let data = there.iter().find(|name| name.starts_with(FOLDER));
        return match data {
            None => Ok(Begun::Incomplete),
            Some(name) => Err(DatasetError::refused(
                format!("{to} has {name}, but no {MANIFEST}"),
                "name another directory with -o",
            )),
        };
    };
    let manifest = read(&text).ok_or_else(|| {
        DatasetError::refused(
            format!("{to}/{MANIFEST} is not one of Meshtone"),
            "name another directory with -o",
        )
    })?;
    check_same(plan, to, &manifest)?;
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
    if manifest.plan != plan.hash().to_string() {
        let problem = format!("the data set in {to} was begun with another plan");
        let help =
            format!("{} there is that plan; name another directory for this one with -o", PlanFile::NAMES[0]);
        return Err(DatasetError::refused(problem, help));
    }
    Ok(())
}

/// The names of all files.
pub(crate) fn names(to: &Destination) -> Result<Vec<String>, DatasetError> {
    to.names()
}

fn is_of_a_data_set(name: &str) -> bool {
    let known = [MANIFEST, CARD].into_iter().chain(PREVIEW).chain(PlanFile::NAMES);
    let shard = || {
        let number = name.strip_prefix(FOLDER)?.strip_prefix("/records-")?.strip_suffix(".parquet")?;
        (!number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit())).then_some(())
    };
    known.into_iter().any(|known| known == name) || shard().is_some()
}

/// Writes a file unless one with the same content is there.
fn write_new(to: &Destination, name: &str, text: &str) -> Result<(), DatasetError> {
    if to.text(name)?.as_deref() == Some(text) { Ok(()) } else { to.write_bytes(name, text.as_bytes()) }
}

/// What a manifest says about its plan.
pub(crate) struct ReadManifest {
    pub plan: String,
    pub version: String,
    pub complete: bool,
}

pub(crate) fn read(text: &str) -> Option<ReadManifest> {
    let value: Value = serde_json::from_str(text).ok()?;
    let field = |key: &str| Some(value.get(key)?.as_str()?.to_owned());
    Some(ReadManifest {
        plan: field("plan_sha256")?,
        version: field("meshtone_version")?,
        complete: value.get("complete")?.as_bool()?,
    })
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

/// The manifest of a complete data set.
pub(crate) fn complete(plan: &Plan, shards: Shards, contents: &Contents) -> String {
    let mut manifest = head(plan, true);
    let table = |counts: &BTreeMap<(String, String), u64>| {
        let mut splits: Map<String, Value> = Map::new();
        for ((split, label), count) in counts {
            let entry = splits.entry(split.clone()).or_insert_with(|| Value::Object(Map::new()));
            if let Value::Object(labels) = entry {
                labels.insert(label.clone(), json!(count));
            }
        }
        Value::Object(splits)
    };
    manifest.insert("records_per_shard".into(), json!(shards.records_per_shard));
    manifest.insert("units_of_split".into(), json!(contents.units_of_split));
    manifest.insert("counts".into(), table(&contents.counts));
    let failures = contents.failures.iter().map(|f| json!({ "record": f.record, "reason": f.reason }));
    manifest.insert("failures".into(), failures.collect());
    let files = contents.files.iter().map(
        |file| json!({ "name": file.name, "bytes": file.bytes, "sha256": file.sha256, "rows": file.rows }),
    );
    manifest.insert("files".into(), files.collect());
    text(&manifest)
}

fn text(manifest: &Map<String, Value>) -> String {
    // Plain values can always be written.
    let mut text = serde_json::to_string_pretty(manifest).unwrap_or_default();
    text.push('\n');
    text
}

/// An error of a plan that was found after reading it.
pub(crate) fn plan_error(plan: &Plan, error: impl Into<meshtone_toml::TomlError>) -> DatasetError {
    let path = plan.sources.first().cloned().unwrap_or_default();
    let text = plan.files.first().map(|file| file.text.clone()).unwrap_or_default();
    DatasetError::Plan(ReadScenarioError::Invalid { path, text, error: Box::new(error.into()) })
}
