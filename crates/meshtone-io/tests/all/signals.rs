//! Signals and summaries, written and read back.
#![allow(clippy::unwrap_used)]

use std::fs::{self, File};
use std::io::{self, Write};

use crate::parquet_help::{Plain, parquet};
use meshtone::scenario::{GearPair, Scenario, Sensor, gearbox_template};
use meshtone::sensor::{ChannelKind, Channels, NamedSignal, SignalSource};
use meshtone_io::ReadResultsError;
use meshtone_io::recording::{RecordingOptions, read_recording};
use meshtone_io::run_identity::RunIdentity;
use meshtone_io::signals::{RATE_KEY, RUN_KEY, SCENARIO_KEY, SignalFormat, SignalTable, read_signals};
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
    let values = [signal(1.0), signal(1e-300), vec![-0.0; 70_000], signal(40.0), signal(17.0), signal(1e9)];
    let named = ChannelKind::ALL.into_iter().zip(values).map(|(kind, values)| {
        let mut signal = NamedSignal::from(kind);
        signal.values = values;
        signal
    });
    Channels::new(258_400.0, 0.95, named.collect())
}

/// A sensor's signal, to stand before the others.
fn of_sensor(number: usize, name: &str, value: f64) -> NamedSignal {
    let mut signal = NamedSignal::new(name.to_owned(), SignalSource::Sensor(number));
    signal.values = vec![value; 70_000];
    signal
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
    SignalTable::of_scenario(scenario(), &channels()).write_parquet(File::create(&path).unwrap()).unwrap();
    let recorded = read_signals(&path).unwrap();
    assert_eq!((recorded.scenario, recorded.channels), (scenario(), channels()));
    assert_eq!(recorded.run, RunIdentity::of(scenario()));
    assert_eq!(recorded.version, env!("CARGO_PKG_VERSION"));
}

/// What is written is read back: bit by bit, or from WAV within half of the last of 24 bits of the full scale.
#[test]
fn signals_of_every_format_are_read_back() {
    let directory = tempdir().unwrap();
    let scenario = scenario().with_sensors(vec![Sensor::default()]);
    let mut channels = channels();
    // Not the whole number of samples a second that a WAV file's header holds.
    channels.sampling_rate_hz = 258_400.4;
    channels.signals.insert(0, of_sensor(0, "pinion_support_vertical_g", 1.5));
    let table = SignalTable::of_scenario(&scenario, &channels);
    for format in SignalFormat::ALL {
        let path = directory.path().join(format.file_name());
        assert_eq!(SignalFormat::of_path(&path), Some(format));
        table.write(File::create(&path).unwrap(), format).unwrap();
        let recording = read_recording(&path, &RecordingOptions::default()).unwrap();
        assert!((recording.sampling_rate_hz / channels.sampling_rate_hz - 1.0).abs() < 1e-9, "{format:?}");
        assert!((recording.start_s - 0.95).abs() < 1e-9, "{format:?}: {}", recording.start_s);
        assert_eq!(recording.scenario_toml.is_some(), format == SignalFormat::Parquet);
        assert_eq!(recording.channels.len(), channels.signals.len());
        for (read, signal) in recording.channels.iter().zip(&channels.signals) {
            assert_eq!((&*read.name, read.unit.as_deref()), (&*signal.name, Some(signal.unit)));
            let written = &signal.values;
            let peak = written.iter().fold(0.0_f64, |peak, value| peak.max(value.abs()));
            let allowed = if format == SignalFormat::Wav { peak * 2.0_f64.powi(-24) } else { 0.0 };
            let off = read.samples.iter().zip(written).map(|(read, written)| (read - written).abs());
            assert!(off.fold(0.0, f64::max) <= allowed, "{format:?} {}", read.name);
        }
        fs::remove_file(&path).unwrap();
    }
}

/// Another reader finds samples between −1 and 1, and the comment states what 1 means.
#[test]
fn wav_files_are_what_players_expect() {
    let mut file = io::Cursor::new(Vec::new());
    SignalTable::of_scenario(scenario(), &channels()).write(&mut file, SignalFormat::Wav).unwrap();
    let bytes = file.into_inner();
    let length = u32::from_le_bytes(bytes[4..8].try_into().unwrap());
    assert_eq!(length as usize, bytes.len() - 8);
    let text = String::from_utf8_lossy(&bytes[..1000]).into_owned();
    assert!(text.contains(r#"{"name":"pinion_shaft_speed_hz","unit":"Hz","full_scale":64.0}"#), "{text}");
    let mut reader = hound::WavReader::new(&bytes[..]).unwrap();
    let spec = reader.spec();
    assert_eq!((spec.channels, spec.sample_rate, spec.bits_per_sample), (6, 258_400, 32));
    let samples: Vec<f32> = reader.samples().map(Result::unwrap).collect();
    assert_eq!(samples.len(), 6 * 70_000);
    let largest = samples.iter().fold(0.0_f32, |most, sample| most.max(sample.abs()));
    assert!(largest > 0.9 && largest <= 1.0, "{largest}");
}

/// The names of a gearbox's signals are none of MATLAB's.
#[test]
fn signals_of_a_gearbox_have_names_that_matlab_accepts() {
    let directory = tempdir().unwrap();
    let mut gearbox = Scenario::from_toml(&gearbox_template(None)).unwrap();
    gearbox.solver.sampling_rate_hz = 2e4;
    gearbox.solver.duration_s = Some(0.2);
    let simulation = meshtone::stages(&gearbox).unwrap().simulate().unwrap();
    let table = SignalTable::of_scenario(&gearbox, &simulation.channels);
    let names = |format: SignalFormat| -> Vec<String> {
        let path = directory.path().join(format.file_name());
        table.write(File::create(&path).unwrap(), format).unwrap();
        let recording = read_recording(&path, &RecordingOptions::default()).unwrap();
        recording.channels.into_iter().map(|channel| channel.name).collect()
    };
    let written: Vec<String> =
        simulation.channels.signals.iter().map(|signal| signal.name.to_string()).collect();
    for format in [SignalFormat::Csv, SignalFormat::Npz, SignalFormat::Wav] {
        assert_eq!(names(format), written, "{format:?}");
    }
    let of_matlab = names(SignalFormat::Mat);
    assert!(of_matlab.contains(&"force_n_z1_z2".to_owned()), "{of_matlab:?}");
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
    SignalTable::of_scenario(scenario(), &channels()).write_parquet(&mut bytes).unwrap();
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
    let sensors = [of_sensor(0, "pinion_support_vertical_g", 1.5), of_sensor(1, "casing_g", -2.5)];
    channels.signals.splice(..0, sensors);
    SignalTable::of_scenario(&scenario, &channels).write_parquet(File::create(&path).unwrap()).unwrap();
    let table = TableReader::new(File::open(&path).unwrap()).unwrap();
    let names: Vec<&str> = table.columns().iter().map(|column| column.name.as_str()).collect();
    assert_eq!(names[..4], ["time_s", "pinion_support_vertical_g", "casing_g", "horizontal_g"]);
    assert_eq!(names.len(), 9);
    let recorded = read_signals(&path).unwrap();
    assert_eq!((recorded.scenario, recorded.channels), (scenario, channels));
}
