//! Exporting a data set to the schema of the Python package `bearing-datasets` 0.3.0, version 2: a table of all signals, `metadata.parquet`,
//! their samples in `signals/`, and a manifest.
//!
//! Names and vocabularies are those of the package's module `schema`. It knows every damage of a tooth as `gear` only, so that the kind
//! stands in a column of its own; spalls of bearings have its words. No cell may be empty: of the data set's other columns, those that every record has are kept.

mod place;

use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, Write};
use std::path::{Component, Path};

use meshtone::scenario::Scenario;
use meshtone_io::table::{CellType, Cells, TableColumn, TableWriter};
use parquet::basic::{Compression, ZstdLevel};
use parquet::file::properties::WriterProperties;
use serde_json::{Map, Value, json};

use crate::croissant::citation;
use crate::digest::{Digest, Hashing};
use crate::error::DatasetError;
use crate::manifest::{self, ReadManifest};
use crate::merge::plan_of;
use crate::plan::{Class, Content, Plan, column_part};
use crate::shard::{self, Column, ReadShard, Topic, Wanted};
use crate::store::Destination;
use crate::verify::{Check, verify};
use crate::words::counted;
use place::{ChannelFacts, bearing_location, facts, is_at, wheel_location};

/// Version of the schema.
const SCHEMA_VERSION: u32 = 2;
const METADATA: &str = "metadata.parquet";
const MANIFEST: &str = "manifest.json";
/// Folder of the samples.
const SIGNALS: &str = "signals";
/// The file of all samples in single precision.
const SIGNAL_FILE: &str = "part-float32.parquet";
/// Columns whose names mean something else in the schema, with the names that they get.
const RENAMED: [(&str, &str); 2] = [("unit", "unit_id"), ("mounting", "mounting_id")];

/// The result of an export.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Exported {
    /// Number of records.
    pub recordings: u64,
    /// Number of signals: raw channels of all records.
    pub signals: u64,
}

/// Exports the raw channels of a data set to the schema of the Python package `bearing-datasets`.
///
/// # Arguments
/// * `from` - the place of the complete data set
/// * `to` - the folder to write, whose name is that of the exported data set; it must be empty or not exist
///
/// The manifest is written last. The same data set gives the same bytes.
///
/// # Errors
/// The data set is not complete, not as it was written, or keeps no raw channel; a bearing of its base scenario has a spall, which no class labels; the folder has files in it; or a file cannot be read or
/// written.
pub fn export_bearing_datasets(from: &Destination, to: &Path) -> Result<Exported, DatasetError> {
    let manifest = manifest::read_begun(from)?;
    let plan = plan_of(from)?;
    let export = Export::new(from, to, &plan, &manifest)?;
    let signals = export.write_signals()?;
    let columns = export.write_metadata(&signals)?;
    let recordings = manifest.files.iter().map(|file| file.shard.rows).sum();
    let exported = Exported { recordings, signals: signals.places.len() as u64 };
    let about = json!({
        "dataset": export.name,
        "title": plan.about.title,
        "license": plan.about.licence,
        "citation": citation(&plan.about),
        "package_version": concat!("Meshtone ", env!("CARGO_PKG_VERSION")),
        "schema_version": SCHEMA_VERSION,
        "content_hash": signals.content_hash(),
        "n_recordings": exported.recordings,
        "n_signals": exported.signals,
        "columns": columns,
        "raw_files": [],
    });
    export.to.write_bytes(MANIFEST, format!("{about:#}\n").as_bytes())?;
    Ok(exported)
}

/// An export in progress.
struct Export<'a> {
    from: &'a Destination,
    to: Destination,
    /// Name of the exported data set.
    name: String,
    content: &'a Content,
    /// Names of the shards.
    shards: Vec<&'a str>,
    /// Columns of the data set.
    columns: Vec<Column>,
    /// The facts about each raw channel.
    channels: Vec<ChannelFacts>,
}

/// The name of a folder, also of one that is named by its place, such as `.`; none of the root.
fn name_of(folder: &Path) -> Option<String> {
    let whole = std::path::absolute(folder).ok()?;
    Some(
        whole
            .components()
            .next_back()
            .filter(|last| matches!(last, Component::Normal(_)))?
            .as_os_str()
            .to_string_lossy()
            .into_owned(),
    )
}

