//! Finishing a data set: its data card, preview, Croissant metadata and manifest.

use meshtone_plot::dataset::{DatasetPreview, Example, PreviewColumn, dataset_figure};

use crate::card;
use crate::contents::{Contents, SampledRecord, SummaryColumns};
use crate::croissant;
use crate::digest::Digest;
use crate::error::DatasetError;
use crate::manifest::{self, CARD, CROISSANT, Document, MANIFEST, PREVIEW};
use crate::plan::{Class, Plan, column_part};
use crate::shard::{self, Column, Shards, Topic, Wanted};
use crate::store::{Destination, Files};
use crate::words::{counted, words_of};

/// Signals of an average that a preview shows, the first that is kept.
const SHOWN: [&str; 2] = ["difference_g", "average_g"];

/// A data set whose shards are all there and known.
#[derive(Clone, Copy)]
pub(crate) struct Finished<'a> {
    pub plan: &'a Plan,
    pub shards: &'a Shards<'a>,
    pub contents: &'a Contents,
    pub columns: &'a [Column],
}

impl Finished<'_> {
    /// Number of records, without those that failed.
    pub fn records(&self) -> u64 {
        self.plan.records() - self.contents.failures.len() as u64
    }
}

/// Writes data card, preview, Croissant metadata and manifest of a data set whose shards are all there. Returns what these hold.
pub(crate) fn finish(
    plan: &Plan,
    shards: &Shards,
    to: &Destination,
    files: &Files,
) -> Result<Contents, DatasetError> {
    let columns = shard::columns(plan);
    let summary_columns = SummaryColumns::new(&columns, shards);
    let contents = Contents::scan(plan, &summary_columns, shards, to, files)?;
    if let (0, Some(first)) = (contents.rows(), contents.failures.values().next()) {
        return Err(DatasetError::NoRecord { records: plan.records(), first: first.clone() });
    }
    let set = Finished { plan, shards, contents: &contents, columns: &columns };
    let figure = dataset_figure(&preview(&set, &summary_columns, to));
    let mut documents = Vec::new();
    let write = |documents: &mut Vec<Document>, name: &str, bytes: &[u8]| {
        documents.push(Document { name: name.to_owned(), digest: Digest::of(bytes) });
        documents.sort_by(|a, b| a.name.cmp(&b.name));
        to.write_bytes(name, bytes)
    };
    write(&mut documents, PREVIEW[0], figure.svg().as_bytes())?;
    write(&mut documents, PREVIEW[1], &figure.png()?)?;
    write(&mut documents, CARD, card::card(&set).as_bytes())?;
    plan.files.iter().try_for_each(|file| write(&mut documents, file.name, file.text.as_bytes()))?;
    let metadata = croissant::metadata(&set, &documents);
    write(&mut documents, CROISSANT, metadata.as_bytes())?;
    // The manifest is written last: a data set with it has everything.
    to.write_bytes(MANIFEST, manifest::complete(&set, &documents).as_bytes())?;
    Ok(contents)
}

