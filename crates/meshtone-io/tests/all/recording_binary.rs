//! Recordings in Parquet, NPY, NPZ and WAV.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use std::fs::{self, File};
use std::io::Cursor;

use crate::parquet_help::{Plain, parquet};
use crate::recording_help::{rate, read, refused};
use hound::{SampleFormat, WavSpec, WavWriter};
use meshtone::scenario::{GearPair, Scenario};
use meshtone::sensor::{ChannelKind, Channels, NamedSignal};
use meshtone_io::recording::{ColumnChoice, Recording, RecordingOptions, read_recording};
use meshtone_io::signals::SignalTable;
use ndarray::{Array1, Array2, Array3, ShapeBuilder, arr0};
use ndarray_npy::{NpzWriter, WriteNpyExt};

fn defaults() -> RecordingOptions {
    RecordingOptions::default()
}

fn names(recording: &Recording) -> Vec<&str> {
    recording.channels.iter().map(|channel| &*channel.name).collect()
}

fn table() -> Array2<f64> {
    Array2::from_shape_fn((60, 3), |(row, column)| row as f64 - 0.5 * column as f64)
}

#[test]
fn signals_of_a_simulation_are_read_with_unit_rate_and_scenario() {
    let directory = tempfile::tempdir().unwrap();
    let signal = |scale: f64| (0..70_000).map(|i| scale * (f64::from(i) / 3.0).sin()).collect::<Vec<_>>();
    let values = [signal(1.0), signal(1e-300), signal(0.0), signal(40.0), signal(17.0), signal(1e9)];
    let named = ChannelKind::ALL.into_iter().zip(values).map(|(kind, values)| {
        let mut signal = NamedSignal::from(kind);
        signal.values = values;
        signal
    });
    let channels = Channels::new(258_400.0, 0.95, named.collect());
    let scenario = Scenario::new(GearPair { pinion_teeth: 20, gear_teeth: 40, ..GearPair::example() });
    let file = File::create(directory.path().join("signals.parquet")).unwrap();
    SignalTable::of_scenario(&scenario, &channels).write_parquet(file).unwrap();
    // The folder stands for its signals.
    let recording = read_recording(directory.path(), &defaults()).unwrap();
    assert_eq!((recording.sampling_rate_hz, recording.start_s), (258_400.0, 0.95));
    assert_eq!(recording.scenario_toml, Some(scenario.to_toml()));
    assert_eq!(recording.channels.len(), 6);
    assert_eq!(recording.channels[0].samples, channels["horizontal_g"]);
    assert_eq!(recording.channels[5].samples, channels["mesh_force_n"]);
    assert!(recording.channels.iter().all(|channel| channel.unit.is_some()));
    assert_eq!(recording.channels[0].unit.as_deref(), Some("g"));
}

#[test]
fn parquet_of_others_is_read() {
    let moments = (0..100).map(|i| Some(1_700_000_000_000_000 + 20 * i));
    let columns = vec![
        ("timestamp", Plain::Moments(moments.collect())),
        ("a [g]", Plain::Single((0..100).map(|i| Some(i as f32 / 4.0)).collect())),
        ("count", Plain::Whole((0..100).map(Some).collect())),
        ("note", Plain::Text((0..100).map(|i| Some(i.to_string())).collect())),
    ];
    let bytes = parquet(columns, Vec::new());
    let recording = read("a.parquet", &bytes, &defaults()).unwrap();
    assert_eq!(recording.sampling_rate_hz, 50_000.0);
    assert_eq!(names(&recording), ["a", "count"]);
    assert_eq!(recording.channels[0].unit.as_deref(), Some("g"));
    assert_eq!(recording.channels[0].samples[99], 24.75);
    let message =
        refused("a.parquet", &bytes, &RecordingOptions { channels: vec!["note".into()], ..defaults() });
    assert!(message.contains("column note holds Utf8; must be real numbers"), "{message}");
    let message =
        refused("a.parquet", &bytes, &RecordingOptions { channels: vec!["b".into()], ..defaults() });
    assert!(
        message.contains("has no column `b`") && message.contains("it has timestamp, a [g]"),
        "{message}"
    );
}

#[test]
fn gaps_in_binary_files_are_named() {
    let nulls = parquet(vec![("a", Plain::Double(vec![Some(1.0), None, Some(2.0)]))], Vec::new());
    let message = refused("a.parquet", &nulls, &rate(1.0));
    assert!(message.contains("sample 2 of column a is empty (null)"), "{message}");
    let mut bytes = Vec::new();
    Array1::from(vec![1.0, 2.0, f64::NAN, 4.0]).write_npy(&mut bytes).unwrap();
    let message = refused("a.npy", &bytes, &rate(1.0));
    assert!(message.contains("sample 3 of column channel 1 is NaN"), "{message}");
    let mut bytes = Vec::new();
    Array1::from(vec![1.0_f32, f32::INFINITY]).write_npy(&mut bytes).unwrap();
    assert!(refused("a.npy", &bytes, &rate(1.0)).contains("sample 2 of column channel 1 is infinite"));
}