/// Refuses a base scenario whose bearings have spalls, because its healthy records would be exported as `normal`.
fn refuse_spalls(base: &Scenario) -> Result<(), DatasetError> {
    let Some(bearing) = base.bearings().iter().find(|bearing| !bearing.defect.is_empty()) else {
        return Ok(());
    };
    Err(DatasetError::refused(
        format!(
            "bearing[{}] of the base scenario has a spall, and healthy records would be exported as \"normal\"",
            bearing.seat_name()
        ),
        "export a data set whose bearings have spalls in its classes alone, where they are labels: fault = { bearing = … }",
    ))
}

/// The facts about the signals that have been written.
#[derive(Default)]
struct WrittenSignals {
    /// Group of rows and row of each signal, in the order of the records and their channels.
    places: Vec<[i64; 2]>,
    /// Numbers of samples, likewise.
    samples: Vec<i64>,
    /// SHA-256 of type and samples by the names of the signals.
    digests: BTreeMap<String, Digest>,
}

impl WrittenSignals {
    /// The package's hash of all signals.
    fn content_hash(&self) -> String {
        let lines = self.digests.iter().map(|(name, digest)| format!("{name}:{}\n", digest.sha256));
        Digest::of(lines.collect::<String>().as_bytes()).sha256.to_string()
    }
}

impl<'a> Export<'a> {
    fn new(
        from: &'a Destination,
        to: &Path,
        plan: &'a Plan,
        manifest: &'a ReadManifest,
    ) -> Result<Self, DatasetError> {
        let found = verify(from, Check::Sizes)?;
        if !found.complete || !found.is_good() {
            let problem = format!("the data set in {from} is not complete, or not as it was written");
            return Err(DatasetError::refused(
                problem,
                "run the command that made it again: it continues the set",
            ));
        }
        if to.read_dir().is_ok_and(|mut files| files.next().is_some()) {
            let problem = format!("{} has files in it", to.display());
            return Err(DatasetError::refused(
                problem,
                "name a directory that is empty or does not exist with -o",
            ));
        }
        let content = &plan.content;
        let channels: Vec<ChannelFacts> =
            content.keep.channels.iter().map(|channel| facts(channel, &content.base)).collect();
        if channels.is_empty() {
            let problem =
                format!("the data set in {from} keeps no raw channels, which are the signals of this schema");
            return Err(DatasetError::refused(problem, "name some in keep.channels of the plan"));
        }
        refuse_spalls(&content.base)?;
        Ok(Self {
            from,
            to: Destination::directory(to),
            name: name_of(to).ok_or_else(|| {
                let problem =
                    format!("the folder {} has no name, which is the name of the data set", to.display());
                DatasetError::refused(problem, "name another folder")
            })?,
            content,
            shards: manifest.files.iter().map(|file| file.name.as_str()).collect(),
            columns: shard::columns(plan),
            channels,
        })
    }

    fn read(&self, shard: &str, wanted: Wanted) -> io::Result<ReadShard> {
        let read = self.from.read_shard(shard, wanted);
        read.map_err(|error| io::Error::new(error.kind(), format!("{}: {error}", self.from.name_of(shard))))
    }

    /// Writes the samples of all channels of all records: groups of rows as the shards have them.
    fn write_signals(&self) -> Result<WrittenSignals, DatasetError> {
        let columns = || {
            vec![
                TableColumn::new("signal_id", CellType::Text),
                TableColumn::new("signal", CellType::Float32List),
            ]
        };
        self.to.write(&format!("{SIGNALS}/{SIGNAL_FILE}"), |file| {
            let mut table = TableWriter::new(file, columns(), properties()?)?;
            let (mut written, mut groups) = (WrittenSignals::default(), 0);
            for shard in &self.shards {
                let read = self.read(shard, Wanted::Columns(&["record"]))?;
                let mut records = read.numbers("record").iter();
                for group in 0..read.groups {
                    let of_channel = |channel: &ChannelFacts| {
                        let wanted = Wanted::Group { column: &channel.name, group };
                        Ok(self
                            .read(shard, wanted)?
                            .signals
                            .into_iter()
                            .map(|signal| signal.iter().map(|&x| x as f32).collect())
                            .collect())
                    };
                    let channels: Vec<Vec<Vec<f32>>> =
                        self.channels.iter().map(of_channel).collect::<io::Result<_>>()?;
                    let (mut names, mut signals) = (Vec::new(), Vec::new());
                    for (row, record) in (0..channels[0].len()).zip(&mut records) {
                        for (of_channel, channel) in channels.iter().zip(&self.channels) {
                            let name = format!("{}/{}", recording(*record), channel.name);
                            written.places.push([groups, signals.len() as i64]);
                            written.samples.push(of_channel[row].len() as i64);
                            written.digests.insert(name.clone(), digest(&of_channel[row])?);
                            names.push(Some(name));
                            signals.push(&of_channel[row][..]);
                        }
                    }
                    table.write_rows(vec![Cells::Text(names), Cells::Float32List(signals)])?;
                    groups += 1;
                }
            }
            table.close()?;
            Ok(written)
        })
    }

