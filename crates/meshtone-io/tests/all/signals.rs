//! Signals and summaries, written and read back.
#![allow(clippy::unwrap_used)]

use std::fs::{self, File};
use std::io::{self, Write};

use crate::parquet_help::{Plain, parquet};
use meshtone::scenario::{GearPair, Scenario, Sensor};
use meshtone::sensor::{Channels, SensorSignal};
use meshtone_io::ReadResultsError;
use meshtone_io::run_identity::RunIdentity;
use meshtone_io::signals::{RATE_KEY, RUN_KEY, SCENARIO_KEY, read_signals, write_signals};
use meshtone_io::table::{CellType, Cells, TableColumn, TableReader, TableWriter};
use parquet::basic::{Compression, Encoding};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use tempfile::tempdir;

fn scenario() -> Scenario {
    Scenario::new(GearPair { pinion_teeth: 20, gear_teeth: 40, ..GearPair::example() })
}

/// More rows than are written at once, with numbers that only exact writing keeps.
fn channels() -> Channels {
    let signal = |scale: f64| (0..70_000).map(|i| scale * (f64::from(i) / 3.0).sin()).collect::<Vec<_>>();
    let mut channels = Channels::default();
    channels.sampling_rate_hz = 258_400.0;
    channels.start_s = 0.95;
    channels.horizontal_g = signal(1.0);
    channels.vertical_g = signal(1e-300);
    channels.axial_g = vec![-0.0; 70_000];
    channels.pinion_shaft_speed_hz = signal(40.0);
    channels.gear_shaft_speed_hz = signal(17.0);
    channels.mesh_force_n = signal(1e9);
    channels
}

fn refused(path: &std::path::Path, metadata: Vec<KeyValue>, words: &str) {
    fs::write(path, parquet(vec![("time_s", Plain::Single(vec![Some(1.0)]))], metadata)).unwrap();
    let error = read_signals(path).unwrap_err();
    assert!(matches!(error, ReadResultsError::Foreign { .. }));
    assert!(error.to_string().contains(words), "{error}");
}

#[test]
fn signals_are_read_back_exactly() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("signals.parquet");
    write_signals(File::create(&path).unwrap(), &scenario(), &channels()).unwrap();
    let recorded = read_signals(&path).unwrap();
    assert_eq!((recorded.scenario, recorded.channels), (scenario(), channels()));
    assert_eq!(recorded.run, RunIdentity::of(&scenario()));
    assert_eq!(recorded.version, env!("CARGO_PKG_VERSION"));
}

#[test]
fn files_of_others_are_refused() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("signals.parquet");
    refused(&path, Vec::new(), "has no metadata meshtone.scenario");
    let text = |key: &str, value: &str| KeyValue::new(key.to_string(), value.to_string());
    let written =
        [text("meshtone.version", "0.1.0"), text(RUN_KEY, "00000000000000ff"), text(RATE_KEY, "1000.0")];
    let broken = [written.to_vec(), vec![text(SCENARIO_KEY, "seed = -1")]].concat();
    refused(&path, broken, "seed = -1");
    let good = || vec![text(SCENARIO_KEY, &scenario().to_toml()), text("meshtone.version", "0.1.0")];
    refused(&path, good(), "has no metadata meshtone.run");
    let wrong_run = [good(), vec![text(RUN_KEY, "7")]].concat();
    refused(&path, wrong_run, "`7` is no run's identity; must be 16 hexadecimal digits");
    let good = || [good(), vec![text(RUN_KEY, "00000000000000ff")]].concat();
    let wrong_rate = [good(), vec![text(RATE_KEY, "fast")]].concat();
    refused(&path, wrong_rate, "is `fast`; must be a number above 0");
    let single = [good(), vec![text(RATE_KEY, "1000.0")]].concat();
    refused(&path, single, "column time_s of Float32; must be of Float64");
}

#[test]
fn cut_files_are_refused() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("signals.parquet");
    let mut bytes = Vec::new();
    write_signals(&mut bytes, &scenario(), &channels()).unwrap();
    fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
    let error = read_signals(&path).unwrap_err();
    assert!(error.to_string().contains("not a whole Parquet file"), "{error}");
    let error = read_signals(&directory.path().join("absent")).unwrap_err();
    assert!(matches!(error, ReadResultsError::Unreadable { .. }));
}

