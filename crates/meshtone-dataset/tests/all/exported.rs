//! A data set in the schema of the Python package `bearing-datasets`.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use std::fs::{self, File};
use std::path::Path;
use std::process::Command;

use meshtone_dataset::export::{Exported, export_bearing_datasets};
use meshtone_dataset::generate::Part;
use meshtone_dataset::store::Destination;
use meshtone_io::recording::{RecordingOptions, read_recording};
use meshtone_io::table::TableReader;

use crate::support::{FAST, SHARDS, differing, plan, run};

/// A data set that has two faults at once, beside the classes of the plan.
fn set(directory: &Path) -> Destination {
    let classes = r#"
        [[class]]
        label = "two"
        fault = [{ kind = "missing-tooth", wheel = "pinion" }, { kind = "missing-tooth", tooth = 3 }]
        [[vary]]"#;
    let set = Destination::directory(directory.join("set"));
    assert!(run(&plan(&FAST.replacen("[[vary]]", classes, 1)), &set, Part::WHOLE, 2).unwrap().complete);
    set
}

/// Every file of an exported set, by its name.
fn files(folder: &Path) -> std::collections::BTreeMap<String, Vec<u8>> {
    let names = ["metadata.parquet", "manifest.json", "signals/part-float32.parquet"];
    names.into_iter().map(|name| (name.to_owned(), fs::read(folder.join(name)).unwrap())).collect()
}

#[test]
fn recordings_of_the_exported_set_are_those_of_the_records() {
    let directory = tempfile::tempdir().unwrap();
    let set = set(directory.path());
    let folder = directory.path().join("gears");
    let exported = export_bearing_datasets(&set, &folder).unwrap();
    assert_eq!(exported, Exported { recordings: 60, signals: 120 });
    let table = TableReader::new(File::open(directory.path().join("set").join(SHARDS[1])).unwrap()).unwrap();
    let numbers = |name: &str| table.numbers(table.column(name).unwrap(), 0).unwrap().values;
    for (row, record) in numbers("record").into_iter().enumerate() {
        let options =
            RecordingOptions { variable: Some(format!("record-{record}")), ..RecordingOptions::default() };
        let recording = read_recording(&folder, &options).unwrap();
        assert_eq!(recording.sampling_rate_hz, numbers("sampling_rate_hz")[row]);
        for name in ["horizontal_g", "vertical_g"] {
            let channel = recording.channel(name).unwrap();
            assert_eq!(channel.unit.as_deref(), Some("g"));
            assert_eq!(channel.samples, table.list(table.column(name).unwrap(), row).unwrap());
        }
    }
    // The same bytes again, and nothing is written over what is there.
    let again = directory.path().join("again").join("gears");
    export_bearing_datasets(&set, &again).unwrap();
    assert_eq!(differing(&files(&folder), &files(&again)), [""; 0]);
    let refused = export_bearing_datasets(&set, &folder).unwrap_err().to_string();
    assert!(refused.contains("gears has files in it"), "{refused}");
    // Which recording is said.
    let of = |variable: Option<&str>| {
        let variable = variable.map(str::to_owned);
        let options = RecordingOptions { variable, ..RecordingOptions::default() };
        read_recording(&folder, &options).unwrap_err().to_string()
    };
    for (variable, words) in [
        (None, "choose one by its recording_id (option variable): record-"),
        (Some("record-1x"), "has no recording `record-1x` (did you mean `record-1`?)"),
    ] {
        assert!(of(variable).contains(words), "{}", of(variable));
    }
}

#[test]
fn sets_that_cannot_be_exported_are_refused() {
    let directory = tempfile::tempdir().unwrap();
    let to = directory.path().join("gears");
    let place = |name: &str| Destination::directory(directory.path().join(name));
    let bare = FAST.replacen("[keep]", "[keep]\nchannels = []", 1);
    run(&plan(&bare), &place("bare"), Part::WHOLE, 2).unwrap();
    run(&plan(FAST), &place("part"), Part { number: 1, of: 2 }, 2).unwrap();
    for (from, words) in
        [("bare", "keeps no raw channels"), ("part", "is not complete"), ("absent", "is no data set")]
    {
        let refused = export_bearing_datasets(&place(from), &to).unwrap_err().to_string();
        assert!(refused.contains(words), "{refused}");
        assert!(!to.exists());
    }
}

/// `cargo xtask test` makes a virtual environment with that package and names its interpreter in `MESHTONE_PYTHON`.
#[test]
fn the_package_s_own_validator_accepts_it() {
    let Some(python) = std::env::var_os("MESHTONE_PYTHON") else {
        println!("skipped: MESHTONE_PYTHON is not set; `cargo xtask test` sets it");
        return;
    };
    let directory = tempfile::tempdir().unwrap();
    export_bearing_datasets(&set(directory.path()), &directory.path().join("sets/gears")).unwrap();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../meshtone-dataset/tests/python/validate.py");
    let output = Command::new(python).arg(script).arg(directory.path()).output().unwrap();
    let said =
        String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    println!("{said}");
}
