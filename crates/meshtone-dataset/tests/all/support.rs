//! What the tests of data sets share.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use meshtone::scenario::Scenario;
use meshtone_dataset::DatasetError;
use meshtone_dataset::draw::{DrawnRecord, Sampler};
use meshtone_dataset::generate::{GenerateControl, Generated, Part, generate};
use meshtone_dataset::plan::Plan;
use meshtone_dataset::store::Destination;

/// A plan of records that take milliseconds: tooth counts with a large common factor need few samples a revolution.
pub const FAST: &str = r#"
seed = 3
records = 60
units = 10

[scenario.gears]
module_mm = 3.0
pinion_teeth = 20
gear_teeth = 40
face_width_mm = 15.0
points_per_tooth = 1000
foundation = { rotation = "tooth" } # so soft that the long steps suffice
[scenario.operation]
pinion_speed_hz = 40.0
brake_torque_nm = 200.0
[scenario.quality]
din_grade = 7
[scenario.solver]
sampling_rate_hz = 1e4

[[class]]
label = "healthy"

[[class]]
label = "breakage"
fault = { kind = "tooth-breakage", chip_height_mm = 3.0, chip_width_mm = 8.0 }
severity = { measure = "fault.chip_height_mm", breaks = [2.0, 4.0] }
[[class.vary]]
key = "fault.chip_height_mm"
uniform = [1.0, 5.0]

[[class]]
label = "missing"
fault = { kind = "missing-tooth" }
severity = 4

[[vary]]
key = "operation.pinion_speed_hz"
uniform = [30.0, 60.0]

[[vary]]
key = "noise.snr_db"
uniform = [10.0, 30.0]

[keep]
sampling_rate_hz = 8e3
records_per_shard = 8

[split]
train = 0.5
validation = 0.1
test = 0.2
[[split.shift]]
name = "fast"
part = 0.2
when = "operation.pinion_speed_hz > 50"
"#;

/// The shards of a data set after it.
pub const SHARDS: [&str; 9] = [
    "data/train-000000.parquet",
    "data/train-000001.parquet",
    "data/train-000002.parquet",
    "data/train-000003.parquet",
    "data/validation-000004.parquet",
    "data/test-000005.parquet",
    "data/test-000006.parquet",
    "data/fast-000007.parquet",
    "data/fast-000008.parquet",
];

pub fn plan(text: &str) -> Plan {
    Plan::read_text(text.to_owned(), Path::new("plan.toml")).unwrap_or_else(|error| panic!("{error}"))
}

pub fn run(plan: &Plan, to: &Destination, part: Part, jobs: usize) -> Result<Generated, DatasetError> {
    let control = GenerateControl { progress: &|_, _| {}, cancelled: &AtomicBool::new(false) };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(jobs).build().unwrap();
    pool.install(|| generate(plan, to, part, &control))
}

/// Every file of a directory, by its name.
pub fn bytes(directory: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    for folder in [directory.to_path_buf(), directory.join("data")] {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_file() {
                let name = path.strip_prefix(directory).unwrap().display().to_string();
                files.insert(name, std::fs::read(&path).unwrap());
            }
        }
    }
    files
}

/// Names of the files that differ.
pub fn differing(a: &BTreeMap<String, Vec<u8>>, b: &BTreeMap<String, Vec<u8>>) -> Vec<String> {
    let names = a.keys().chain(b.keys());
    let mut names: Vec<String> = names.filter(|name| a.get(*name) != b.get(*name)).cloned().collect();
    names.sort();
    names.dedup();
    names
}

/// The scenario of a record of a pair.
pub fn pair_of(sampler: &Sampler, record: &DrawnRecord) -> Scenario {
    sampler.scenario(record).unwrap()
}