#[test]
fn columns_of_one_name_are_refused_before_anything_is_written() {
    let column = || TableColumn {
        name: "speed".into(),
        cells: CellType::Float64,
        nullable: false,
        metadata: Vec::new(),
    };
    let mut file = Vec::new();
    let refused = TableWriter::new(&mut file, vec![column(), column()], WriterProperties::builder().build());
    assert!(refused.map(drop).unwrap_err().to_string().contains("two columns are called speed"));
    assert!(file.is_empty());
}

fn signal_file(to: impl Write + Send, cells: Cells, statistics: EnabledStatistics) -> io::Result<()> {
    let column = TableColumn {
        name: "vertical_g".into(),
        cells: CellType::Float64,
        nullable: false,
        metadata: Vec::new(),
    };
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_dictionary_enabled(false)
        .set_encoding(Encoding::BYTE_STREAM_SPLIT)
        .set_statistics_enabled(statistics)
        .build();
    let mut table = TableWriter::new(to, vec![column], properties)?;
    table.write_rows(vec![cells])?;
    table.close()
}

/// Single cells go through the library's encoder, signals through our own.
#[test]
fn signals_are_split_as_the_library_splits_them() {
    let wave = |row: usize| (row as f64).sin() + if row.is_multiple_of(1000) { f64::NAN } else { 0.0 };
    let (time, nowhere) = (|row: usize| row as f64 / 3.0, |_: usize| f64::NAN);
    let signals: [&dyn Fn(usize) -> f64; 3] = [&wave, &time, &nowhere];
    for rows in [1, 63, 64, 20_479, 20_480, 20_481, 70_000] {
        for (at, statistics) in signals
            .into_iter()
            .flat_map(|at| [EnabledStatistics::None, EnabledStatistics::Chunk].map(|kind| (at, kind)))
        {
            let written = |cells: Cells| {
                let mut file = Vec::new();
                signal_file(&mut file, cells, statistics).unwrap();
                file
            };
            let library = written(Cells::Float64((0..rows).map(|row| Some(at(row))).collect()));
            let signal: Vec<f64> = (0..rows).map(at).collect();
            assert!(library == written(Cells::Signal(&signal)), "{rows} rows, {statistics:?}");
        }
    }
}

/// A disk with room for some bytes.
struct Full {
    room: usize,
}

impl Write for Full {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.room = self.room.checked_sub(bytes.len()).ok_or(io::ErrorKind::StorageFull)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_full_disk_is_reported_wherever_it_happens() {
    let signal = vec![1.0; 30_000];
    let mut file = Vec::new();
    let write =
        |to: &mut (dyn Write + Send)| signal_file(to, Cells::Signal(&signal), EnabledStatistics::None);
    write(&mut file).unwrap();
    write(&mut Full { room: file.len() }).unwrap();
    for room in [0, 4, file.len() / 2, file.len() - 1] {
        let error = write(&mut Full { room }).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::StorageFull, "{room} of {}", file.len());
    }
}

/// Sensors come first, in their order, and are read back by the scenario's names.
#[test]
fn sensors_are_the_first_columns() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("signals.parquet");
    let mut second = Sensor::default();
    second.name = Some("casing".into());
    let scenario = scenario().with_sensors(vec![Sensor::default(), second]);
    let mut channels = channels();
    let signal = |name: &str, value: f64| SensorSignal { name: name.into(), values_g: vec![value; 70_000] };
    channels.sensors = vec![signal("pinion_support_vertical", 1.5), signal("casing", -2.5)];
    write_signals(File::create(&path).unwrap(), &scenario, &channels).unwrap();
    let table = TableReader::new(File::open(&path).unwrap()).unwrap();
    let names: Vec<&str> = table.columns().iter().map(|column| column.name.as_str()).collect();
    assert_eq!(names[..4], ["time_s", "pinion_support_vertical_g", "casing_g", "horizontal_g"]);
    assert_eq!(names.len(), 9);
    let recorded = read_signals(&path).unwrap();
    assert_eq!((recorded.scenario, recorded.channels), (scenario, channels));
}
