//! What a record holds is what its scenario gives, taken as a rig would take it.
#![allow(clippy::unwrap_used, clippy::panic)]

use meshtone::sensor::ContactFigures;
use std::fs::File;
use std::path::Path;

use crate::support::{FAST, SHARDS, pair_of, plan, run};
use meshtone::scenario::MemoryLimit;
use meshtone::signal::{
    ChainSettings, Edge, ShaftPhase, angular_resample, kaiser, kurtosis, octave_bands, process_channel,
    resample_with, resampling_ratio, rms,
};
use meshtone_dataset::draw::Sampler;
use meshtone_dataset::generate::Part;
use meshtone_dataset::plan::Plan;
use meshtone_dataset::shard::Shards;
use meshtone_dataset::store::Destination;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::{Field, Row, RowAccessor};

pub struct Made {
    pub directory: tempfile::TempDir,
    pub rows: Vec<Row>,
}

pub fn made(plan: &Plan) -> Made {
    let directory = tempfile::tempdir().unwrap();
    let to = directory.path().join("set");
    let generated = run(plan, &Destination::directory(&to), Part::WHOLE, 2).unwrap();
    assert_eq!(generated.failures, []);
    Made { rows: read(&to), directory }
}

/// The records of a shard, in its order.
fn rows_of(shard: &Path) -> Vec<Row> {
    let shard = SerializedFileReader::new(File::open(shard).unwrap()).unwrap();
    shard.get_row_iter(None).unwrap().map(Result::unwrap).collect()
}

/// The records of all splits, by their numbers.
fn read(directory: &Path) -> Vec<Row> {
    let shards = std::fs::read_dir(directory.join("data")).unwrap();
    let mut rows: Vec<Row> = shards.flat_map(|shard| rows_of(&shard.unwrap().path())).collect();
    // The number of the record is the first column.
    rows.sort_by_key(|row| row.get_long(0).unwrap());
    rows
}

impl Made {
    pub fn field(&self, name: &str, row: usize) -> &Field {
        let mut fields = self.rows[row].get_column_iter();
        fields.find(|(other, _)| *other == name).unwrap_or_else(|| panic!("{name}")).1
    }

    pub fn signal(&self, name: &str, row: usize) -> Vec<f64> {
        let Field::ListInternal(list) = self.field(name, row) else { panic!("{name}") };
        let number = |item: &Field| match item {
            Field::Float(number) => f64::from(*number),
            other => panic!("{name}: {other}"),
        };
        list.elements().iter().map(number).collect()
    }

    pub fn number(&self, name: &str, row: usize) -> f64 {
        match self.field(name, row) {
            Field::Double(number) => *number,
            other => panic!("{name}: {other}"),
        }
    }

    pub fn integer(&self, name: &str, row: usize) -> i64 {
        match self.field(name, row) {
            Field::Long(number) => *number,
            other => panic!("{name}: {other}"),
        }
    }

    /// A whole number of any width.
    pub fn whole(&self, name: &str, row: usize) -> i64 {
        match self.field(name, row) {
            Field::Int(number) => i64::from(*number),
            Field::Long(number) => *number,
            other => panic!("{name}: {other}"),
        }
    }

    pub fn tooth(&self, row: usize) -> Option<i32> {
        match self.field("fault_tooth", row) {
            Field::Int(number) => Some(*number),
            Field::Null => None,
            other => panic!("{other}"),
        }
    }

    pub fn text(&self, name: &str, row: usize) -> String {
        match self.field(name, row) {
            Field::Str(text) => text.clone(),
            other => panic!("{name}: {other}"),
        }
    }
}

fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
    let (p, q) = (mean(a), mean(b));
    let sum = |f: &dyn Fn(f64, f64) -> f64| a.iter().zip(b).map(|(x, y)| f(x - p, y - q)).sum::<f64>();
    sum(&|x, y| x * y) / (sum(&|x, _| x * x) * sum(&|_, y| y * y)).sqrt()
}

#[test]
fn rows_are_the_plans_records() {
    let plan = plan(FAST);
    let made = made(&plan);
    let sampler = Sampler::new(&plan.content).unwrap();
    assert_eq!(made.rows.len(), 60);
    for row in 0..60 {
        let record = sampler.record(row as u64).unwrap();
        assert_eq!(made.integer("record", row), row as i64);
        assert_eq!(made.integer("unit", row), record.unit as i64);
        assert_eq!(made.integer("seed", row), record.seed as i64);
        assert_eq!(made.text("label", row), plan.content.classes[record.class].label);
        assert_eq!(made.text("split", row), plan.content.splits.names()[record.split]);
        let speed = record.values.iter().find(|(key, _)| key == "operation.pinion_speed_hz").unwrap().1;
        assert_eq!(made.number("pinion_speed_hz", row), speed);
        assert_eq!(made.number("gear_speed_hz", row), speed * 20.0 / 40.0);
        assert_eq!(made.tooth(row).is_some(), record.class != 0);
        // A hunting period: so many revolutions of the gear as the pinion has teeth over their common divisor.
        let seconds = made.signal("vertical_g", row).len() as f64 / 8e3;
        assert!((seconds * speed - 40.0).abs() < 2.0 * speed / 8e3, "{seconds}");
    }
}

/// The loaders of other libraries find the splits by the names of the files.
#[test]
fn a_file_has_records_of_one_split_by_their_numbers() {
    let made = made(&plan(FAST));
    let mut records = Vec::new();
    for name in SHARDS {
        let rows = rows_of(&made.directory.path().join("set").join(name));
        let numbers: Vec<i64> = rows.iter().map(|row| row.get_long(0).unwrap()).collect();
        assert!(numbers.is_sorted(), "{numbers:?}");
        for number in numbers {
            let split = made.text("split", number as usize);
            assert!(name.starts_with(&format!("data/{split}-")), "{name}: {split}");
            records.push(number);
        }
    }
    records.sort_unstable();
    assert!(records.into_iter().eq(0..60));
}

