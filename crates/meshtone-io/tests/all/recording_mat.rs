//! Recordings in MATLAB files, against files that SciPy wrote.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use std::fs;
use std::path::{Path, PathBuf};

use crate::recording_help::{rate, read, refused};
use meshtone_io::recording::{ColumnChoice, Recording, RecordingOptions, RecordingWarning, read_recording};

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../meshtone-io/tests/recordings").join(name)
}

fn bytes(name: &str) -> Vec<u8> {
    fs::read(fixture(name)).unwrap()
}

fn names(recording: &Recording) -> Vec<&str> {
    recording.channels.iter().map(|channel| &*channel.name).collect()
}

fn variable(name: &str) -> RecordingOptions {
    RecordingOptions { variable: Some(name.to_string()), ..RecordingOptions::default() }
}

fn one() -> Vec<f64> {
    (0..50).map(|index| 0.5 * f64::from(index) - 3.0).collect()
}

fn scaled(by: f64) -> Vec<f64> {
    one().into_iter().map(|sample| by * sample).collect()
}

#[test]
fn variables_are_channels() {
    for file in ["flat.mat", "flat_compressed.mat"] {
        let recording = read_recording(&fixture(file), &RecordingOptions::default()).unwrap();
        assert_eq!(names(&recording), ["X097_DE_time", "X097_FE_time"]);
        assert_eq!(recording.sampling_rate_hz, 12_800.0);
        assert_eq!(recording.channels[0].samples, one());
        let squares: Vec<f64> = (0..50).map(|index| f64::from(index * index)).collect();
        assert_eq!(recording.channels[1].samples, squares);
    }
}

#[test]
fn structs_and_cells_are_reached_by_paths() {
    for file in ["nested.mat", "nested_compressed.mat"] {
        let of = |name: &str| read_recording(&fixture(file), &variable(name)).unwrap();
        let sensors = of("bench.sensors");
        assert_eq!(names(&sensors), ["pair 1", "pair 2", "speed"]);
        assert_eq!(sensors.sampling_rate_hz, 12_800.0);
        assert_eq!(sensors.channels[0].samples, one());
        assert_eq!(sensors.channels[1].samples, scaled(-2.0));
        assert_eq!(sensors.channels[2].samples, [24.5; 50]);
        assert_eq!(of("bench.sensors.pair").channels.len(), 2);
        assert_eq!(of("record(2).signal").channels[0].samples, scaled(2.0));
        assert_eq!(of("runs{2}.signal").channels[0].samples, one()[..20]);
        assert_eq!(of("runs{2}").channels[0].samples, one()[..20]);
        assert_eq!(of("cells{3}").channels[1].samples, scaled(-2.0));
        let chosen = RecordingOptions { channels: vec!["speed".into()], ..RecordingOptions::default() };
        assert_eq!(names(&read_recording(&fixture(file), &chosen).unwrap()), ["bench.sensors.speed"]);
    }
}

#[test]
fn what_is_no_recording_is_named() {
    let file = bytes("nested.mat");
    let message = refused("n.mat", &file, &variable("bench.sensor"));
    assert!(message.contains("has no variable `bench.sensor` that holds numbers"), "{message}");
    assert!(message.contains("bench.sensors.pair (50 × 2 double)"), "{message}");
    let message = refused("n.mat", &file, &variable("complex"));
    assert!(message.contains("has no variable `complex` that holds numbers"), "{message}");
    let message =
        refused("n.mat", &file, &RecordingOptions { channels: vec!["complex".into()], ..rate(1.0) });
    assert!(message.contains("column complex holds complex numbers; must be real numbers"), "{message}");
    let message = refused("n.mat", &file, &rate(1.0));
    assert!(message.contains("the channels are not equally long; choose those"), "{message}");
    assert!(message.contains("runs{2}.signal (20 samples)"), "{message}");
}

#[test]
fn version_4_is_read_and_no_version_refused() {
    let version_4 = refused("old.mat", &bytes("version4.mat"), &RecordingOptions::default());
    assert!(version_4.contains("has one column alone"), "{version_4}");
    let no_version = refused("old.mat", &[b'x'; 200], &RecordingOptions::default());
    assert!(no_version.contains("its head is that of no version of MATLAB"), "{no_version}");
}

#[test]
fn version_7_3_is_read_as_version_5() {
    let of = |name: &str| read_recording(&fixture("v73.mat"), &variable(name)).unwrap();
    let acc = of("acc");
    assert_eq!((acc.sampling_rate_hz, &acc.channels[0].samples), (12_800.0, &one()));
    let squares: Vec<f64> = (0..50).map(|index| f64::from(index * index)).collect();
    assert_eq!(of("count").channels[0].samples, squares);
    let pair = of("run.pair");
    assert_eq!(names(&pair), ["run.pair 1", "run.pair 2"]);
    assert_eq!(pair.channels[1].samples, scaled(-2.0));
    let all =
        RecordingOptions { channels: vec!["acc".into(), "run.pair".into()], ..RecordingOptions::default() };
    assert_eq!(read_recording(&fixture("v73.mat"), &all).unwrap().channels.len(), 3);
    let file = bytes("v73.mat");
    let message = refused("m.mat", &file, &variable("cell"));
    assert!(message.contains("cells (1 × 1 a cell array; save its arrays as variables"), "{message}");
    for (name, what) in [
        ("name", "column name holds text; must be real numbers"),
        ("empty", "column empty holds an empty array; must be real numbers"),
        (
            "sparse.data",
            "column sparse.data holds a sparse array; save it with full(…); must be real numbers",
        ),
    ] {
        let chosen = RecordingOptions { channels: vec![name.into()], ..rate(1.0) };
        let message = refused("m.mat", &file, &chosen);
        assert!(message.contains(what), "{message}");
    }
}

