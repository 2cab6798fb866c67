//! Wrong input: whatever comes, a reader gives a result or an error that says what is wrong.

use std::fs;
use std::path::Path;
use std::sync::OnceLock;
use std::sync::atomic::AtomicBool;

use meshtone::batch::Control;
use meshtone::scenario::{Scenario, ScenarioFiles};
use meshtone_dataset::expression::{Condition, Expression};
use meshtone_dataset::generate::{GenerateControl, Part, generate};
use meshtone_dataset::plan::Plan;
use meshtone_dataset::store::Destination;
use meshtone_dataset::verify::{Check, verify};
use meshtone_diagnose::{Prior, ReferenceStore};
use meshtone_io::experiment::{read_experiment, read_tuned};
use meshtone_io::recording::{RecordingFormat, RecordingOptions, read_recording};
use meshtone_io::scenario_file::{FilesBeside, ScenarioFile};
use meshtone_io::signals::read_signals;
use meshtone_io::summary::read_run;

use crate::laws::follows_plan;
use crate::{folder, guarded, written};

/// Longest message of an error.
const LONGEST_MESSAGE: usize = 20_000;

/// Reads an input as a file.
fn file<T, E: ToString>(name: &str, bytes: &[u8], read: impl FnOnce(&Path) -> Result<T, E>) {
    guarded(|| {
        said(read(&written(name, bytes)));
    });
}

/// What was read, or an error with a message.
fn said<T, E: ToString>(read: Result<T, E>) -> Option<T> {
    let message = read.as_ref().err().map(ToString::to_string);
    let is_one = |message: &String| !message.is_empty() && message.len() < LONGEST_MESSAGE;
    assert!(message.as_ref().is_none_or(is_one), "a message: {message:?}");
    read.ok()
}

/// A recording, with its own sampling rate and with one that is given. What begins as another format is read as such by the target `text` alone.
pub fn recording(name: &str, bytes: &[u8]) {
    let format = name.rsplit('.').next().and_then(RecordingFormat::of_ending);
    let format = format.filter(|format| *format != RecordingFormat::Text);
    let own = RecordingOptions { format, ..RecordingOptions::default() };
    file(name, bytes, |path| {
        said(read_finite(path, &own));
        read_finite(path, &RecordingOptions { sampling_rate_hz: Some(1e4), ..own.clone() })
    });
}

fn read_finite(path: &Path, options: &RecordingOptions) -> Result<(), String> {
    let recording = read_recording(path, options).map_err(|error| error.to_string())?;
    let rate_hz = recording.sampling_rate_hz;
    assert!(rate_hz.is_finite() && rate_hz > 0.0 && !recording.is_empty(), "{rate_hz} S/s");
    for channel in &recording.channels {
        assert_eq!(channel.samples.len(), recording.len());
        assert!(channel.samples.iter().all(|sample| sample.is_finite()), "samples that are no numbers");
    }
    Ok(())
}

/// A file of a set of recordings in the schema of bearing-datasets.
pub fn signal_set(name: &str, bytes: &[u8]) {
    static PREPARED: OnceLock<()> = OnceLock::new();
    PREPARED.get_or_init(|| {
        written("set/metadata.parquet", include_bytes!("../seeds/set_metadata/metadata.parquet"));
        let signals = include_bytes!("../seeds/set_signals/part-float32.parquet");
        written("set/signals/part-float32.parquet", signals);
    });
    let options = RecordingOptions { variable: Some("record-1".to_owned()), ..RecordingOptions::default() };
    file(&format!("set/{name}"), bytes, |_| read_recording(&folder().join("set"), &options));
}

pub fn signals(bytes: &[u8]) {
    file("signals.parquet", bytes, read_signals);
}

pub fn summary(bytes: &[u8]) {
    file("summary.json", bytes, read_run);
}

/// A file that a scenario names.
fn beside<T, E: ToString>(name: &str, bytes: &[u8], read: impl FnOnce(&FilesBeside) -> Result<T, E>) {
    file(name, bytes, |_| read(&FilesBeside::new(folder())));
}

pub fn wheels(bytes: &[u8]) {
    beside("wheels.npz", bytes, |files| {
        said(files.profile_errors("wheels.npz"));
        files.wheel_deviations("wheels.npz")
    });
}

pub fn response(bytes: &[u8]) {
    beside("response.csv", bytes, |files| files.frequency_response("response.csv"));
}

pub fn profile(bytes: &[u8]) {
    beside("profile.csv", bytes, |files| files.profile("profile.csv"));
}

pub fn scenario(bytes: &[u8]) {
    file("scenario.toml", bytes, ScenarioFile::read);
}

pub fn plan(bytes: &[u8]) {
    file("plan.toml", bytes, |path| Plan::read(path).map(|plan| follows_plan(&plan)));
}

pub fn expression(bytes: &[u8]) {
    guarded(|| {
        let Ok(text) = std::str::from_utf8(bytes) else { return };
        let number = |key: &str| Some(key.len() as f64);
        said(Expression::parse(text).map(|of| (of.value(&number), of.keys().len())));
        said(Condition::parse(text).map(|of| (of.holds(&number), of.keys().len())));
    });
}

pub fn experiment(bytes: &[u8]) {
    crate::laws::files_of_experiments();
    file("experiment.toml", bytes, read_experiment);
}

pub fn tuned(bytes: &[u8]) {
    file("tuned.toml", bytes, read_tuned);
}

/// A file of a data set.
pub fn data_set(name: &str, bytes: &[u8]) {
    static PREPARED: OnceLock<()> = OnceLock::new();
    let set = Destination::directory(folder().join("data_set"));
    PREPARED.get_or_init(|| {
        let text = include_str!("../seeds/plan/small.toml").to_owned();
        let plan = Plan::read_text(text, Path::new("plan.toml")).unwrap_or_else(|error| panic!("{error}"));
        let control = GenerateControl { progress: &|_, _| {}, cancelled: &AtomicBool::new(false) };
        generate(&plan, &set, Part::WHOLE, &control).unwrap_or_else(|error| panic!("{error}"));
    });
    file(&format!("data_set/{name}"), bytes, |_| {
        said(verify(&set, Check::Sizes));
        verify(&set, Check::Bytes)
    });
}

/// A request of the page of `meshtone explore`.
pub fn page(bytes: &[u8]) {
    guarded(|| {
        said(meshtone_explore::read_request(bytes));
    });
}

/// A batch of what `meshtone diagnose` has simulated before.
pub fn reference(bytes: &[u8]) {
    static PREPARED: OnceLock<(ReferenceStore, Prior)> = OnceLock::new();
    let (store, prior) = PREPARED.get_or_init(|| {
        let rig = Scenario::from_toml(meshtone_explore::presets()[0].toml).unwrap();
        let (store, prior) = (ReferenceStore::new(folder()), Prior::new(&rig).unwrap());
        fs::create_dir_all(store.folder_of(&prior)).unwrap();
        (store, prior)
    });
    guarded(|| {
        fs::write(store.folder_of(prior).join("batch-0000.npz"), bytes).unwrap();
        let control = Control { cancelled: &AtomicBool::new(true), ..Control::default() };
        said(store.get(prior, 1, &control));
    });
}