/// Also where the name of a split goes on with a number, as of the files of another split.
#[test]
fn patterns_match_the_files_of_one_split() {
    let plan = plan(&FAST.replace("\"fast\"", "\"test-2\""));
    let sampler = Sampler::new(&plan.content).unwrap();
    let shards = Shards::new(&plan, &sampler);
    assert_eq!(shards.pattern("test"), "data/test-[0-9][0-9][0-9][0-9][0-9][0-9].parquet");
    let matches = |pattern: &str, name: &str| {
        name.replace(|c: char| c.is_ascii_digit(), "#") == pattern.replace("[0-9]", "#").replace("-2-", "-#-")
    };
    let names: Vec<String> = (0..shards.count()).map(|shard| shards.name(shard)).collect();
    for (split, count) in [("train", 4), ("validation", 1), ("test", 2), ("test-2", 2)] {
        let pattern = shards.pattern(split);
        assert_eq!(
            names.iter().filter(|name| matches(&pattern, name)).count(),
            count,
            "{pattern}: {names:?}"
        );
    }
}

/// A run that is killed loses the shard that it was writing. A core took 13 and 180 ms for a record of these plans (2026-11).
#[test]
fn a_killed_run_loses_less_than_a_minute() {
    let per_shard = |plan: &Plan| {
        let sampler = Sampler::new(&plan.content).unwrap();
        Shards::new(plan, &sampler).records_per_shard
    };
    let read = |name: &str| Plan::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(name)).unwrap();
    let gearbox = meshtone_dataset::plan::gearbox_template()
        .replace("[keep]", "[keep]\naverage = false\ndifference = false\nchannels = []");
    let (benchmark, gearbox) =
        (per_shard(&read("../../python/meshtone/benchmark/pairs-1.toml")), per_shard(&plan(&gearbox)));
    // Of indicators alone, 32 MB would be thousands of records of the gearbox.
    for (records, record_s) in [(benchmark, 0.013), (gearbox, 0.18)] {
        let lost_s = records as f64 * record_s;
        println!("{records} records, {lost_s:.0} s");
        assert!((5.0..60.0).contains(&lost_s), "{records} records: {lost_s} s");
    }
}

/// Warnings and the time without pushing teeth are those of the record's scenario, simulated alone; card and manifest count them.
#[test]
fn warnings_are_columns_and_are_counted() {
    let light = FAST
        .replace("records = 60", "records = 12")
        .replace("brake_torque_nm = 200.0", "brake_torque_nm = 3.0")
        .replacen("sampling_rate_hz = 1e4", "sampling_rate_hz = 1e5", 1);
    let undercut = light
        .replace("pinion_teeth = 20", "pinion_teeth = 14")
        .replace("brake_torque_nm = 3.0", "brake_torque_nm = 200.0");
    for (model, text) in [("linear", light), ("contact", undercut)] {
        let sections = format!("[scenario]\nmodel = \"{model}\"\n[scenario.gears]");
        let plan = plan(&text.replace("[scenario.gears]", &sections));
        let made = made(&plan);
        let sampler = Sampler::new(&plan.content).unwrap();
        let mut counts = std::collections::BTreeMap::new();
        for row in 0..12 {
            let scenario = pair_of(&sampler, &sampler.record(row as u64).unwrap());
            let (stages, mut warnings) =
                meshtone::stages_and_warnings(&scenario, MemoryLimit::default()).unwrap();
            let simulation = stages.simulate().unwrap();
            // A data set judges the step by an estimate alone.
            warnings.extend(simulation.warnings_of_signals(meshtone::StepJudgement::Estimated));
            let codes: Vec<&str> = warnings.iter().map(|warning| warning.kind.code()).collect();
            assert_eq!(made.text("warnings", row), codes.join(";"));
            codes.iter().for_each(|code| *counts.entry((*code).to_owned()).or_insert(0) += 1);
            let (name, part) = match simulation.contact_figures() {
                Some(figures) => ("apart_fraction", figures.apart_fraction),
                None => {
                    let force = ContactFigures::of_force(&simulation.channels["mesh_force_n"]);
                    ("tension_fraction", force.back_flank_fraction)
                }
            };
            // The record is simulated from where it begins, with a margin for filters.
            assert!(
                (made.number(name, row) - part).abs() < 0.01,
                "{name}: {} {part}",
                made.number(name, row)
            );
        }
        println!("{model}: {counts:?}");
        let common = if model == "linear" { "mesh-pulls" } else { "undercut" };
        assert!(counts.get(common).is_some_and(|count| *count > 2), "{counts:?}");
        let file =
            |name: &str| std::fs::read_to_string(made.directory.path().join("set").join(name)).unwrap();
        let manifest: serde_json::Value = serde_json::from_str(&file("manifest.json")).unwrap();
        assert_eq!(manifest["warnings"], serde_json::json!(counts));
        let row = format!("| `{common}` | {} | ", counts[common]);
        assert!(file("README.md").contains(&row), "{row}");
    }
}

/// A linear mesh that hardly anything damps.
const RESONANT: &str = r#"[scenario]
model = "linear"
[scenario.rig]
damping_ratio = 0.005
mesh_damping_ratio = 0.005
[scenario.gears]
tip_chamfer_mm = 0.6"#;