#[test]
fn other_hdf5_is_read() {
    let recording = read_recording(&fixture("plain.h5"), &variable("bench")).unwrap();
    assert_eq!((names(&recording), recording.sampling_rate_hz.round()), (vec!["pair 1", "pair 2"], 12_800.0));
    assert_eq!(recording.channels[0].samples, one());
    assert_eq!(recording.channels[1].samples, scaled(-2.0));
}

#[test]
fn cut_files_are_refused_wherever_they_end() {
    for name in ["flat.mat", "flat_compressed.mat", "nested_compressed.mat", "v73.mat", "plain.h5"] {
        let file = bytes(name);
        for end in (0..file.len()).step_by(7) {
            let result = read("cut.mat", &file[..end], &rate(1.0));
            // Whole variables are a whole file.
            if let Ok(recording) = &result {
                assert!(recording.channels.iter().all(|channel| channel.samples.len() == 50), "{name} {end}");
            }
        }
    }
    // The first data of HDF5 stand behind the index, so that half of a file is none.
    for name in ["v73.mat", "plain.h5"] {
        let file = bytes(name);
        refused("cut.mat", &file[..file.len() / 2], &rate(1.0));
    }
    let file = bytes("flat.mat");
    let message = refused("cut.mat", &file[..400], &rate(1.0));
    assert!(message.contains("is not a whole MAT file: the variable at byte 128"), "{message}");
    assert!(message.contains("is the file cut off?"), "{message}");
}

/// An element: type, length, content, and what fills the last eight bytes.
fn element(kind: u32, content: &[u8]) -> Vec<u8> {
    let mut bytes = [kind.to_le_bytes(), (content.len() as u32).to_le_bytes()].concat();
    bytes.extend_from_slice(content);
    bytes.resize(bytes.len().next_multiple_of(8), 0);
    bytes
}

/// A column of doubles as MATLAB's `save -v6` writes it.
fn column(name: &str, values: &[f64]) -> Vec<u8> {
    let numbers = |numbers: [u32; 2]| numbers.map(u32::to_le_bytes).concat();
    let values: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    let flags = element(6, &numbers([6, 0]));
    let shape = element(5, &numbers([values.len() as u32 / 8, 1]));
    element(14, &[flags, shape, element(1, name.as_bytes()), element(9, &values)].concat())
}

fn mat(columns: &[(&str, &[f64])]) -> Vec<u8> {
    let mut bytes = vec![b' '; 124];
    bytes.extend_from_slice(&[0, 1, b'I', b'M']);
    bytes.extend(columns.iter().flat_map(|(name, values)| column(name, values)));
    bytes
}

#[test]
fn variables_of_one_name_are_chosen_by_number() {
    let by = |channel: ColumnChoice| RecordingOptions { channels: vec![channel], ..rate(1e3) };
    let (first, second) = (one(), scaled(2.0));
    let twins = mat(&[("acc", &first), ("speed", &[1.0; 50]), ("acc", &second)]);
    let problem = refused("twins.mat", &twins, &by("acc".into()));
    assert!(problem.contains("`acc` is the name of columns 1 and 3; choose one by its number"), "{problem}");
    for (number, samples) in [(1, &first), (3, &second)] {
        let recording = read("twins.mat", &twins, &by(number.into())).unwrap();
        assert_eq!(recording.channels[0].samples, *samples);
        assert_eq!(recording.warnings, []);
    }
}

#[test]
fn of_variables_of_one_name_one_that_is_zero_is_left_out() {
    let by = |channel: ColumnChoice| RecordingOptions { channels: vec![channel], ..rate(1e3) };
    let twins = mat(&[("acc", &[0.0; 50]), ("acc", &one()), ("other", &[0.0; 50])]);
    let left_out = RecordingWarning::ZeroTwin { name: "acc".to_string(), number: 1 };
    let recording = read("twins.mat", &twins, &by("acc".into())).unwrap();
    assert_eq!(
        (recording.channels[0].samples.clone(), &recording.warnings[..]),
        (one(), &[left_out.clone()][..])
    );
    // Nothing else is left out.
    let recording = read("twins.mat", &twins, &rate(1e3)).unwrap();
    assert_eq!((names(&recording), &recording.warnings[..]), (vec!["acc", "other"], &[left_out][..]));
    let recording = read("twins.mat", &twins, &by(1.into())).unwrap();
    assert_eq!((recording.channels[0].samples.clone(), recording.warnings.len()), (vec![0.0; 50], 0));
    let both_zero = mat(&[("acc", &[0.0; 50]), ("acc", &[0.0; 50])]);
    assert_eq!(names(&read("twins.mat", &both_zero, &rate(1e3)).unwrap()), ["acc", "acc"]);
}