#[test]
fn arrays_of_every_order_and_type_are_read() {
    let (table, options) = (table(), rate(1000.0));
    let mut fortran = Array2::zeros((60, 3).f());
    fortran.assign(&table);
    for array in [table.clone(), fortran, table.t().to_owned(), table.t().as_standard_layout().to_owned()] {
        let mut bytes = Vec::new();
        array.write_npy(&mut bytes).unwrap();
        let recording = read("a.npy", &bytes, &options).unwrap();
        assert_eq!(recording.channels.len(), 3);
        for (channel, column) in recording.channels.iter().zip(table.columns()) {
            assert_eq!(channel.samples, column.to_vec());
        }
    }
    let (mut short, mut single) = (Vec::new(), Vec::new());
    Array1::from(vec![-3_i16, 4, 5]).write_npy(&mut short).unwrap();
    assert_eq!(read("a.npy", &short, &options).unwrap().channels[0].samples, [-3.0, 4.0, 5.0]);
    Array1::from(vec![0.1_f32, 4.0]).write_npy(&mut single).unwrap();
    assert_eq!(read("a.npy", &single, &options).unwrap().channels[0].samples[0], f64::from(0.1_f32));
    let mut cube = Vec::new();
    Array3::<f64>::zeros((2, 3, 4)).write_npy(&mut cube).unwrap();
    let message = refused("a.npy", &cube, &options);
    assert!(
        message.contains("column 1 holds an array of shape 2 × 3 × 4; must have one or two dimensions"),
        "{message}"
    );
    let chosen = RecordingOptions { channels: vec![2.into()], ..options };
    let mut bytes = Vec::new();
    table.write_npy(&mut bytes).unwrap();
    let recording = read("a.npy", &bytes, &chosen).unwrap();
    assert_eq!(names(&recording), ["channel 2"]);
    assert_eq!(recording.channels[0].samples, table.column(1).to_vec());
}

fn npz(compressed: bool) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let mut archive =
        if compressed { NpzWriter::new_compressed(&mut bytes) } else { NpzWriter::new(&mut bytes) };
    archive.add_array("bench", &table()).unwrap();
    archive.add_array("speed [Hz]", &Array1::from_elem(60, 24.5)).unwrap();
    archive.add_array("fs", &arr0(12_800.0)).unwrap();
    archive.finish().unwrap();
    bytes.into_inner()
}

#[test]
fn archives_are_read() {
    for compressed in [false, true] {
        let bytes = npz(compressed);
        let recording = read("a.npz", &bytes, &defaults()).unwrap();
        assert_eq!(names(&recording), ["bench 1", "bench 2", "bench 3", "speed"]);
        assert_eq!(recording.channels[3].unit.as_deref(), Some("Hz"));
        assert_eq!(recording.sampling_rate_hz, 12_800.0);
        assert_eq!(recording.channels[2].samples, table().column(2).to_vec());
        let variable = RecordingOptions { variable: Some("bench".to_string()), ..defaults() };
        assert_eq!(read("a.npz", &bytes, &variable).unwrap().channels.len(), 3);
        let variable = RecordingOptions { variable: Some("bank".to_string()), ..defaults() };
        let message = refused("a.npz", &bytes, &variable);
        assert!(message.contains("has no variable `bank`"), "{message}");
        assert!(message.contains("bench (60 × 3 float64)"), "{message}");
    }
}

#[test]
fn a_stated_rate_and_a_time_array_must_agree() {
    let with_rate = |rate_hz: f64| {
        let mut bytes = Cursor::new(Vec::new());
        let mut archive = NpzWriter::new(&mut bytes);
        archive.add_array("t", &Array1::from_shape_fn(100, |index| 3.0 + index as f64 / 1000.0)).unwrap();
        archive.add_array("a", &Array1::from_elem(100, 1.0)).unwrap();
        archive.add_array("sampling_rate_khz", &arr0(rate_hz / 1000.0)).unwrap();
        archive.finish().unwrap();
        bytes.into_inner()
    };
    let recording = read("a.npz", &with_rate(1000.0), &defaults()).unwrap();
    assert_eq!((recording.sampling_rate_hz, recording.start_s, names(&recording)), (1000.0, 3.0, vec!["a"]));
    assert_eq!(recording.len(), 100);
    let message = refused("a.npz", &with_rate(2000.0), &defaults());
    assert!(message.contains("sampling_rate_khz states a sampling rate of 2000 S/s"), "{message}");
    assert!(message.contains("time column t says 1000 S/s; give the sampling rate"), "{message}");
    assert_eq!(read("a.npz", &with_rate(2000.0), &rate(50.0)).unwrap().sampling_rate_hz, 50.0);
    assert!(refused("a.npz", &with_rate(-1.0), &defaults()).contains("must be above 0"));
}

