//! The readers, each with right input.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use meshtone::scenario::{Model, ScenarioFiles, WheelName};
use meshtone::sensor::{Channel, ChannelKind};
use meshtone::tuning::Enhancement;
use meshtone_dataset::draw::Sampler;
use meshtone_dataset::generate::{GenerateControl, Part, generate};
use meshtone_dataset::plan::Plan;
use meshtone_dataset::store::Destination;
use meshtone_dataset::verify::{Check, verify};
use meshtone_io::experiment::{Tuned, read_experiment, read_tuned, write_tuned};
use meshtone_io::recording::{RecordingOptions, read_recording};
use meshtone_io::scenario_file::{FilesBeside, ScenarioFile};
use meshtone_io::signals::{SignalTable, read_signals};
use meshtone_io::summary::read_run;
use meshtone_io::table::{CellType, Cells, TableColumn, TableWriter};

/// A reader.
pub struct Reader {
    /// Its name on the command line.
    pub name: &'static str,
    /// In the table.
    pub title: &'static str,
    /// Right inputs, by their paths in the folder of the inputs.
    pub seeds: Vec<(PathBuf, Vec<u8>)>,
    /// Reads a file; whether it could be.
    pub read: Box<dyn Fn(&Path) -> bool>,
}

/// All readers. Their inputs, and what stands beside them, are put into a folder.
///
/// # Arguments
/// * `work` - the folder
pub fn readers(work: &Path) -> Vec<Reader> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let examples = root.join("examples");
    let recordings = root.join("crates/meshtone-io/tests/recordings");
    for folder in
        [&examples, &examples.join("same_wheels"), &examples.join("datasets"), &examples.join("experiments")]
    {
        copy_files(folder, work);
    }
    copy_files(&recordings, work);
    make_others(work);
    let seeds = |names: &[&str]| -> Vec<(PathBuf, Vec<u8>)> {
        let read = |name: &&str| (PathBuf::from(*name), fs::read(work.join(name)).expect("a right input"));
        names.iter().map(read).collect()
    };
    let reader = |name, title, names: &[&str], read: Box<dyn Fn(&Path) -> bool>| Reader {
        name,
        title,
        seeds: seeds(names),
        read,
    };
    let scenarios = [
        "healthy.toml",
        "contact.toml",
        "pits.toml",
        "profile_shift.toml",
        "root_crack.toml",
        "sensors.toml",
        "several_faults.toml",
        "tooth_breakage.toml",
        "tooth_destruction.toml",
        "wear.toml",
        "through_face.toml",
        "partial_face.toml",
        "missing_tooth.toml",
    ];
    let experiments = ["breakage.toml", "breakage_contact.toml", "destruction.toml", "pitting.toml"];
    let parquet = [
        "gaps.parquet",
        "moments.parquet",
        "moments_int96.parquet",
        "polars.parquet",
        "types.parquet",
        "encodings_none.parquet",
        "encodings_zstd.parquet",
        "encodings_gzip.parquet",
        "encodings_lz4.parquet",
    ];
    vec![
        reader("scenario", "scenario", &scenarios, Box::new(|path| ScenarioFile::read(path).is_ok())),
        reader("plan", "plan of a data set", &["benchmark.toml", "first_look.toml"], Box::new(read_plan)),
        reader("experiment", "experiment", &experiments, Box::new(|path| read_experiment(path).is_ok())),
        reader("tuned", "tuned.toml", &["tuned.toml"], Box::new(|path| read_tuned(path).is_ok())),
        reader("csv", "recording: text", &["time.csv", "excel.csv", "bare.csv"], Box::new(recording)),
        reader("wav", "recording: WAV", &["a.wav"], Box::new(recording)),
        reader(
            "mat",
            "recording: MATLAB",
            &["flat.mat", "flat_compressed.mat", "nested.mat", "nested_compressed.mat", "v73.mat"],
            Box::new(recording),
        ),
        reader("hdf5", "recording: HDF5", &["plain.h5"], Box::new(recording)),
        reader("npy", "recording: NPY", &["a.npy"], Box::new(recording)),
        reader("npz", "recording: NPZ", &["wheels.npz"], Box::new(recording)),
        reader("parquet", "recording: Parquet", &parquet, Box::new(recording)),
        reader("errors", "errors file of wheels", &["wheels.npz"], Box::new(read_errors)),
        reader(
            "response",
            "frequency response",
            &["sensors_housing.csv"],
            Box::new(|path| beside(path, |files, name| files.frequency_response(name).is_ok())),
        ),
        reader(
            "profile",
            "profile of speed or torque",
            &["speed.csv"],
            Box::new(|path| beside(path, |files, name| files.profile(name).is_ok())),
        ),
        reader(
            "signals",
            "signals.parquet",
            &["signals.parquet"],
            Box::new(|path| read_signals(path).is_ok()),
        ),
        reader("summary", "summary.json", &["summary.json"], Box::new(|path| read_run(path).is_ok())),
        reader("manifest", "manifest of a data set", &["set/manifest.json"], Box::new(verified)),
        reader("shard", "shard of a data set", &["set/data/train-000000.parquet"], Box::new(verified)),
        reader(
            "signal_set",
            "recording of a set of bearing-datasets",
            &["signal_set/metadata.parquet", "signal_set/signals/part-float32.parquet"],
            Box::new(of_signal_set),
        ),
    ]
}

