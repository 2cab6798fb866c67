//! The end of a data set: its data card, preview, Croissant metadata and manifest.

use std::collections::BTreeMap;

use meshtone_plot::dataset::{DatasetPreview, Example, Indicator, Key, dataset_figure};

use crate::card;
use crate::contents::{Contents, INDICATORS, Looked, SampledRecord, is_drawn};
use crate::croissant;
use crate::digest::Digest;
use crate::error::DatasetError;
use crate::manifest::{self, CARD, CROISSANT, MANIFEST, PREVIEW, ReadManifest};
use crate::part_list::{self, PartList};
use crate::plan::{Content, Plan, SplitBy};
use crate::shard::{self, Column, ColumnKind, FailedRecord, Shards, Wanted};
use crate::store::Destination;
use crate::words::{counted, words_of};

/// Finishes a data set where all shards are there. Returns whether it is complete.
pub(crate) fn finish_if_complete(
    plan: &Plan,
    shards: Shards,
    to: &Destination,
) -> Result<bool, DatasetError> {
    let files = to.files()?;
    let manifest = manifest::read(to)?;
    let was_complete = manifest.as_ref().is_some_and(|manifest| manifest.complete);
    let mut contents = Contents::default();
    contents.add_place(plan, to, &files, manifest.filter(ReadManifest::can_be_relied_on))?;
    let is_there =
        |shard: u64| files.contains_key(&shards.name(shard)) && contents.files.contains_key(&shard);
    if !(0..shards.count()).all(is_there) {
        // Another part may have completed it meanwhile and taken the lists away.
        return Ok(!was_complete && manifest::read(to)?.is_some_and(|manifest| manifest.complete));
    }
    contents.settle(to, shards)?;
    let has_size = |shard: u64| files.get(&shards.name(shard)) == Some(&contents.files[&shard].digest.bytes);
    if !(0..shards.count()).all(has_size) {
        return Ok(false);
    }
    finish(plan, shards, to, contents)?;
    Ok(true)
}

/// Writes data card, preview, Croissant metadata and manifest of a data set whose shards are all there and known.
pub(crate) fn finish(
    plan: &Plan,
    shards: Shards,
    to: &Destination,
    mut contents: Contents,
) -> Result<(), DatasetError> {
    let columns = shard::columns(plan);
    let looked = Looked::new(&columns, shards);
    contents.count_all(&looked, shards, to)?;
    if contents.rows() == 0
        && let Some((&record, reason)) = contents.failures.first_key_value()
    {
        let first = FailedRecord { record, reason: reason.clone() };
        return Err(DatasetError::NoRecord { records: plan.records(), first });
    }
    let figure = dataset_figure(&preview(plan, shards, &contents, &looked, to, &columns));
    let units_of_split = units_of_split(plan);
    let card = card::card(plan, shards, &contents, &units_of_split, &columns);
    let written = [
        (PREVIEW[0], figure.svg().as_bytes().to_vec()),
        (PREVIEW[1], figure.png()?),
        (CARD, card.into_bytes()),
    ];
    let mut documents: BTreeMap<&str, Digest> = BTreeMap::new();
    for (name, bytes) in &written {
        to.write_bytes(name, bytes)?;
        documents.insert(name, Digest::of(bytes));
    }
    manifest::write_plan(plan, to)?;
    documents.extend(plan.files.iter().map(|file| (file.name, Digest::of(file.text.as_bytes()))));
    let metadata = croissant::metadata(plan, shards, &units_of_split, &columns, &documents);
    to.write_bytes(CROISSANT, metadata.as_bytes())?;
    documents.insert(CROISSANT, Digest::of(metadata.as_bytes()));
    // A data set with this manifest has everything.
    to.write(MANIFEST, |file| {
        manifest::write_complete(file, plan, shards, &contents, &units_of_split, &documents)
    })?;
    // It has what the lists had.
    PartList::names(&to.files_in(part_list::FOLDER)?).try_for_each(|name| to.remove(name))
}

/// The units, or mountings, of each split that has any.
fn units_of_split(plan: &Plan) -> BTreeMap<String, u64> {
    let Content { splits, units, mountings, .. } = &plan.content;
    let counts = splits.counts(match splits.by {
        SplitBy::Unit => *units,
        SplitBy::Mounting => units * mountings,
    });
    let names = plan.content.splits.names().into_iter().map(str::to_owned);
    names.zip(counts).filter(|(_, units)| *units > 0).collect()
}