#[test]
fn channels_of_unequal_length_are_named() {
    let mut bytes = Cursor::new(Vec::new());
    let mut archive = NpzWriter::new(&mut bytes);
    archive.add_array("a", &Array1::from_elem(100, 1.0)).unwrap();
    archive.add_array("b", &Array1::from_elem(99, 1.0)).unwrap();
    archive.finish().unwrap();
    let message = refused("a.npz", &bytes.into_inner(), &rate(1.0));
    assert!(
        message.ends_with("(option channels, or variable): a (100 samples), b (99 samples)"),
        "{message}"
    );
}

#[test]
fn changed_numbers_in_an_archive_are_noticed() {
    let bytes = npz(false);
    let number = 59.0_f64.to_le_bytes();
    let at = bytes.windows(8).position(|window| window == number).unwrap();
    let mut changed = bytes.clone();
    changed[at] ^= 1;
    let message = refused("a.npz", &changed, &defaults());
    assert!(message.contains("array bench: ") && message.contains("checksum"), "{message}");
}

#[test]
fn the_fields_of_a_structured_array_are_columns() {
    let header = "{'descr': [('time_s', '<f8'), ('note', '|S2'), ('a [g]', '<f4')], 'fortran_order': False, \
                  'shape': (3,), }\n";
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    for (time, sample) in [(0.0_f64, 1.5_f32), (0.5, -2.0), (1.0, 3.0)] {
        bytes.extend(time.to_le_bytes());
        bytes.extend(b"xy");
        bytes.extend(sample.to_le_bytes());
    }
    let recording = read("a.npy", &bytes, &defaults()).unwrap();
    assert_eq!((recording.sampling_rate_hz, names(&recording)), (2.0, vec!["a"]));
    assert_eq!(recording.channels[0].unit.as_deref(), Some("g"));
    assert_eq!(recording.channels[0].samples, [1.5, -2.0, 3.0]);
}

fn wav(spec: WavSpec, write: impl Fn(&mut WavWriter<&mut Cursor<Vec<u8>>>)) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let mut writer = WavWriter::new(&mut bytes, spec).unwrap();
    write(&mut writer);
    writer.finalize().unwrap();
    bytes.into_inner()
}

#[test]
fn wav_is_read() {
    let spec = |bits_per_sample, sample_format| WavSpec {
        channels: 2,
        sample_rate: 51_200,
        bits_per_sample,
        sample_format,
    };
    for bits in [8, 16, 24, 32] {
        let quarter = 1 << (bits - 3);
        let bytes = wav(spec(bits, SampleFormat::Int), |writer| {
            [quarter, -quarter, 0, 2 * quarter]
                .iter()
                .for_each(|sample| writer.write_sample(*sample).unwrap());
        });
        let recording = read("a.wav", &bytes, &defaults()).unwrap();
        assert_eq!((recording.sampling_rate_hz, recording.len()), (51_200.0, 2));
        assert_eq!(recording.channels[0].samples, [0.25, 0.0], "{bits}");
        assert_eq!(recording.channels[1].samples, [-0.25, 0.5], "{bits}");
    }
    let bytes = wav(spec(32, SampleFormat::Float), |writer| {
        [1.5_f32, -2.5].iter().for_each(|sample| writer.write_sample(*sample).unwrap());
    });
    assert_eq!(read("a.wav", &bytes, &defaults()).unwrap().channels[1].samples, [-2.5]);
}

/// Two channels of floating point of 64 bits, with a chunk of another kind before them.
fn wav_of_doubles(samples: &[f64], is_extensible: bool) -> Vec<u8> {
    let kind: u16 = if is_extensible { 0xfffe } else { 3 };
    let mut format = kind.to_le_bytes().to_vec();
    format.extend(2_u16.to_le_bytes());
    format.extend(51_200_u32.to_le_bytes());
    format.extend((51_200_u32 * 16).to_le_bytes());
    format.extend(16_u16.to_le_bytes());
    format.extend(64_u16.to_le_bytes());
    if is_extensible {
        format.extend([22, 0, 64, 0, 3, 0, 0, 0]);
        format.extend(3_u16.to_le_bytes());
        format.extend(b"\x00\x00\x00\x00\x10\x00\x80\x00\x00\xaa\x00\x38\x9b\x71");
    }
    let mut bytes = b"RIFF\xff\xff\xff\x00WAVE".to_vec();
    let data = samples.iter().flat_map(|sample| sample.to_le_bytes()).collect();
    for (mark, content) in [(b"note", vec![b'x'; 3]), (b"fmt ", format), (b"data", data)] {
        bytes.extend(mark);
        bytes.extend((content.len() as u32).to_le_bytes());
        bytes.extend(&content);
        bytes.resize(bytes.len().next_multiple_of(2), 0);
    }
    bytes
}