/// Of a record the step is judged by an estimate alone. It is a bound: of what it reports of a step that is far too long, a second
/// simulation with half the step confirms most, and of a step that is short enough it reports nothing.
#[test]
fn a_step_too_long_is_warned_of_without_a_second_simulation() {
    for (rate, expected) in [("2e4", 10..=12), ("1e5", 0..=0)] {
        let plan = plan(
            &FAST
                .replace("records = 60", "records = 12")
                .replacen("sampling_rate_hz = 1e4", &format!("sampling_rate_hz = {rate}"), 1)
                // So light that no flanks overlap.
                .replace("brake_torque_nm = 200.0", "brake_torque_nm = 2.0")
                .replace("[scenario.gears]", RESONANT),
        );
        let (made, sampler) = (made(&plan), Sampler::new(&plan.content).unwrap());
        let warned: Vec<usize> = (0..12)
            .filter(|row| made.text("warnings", *row).split(';').any(|code| code == "step-error"))
            .collect();
        assert!(expected.contains(&warned.len()), "{rate}: {warned:?}");
        let is_confirmed = |row: &&usize| {
            let scenario = pair_of(&sampler, &sampler.record(**row as u64).unwrap());
            let (stages, _) = meshtone::stages_and_warnings(&scenario, MemoryLimit::default()).unwrap();
            let repeated = stages.simulate().unwrap().warnings_of_signals(meshtone::StepJudgement::Repeated);
            repeated.iter().any(|warning| warning.kind.code() == "step-error")
        };
        let confirmed = warned.iter().filter(is_confirmed).count();
        println!("{rate} S/s: warned of {}, confirmed of {confirmed}", warned.len());
        assert!(4 * confirmed >= 3 * warned.len(), "{rate}: {confirmed} of {warned:?}");
    }
}

/// Average, difference and indicators are those of the raw channel as it is kept, noise included.
#[test]
fn the_raw_channel_gives_the_same_average() {
    let plan = plan(FAST);
    let made = made(&plan);
    for row in 0..12 {
        let raw = made.signal("vertical_g", row);
        let phase = ShaftPhase::constant(made.number("gear_speed_hz", row), 8e3, raw.len()).unwrap();
        let record = process_channel(&raw, &phase, 40, &ChainSettings::default()).unwrap();
        for (name, values) in
            [("average_g", &record.average.values), ("difference_g", &record.parts.difference)]
        {
            let kept = made.signal(name, row);
            assert!(
                kept.iter().zip(values).all(|(a, b)| (a - b).abs() <= 1e-7 * rms(values).max(b.abs())),
                "{name}"
            );
        }
        assert_eq!(record.average.revolutions, 20);
        for value in record.indicators.table("g") {
            let name = if value.unit == "g" { format!("{}_g", value.name) } else { value.name };
            let kept = match made.field(&name, row) {
                Field::Null => None,
                _ => Some(made.number(&name, row)),
            };
            assert_eq!(value.value, kept, "{name}");
        }
    }
}

/// A low-pass filter of 80 dB between 0.8 and 1 of half the lower rate, by Kaiser's formulas.
fn steep_taps(up: usize, down: usize) -> Vec<f64> {
    let crossing = up.max(down) as f64 / 0.9;
    let half = (23.0 * crossing) as usize;
    let sinc =
        |t: f64| if t == 0.0 { 1.0 } else { (std::f64::consts::PI * t).sin() / (std::f64::consts::PI * t) };
    let tap = |i: usize| {
        let t = (i as f64 - half as f64) / crossing;
        sinc(t) * kaiser(t / 23.0, 7.857)
    };
    let taps: Vec<f64> = (0..=2 * half).map(tap).collect();
    let scale = up as f64 / taps.iter().sum::<f64>();
    taps.into_iter().map(|tap| tap * scale).collect()
}

/// A record is its scenario's simulation, begun at the mark and brought to the data set's rate.
#[test]
fn the_simulation_is_in_the_record() {
    compare_with_simulations(FAST, "vertical_g", 6, |simulation| &simulation.channels["vertical_g"]);
}

/// The resonance of a sensor without noise is applied at the data set's rate, and at that of the simulation elsewhere.
#[test]
fn a_resonance_is_the_same_at_either_rate() {
    let sensor = "[[scenario.sensor]]\nname = \"casing\"\nresonance_hz = 2e3\nresonance_damping_ratio = 0.02\n\n[[class]]";
    let text = FAST.replacen("[[class]]", sensor, 1);
    compare_with_simulations(&text, "casing_g", 3, |simulation| &simulation.channels.signals[0].values[..]);
}

/// Compares the first records of a plan with simulations of their scenarios.
fn compare_with_simulations(
    text: &str,
    channel: &str,
    records: usize,
    simulated: impl Fn(&meshtone::Simulation) -> &[f64],
) {
    let plan = plan(
        &text
            .replace("[[vary]]\nkey = \"noise.snr_db\"\nuniform = [10.0, 30.0]\n", "")
            // Speeds at which the ratio of the rates is one of small numbers, for the other resampling.
            .replace("uniform = [30.0, 60.0]", "choice = [32.0, 40.0, 52.0]"),
    );
    let made = made(&plan);
    let sampler = Sampler::new(&plan.content).unwrap();
    for row in 0..records {
        let record = sampler.record(row as u64).unwrap();
        let simulation = meshtone::simulate(pair_of(&sampler, &record)).unwrap();
        let (up, down) = resampling_ratio(simulation.channels.sampling_rate_hz, 8e3).unwrap();
        // It begins when some tooth comes into contact; nothing else differs.
        let simulated = simulated(&simulation);
        let from = |start: usize| {
            let turned = [&simulated[start..], &simulated[..start]].concat();
            resample_with(&turned, up, down, &steep_taps(up, down), Edge::Periodic).unwrap()
        };
        let kept = made.signal(channel, row);
        let period = from(0).len();
        assert_eq!(kept.len(), period + 1);
        let per_tooth = simulation.stages.time.samples_per_pinion_revolution / 20;
        let starts = (0..simulated.len()).step_by(per_tooth);
        let best = starts.map(|start| correlation(&kept[..period], &from(start))).fold(f64::MIN, f64::max);
        assert!(best > 0.999_999, "{row}: {best}");
    }
}

/// The damaged tooth's number is where the difference is largest.
#[test]
fn the_fault_is_at_its_tooth() {
    let text = FAST.replace("[[vary]]\nkey = \"noise.snr_db\"\nuniform = [10.0, 30.0]\n", "");
    bursts_are_at_their_teeth(&text, 40.0, |_, _| {});
}

