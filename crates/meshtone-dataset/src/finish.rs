//! The end of a data set: what it holds, its data card, preview and manifest.

use std::collections::BTreeMap;

use meshtone_plot::dataset::{DatasetPreview, Example, Indicator, Key, dataset_figure};

use crate::card;
use crate::draw::Sampler;
use crate::error::DatasetError;
use crate::manifest::{self, CARD, MANIFEST, PREVIEW};
use crate::plan::Plan;
use crate::shard::{self, Column, ColumnKind, FailedRecord, ReadShard, Shards, Wanted};
use crate::store::Destination;
use crate::words::counted;

/// Records that a preview shows at most.
const PREVIEWED: u64 = 4_000;
/// Indicators that a preview shows.
const INDICATORS: [&str; 4] = ["average_rms", "difference_rms", "fm4", "energy_ratio"];

/// What a data set holds.
#[derive(Debug, Default)]
pub(crate) struct Contents {
    /// Records by split and label.
    pub counts: BTreeMap<(String, String), u64>,
    /// Units in each split.
    pub units_of_split: BTreeMap<String, u64>,
    /// Records that failed.
    pub failures: Vec<FailedRecord>,
    /// All shards.
    pub files: Vec<ShardFile>,
    /// Least and largest value of each column of numbers.
    pub ranges: BTreeMap<String, [f64; 2]>,
    sampled: Sampled,
}

/// A shard's file.
#[derive(Debug)]
pub(crate) struct ShardFile {
    pub name: String,
    pub bytes: u64,
    pub sha256: String,
    pub rows: u64,
}

/// Some records, for the preview.
#[derive(Debug, Default)]
struct Sampled {
    labels: Vec<String>,
    splits: Vec<String>,
    /// By column, one value for each record.
    values: BTreeMap<String, Vec<f64>>,
    /// Shard and row of the first record of each label.
    first: BTreeMap<String, (u64, usize)>,
}

/// Writes data card, preview and manifest, where all shards are there.
pub(crate) fn finish_if_complete(
    plan: &Plan,
    shards: Shards,
    to: &Destination,
) -> Result<bool, DatasetError> {
    let names = manifest::names(to)?;
    if (0..shards.count()).any(|shard| !names.contains(&Shards::name(shard))) {
        return Ok(false);
    }
    let columns = shard::columns(plan);
    let Some(contents) = contents(plan, shards, to, &columns)? else { return Ok(false) };
    let preview = preview(plan, &contents, to, &columns);
    let figure = dataset_figure(&preview);
    let png = figure.png()?;
    to.write_bytes(PREVIEW[0], figure.svg().as_bytes())?;
    to.write_bytes(PREVIEW[1], &png)?;
    to.write_bytes(CARD, card::card(plan, shards, &contents, &columns).as_bytes())?;
    // Last: a data set with this manifest has everything.
    to.write_bytes(MANIFEST, manifest::complete(plan, shards, &contents).as_bytes())?;
    Ok(true)
}

/// Reads all shards; none where one of them is of another plan.
fn contents(
    plan: &Plan,
    shards: Shards,
    to: &Destination,
    columns: &[Column],
) -> Result<Option<Contents>, DatasetError> {
    let mut contents = Contents::default();
    let hash = plan.hash();
    let plain: Vec<&Column> = columns.iter().filter(|column| !column.kind.is_signal()).collect();
    let names: Vec<&str> = plain.iter().map(|column| column.name.as_str()).collect();
    let every = shards.records.div_ceil(PREVIEWED).max(1) as i64;
    for shard in 0..shards.count() {
        let name = Shards::name(shard);
        let read = to.shard(&name, Wanted::Columns(&names));
        let Some(read) = read.filter(|read| read.metadata.is_of(&hash, &shards.range(shard))) else {
            return Ok(None);
        };
        let (sha256, bytes) = to.sha256(&name)?;
        contents.add(&read, &plain, every, shard);
        contents.failures.extend(read.metadata.failures);
        contents.files.push(ShardFile { name, bytes, sha256, rows: read.rows });
    }
    let sampler = Sampler::new(&plan.content).map_err(|error| manifest::plan_error(plan, error))?;
    let splits = plan.content.splits.names();
    let counts = plan.content.splits.unit_counts(plan.content.units);
    debug_assert!(sampler.records() == shards.records);
    contents.units_of_split =
        splits.into_iter().map(str::to_owned).zip(counts).filter(|(_, n)| *n > 0).collect();
    Ok(Some(contents))
}