fn preview(
    plan: &Plan,
    shards: Shards,
    contents: &Contents,
    looked: &Looked<'_>,
    to: &Destination,
    columns: &[Column],
) -> DatasetPreview {
    let sampled: Vec<&SampledRecord> = contents.seen.sampled.values().collect();
    let values_of = |name: &str| {
        let place = looked.sampled.iter().position(|sampled| *sampled == name);
        place.map_or_else(Vec::new, |place| sampled.iter().map(|record| record.values[place]).collect())
    };
    let classes: Vec<String> = plan.content.classes.iter().map(|class| class.label.clone()).collect();
    let shown = [ColumnKind::Difference, ColumnKind::Average]
        .iter()
        .find_map(|kind| columns.iter().find(|column| column.kind == *kind))
        .or_else(|| columns.iter().find(|column| column.kind.is_signal()));
    let examples = classes.iter().filter_map(|label| {
        let &(shard, row) = contents.seen.first.get(label)?;
        let file = shards.name(shard);
        let signal = shown.map_or_else(Vec::new, |column| signal(to, &file, row, &column.name));
        Some(Example { label: label.clone(), conditions: conditions(to, &file, row), signal })
    });
    let place = |names: &[String], name: &str| names.iter().position(|other| other == name).unwrap_or(0);
    let splits: Vec<String> = plan.content.splits.names().into_iter().map(str::to_owned).collect();
    let keys = columns
        .iter()
        .filter(|column| is_varied(column, contents))
        .map(|column| Key { name: words_of(&column.name), values: values_of(&column.name) });
    let indicators = INDICATORS.iter().filter_map(|name| {
        let column =
            columns.iter().find(|column| column.kind == ColumnKind::Indicator((*name).to_owned()))?;
        Some(Indicator { name: words_of(&column.name), values: values_of(&column.name) })
    });
    let failures = contents.failures.len() as u64;
    DatasetPreview {
        title: plan.about.title.clone(),
        facts: format!(
            "{} of {}, {}",
            counted(plan.records() - failures, "record"),
            counted(plan.content.units, "unit"),
            counted(contents.files.len() as u64, "shard")
        ),
        signal_name: shown.map_or_else(String::new, |column| words_of(&column.name)),
        over_angle: plan.content.keep.over_angle.is_some()
            || shown.is_some_and(|column| !matches!(column.kind, ColumnKind::Channel(_))),
        examples: examples.collect(),
        class_of: sampled.iter().map(|record| place(&classes, &record.label)).collect(),
        split_of: sampled.iter().map(|record| place(&splits, &record.split)).collect(),
        classes,
        splits,
        keys: keys.collect(),
        indicators: indicators.collect(),
    }
}

/// Whether a column is one of what a record is drawn with, and not the same everywhere.
fn is_varied(column: &Column, contents: &Contents) -> bool {
    is_drawn(column) && contents.seen.ranges.get(&column.name).is_some_and(|[least, largest]| least < largest)
}

/// One signal of one record.
fn signal(to: &Destination, shard: &str, row: usize, column: &str) -> Vec<f64> {
    let read = to.read_shard(shard, Wanted::Signal { column, row });
    read.map_or_else(|_| Vec::new(), |read| read.signal.iter().map(|&x| f64::from(x)).collect())
}

/// Speed, load and severity of one record, in words.
fn conditions(to: &Destination, shard: &str, row: usize) -> String {
    let names = ["pinion_teeth", "gear_teeth", "pinion_speed_hz", "brake_torque_nm", "severity"];
    let Ok(read) = to.read_shard(shard, Wanted::Columns(&names)) else { return String::new() };
    let number = |name: &str| read.numbers(name).get(row).copied().unwrap_or(f64::NAN);
    let [pinion, gear, speed, torque, severity] = names.map(number);
    let severity = if severity > 0.0 { format!(", severity {severity}") } else { String::new() };
    format!("{pinion}/{gear} teeth, {speed:.1} Hz, {torque:.1} N m{severity}")
}