    /// Writes the table of all signals. Returns the meaning of each of its columns.
    fn write_metadata(&self, signals: &WrittenSignals) -> Result<Map<String, Value>, DatasetError> {
        let names: Vec<&str> = self
            .columns
            .iter()
            .filter(|column| !column.is_signal())
            .map(|column| column.name.as_str())
            .collect();
        let others = self.others(&names).map_err(DatasetError::read(self.from.to_string()))?;
        let mut meanings = Map::new();
        self.to.write(METADATA, |file| {
            let mut table: Option<TableWriter<_>> = None;
            let (mut file, mut first) = (Some(file), 0);
            for shard in &self.shards {
                let read = self.read(shard, Wanted::Columns(&names))?;
                let rows = self.rows(&read, signals, first, &others);
                first += read.rows as usize * self.channels.len();
                if let Some(file) = file.take() {
                    meanings = rows.iter().map(|row| (row.name.to_owned(), json!(row.meaning))).collect();
                    let columns = rows.iter().map(|row| TableColumn::new(&row.name, row.cell_type));
                    table = Some(TableWriter::new(file, columns.collect(), properties()?)?);
                }
                if let (Some(table), true) = (&mut table, read.rows > 0) {
                    table.write_rows(rows.into_iter().map(|row| row.cells).collect())?;
                }
            }
            table.map_or(Ok(()), TableWriter::close)
        })?;
        Ok(meanings)
    }

    /// Columns of the data set that every record has and that the schema has no own column for.
    fn others(&self, names: &[&str]) -> io::Result<Vec<&Column>> {
        let is_other = |column: &&Column| {
            let own = column.name.starts_with("fault") || column.name == "label";
            !column.is_signal() && !own && !matches!(column.topic, Topic::Indicator { .. })
        };
        let mut empty: BTreeSet<&str> = BTreeSet::new();
        for shard in &self.shards {
            let read = self.read(shard, Wanted::Columns(names))?;
            empty.extend(names.iter().copied().filter(|name| read.numbers(name).iter().any(|x| x.is_nan())));
        }
        Ok(self
            .columns
            .iter()
            .filter(is_other)
            .filter(|column| !empty.contains(&column.name.as_str()))
            .collect())
    }
}

/// A column of the table of signals, in the rows of a shard.
struct MetadataColumn {
    name: String,
    meaning: String,
    cell_type: CellType,
    cells: Cells<'static>,
}