/// A damaged tooth of the pinion shows at its number in the average over the pinion's revolutions.
#[test]
fn a_fault_of_the_pinion_is_at_its_tooth() {
    let text = FAST
        .replace("[[vary]]\nkey = \"noise.snr_db\"\nuniform = [10.0, 30.0]\n", "")
        .replace(
            "{ kind = \"missing-tooth\" }",
            "{ kind = \"missing-tooth\", wheel = \"pinion\", tooth = 5 }",
        )
        .replace("[keep]", "[keep]\nwheel = \"pinion\"");
    bursts_are_at_their_teeth(&text, 20.0, |made, row| {
        assert_eq!(
            ["fault_kind", "fault_wheel"].map(|name| made.text(name, row)),
            ["missing-tooth", "pinion"]
        );
    });
}

/// Whether the burst of every record of the missing tooth follows its tooth's contact, in records that begin anywhere and in those
/// that begin at it.
///
/// # Arguments
/// * `text` - the plan
/// * `teeth` - of the wheel over whose revolutions is averaged
/// * `check` - what else holds in a record
fn bursts_are_at_their_teeth(text: &str, teeth: f64, check: impl Fn(&Made, usize)) {
    let random = made(&plan(text));
    let aligned = made(&plan(&text.replace("[keep]", "[keep]\naligned = true")));
    let mut seen = Vec::new();
    for (made, is_aligned) in [(&random, false), (&aligned, true)] {
        for row in (0..60).filter(|&row| made.text("label", row) == "missing") {
            check(made, row);
            let difference = made.signal("difference_g", row);
            let largest = (0..difference.len())
                .max_by(|&a, &b| difference[a].abs().total_cmp(&difference[b].abs()))
                .unwrap();
            let pitch = largest as f64 / difference.len() as f64 * teeth;
            let tooth = made.tooth(row).unwrap();
            // It rings after its tooth came into contact, or should have.
            let after = (pitch - f64::from(tooth - 1)).rem_euclid(teeth);
            assert!(after < 4.0, "row {row}: {after} pitches after tooth {tooth}");
            assert!(!is_aligned || tooth == 1);
            seen.push(tooth);
        }
    }
    seen.sort_unstable();
    seen.dedup();
    assert!(seen.len() > 5, "{seen:?}");
}

/// Each fault has columns of its own; a key of the first is in one column, whether it is alone or not.
#[test]
fn several_faults_of_a_record() {
    let chip = "{ kind = \"tooth-breakage\", wheel = \"pinion\", tooth = 2, chip_height_mm = 3.0, chip_width_mm = 8.0 }";
    let missing = "{ kind = \"missing-tooth\", tooth = 9 }";
    let text = FAST.replace(
        "fault = { kind = \"missing-tooth\" }\nseverity = 4",
        &format!("fault = [{chip}, {missing}]\nseverity = 4\n[[class.vary]]\nkey = \"fault[0].chip_height_mm\"\nuniform = [1.0, 2.0]"),
    );
    let made = made(&plan(&text));
    let names: Vec<String> = made.rows[0].get_column_iter().map(|(name, _)| name.clone()).collect();
    assert_eq!(names.iter().filter(|name| *name == "fault_chip_height_mm").count(), 1);
    for row in 0..60 {
        let is_double = made.text("label", row) == "missing";
        let tooth = |name: &str| match made.field(name, row) {
            Field::Int(tooth) => Some(*tooth),
            Field::Null => None,
            other => panic!("{name}: {other}"),
        };
        assert_eq!(tooth("fault_2_tooth").is_some(), is_double);
        if !is_double {
            continue;
        }
        let named = ["fault_kind", "fault_wheel", "fault_2_kind", "fault_2_wheel"];
        assert_eq!(
            named.map(|name| made.text(name, row)),
            ["tooth-breakage", "pinion", "missing-tooth", "gear"]
        );
        assert!((1.0..=2.0).contains(&made.number("fault_chip_height_mm", row)));
        assert!((1..=20).contains(&tooth("fault_tooth").unwrap()));
        assert!((1..=40).contains(&tooth("fault_2_tooth").unwrap()));
        // The pinion's second tooth and the gear's ninth enter contact 7 teeth apart, up to the pinion's revolutions.
        assert_eq!((tooth("fault_2_tooth").unwrap() - tooth("fault_tooth").unwrap()).rem_euclid(20), 7);
    }
}

/// A drawn tooth has a column beside that of the same tooth counted from the record's start.
#[test]
fn a_drawn_tooth_is_stated_twice() {
    let missing = "fault = { kind = \"missing-tooth\" }\nseverity = 4";
    let drawn = format!("{missing}\n[[class.vary]]\nkey = \"fault.tooth\"\nchoice = [3, 17]");
    let plan = plan(
        &FAST.replace(missing, &drawn).replace("records_per_shard", "aligned = true\nrecords_per_shard"),
    );
    let made = made(&plan);
    let sampler = Sampler::new(&plan.content).unwrap();
    let mut seen = Vec::new();
    for row in (0..60).filter(|&row| made.text("label", row) == "missing") {
        let scenario = pair_of(&sampler, &sampler.record(row as u64).unwrap());
        let of_scenario = made.number("fault_tooth_of_scenario", row);
        assert_eq!(of_scenario, f64::from(scenario.faults[0].tooth.only().unwrap()));
        // An aligned record begins with it.
        assert_eq!(made.tooth(row), Some(1));
        seen.push(of_scenario as u32);
    }
    assert!(seen.contains(&3) && seen.contains(&17), "{seen:?}");
}