impl Contents {
    fn add(&mut self, read: &ReadShard, columns: &[&Column], every: i64, shard: u64) {
        let (labels, splits) = (read.texts("label"), read.texts("split"));
        for (label, split) in labels.iter().zip(splits) {
            *self.counts.entry((split.clone(), label.clone())).or_default() += 1;
        }
        let records = read.numbers("record");
        let chosen: Vec<usize> = (0..records.len()).filter(|&i| (records[i] as i64) % every == 0).collect();
        for (row, label) in labels.iter().enumerate() {
            self.sampled.first.entry(label.clone()).or_insert((shard, row));
        }
        for &i in &chosen {
            self.sampled.labels.push(labels[i].clone());
            self.sampled.splits.push(splits[i].clone());
        }
        for column in columns {
            let values = read.numbers(&column.name);
            if values.is_empty() {
                continue;
            }
            for &value in values.iter().filter(|value| value.is_finite()) {
                let range = self.ranges.entry(column.name.clone()).or_insert([value, value]);
                *range = [range[0].min(value), range[1].max(value)];
            }
            let sampled = self.sampled.values.entry(column.name.clone()).or_default();
            sampled.extend(chosen.iter().map(|&i| values[i]));
        }
    }
}

fn preview(plan: &Plan, contents: &Contents, to: &Destination, columns: &[Column]) -> DatasetPreview {
    let sampled = &contents.sampled;
    let classes: Vec<String> = plan.content.classes.iter().map(|class| class.label.clone()).collect();
    let shown = [ColumnKind::Difference, ColumnKind::Average]
        .iter()
        .find_map(|kind| columns.iter().find(|column| column.kind == *kind))
        .or_else(|| columns.iter().find(|column| column.kind.is_signal()));
    let examples = classes.iter().filter_map(|label| {
        let &(shard, row) = sampled.first.get(label)?;
        let signal = shown.map_or_else(Vec::new, |column| signal(to, shard, row, &column.name));
        Some(Example { label: label.clone(), conditions: conditions(to, shard, row), signal })
    });
    let place = |names: &[String], name: &str| names.iter().position(|other| other == name).unwrap_or(0);
    let splits: Vec<String> = plan.content.splits.names().into_iter().map(str::to_owned).collect();
    let keys = columns.iter().filter(|column| is_varied(column, contents)).map(|column| Key {
        name: column.name.clone(),
        values: sampled.values.get(&column.name).cloned().unwrap_or_default(),
    });
    let indicators = INDICATORS.iter().filter_map(|name| {
        let column =
            columns.iter().find(|column| column.kind == ColumnKind::Indicator((*name).to_owned()))?;
        Some(Indicator { name: column.name.clone(), values: sampled.values.get(&column.name)?.clone() })
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
        signal_name: shown.map_or_else(String::new, |column| column.name.clone()),
        over_angle: shown.is_some_and(|column| !matches!(column.kind, ColumnKind::Channel(_))),
        examples: examples.collect(),
        class_of: sampled.labels.iter().map(|label| place(&classes, label)).collect(),
        split_of: sampled.splits.iter().map(|split| place(&splits, split)).collect(),
        classes,
        splits,
        keys: keys.collect(),
        indicators: indicators.collect(),
    }
}

/// Whether a column is one of what a record is drawn with, and not the same everywhere.
fn is_varied(column: &Column, contents: &Contents) -> bool {
    let of_record = matches!(
        column.kind,
        ColumnKind::Key(_)
            | ColumnKind::PinionSpeed
            | ColumnKind::BrakeTorque
            | ColumnKind::PinionTeeth
            | ColumnKind::GearTeeth
            | ColumnKind::Severity
    );
    of_record && contents.ranges.get(&column.name).is_some_and(|[least, largest]| least < largest)
}

/// One signal of one record.
fn signal(to: &Destination, shard: u64, row: usize, column: &str) -> Vec<f64> {
    let read = to.shard(&Shards::name(shard), Wanted::Signal { column, row });
    read.map_or_else(Vec::new, |read| read.signal.iter().map(|&x| f64::from(x)).collect())
}

/// Speed, load and severity of one record, in words.
fn conditions(to: &Destination, shard: u64, row: usize) -> String {
    let names = ["pinion_teeth", "gear_teeth", "pinion_speed_hz", "brake_torque_nm", "severity"];
    let Some(read) = to.shard(&Shards::name(shard), Wanted::Columns(&names)) else { return String::new() };
    let number = |name: &str| read.numbers(name).get(row).copied().unwrap_or(f64::NAN);
    let [pinion, gear, speed, torque, severity] = names.map(number);
    let severity = if severity > 0.0 { format!(", severity {severity}") } else { String::new() };
    format!("{pinion}/{gear} teeth, {speed:.1} Hz, {torque:.1} N m{severity}")
}
