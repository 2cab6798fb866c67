//! Signals and summaries, written and read back.
#![allow(clippy::unwrap_used)]

use std::fs::{self, File};

use crate::parquet_help::{Plain, parquet};
use meshtone::scenario::{GearPair, Scenario};
use meshtone::signal::Channels;
use meshtone_io::ReadResultsError;
use meshtone_io::run_identity::RunIdentity;
use meshtone_io::signals::{RATE_KEY, RUN_KEY, SCENARIO_KEY, read_signals, write_signals};
use parquet::file::metadata::KeyValue;
use tempfile::tempdir;

fn scenario() -> Scenario {
    Scenario::new(GearPair {
        module_mm: 3.0,
        pinion_teeth: 20,
        gear_teeth: 40,
        face_width_mm: 15.0,
        pinion_speed_hz: 40.0,
        brake_torque_nm: 10.0,
    })
}

/// More rows than are written at once, with numbers that only exact writing keeps.
fn channels() -> Channels {
    let signal = |scale: f64| (0..70_000).map(|i| scale * (f64::from(i) / 3.0).sin()).collect::<Vec<_>>();
    Channels {
        sampling_rate_hz: 258_400.0,
        start_s: 0.95,
        horizontal_g: signal(1.0),
        vertical_g: signal(1e-300),
        axial_g: vec![-0.0; 70_000],
        pinion_speed_hz: signal(40.0),
        gear_speed_hz: signal(17.0),
        mesh_force_n: signal(1e9),
    }
}

fn refused(path: &std::path::Path, metadata: Vec<KeyValue>, words: &str) {
    fs::write(path, parquet(vec![("time_s", Plain::Single(vec![Some(1.0)]))], metadata)).unwrap();
    let error = read_signals(path).unwrap_err();
    assert!(matches!(error, ReadResultsError::Foreign { .. } | ReadResultsError::Scenario { .. }));
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
    let broken = KeyValue::new(SCENARIO_KEY.to_string(), "seed = -1".to_string());
    refused(&path, vec![broken], "seed = -1");
    let text = |key: &str, value: &str| KeyValue::new(key.to_string(), value.to_string());
    let good = || vec![text(SCENARIO_KEY, &scenario().to_toml()), text("meshtone.version", "0.1.0")];
    refused(&path, good(), "has no metadata meshtone.run");
    let wrong_run = [good(), vec![text(RUN_KEY, "7")]].concat();
    refused(&path, wrong_run, "`7` is no run's identity; must be 16 hexadecimal digits");
    let good = || [good(), vec![text(RUN_KEY, "00000000000000ff")]].concat();
    let wrong_rate = [good(), vec![text(RATE_KEY, "fast")]].concat();
    refused(&path, wrong_rate, "is `fast`; must be a number above 0");
    let single = [good(), vec![text(RATE_KEY, "1000.0")]].concat();
    refused(&path, single.clone(), "column time_s of Float32; must be of Float64");
    // Neither is a file foreign whose scenario names its convention, as the model was called.
    let earlier = scenario().to_toml().replacen("model = \"linear\"", "convention = \"corrected\"", 1);
    assert!(earlier.contains("convention"));
    let named_earlier = [vec![text(SCENARIO_KEY, &earlier)], single[1..].to_vec()].concat();
    refused(&path, named_earlier, "column time_s of Float32; must be of Float64");
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