impl Export<'_> {
    /// Makes the rows of a shard's signals, in the order in which the signals were written. The columns stand in the order of the schema;
    /// those that only Meshtone has come last.
    fn rows(
        &self,
        read: &ReadShard,
        signals: &WrittenSignals,
        first: usize,
        others: &[&Column],
    ) -> Vec<MetadataColumn> {
        let (records, channels) = (read.rows as usize, self.channels.len());
        let count = records * channels;
        let text = |name: &str, meaning: &str, of: &dyn Fn(usize, &ChannelFacts) -> String| {
            let cells = (0..count).map(|row| Some(of(row / channels, &self.channels[row % channels])));
            column(name, meaning, CellType::Text, Cells::Text(cells.collect()))
        };
        let number = |name: &str, meaning: &str, of: &dyn Fn(usize) -> f64| {
            let cells = (0..count).map(|row| Some(of(row / channels)));
            column(name, meaning, CellType::Float64, Cells::Float64(cells.collect()))
        };
        let whole = |name: &str, meaning: &str, of: &dyn Fn(usize) -> i64| {
            let cells = (0..count).map(|row| Some(of(row)));
            column(name, meaning, CellType::Int64, Cells::Int64(cells.collect()))
        };
        let faults: Vec<Vec<ReadFault>> = (0..records).map(|record| faults_of(read, record)).collect();
        let joined = |record: usize, healthy: &str, of: &dyn Fn(&ReadFault) -> String| {
            let parts: Vec<String> = faults[record].iter().map(of).collect();
            if parts.is_empty() { healthy.to_owned() } else { parts.join("+") }
        };
        let location = |fault: &ReadFault| fault.location(&self.content.base);
        let or_none = |part: &Option<String>| part.clone().unwrap_or_else(|| "none".to_owned());
        let at_fault = (0..count).map(|row| {
            let sensor = &self.channels[row % channels].location;
            faults[row / channels].iter().any(|fault| is_at(sensor, &location(fault)))
        });
        let record_number = read.numbers("record");
        let recording_of = |record: usize| recording(record_number[record]);
        let label = read.texts("label");
        let grade = read.numbers("severity");
        let level = |row: usize| {
            if faults[row / channels].is_empty() { 0 } else { (grade[row / channels] as i64).max(1) }
        };
        let speed = self.content.base.speed_key().trim_start_matches("operation.");
        let (speed_hz, torque_nm) = (read.numbers(speed), read.numbers("brake_torque_nm"));
        let rate_hz = self.sampling_rates(read);
        let profile = if self.content.base.operation.is_steady() { "constant" } else { "varying" };
        let place = |row: usize| signals.places[first + row];
        let mut rows = vec![
            text("dataset", "name of the data set", &|_, _| self.name.clone()),
            text("signal_id", "the signal: one channel of one record", &|record, channel| {
                format!("{}/{}", recording_of(record), channel.name)
            }),
            text("recording_id", "the record", &|record, _| recording_of(record)),
            text("native_label", "the class of the plan", &|record, _| label[record].clone()),
            text("channel", "column of the channel", &|_, channel| channel.name.clone()),
            text("sensor_location", "where the sensor sits", &|_, channel| channel.location.clone()),
            number(
                "fs",
                "sampling rate in Hz; of channels over the angle at the speed of the record",
                &|record| rate_hz[record],
            ),
            whole("n_samples", "number of samples", &|row| signals.samples[first + row]),
            text(
                "fault_type",
                "gear for every damaged tooth; outer, inner or rolling_element of a bearing, '+'-joined; 'normal' if healthy",
                &|record, _| joined(record, "normal", &|fault| fault.schema_type().to_owned()),
            ),
            text(
                "fault_location",
                "where the damaged wheel or bearing sits, '+'-joined; 'none' if healthy",
                &|record, _| joined(record, "none", &location),
            ),
            column(
                "sensor_at_fault",
                "whether sensor_location is or contains fault_location, or the reverse",
                CellType::Boolean,
                Cells::Boolean(at_fault.collect()),
            ),
            text("signal_file", "file in signals/ that has the samples", &|_, _| SIGNAL_FILE.to_owned()),
            whole("signal_row_group", "its group of rows", &|row| place(row)[0]),
            whole("signal_row", "row in that group", &|row| place(row)[1]),
            text("quantity", "quantity that is measured", &|_, channel| channel.quantity.to_owned()),
            text("unit", "unit of the samples", &|_, channel| channel.unit.to_owned()),
            text("axis", "direction of the measurement", &|_, channel| channel.axis.to_owned()),
            text("sensor_mounting", "what the sensor is on", &|_, channel| channel.mounting.to_owned()),
            number("speed_rpm", "speed of the driving shaft, as the record was drawn", &|record| {
                60.0 * speed_hz[record]
            }),
            text("speed_profile", "how the speed changes during the record", &|_, _| profile.to_owned()),
            number("load", "brake torque on the output shaft, in load_unit", &|record| torque_nm[record]),
            text("load_unit", "unit of load", &|_, _| "Nm".to_owned()),
            text("fault_origin", "artificial for every damage; 'none' if healthy", &|record, _| {
                if faults[record].is_empty() { "none" } else { "artificial" }.to_owned()
            }),
            text(
                "fault_severity",
                "severity from 0 to 1 on the scale of the kind of damage, which Meshtone's guide defines; 'none' if healthy",
                &|record, _| joined(record, "none", &ReadFault::severity_words),
            ),
            whole(
                "fault_severity_level",
                "grade of the severity, as the plan divides it; 0 if healthy",
                &level,
            ),
            text("fault_kind", "kind of damage, '+'-joined; 'none' if healthy", &|record, _| {
                joined(record, "none", &|fault| fault.kind.clone())
            }),
            text(
                "fault_wheel",
                "the damaged wheel, '+'-joined; 'none' if healthy, and of a bearing",
                &|record, _| joined(record, "none", &|fault| or_none(&fault.wheel)),
            ),
        ];
        if self.content.classes.iter().any(Class::has_damaged_bearing) {
            let meaning =
                "the damaged bearing by its shaft and place, '+'-joined; 'none' if healthy, and of a wheel";
            rows.push(text("fault_bearing", meaning, &|record, _| {
                joined(record, "none", &|fault| or_none(&fault.bearing))
            }));
        }
        rows.extend(others.iter().map(|other| {
            let name =
                RENAMED.iter().find(|(old, _)| *old == other.name).map_or(&other.name[..], |(_, new)| new);
            let (values, meaning) = (read.numbers(&other.name), &other.description);
            match other.cell_type {
                CellType::Text => text(name, meaning, &|record, _| read.texts(&other.name)[record].clone()),
                CellType::Int32 | CellType::Int64 => {
                    whole(name, meaning, &|row| values[row / channels] as i64)
                }
                _ => number(name, meaning, &|record| values[record]),
            }
        }));
        rows
    }

    /// (Hz) Sampling rate of each record; of channels over the angle at the record's constant speed.
    fn sampling_rates(&self, read: &ReadShard) -> Vec<f64> {
        let keep = &self.content.keep;
        let Some(angle) = keep.over_angle else { return read.numbers("sampling_rate_hz").to_vec() };
        let speed = format!("{}_speed_hz", column_part(keep.wheel.all()[0].name()));
        read.numbers(&speed).iter().map(|speed_hz| speed_hz * angle.points_per_revolution as f64).collect()
    }
}