/// What the preview of a data set shows: an example of each class, the keys that vary, and the indicators.
///
/// Keys and indicators are those of a sample of the records, which the summary has kept while the records were made; only the examples are
/// read from shards. An example's signal is the difference signal or else the average, in which damage is seen best, and a raw signal where
/// neither is kept.
fn preview(set: &Finished, summary_columns: &SummaryColumns<'_>, to: &Destination) -> DatasetPreview {
    let Finished { plan, shards, contents, columns } = *set;
    let sampled: Vec<&SampledRecord> = contents.sampled.values().collect();
    let shown_column = |column: &Column| {
        let place = summary_columns.sampled.iter().position(|sampled| *sampled == column.name)?;
        let values = sampled.iter().map(|record| record.values[place]).collect();
        Some(PreviewColumn { name: words_of(&column.name), values })
    };
    let classes = &plan.content.classes;
    let labels: Vec<String> = classes.iter().map(|class| class.label.clone()).collect();
    let of_name =
        |name: &str| columns.iter().find(|column| column.topic == Topic::Revolution && column.name == name);
    // Damage shows in the average of its own wheel.
    let shown = |class: &Class| {
        let keep = &plan.content.keep;
        let damaged = class.faults.first().and_then(|fault| Some(&fault.teeth()?.wheel));
        let averaged = keep.wheel.all().iter().find(|wheel| damaged == Some(*wheel));
        let prefix = keep.wheel.prefix(averaged.unwrap_or(&keep.wheel.all()[0]));
        let of_revolution = SHOWN.iter().find_map(|name| of_name(&format!("{prefix}{name}")));
        of_revolution.or_else(|| columns.iter().find(|column| column.is_signal()))
    };
    let first = classes.first().and_then(shown);
    let signal_name = SHOWN.into_iter().find(|name| first.is_some_and(|column| column.name.ends_with(name)));
    let signal_name = signal_name.or_else(|| first.map(|column| column.name.as_str()));
    let examples = classes.iter().filter_map(|class| {
        let &(shard, row) = contents.first.get(&class.label)?;
        let file = shards.name(shard);
        let read = |column: &Column| to.read_shard(&file, Wanted::Signal { column: &column.name, row }).ok();
        let signal = shown(class).and_then(read).map(|read| read.signal).unwrap_or_default();
        Some(Example { label: class.label.clone(), conditions: conditions(plan, to, &file, row), signal })
    });
    let place = |names: &[String], name: &str| names.iter().position(|other| other == name).unwrap_or(0);
    let splits: Vec<String> = plan.content.splits.names().into_iter().map(str::to_owned).collect();
    let varies = |column: &&Column| {
        let range = contents.ranges.get(&column.name);
        column.is_drawn() && range.is_some_and(|[least, largest]| least < largest)
    };
    let indicators = columns.iter().filter(|column| column.is_previewed_indicator());
    DatasetPreview {
        title: plan.about.title.clone(),
        facts: format!(
            "{} of {}, {}",
            counted(set.records(), "record"),
            counted(plan.content.units, "unit"),
            counted(contents.files.len() as u64, "shard")
        ),
        signal_name: signal_name.map_or_else(String::new, words_of),
        over_angle: plan.content.keep.over_angle.is_some()
            || first.is_some_and(|column| column.topic != Topic::Channel),
        examples: examples.collect(),
        class_of: sampled.iter().map(|record| place(&labels, &record.label)).collect(),
        split_of: sampled.iter().map(|record| place(&splits, &record.split)).collect(),
        classes: labels,
        splits,
        keys: columns.iter().filter(varies).filter_map(shown_column).collect(),
        indicators: indicators.filter_map(shown_column).collect(),
    }
}

/// Teeth, speed, load and severity of one record, in words.
fn conditions(plan: &Plan, to: &Destination, shard: &str, row: usize) -> String {
    let speed = plan.content.base.words().speed_key.trim_start_matches("operation.");
    let teeth = plan.content.base.wheel_names().into_iter().map(|wheel| column_part(wheel) + "_teeth");
    let names: Vec<String> = teeth.chain([speed, "brake_torque_nm", "severity"].map(str::to_owned)).collect();
    let wanted: Vec<&str> = names.iter().map(String::as_str).collect();
    let Ok(read) = to.read_shard(shard, Wanted::Columns(&wanted)) else { return String::new() };
    let number = |name: &&str| read.numbers(name).get(row).copied().unwrap_or(f64::NAN);
    let numbers: Vec<f64> = wanted.iter().map(number).collect();
    let (teeth, [speed, torque, severity]) = numbers.split_last_chunk().unwrap_or((&[], &[f64::NAN; 3]));
    let teeth = teeth.iter().map(f64::to_string).collect::<Vec<_>>().join("/");
    let severity = if *severity > 0.0 { format!(", severity {severity}") } else { String::new() };
    format!("{teeth} teeth, {speed:.1} Hz, {torque:.1} N m{severity}")
}
