//! Records a second, from the plan to files on the disk: of pairs, two channels of one hunting period at 25 kS/s, average, difference and
//! indicators, or what the benchmark keeps; and a tenth as many of a gearbox, as its template of a plan has them.
//!
//! ```sh
//! cargo bench -p meshtone-dataset                 # all plans, as many threads as processors
//! cargo bench -p meshtone-dataset -- 400 1        # 400 records of pairs each, one thread
//! ```
//!
//! Printed are records a second, and a second of processor time, which other programs' load hardly changes (Linux).
#![allow(clippy::expect_used, clippy::panic, clippy::print_stdout, missing_docs)]

use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use meshtone_dataset::generate::{GenerateControl, Part, generate};
use meshtone_dataset::plan::{Plan, gearbox_template};
use meshtone_dataset::store::Destination;

/// The healthy example's machine and each kind of fault, at 40 Hz, as many records of each.
const REFERENCE: &str = r#"
records = RECORDS
units = 20
scenario = "machine.toml"
[[class]]
label = "healthy"
[[class]]
label = "tooth-breakage"
fault = { kind = "tooth-breakage", chip_height_mm = 3.0, chip_width_mm = 8.0 }
[[class]]
label = "missing-tooth"
fault = { kind = "missing-tooth" }
[[class]]
label = "partial-face"
fault = { kind = "partial-face", width_mm = 5.0, start = 0.2, end = 0.6, depth = 0.5 }
[[class]]
label = "through-face"
fault = { kind = "through-face", start = 0.2, end = 0.6, depth = 0.5 }
[[class]]
label = "tooth-destruction"
fault = { kind = "tooth-destruction", start = 0.3, end = 0.8 }
[[vary]]
key = "operation.brake_torque_nm"
log_uniform = [2.0, 40.0]
"#;

fn main() {
    let mut numbers = std::env::args().skip(1).filter_map(|argument| argument.parse::<usize>().ok());
    let (records, threads) = (numbers.next().unwrap_or(600), numbers.next().unwrap_or(0));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../python/meshtone/benchmark");
    let benchmark = std::fs::read_to_string(folder.join("pairs-1.toml")).expect("the plan is there");
    let benchmark = benchmark.replace("records = 8000", &format!("records = {records}"));
    let gearbox = gearbox_template().replace("records = 200", &format!("records = {}", records / 10));
    let plans = [
        ("six classes at 40 Hz", REFERENCE.replace("RECORDS", &records.to_string())),
        ("pairs-1.toml, 15 to 45 Hz, a sensor, noise", benchmark),
        ("gearbox of two stages, from its template", gearbox),
    ];
    for (name, text) in plans {
        let plan = Plan::read_text(text, &folder.join("plan.toml")).unwrap_or_else(|error| panic!("{error}"));
        let directory = tempfile::tempdir().expect("a temporary directory");
        let control = GenerateControl { progress: &|_, _| {}, cancelled: &AtomicBool::new(false) };
        let (start, processor) = (Instant::now(), processor_s());
        let to = Destination::directory(directory.path());
        let generated =
            pool.install(|| generate(&plan, &to, Part::WHOLE, &control)).expect("it is generated");
        let (wall, used) = (start.elapsed().as_secs_f64(), processor_s() - processor);
        let made = generated.written_records as f64;
        println!(
            "{name}: {made} records, {} failed, in {wall:.2} s: {:.0} a second; {used:.2} s of processor time: {:.0} a second",
            generated.failures.len(),
            made / wall,
            made / used
        );
    }
}

/// (s) Processor time that this process has used; NaN where the system does not say.
fn processor_s() -> f64 {
    let ticks = || {
        let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
        // Behind the program's name, which may hold anything.
        let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
        Some(fields.get(11)?.parse::<f64>().ok()? + fields.get(12)?.parse::<f64>().ok()?)
    };
    // A hundred ticks a second on every Linux.
    ticks().map_or(f64::NAN, |ticks| ticks / 100.0)
}