/// Every fault has a severity, however it was given.
#[test]
fn a_severity_is_stated_of_every_fault() {
    let missing = "fault = { kind = \"missing-tooth\" }\nseverity = 4";
    let crack = "fault = [{ kind = \"root-crack\", severity = 0.0 }, { kind = \"missing-tooth\", tooth = 9 }]\n\
                 [[class.vary]]\nkey = \"fault[0].severity\"\nchoice = [0.0, 0.4]";
    let plan = plan(&FAST.replace(missing, crack));
    let made = made(&plan);
    let sampler = Sampler::new(&plan.content).unwrap();
    let mut seen = Vec::new();
    for row in 0..60 {
        let severities = ["fault_severity", "fault_2_severity"].map(|name| match made.field(name, row) {
            Field::Double(severity) => Some(*severity),
            Field::Null => None,
            other => panic!("{name}: {other}"),
        });
        let scenario = pair_of(&sampler, &sampler.record(row as u64).unwrap());
        let expected = scenario.fault_severities().unwrap();
        assert_eq!(severities.into_iter().flatten().collect::<Vec<_>>(), expected);
        seen.extend(expected);
    }
    assert!([0.0, 0.4, 1.0].iter().all(|severity| seen.contains(severity)), "{seen:?}");
}

/// A fault on several teeth is on none that could be counted; its wheel and kind are stated.
#[test]
fn a_fault_on_several_teeth_has_no_number() {
    let missing = "fault = { kind = \"missing-tooth\" }";
    let made = made(&plan(&FAST.replace(missing, "fault = { kind = \"missing-tooth\", tooth = [1, 2] }")));
    for row in (0..60).filter(|&row| made.text("label", row) == "missing") {
        assert_eq!(made.tooth(row), None);
        assert_eq!(["fault_kind", "fault_wheel"].map(|name| made.text(name, row)), ["missing-tooth", "gear"]);
    }
}

#[test]
fn noise_is_as_large_as_it_says_and_of_each_channel_its_own() {
    let without = made(&plan(&FAST.replace(
        "key = \"noise.snr_db\"\nuniform = [10.0, 30.0]",
        "key = \"noise.level_g\"\nuniform = [0.0, 1e-12]",
    )));
    let with = made(&plan(FAST));
    let level = made(&plan(&FAST.replace(
        "key = \"noise.snr_db\"\nuniform = [10.0, 30.0]",
        "key = \"noise.level_g\"\nuniform = [1.999999, 2.0]",
    )));
    for row in 0..20 {
        let noise = |made: &Made, name: &str| -> Vec<f64> {
            let (noisy, clean) = (made.signal(name, row), without.signal(name, row));
            noisy.iter().zip(&clean).map(|(a, b)| a - b).collect()
        };
        let [vertical, horizontal] = ["vertical_g", "horizontal_g"].map(|name| noise(&with, name));
        let clean = without.signal("vertical_g", row);
        let mean = clean.iter().sum::<f64>() / clean.len() as f64;
        let deviation = rms(&clean.iter().map(|x| x - mean).collect::<Vec<_>>());
        let ratio_db = 20.0 * (deviation / rms(&vertical)).log10();
        assert!((ratio_db - with.number("noise_snr_db", row)).abs() < 0.3, "{ratio_db}");
        assert!(correlation(&vertical, &horizontal).abs() < 0.06);
        assert!((rms(&noise(&level, "vertical_g")) / 2.0 - 1.0).abs() < 0.04);
    }
}

#[test]
fn a_fluctuating_speed_is_followed() {
    let text = FAST.replace("brake_torque_nm = 200.0", "brake_torque_nm = 200.0\nspeed_fluctuation_hz = 0.2");
    let text = text
        .replace("[[vary]]\nkey = \"noise.snr_db\"\nuniform = [10.0, 30.0]\n", "")
        .replace("records = 60", "records = 12");
    let made = made(&plan(&text));
    for row in 0..12 {
        let angle = made.number("gear_angle_rev", row);
        assert!(angle.is_finite());
        // The mesh is what the average shows.
        assert!(made.number("average_rms_g", row) > made.number("difference_rms_g", row));
    }
}

#[test]
fn only_what_is_wanted_is_kept() {
    let keep = "[keep]\nchannels = [\"axial_g\"]\nduration_s = 0.25\naverage = false\nindicators = false";
    let made = made(&plan(&FAST.replace("[keep]", keep)));
    let names: Vec<String> = made.rows[0].get_column_iter().map(|(name, _)| name.clone()).collect();
    assert!(names.contains(&"difference_g".to_owned()) && names.contains(&"axial_g".to_owned()));
    for absent in ["average_g", "vertical_g", "fm4"] {
        assert!(!names.contains(&absent.to_owned()), "{absent}");
    }
    assert!((0..60).all(|row| made.signal("axial_g", row).len() == 2000));
}

#[test]
fn enhanced_signals_are_those_of_the_hybrid_stage() {
    let directory = tempfile::tempdir().unwrap();
    let tuned = "model = \"contact\"\n[enhancement]\nwidth_ratio = 0.5\nfault_to_harmonics_ratio = 1.0\nnoise_level = 0.0\n\
                 [signal]\nsampling_rate_hz = 8e3\n[[key]]\nkey = \"rig.support.damping_ratio\"\nvalue = 0.08\n";
    std::fs::write(directory.path().join("tuned.toml"), tuned).unwrap();
    let text =
        FAST.replace("seed = 3", "seed = 3\ntuned = \"tuned.toml\"").replace("records = 60", "records = 24");
    let path = directory.path().join("plan.toml");
    std::fs::write(&path, text).unwrap();
    let plan = Plan::read(&path).unwrap();
    let sampler = Sampler::new(&plan.content).unwrap();
    let made = made(&plan);
    for row in 0..24 {
        let scenario = pair_of(&sampler, &sampler.record(row as u64).unwrap());
        assert_eq!(scenario.number("rig.support.damping_ratio"), Some(0.08));
        let relative = rms(&made.signal("enhanced_relative_difference", row));
        match made.text("label", row).as_str() {
            "healthy" => assert!((relative - 1.0).abs() < 1e-6, "{relative}"),
            "missing" => assert!(relative > 1.5, "{relative}"),
            _ => assert!(relative > 0.5, "{relative}"),
        }
    }
    // Merging reads the plan's copies.
    let set = directory.path().join("set");
    run(&plan, &Destination::directory(&set), Part { number: 1, of: 2 }, 2).unwrap();
    run(&plan, &Destination::directory(directory.path().join("other")), Part { number: 2, of: 2 }, 2)
        .unwrap();
    let parts = [Destination::directory(&set), Destination::directory(directory.path().join("other"))];
    assert!(
        meshtone_dataset::merge::merge(&parts, &parts[0], meshtone_dataset::verify::Check::Sizes)
            .unwrap()
            .complete
    );
}

