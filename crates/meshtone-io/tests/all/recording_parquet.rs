//! Recordings that pyarrow and polars wrote.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::path::{Path, PathBuf};

use meshtone_io::recording::{Recording, RecordingOptions, TimeColumn, read_recording};

use crate::recording_help::rate;

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../meshtone-io/tests/recordings").join(name)
}

fn samples<'r>(recording: &'r Recording, name: &str) -> &'r [f64] {
    let mut channels = recording.channels.iter();
    &channels.find(|channel| channel.name == name).unwrap_or_else(|| panic!("{name}")).samples
}

fn rows(number: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..60).map(f64::from).map(number).collect()
}

fn signal() -> Vec<f64> {
    rows(|row| row / 8.0 - 3.0)
}

#[test]
fn every_type_of_numbers_is_read() {
    let recording = read_recording(&file("types.parquet"), &rate(1.0)).unwrap();
    for (name, expected) in [
        ("int8", rows(|row| row - 30.0)),
        ("int16", rows(|row| row - 30.0)),
        ("int32", rows(|row| row - 30.0)),
        ("int64", rows(|row| row - 30.0)),
        ("uint8", rows(|row| row)),
        ("uint16", rows(|row| row)),
        ("uint32", rows(|row| row)),
        ("uint64", rows(|row| row)),
        ("large", rows(|row| 2_f64.powi(63) + 2048.0 * row)),
        ("large32", rows(|row| 2_f64.powi(31) + row)),
        ("float", signal()),
        ("double", signal()),
    ] {
        assert_eq!(samples(&recording, name), expected, "{name}");
    }
    assert_eq!(recording.channels.len(), 12);
    let units: Vec<_> = recording.channels.iter().filter_map(|channel| channel.unit.as_deref()).collect();
    assert_eq!(units, ["m/s²", "g"]);
}

#[test]
fn other_types_are_left_out_and_refused_where_they_are_chosen() {
    for (name, kind) in [
        ("truth", "Boolean"),
        ("text", "Utf8"),
        ("long text", "Utf8"),
        ("bytes", "Binary"),
        ("half", "Float16"),
        ("day", "Date32"),
        ("hour", "Time"),
        ("money", "Decimal"),
        ("nothing", "Null"),
        ("list", "List"),
        ("group", "Struct"),
        ("map", "Map"),
    ] {
        let options = RecordingOptions { channels: vec![name.into()], ..rate(1.0) };
        let refused = read_recording(&file("types.parquet"), &options).unwrap_err().to_string();
        assert!(refused.ends_with(&format!("column {name} holds {kind}; must be real numbers")), "{refused}");
    }
}

#[test]
fn every_encoding_and_compression_is_read() {
    for compression in ["gzip", "zstd", "lz4", "none"] {
        let name = format!("encodings_{compression}.parquet");
        let recording = read_recording(&file(&name), &rate(1.0)).unwrap();
        assert_eq!(samples(&recording, "delta"), rows(|row| row * row), "{compression}");
        for name in ["split", "plain", "single"] {
            assert_eq!(samples(&recording, name), signal(), "{compression} {name}");
        }
    }
}

#[test]
fn another_codec_is_named_with_those_that_are_read() {
    let refused = read_recording(&file("brotli.parquet"), &rate(1.0)).unwrap_err().to_string();
    for words in ["column a is compressed by BROTLI, which is not read", "Snappy, gzip, LZ4 or Zstandard"] {
        assert!(refused.contains(words), "{refused}");
    }
}

#[test]
fn moments_of_every_unit_are_times() {
    let rate_of = |name: &str, time: &str| {
        let options = RecordingOptions {
            channels: vec!["a".into()],
            time: TimeColumn::Chosen(time.into()),
            ..RecordingOptions::default()
        };
        let recording = read_recording(&file(name), &options).unwrap();
        assert_eq!(samples(&recording, "a"), signal(), "{name} {time}");
        recording.sampling_rate_hz
    };
    for name in ["moments.parquet", "moments_int96.parquet"] {
        assert_eq!(rate_of(name, "second"), 1.0);
        for time in ["milli", "micro", "nano"] {
            assert_eq!(rate_of(name, time), 1000.0, "{name} {time}");
        }
    }
    assert_eq!(rate_of("moments.parquet", "duration s"), 1.0);
    for unit in ["ms", "us", "ns"] {
        assert_eq!(rate_of("moments.parquet", &format!("duration {unit}")), 1000.0, "{unit}");
    }
}

#[test]
fn gaps_matter_only_where_they_are_read() {
    let refused = read_recording(&file("gaps.parquet"), &rate(1.0)).unwrap_err().to_string();
    assert!(refused.contains("sample 42 of column b is empty (null)"), "{refused}");
    let options = RecordingOptions { channels: vec!["a".into()], ..rate(1.0) };
    assert_eq!(samples(&read_recording(&file("gaps.parquet"), &options).unwrap(), "a"), signal());
}

#[test]
fn polars_files_are_read() {
    let recording = read_recording(&file("polars.parquet"), &RecordingOptions::default()).unwrap();
    assert_eq!(recording.sampling_rate_hz, 100.0);
    assert_eq!(samples(&recording, "a"), signal());
    assert_eq!(samples(&recording, "b"), rows(|row| row));
    assert_eq!(recording.channels.len(), 2);
}