fn copy_files(from: &Path, to: &Path) {
    for entry in fs::read_dir(from).expect("a folder of the repository") {
        let path = entry.expect("a file").path();
        if path.is_file() {
            fs::copy(&path, to.join(path.file_name().unwrap_or_default())).expect("a copy");
        }
    }
}

/// What no file of the repository is.
fn make_others(work: &Path) {
    let write = |name: &str, bytes: &[u8]| fs::write(work.join(name), bytes).expect("it can be written");
    let rows = |line: &dyn Fn(u32) -> String| (0..40).map(line).collect::<String>();
    let time =
        rows(&|row| format!("{:.4},{:.3},{}\n", f64::from(row) / 1000.0, f64::from(row % 7) - 3.0, row));
    write("time.csv", format!("t [s],a [g],tacho\n{time}").as_bytes());
    let excel = rows(&|row| format!("{row},25;\"{}\"\r\n", row % 5));
    write("excel.csv", format!("a [mV];b\r\n{excel}").as_bytes());
    write("bare.csv", rows(&|row| format!("{:e}\n", f64::from(row) * 0.1)).as_bytes());
    write("speed.csv", b"time_s,speed_hz\n0,38\n0.5,40\n1,42\n");
    write("a.npy", &npy(&[10, 3]));
    write("a.wav", &wav(80));
    write(
        "summary.json",
        b"{ \"format_version\": 2, \"run\": \"00000000000000ff\", \"model\": \"contact\" }\n",
    );
    let tuned = Tuned {
        model: Model::Contact,
        enhancement: Enhancement { width_ratio: 0.2, fault_to_harmonics_ratio: 2.0, noise_level: 0.5 },
        centre_rev: 0.0,
        channel: Channel::Fixed(ChannelKind::Vertical),
        sampling_rate_hz: 25e3,
        wheel: WheelName::Gear,
        sidebands: 2,
        shaft_orders: 7,
        keys: vec![("rig.damping_ratio".to_owned(), 0.05)],
    };
    write("tuned.toml", write_tuned(&tuned, "rig.toml").as_bytes());
    let mut scenario = ScenarioFile::read(&work.join("healthy.toml")).expect("an example").scenario;
    scenario.solver.sampling_rate_hz = 1e4;
    let simulation = meshtone::simulate(&scenario).expect("an example");
    let mut signals = Vec::new();
    let table = SignalTable::of_scenario(&scenario, &simulation.channels);
    table.write_parquet(&mut signals).expect("it can be written");
    write("signals.parquet", &signals);
    let plan =
        Plan::read_text(PLAN.to_owned(), &work.join("plan.toml")).unwrap_or_else(|error| panic!("{error}"));
    let control = GenerateControl { progress: &|_, _| {}, cancelled: &AtomicBool::new(false) };
    generate(&plan, &Destination::directory(work.join("set")), Part::WHOLE, &control)
        .unwrap_or_else(|error| panic!("{error}"));
    make_signal_set(&work.join("signal_set"));
}

/// A recording of two channels in the schema of bearing-datasets.
fn make_signal_set(folder: &Path) {
    fs::create_dir_all(folder.join("signals")).expect("it can be written");
    let make = |name: &str, columns: Vec<(&str, CellType, Cells)>| {
        let file = fs::File::create(folder.join(name)).expect("it can be written");
        let names = columns.iter().map(|(name, kind, _)| TableColumn::new(name, *kind)).collect();
        let mut table = TableWriter::new(file, names, Default::default()).expect("it can be written");
        table.write_rows(columns.into_iter().map(|(.., cells)| cells).collect()).expect("it can be written");
        table.close().expect("it can be written");
    };
    let texts = |texts: [&str; 2]| Cells::Text(texts.map(|text| Some(text.to_owned())).to_vec());
    let whole = |numbers: [i64; 2]| Cells::Int64(numbers.map(Some).to_vec());
    let samples = [[0.5_f32; 40], [-0.25; 40]];
    let signals = Cells::Float32List(samples.iter().map(|signal| &signal[..]).collect());
    make("signals/part-float32.parquet", vec![("signal", CellType::Float32List, signals)]);
    make(
        "metadata.parquet",
        vec![
            ("recording_id", CellType::Text, texts(["record-1"; 2])),
            ("channel", CellType::Text, texts(["a_g", "b_g"])),
            ("fs", CellType::Float64, Cells::Float64(vec![Some(1e4); 2])),
            ("n_samples", CellType::Int64, whole([40; 2])),
            ("unit", CellType::Text, texts(["g"; 2])),
            ("signal_file", CellType::Text, texts(["part-float32.parquet"; 2])),
            ("signal_row_group", CellType::Int64, whole([0; 2])),
            ("signal_row", CellType::Int64, whole([0, 1])),
        ],
    );
}