/// Enhancement that changes nothing leaves the record's own difference signal, but for where it begins and its scale: it is read as
/// the model of the scenario has it, here band-limited.
#[test]
fn what_is_enhanced_is_read_as_the_model_has_it() {
    let directory = tempfile::tempdir().unwrap();
    let tuned = "model = \"contact\"\n[enhancement]\nwidth_ratio = 1.0\nfault_to_harmonics_ratio = 1.0\nnoise_level = 0.0\n\
                 [signal]\nsampling_rate_hz = 8e3\n";
    std::fs::write(directory.path().join("tuned.toml"), tuned).unwrap();
    let text = FAST
        .replace("seed = 3", "seed = 3\ntuned = \"tuned.toml\"")
        .replace("records = 60", "records = 24")
        .replace("[[vary]]\nkey = \"noise.snr_db\"\nuniform = [10.0, 30.0]\n", "");
    let path = directory.path().join("plan.toml");
    std::fs::write(&path, text).unwrap();
    let made = made(&Plan::read(&path).unwrap());
    for row in (0..24).filter(|&row| made.text("label", row) == "missing") {
        let shape = |name: &str| {
            let signal = made.signal(name, row);
            let largest = signal.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            largest / rms(&signal)
        };
        let (enhanced, own) = (shape("enhanced_relative_difference"), shape("difference_g"));
        // Both are in single precision.
        assert!((enhanced / own - 1.0).abs() < 1e-4, "{enhanced} and {own}");
    }
}

#[test]
fn what_is_enhanced_is_averaged_over_the_wheel_that_was_tuned_to() {
    let directory = tempfile::tempdir().unwrap();
    let tuned = "model = \"contact\"\n[enhancement]\nwidth_ratio = 0.5\nfault_to_harmonics_ratio = 1.0\nnoise_level = 0.0\n\
                 [signal]\nsampling_rate_hz = 8e3\nwheel = \"pinion\"\n";
    std::fs::write(directory.path().join("tuned.toml"), tuned).unwrap();
    let path = directory.path().join("plan.toml");
    let plan = |keep: &str| {
        let text = FAST.replace("seed = 3", "seed = 3\ntuned = \"tuned.toml\"").replace("[keep]", keep);
        std::fs::write(&path, text.replace("records = 60", "records = 24")).unwrap();
        Plan::read(&path)
    };
    let of_pinion = plan("[keep]").unwrap();
    assert_eq!(of_pinion.content.keep.wheel.names(), "pinion");
    let made = made(&of_pinion);
    let points = made.signal("enhanced_relative_difference", 0).len();
    assert_eq!(points, made.signal("difference_g", 0).len());
    let error = plan("[keep]\nwheel = \"gear\"").unwrap_err().to_string();
    assert!(error.contains("keep.wheel") && error.contains("tuned to"), "{error}");
}

/// Listed sensors are kept and analysed unless others are named, and their numbers can be varied.
#[test]
fn sensors_are_what_is_kept() {
    let sensors = "[[scenario.sensor]]\nname = \"casing\"\nresonance_hz = 2e3\n[[scenario.sensor]]\nrange_g = 1.0\n\n[[class]]";
    let vary =
        "[[vary]]\nkey = \"sensor[0].resonance_hz\"\nuniform = [1.5e3, 3e3]\n\n[keep]\nduration_s = 0.15";
    let text = FAST
        .replacen("[[class]]", sensors, 1)
        .replacen("[keep]", vary, 1)
        .replace("[[vary]]\nkey = \"noise.snr_db\"\nuniform = [10.0, 30.0]\n", "")
        .replace("records = 60", "records = 16");
    let plan = plan(&text);
    let keep = &plan.content.keep;
    let names: Vec<_> = keep.channels.iter().map(|channel| channel.name()).collect();
    assert_eq!(names, ["casing_g", "pinion_support_vertical_g"]);
    assert_eq!(keep.analysed.name(), "casing_g");
    let made = made(&plan);
    for row in 0..16 {
        let [casing, ranged] = ["casing_g", "pinion_support_vertical_g"].map(|name| made.signal(name, row));
        assert_eq!((casing.len(), ranged.len()), (1200, 1200));
        // A signal that is cut to the range jumps between its ends, and the filter of the data set's rate rings beyond them.
        let largest = |signal: &[f64]| signal.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        assert!(
            largest(&ranged) < 3.0 && largest(&casing) > 3.0,
            "{} {}",
            largest(&ranged),
            largest(&casing)
        );
    }
    let named = text.replacen(
        "duration_s = 0.15",
        "channels = [\"vertical_g\", \"casing_g\"]\nanalysed = \"vertical_g\"",
        1,
    );
    let keep = crate::support::plan(&named).content.keep;
    assert_eq!(
        keep.channels.iter().map(|channel| channel.name()).collect::<Vec<_>>(),
        ["vertical_g", "casing_g"]
    );
}