fn column(name: &str, meaning: &str, cell_type: CellType, cells: Cells<'static>) -> MetadataColumn {
    MetadataColumn { name: name.to_owned(), meaning: meaning.to_owned(), cell_type, cells }
}

/// A fault of a record.
struct ReadFault {
    kind: String,
    wheel: Option<String>,
    bearing: Option<String>,
    severity: f64,
}

impl ReadFault {
    /// The schema's word for its kind.
    fn schema_type(&self) -> &'static str {
        match self.kind.as_str() {
            "outer-race" => "outer",
            "inner-race" => "inner",
            "rolling-element" => "rolling_element",
            _ => "gear",
        }
    }

    /// Where the damaged part sits, in the schema's words.
    fn location(&self, base: &Scenario) -> String {
        match (&self.wheel, &self.bearing) {
            (_, Some(bearing)) => bearing_location(bearing, base),
            (wheel, None) => wheel_location(wheel.as_deref().unwrap_or_default(), base),
        }
    }

    fn severity_words(&self) -> String {
        if self.severity.is_nan() { "not graded".to_owned() } else { format!("{:.3}", self.severity) }
    }
}

/// The faults of a record; none of a healthy one.
fn faults_of(read: &ReadShard, record: usize) -> Vec<ReadFault> {
    let prefixes =
        (1..).map(|number| if number == 1 { "fault".to_owned() } else { format!("fault_{number}") });
    let fault = |prefix: String| {
        let text = |name: &str| {
            let texts = read.texts(&format!("{prefix}_{name}"));
            texts.get(record).filter(|text| !text.is_empty()).cloned()
        };
        let severity = read.numbers(&format!("{prefix}_severity")).get(record).copied();
        let kind = text("kind")?;
        let severity = severity.unwrap_or(f64::NAN);
        Some(ReadFault { kind, wheel: text("wheel"), bearing: text("bearing"), severity })
    };
    prefixes.map_while(fault).collect()
}

/// The name of a record.
fn recording(record: f64) -> String {
    format!("record-{record}")
}

fn digest(signal: &[f32]) -> io::Result<Digest> {
    let mut hashing = Hashing::new(io::sink());
    hashing.write_all(b"float32")?;
    signal.iter().try_for_each(|value| hashing.write_all(&value.to_le_bytes()))?;
    Ok(hashing.digest())
}

fn properties() -> io::Result<WriterProperties> {
    let compression = ZstdLevel::try_new(1).map(Compression::ZSTD).map_err(io::Error::other)?;
    Ok(WriterProperties::builder().set_compression(compression).build())
}

impl std::fmt::Display for Exported {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { recordings, signals } = *self;
        write!(formatter, "{} of {}", counted(signals, "signal"), counted(recordings, "record"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use meshtone::scenario::{Bearing, BearingDefect, DefectPlace, Operation, Scenario};

    #[test]
    fn records_with_a_spall_are_not_exported_as_normal() {
        let mut bearing = Bearing::new("input", 0.5);
        let base = |bearing: &Bearing| {
            let operation = Operation::new(25.0, 10.0);
            Scenario::of_shafts(vec![], vec![], vec![], vec![bearing.clone()], operation)
        };
        assert!(refuse_spalls(&base(&bearing)).is_ok());
        bearing.defect.push(BearingDefect::new(DefectPlace::Outer, 0.2));
        let refused = refuse_spalls(&base(&bearing)).unwrap_err().to_string();
        assert!(refused.contains("bearing[input:0.5] of the base scenario has a spall"), "{refused}");
    }
}