/// A small data set.
const PLAN: &str = r#"
records = 8
units = 4
[scenario.gears]
module_mm = 3.0
pinion_teeth = 20
gear_teeth = 40
face_width_mm = 15.0
points_per_tooth = 1000
[scenario.operation]
pinion_speed_hz = 40.0
brake_torque_nm = 10.0
[scenario.solver]
sampling_rate_hz = 1e4
[[class]]
label = "healthy"
[[class]]
label = "missing"
fault = { kind = "missing-tooth" }
[keep]
sampling_rate_hz = 4e3
records_per_shard = 4
"#;

/// Numbers in NumPy's format.
fn npy(shape: &[usize]) -> Vec<u8> {
    let shown: Vec<String> = shape.iter().map(usize::to_string).collect();
    let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({},), }}", shown.join(", "));
    let header = format!("{header:<117}\n");
    let values = (0..shape.iter().product::<usize>()).flat_map(|value| (value as f64).to_le_bytes());
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend((header.len() as u16).to_le_bytes());
    file.extend(header.bytes().chain(values));
    file
}

/// Two channels of 16-bit samples.
fn wav(samples: u16) -> Vec<u8> {
    let data: Vec<u8> = (0..2 * samples).flat_map(|sample| (sample * 37).to_le_bytes()).collect();
    let mut file = b"RIFF".to_vec();
    file.extend((36 + data.len() as u32).to_le_bytes());
    file.extend(b"WAVEfmt \x10\0\0\0\x01\0\x02\0");
    file.extend(8000_u32.to_le_bytes());
    file.extend(32000_u32.to_le_bytes());
    file.extend(b"\x04\0\x10\0data");
    file.extend((data.len() as u32).to_le_bytes());
    file.extend(data);
    file
}

/// A plan, and the records that it draws.
fn read_plan(path: &Path) -> bool {
    let Ok(plan) = Plan::read(path) else { return false };
    let Ok(sampler) = Sampler::new(&plan.content) else { return false };
    let last = sampler.records().saturating_sub(1);
    [0, last / 2, last]
        .into_iter()
        .all(|index| sampler.record(index).is_ok_and(|record| sampler.scenario(&record).is_ok()))
}

/// A recording, with a rate that is given and with its own.
fn recording(path: &Path) -> bool {
    let given = RecordingOptions { sampling_rate_hz: Some(1e4), ..RecordingOptions::default() };
    let own = read_recording(path, &RecordingOptions::default()).is_ok();
    let read = read_recording(path, &given);
    if let Ok(recording) = &read {
        assert!(!recording.is_empty(), "a recording without samples");
        let finite = |channel: &meshtone_io::recording::Channel| {
            channel.samples.iter().all(|sample| sample.is_finite())
        };
        assert!(recording.channels.iter().all(finite), "samples that are no numbers");
    }
    own || read.is_ok()
}

fn read_errors(path: &Path) -> bool {
    beside(path, |files, name| files.profile_errors(name).is_ok() & files.wheel_deviations(name).is_ok())
}

/// As a scenario beside the file would read it.
fn beside(path: &Path, read: impl Fn(&FilesBeside, &str) -> bool) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    read(&FilesBeside::new(path.parent().unwrap_or(Path::new(""))), &name)
}

/// A recording of the set that a file belongs to.
fn of_signal_set(path: &Path) -> bool {
    let is_one = |folder: &&Path| folder.join("metadata.parquet").exists();
    let folder = path.ancestors().skip(1).find(is_one).unwrap_or(path);
    let options = RecordingOptions { variable: Some("record-1".to_owned()), ..RecordingOptions::default() };
    read_recording(folder, &options).is_ok()
}

/// The data set that a file belongs to.
fn verified(path: &Path) -> bool {
    let is_one = |folder: &&Path| folder.join("manifest.json").exists();
    let place = Destination::directory(path.ancestors().skip(1).find(is_one).unwrap_or(path));
    let good = |check| verify(&place, check).is_ok_and(|found| found.is_good());
    good(Check::Sizes) & good(Check::Bytes)
}