/// Two records of one unit under one condition differ by their noise alone, wherever they begin, up to 0.8 of half the sampling
/// rate.
#[test]
fn averages_repeat_but_for_their_noise() {
    let text = FAST
        .replace("records = 60", "records = 40")
        .replace("units = 10", "units = 1")
        .replace("uniform = [30.0, 60.0]", "fixed = 40.0")
        .replace("uniform = [10.0, 30.0]", "fixed = 40.0");
    let text = format!(
        "{}[keep]\nsampling_rate_hz = 8e3\n[split]\ntrain = 1.0\n",
        &text[..text.find("[keep]").unwrap()]
    );
    let healthy = |text: &str| {
        let (first, last) =
            (text.find("[[class]]\nlabel = \"breakage\"").unwrap(), text.find("[[vary]]").unwrap());
        [&text[..first], &text[last..]].concat()
    };
    let made = made(&plan(&healthy(&text)));
    let averages: Vec<Vec<f64>> = (0..40).map(|row| made.signal("average_g", row)).collect();
    let revolutions = made.number("simulated_s", 0) * made.number("gear_speed_hz", 0);
    assert!((revolutions - 20.0).abs() < 1e-9);
    let raw = made.signal("vertical_g", 0);
    let noise = rms(&raw) * 1e-2;
    let nyquist_order = 4e3 / made.number("gear_speed_hz", 0);
    let lines = averages[0].len();
    for band in 0..8 {
        let [from, to] = [band, band + 1].map(|tenth| (f64::from(tenth) / 10.0 * nyquist_order) as usize);
        let mut power = 0.0;
        for (a, b) in (0..20).map(|pair| (2 * pair, 2 * pair + 1)) {
            let difference: Vec<f64> = averages[a].iter().zip(&averages[b]).map(|(x, y)| x - y).collect();
            let spectrum = meshtone_fourier::real_spectrum(&difference);
            power += spectrum[from..to].iter().map(|line| 2.0 * line.norm_sqr()).sum::<f64>() / 20.0;
        }
        let power = power / (lines * lines) as f64;
        // White: a tenth of the band has a tenth of it; of twice that of one average.
        let expected = 2.0 * noise * noise / revolutions * (to - from) as f64 / nyquist_order;
        let off_db = 10.0 * (power / expected).log10();
        assert!(off_db.abs() < 1.0, "band {band}: {off_db} dB");
    }
}

/// As many values in every record, at equal angles from the mark on, whatever the speed.
#[test]
fn records_over_the_angle_are_of_one_length() {
    let keep = "[keep]\npoints_per_revolution = 256\nrevolutions = 3";
    let over_time = FAST.replace("records = 60", "records = 12");
    let (angular, timely) = (made(&plan(&over_time.replace("[keep]", keep))), made(&plan(&over_time)));
    for row in 0..12 {
        let kept = angular.signal("vertical_g", row);
        assert_eq!(
            (kept.len(), angular.signal("average_g", row).len(), angular.signal("difference_g", row).len()),
            (768, 256, 256)
        );
        let speed = angular.number("gear_speed_hz", row);
        assert!((angular.number("sampling_rate_hz", row) - 256.0 * speed).abs() < 1e-9);
        // What both show of the same channel: tones below 0.7 of what 256 values show.
        let raw = timely.signal("vertical_g", row);
        let phase = ShaftPhase::constant(speed, 8e3, raw.len()).unwrap();
        let read = angular_resample(&raw, &phase, &Default::default()).unwrap();
        let points = read.points_per_revolution;
        let low = |values: &[f64], points: usize| {
            let mut spectrum = meshtone_fourier::real_spectrum(&values[points..2 * points]);
            spectrum.truncate(90);
            spectrum.into_iter().map(|line| line / points as f64).collect::<Vec<_>>()
        };
        let (a, b) = (low(&kept, 256), low(&read.values, points));
        let size = b.iter().map(|line| line.norm_sqr()).sum::<f64>().sqrt();
        let off = a.iter().zip(&b).map(|(x, y)| (x - y).norm_sqr()).sum::<f64>().sqrt();
        assert!(off < 0.02 * size, "{row}: {off} of {size}");
        // Indicators are of the revolutions that the record keeps: the first three of the longer one. The noise is drawn for the
        // level of each.
        let three = (3.0 * 8e3 / speed).ceil() as usize + 1;
        let phase = ShaftPhase::constant(speed, 8e3, three).unwrap();
        let first = process_channel(&raw[..three], &phase, 40, &ChainSettings::default()).unwrap();
        let kurtosis = kurtosis(&first.parts.difference).unwrap();
        let given = angular.number("difference_kurtosis", row);
        assert!((given / kurtosis - 1.0).abs() < 1e-3, "{row}: {given} {kurtosis}");
    }
}

/// A record of an unsteady motion is as long as it is asked to be.
#[test]
fn an_unsteady_record_has_its_duration() {
    let unsteady = FAST
        .replace("brake_torque_nm = 200.0", "brake_torque_nm = 200.0\nspeed_fluctuation_hz = 0.2")
        .replace("records = 60", "records = 12");
    for (duration_s, samples) in [(0.25, 2000), (0.3, 2400), (0.7, 5600)] {
        let made =
            made(&plan(&unsteady.replacen("[keep]", &format!("[keep]\nduration_s = {duration_s}"), 1)));
        assert!((0..12).all(|row| made.signal("vertical_g", row).len() == samples));
    }
}

/// Octaves are those of the difference signal; null beyond what the rate shows.
#[test]
fn octaves_are_of_the_difference_signal() {
    let made = made(&plan(&FAST.replace("records = 60", "records = 10")));
    for row in 0..10 {
        let difference = made.signal("difference_g", row);
        let nyquist_order = 4e3 / made.number("gear_speed_hz", row);
        let bands = octave_bands(&difference, 40, 0.8 * nyquist_order).unwrap();
        let shown: Vec<_> = bands.iter().flatten().collect();
        assert!((2..=3).contains(&shown.len()), "{}", shown.len());
        for (band, name) in shown.into_iter().zip(["half", "1", "2"]) {
            let kept = made.number(&format!("difference_octave_{name}_rms_g"), row);
            assert!((kept - band.rms).abs() < 1e-6 * band.rms, "{name}: {kept} {}", band.rms);
        }
        assert!(matches!(made.field("difference_octave_32_rms_g", row), Field::Null));
    }
}

