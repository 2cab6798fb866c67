//! Signals and summaries, written and read back.
#![allow(clippy::unwrap_used)]

use std::fs::{self, File};
use std::io::{self, Write};

use meshtone::scenario::{GearPair, Scenario, Sensor, gearbox_template};
use meshtone::sensor::{ChannelKind, Channels, NamedSignal, SignalSource};
use meshtone_io::recording::{RecordingOptions, read_recording};
use meshtone_io::run_identity::RunIdentity;
use meshtone_io::signals::{RUN_KEY, SCENARIO_KEY, SignalFormat, SignalTable};
use meshtone_io::table::{CellType, Cells, TableColumn, TableReader, TableWriter};
use parquet::file::properties::WriterProperties;
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

fn signal_file(to: impl Write + Send, signal: &[f64]) -> io::Result<()> {
    let column = TableColumn {
        name: "vertical_g".into(),
        cells: CellType::Float64,
        nullable: false,
        metadata: Vec::new(),
    };
    let mut table = TableWriter::new(to, vec![column], WriterProperties::builder().build())?;
    table.write_rows(vec![Cells::Signal(signal)])?;
    table.close()
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
    let signal: Vec<f64> = (0..30_000).map(f64::from).collect();
    let mut file = Vec::new();
    signal_file(&mut file, &signal).unwrap();
    signal_file(&mut Full { room: file.len() }, &signal).unwrap();
    for room in [0, 4, file.len() / 2, file.len() - 1] {
        let error = signal_file(&mut Full { room }, &signal).unwrap_err();
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
    SignalTable::of_scenario(&scenario, &channels)
        .write(File::create(&path).unwrap(), SignalFormat::Parquet)
        .unwrap();
    let table = TableReader::new(File::open(&path).unwrap()).unwrap();
    let names: Vec<&str> = table.columns().iter().map(|column| column.name.as_str()).collect();
    assert_eq!(names[..4], ["time_s", "pinion_support_vertical_g", "casing_g", "horizontal_g"]);
    assert_eq!(names.len(), 9);
    assert_eq!(Scenario::from_toml(table.text_of(SCENARIO_KEY).unwrap()).unwrap(), scenario);
    assert_eq!(table.text_of(RUN_KEY), Some(&*RunIdentity::of(&scenario).to_string()));
}