#[test]
fn wav_of_double_precision_is_read() {
    let samples = [1.5, -2.5, 1e-300, 0.1, std::f64::consts::PI, 0.0];
    for is_extensible in [false, true] {
        let bytes = wav_of_doubles(&samples, is_extensible);
        let recording = read("a.wav", &bytes, &defaults()).unwrap();
        assert_eq!((recording.sampling_rate_hz, recording.len()), (51_200.0, 3));
        assert_eq!(recording.channels[0].samples, [1.5, 1e-300, std::f64::consts::PI]);
        let second = RecordingOptions { channels: vec![ColumnChoice::Number(2)], ..defaults() };
        let recording = read("a.wav", &bytes, &second).unwrap();
        assert_eq!(recording.channels[0].samples, [-2.5, 0.1, 0.0]);
        let message = refused("a.wav", &bytes[..bytes.len() - 8], &defaults());
        assert!(message.contains("is not a whole WAV file: it ends too early"), "{message}");
        let message = refused("a.wav", &bytes[..60], &defaults());
        assert!(message.contains("is not a whole WAV file"), "{message}");
    }
    let message = refused("a.wav", &wav_of_doubles(&samples[..5], false), &defaults());
    assert!(
        message.contains(
            "its 40 bytes of samples are no whole number of samples of 8 bytes for each of 2 channels"
        ),
        "{message}"
    );
    let huge = wav_of_doubles(&samples, false);
    let data = huge.len() - 8 * samples.len() - 4;
    let lying = [&huge[..data], &[0xf0, 0xff, 0xff, 0xff], &huge[data + 4..]].concat();
    let message = refused("a.wav", &lying, &defaults());
    assert!(message.contains("announces 4294967280 bytes of samples, but ends after"), "{message}");
}

#[test]
fn files_that_are_empty_cut_or_unknown_are_refused() {
    for name in ["a.csv", "a.parquet", "a.npy", "a.npz", "a.mat", "a.wav"] {
        assert_eq!(refused(name, b"", &defaults()), format!("{name}: is empty (0 bytes)"));
    }
    let mut npy = Vec::new();
    table().write_npy(&mut npy).unwrap();
    let spec =
        WavSpec { channels: 1, sample_rate: 8000, bits_per_sample: 16, sample_format: SampleFormat::Int };
    let wav = wav(spec, |writer| (0..500).for_each(|sample| writer.write_sample(sample).unwrap()));
    let parquet = parquet(vec![("a", Plain::doubles((0..500).map(f64::from)))], Vec::new());
    for (name, bytes) in [("a.npy", npy), ("a.npz", npz(true)), ("a.wav", wav), ("a.parquet", parquet)] {
        for end in [3, 9, 40, bytes.len() / 2, bytes.len() - 1] {
            let message = refused(name, &bytes[..end], &rate(1.0));
            assert!(message.starts_with(&format!("{name}: ")), "{end}: {message}");
            assert!(message.contains("is not a whole"), "{end}: {message}");
        }
    }
    let message = refused("a.xyz", b"hello", &defaults());
    assert!(message.contains("has no known format (it ends in .xyz"), "{message}");
    let missing = read_recording("no/such/file.csv".as_ref(), &defaults()).unwrap_err().to_string();
    assert!(missing.starts_with("cannot read no/such/file.csv: "), "{missing}");
}

#[test]
fn a_header_that_announces_more_than_there_is_takes_no_memory() {
    let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (1000000000000,), }\n";
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend([0; 64]);
    let message = refused("a.npy", &bytes, &rate(1.0));
    assert!(message.contains("takes 8000000000000 bytes, but there are 64"), "{message}");
}

#[test]
fn options_are_checked() {
    let mut bytes = Vec::new();
    table().write_npy(&mut bytes).unwrap();
    for wrong in [0.0, -1.0, 1e-308, 1e300, f64::NAN, f64::INFINITY] {
        assert!(refused("a.npy", &bytes, &rate(wrong)).contains("must be from 1e-6 to 1e12 S/s"));
    }
    let variable = RecordingOptions { variable: Some("x".to_string()), ..rate(1.0) };
    assert!(refused("a.npy", &bytes, &variable).contains("a.npy: variable `x` is given, but only NPZ"));
    assert!(refused("a.npy", &bytes, &defaults()).contains("does not state its sampling rate"));
    let directory = tempfile::tempdir().unwrap();
    let empty = read_recording(directory.path(), &defaults()).unwrap_err().to_string();
    assert!(empty.starts_with("cannot read "), "{empty}");
    assert!(fs::read_dir(directory.path()).unwrap().next().is_none());
}