/// A path's gain is in the channel, and in nothing that is computed of the mechanics.
#[test]
fn a_path_multiplies_the_channel() {
    let text = FAST.replace("records = 60", "records = 10").replace("noise.snr_db", "path.gain_db");
    let text = text.replace("uniform = [10.0, 30.0]", "fixed = 20.0");
    let without = text.replace("[[vary]]\nkey = \"path.gain_db\"\nfixed = 20.0\n", "");
    let (passed, plain) = (made(&plan(&text)), made(&plan(&without)));
    for row in 0..10 {
        let ratio = rms(&passed.signal("vertical_g", row)) / rms(&plain.signal("vertical_g", row));
        assert!((ratio - 10.0).abs() < 1e-5, "{ratio}");
        let ratio = passed.number("difference_kurtosis", row) / plain.number("difference_kurtosis", row);
        assert!((ratio - 1.0).abs() < 1e-5, "{ratio}");
        assert_eq!(passed.number("path_gain_db", row), 20.0);
    }
}

/// (g) The amplitude of a raw channel at a frequency of which its length is a whole number of periods.
fn amplitude(signal: &[f64], periods: f64) -> f64 {
    let step = std::f64::consts::TAU * periods / signal.len() as f64;
    let part =
        |of: fn(f64) -> f64| signal.iter().enumerate().map(|(i, x)| x * of(step * i as f64)).sum::<f64>();
    part(f64::cos).hypot(part(f64::sin)) * 2.0 / signal.len() as f64
}

// Two sets that differ by the path's ripple alone: at one frequency the two differ by a gain that is the mounting's own.
#[test]
fn runs_to_failure_and_ripples_of_paths_are_written() {
    let growth = "fault = { kind = \"root-crack\", severity = 0.5 }\n\
                  growth = { law = \"paris\", start = 0.05, failure = 0.9, life_rev = 1e6, censored = 0.5 }";
    let (body, _) = FAST.split_once("[split]").unwrap();
    let set = |ripple_db: &str| {
        let text = body
            .replace("fault = { kind = \"missing-tooth\" }\nseverity = 4", growth)
            .replace("records = 60\nunits = 10", "records = 36\nunits = 4\nmountings = 2")
            .replace("uniform = [30.0, 60.0]", "fixed = 40.0")
            .replace(
                "key = \"noise.snr_db\"\nuniform = [10.0, 30.0]",
                &format!("key = \"path.ripple_db\"\nfixed = {ripple_db}\nper = \"mounting\""),
            );
        made(&plan(&format!(
            "{text}\n[split]\nby = \"mounting\"\ntrain = 0.5\nvalidation = 0.0\ntest = 0.5\n"
        )))
    };
    let [even, rippled] = ["0.0", "3.0"].map(set);

    let mut gains = std::collections::BTreeMap::<i64, Vec<f64>>::new();
    let mut runs = std::collections::BTreeMap::<i64, Vec<[f64; 4]>>::new();
    for row in 0..rippled.rows.len() {
        let [before, after] = [&even, &rippled].map(|set| {
            assert_eq!(set.integer("record", row), even.integer("record", row));
            let signal = set.signal("vertical_g", row);
            // The mesh's 20 periods in each of the pinion's revolutions, at 40 Hz and 8 kS/s.
            amplitude(&signal, (signal.len() as f64 / 10.0).round())
        });
        gains.entry(rippled.whole("mounting", row)).or_default().push(after / before);
        if rippled.text("label", row) == "missing" {
            let [age, left, severity] =
                ["age_rev", "remaining_rev", "fault_severity"].map(|name| rippled.number(name, row));
            let censored = rippled.whole("censored", row) as f64;
            let answers = [age, left, censored, severity];
            runs.entry(rippled.whole("unit", row)).or_default().push(answers);
        } else {
            assert!(
                ["age_rev", "remaining_rev", "censored"]
                    .iter()
                    .all(|name| *rippled.field(name, row) == Field::Null)
            );
        }
    }
    assert_eq!(gains.len(), 8);
    for of_mounting in gains.values() {
        assert!(of_mounting.iter().all(|gain| (gain / of_mounting[0] - 1.0).abs() < 0.03), "{gains:?}");
    }
    let decibels: Vec<f64> = gains.values().map(|gains| 20.0 * gains[0].log10()).collect();
    let spread = decibels.iter().map(|db| db * db).sum::<f64>() / decibels.len() as f64;
    // Of eight normal draws with 3 dB, within four times the standard error of a variance.
    assert!((1.0..27.0).contains(&spread), "{decibels:?}");

    assert_eq!(runs.len(), 4);
    let mut stopped = 0;
    for run in runs.values_mut() {
        run.sort_by(|a, b| a[0].total_cmp(&b[0]));
        assert_eq!(run.len(), 3);
        assert!(run.windows(2).all(|pair| pair[0][1] > pair[1][1] && pair[0][3] < pair[1][3]), "{run:?}");
        // The age and what is left are the run's observed life, the same of all its records: all of the life, or less where it was stopped.
        let life = run[0][0] + run[0][1];
        assert!(run.iter().all(|[age, left, censored, _]| {
            (age + left - life).abs() < 1e-6 * life && *censored == run[0][2]
        }));
        assert_eq!(life < 0.999e6, run[0][2] == 1.0, "{run:?}");
        stopped += u32::from(run[0][2] == 1.0);
    }
    assert!((1..4).contains(&stopped), "{stopped}");

    let card = std::fs::read_to_string(rippled.directory.path().join("set/README.md")).unwrap();
    assert!(card.contains("**Splits are by mounting**") && card.contains("| *mountings* | "), "{card}");
}
