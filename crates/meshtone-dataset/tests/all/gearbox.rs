//! Data sets of a gearbox.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;

use meshtone::signal::{
    AngleZero, AngularSettings, GearTrain, ShaftPhase, StatedTurning, TrainRecording, TrainSettings,
    TrainTurning, revolution_average,
};
use meshtone_dataset::draw::Sampler;
use meshtone_dataset::generate::Part;
use meshtone_dataset::merge::merge;
use meshtone_dataset::plan::{gearbox_template, planetary_template};
use meshtone_dataset::store::Destination;
use meshtone_dataset::verify::{Check, verify};
use parquet::record::Field;

use crate::records::made;
use crate::refused::refused;
use crate::support::{bytes, differing, plan, run};

const WHEELS: [&str; 4] = ["z1", "z2", "z3", "z4"];

/// The plan that `meshtone init dataset --gearbox` prints, with fewer records, a lower rate, less settling and shafts of fewer elements.
fn fast() -> String {
    let mut text = gearbox_template();
    for (written, other) in [
        ("records = 200", "records = 48\nseed = 5"),
        ("sampling_rate_hz = 50000.0", "sampling_rate_hz = 20000.0"),
        ("#sampling_rate_hz = 25e3", "records_per_shard = 20\nsampling_rate_hz = 1e4"),
        ("duration_s = 1.0     ", "duration_s = 0.6     "),
        ("settle_fraction = 0.81", "settle_fraction = 0.25"),
        ("radius_mm = 20.0\n", "radius_mm = 20.0\nelements = 2\n"),
    ] {
        assert!(text.contains(written), "{written}");
        text = text.replace(written, other);
    }
    text
}

#[test]
fn records_are_labelled_by_wheel_and_no_unit_is_in_two_splits() {
    let plan = plan(&fast());
    let made = made(&plan);
    let mut classes = BTreeMap::new();
    let mut splits_of_units: BTreeMap<i64, BTreeSet<String>> = BTreeMap::new();
    let mut damaged_teeth = BTreeSet::new();
    for row in 0..made.rows.len() {
        let label = made.text("label", row);
        *classes.entry(label.clone()).or_insert(0) += 1;
        splits_of_units.entry(made.integer("unit", row)).or_default().insert(made.text("split", row));
        if label == "healthy" {
            for name in ["fault_kind", "fault_wheel", "fault_tooth", "fault_severity"] {
                assert_eq!(made.field(name, row), &Field::Null);
            }
            assert_eq!(made.whole("severity", row), 0);
            continue;
        }
        let (wheel, kind) = label.split_once('-').unwrap();
        assert_eq!(made.text("fault_wheel", row), wheel);
        assert!(made.text("fault_kind", row).contains(kind), "{label}");
        if let Some(tooth) = made.tooth(row) {
            damaged_teeth.insert((wheel.to_owned(), tooth));
            assert!((1..=made.whole(&format!("{wheel}_teeth"), row)).contains(&i64::from(tooth)));
        }
        let severity = made.number("fault_severity", row);
        let grade = if kind == "missing" { 5 } else { 1 + (severity * 4.0) as i64 };
        assert_eq!(made.whole("severity", row), grade, "{label} {severity}");
    }
    let expected =
        [("healthy", 16), ("z1-breakage", 8), ("z2-breakage", 8), ("z4-missing", 8), ("z4-pits", 8)];
    assert_eq!(classes, expected.map(|(label, count)| (label.to_owned(), count)).into());
    // The tooth is no label that the wheel alone gives away.
    assert!(damaged_teeth.len() > 12, "{damaged_teeth:?}");
    assert_eq!(splits_of_units.len(), 10);
    assert!(splits_of_units.values().all(|splits| splits.len() == 1), "{splits_of_units:?}");
    let all: BTreeSet<_> = splits_of_units.values().flatten().cloned().collect();
    assert_eq!(all, ["train", "validation", "test", "fast"].map(str::to_owned).into());
}

/// Jobs, parts, and a run that was stopped change no byte.
#[test]
fn a_data_set_of_a_gearbox_is_resumed_merged_and_verified_as_one_of_a_pair() {
    let plan = plan(&fast());
    let directory = tempfile::tempdir().unwrap();
    let place = |name: &str| Destination::directory(directory.path().join(name));
    assert!(run(&plan, &place("whole"), Part::WHOLE, 2).unwrap().complete);
    let whole = bytes(&directory.path().join("whole"));
    assert!(verify(&place("whole"), Check::Bytes).unwrap().is_good());
    let shard = directory.path().join("whole/data/train-000001.parquet");
    std::fs::remove_file(&shard).unwrap();
    assert_eq!(verify(&place("whole"), Check::Sizes).unwrap().missing.len(), 1);
    let again = run(&plan, &place("whole"), Part::WHOLE, 1).unwrap();
    assert_eq!((again.kept_shards, again.written_shards), (4, 1));
    assert_eq!(differing(&whole, &bytes(&directory.path().join("whole"))), [""; 0]);
    for number in 1..=2 {
        run(&plan, &place(&format!("part{number}")), Part { number, of: 2 }, 2).unwrap();
    }
    merge(&[place("part1"), place("part2")], &place("merged"), Check::Bytes).unwrap();
    assert_eq!(differing(&whole, &bytes(&directory.path().join("merged"))), [""; 0]);
    let card = std::str::from_utf8(&whole["README.md"]).unwrap();
    assert!(card.contains("10 units (gearboxes)") && card.contains("missing-tooth of z4"), "{card}");
}

/// The same plan with a material whose density varies, as wheels do, by unit.
fn of_varied_material(per: &str) -> String {
    let material =
        "[scenario.material]\nyoungs_modulus_gpa = 210.0\npoisson_ratio = 0.3\ndensity_kg_per_m3 = 7850.0";
    let vary = format!(
        "[[vary]]\nkey = \"material.density_kg_per_m3\"\n{per}uniform = [7700.0, 7900.0]\n{material}\n"
    );
    fast().replacen("[[scenario.shaft]]", &(vary + "[[scenario.shaft]]"), 1)
}

/// What is wrong with the wheels' teeth depends on the unit alone, and is another one in every unit.
#[test]
fn the_wheels_are_those_of_the_unit() {
    let plan = plan(&of_varied_material(""));
    let sampler = Sampler::new(&plan.content).unwrap();
    let mut units = BTreeMap::new();
    let mut again = 0;
    for index in 0..plan.records() {
        let drawn = sampler.record(index).unwrap();
        let mut gearbox = sampler.scenario(&drawn).unwrap();
        gearbox.faults.clear();
        let stages = meshtone::stages(&gearbox).unwrap();
        let deviations: Vec<_> = (stages.pairs.into_iter())
            .map(|pair| (pair.profile_errors.unwrap(), pair.run_out, pair.helix_slope_um))
            .collect();
        let of_record = (gearbox.material, deviations);
        if let Some(of_unit) = units.insert(drawn.unit, of_record.clone()) {
            assert!(of_unit == of_record, "unit {}", drawn.unit);
            again += 1;
        }
    }
    assert_eq!((units.len(), again), (10, 38));
    let units: Vec<_> = units.into_values().collect();
    for (number, (material, deviations)) in units.iter().enumerate() {
        for (other_material, other) in &units[..number] {
            assert_ne!(material, other_material);
            assert!(deviations.iter().zip(other).all(|(one, other)| one.0 != other.0));
        }
    }
}

/// What a record says of each wheel is what the chain for recordings of trains finds in its kept channel, which only knows the wheels' angles.
#[test]
fn indicators_are_those_of_a_recording_of_the_channel() {
    // The kept channel is all that is analysed only where it is not cut to a duration of its own.
    let text = fast()
        .replace("records = 48", "records = 10")
        .replace("units = 10", "units = 4")
        .replace("duration_s = 1.0\n", "duration_s = 0.6\n")
        .replace("duration_s = 0.6     ", "#");
    let plan = plan(&text);
    let made = made(&plan);
    let sampler = Sampler::new(&plan.content).unwrap();
    let mut largest: f64 = 0.0;
    for row in 0..made.rows.len() {
        let drawn = sampler.record(made.integer("record", row) as u64).unwrap();
        let gearbox = sampler.scenario(&drawn).unwrap();
        let mut train = GearTrain::of_scenario(&gearbox).unwrap();
        for wheel in &mut train.wheels {
            wheel.start_rev = made.number(&format!("{}_angle_rev", wheel.name), row);
        }
        let signal = made.signal("output_1_vertical_g", row);
        let sampling_rate_hz = made.number("sampling_rate_hz", row);
        let phase = ShaftPhase::constant(made.number("input_speed_hz", row), sampling_rate_hz, signal.len());
        let phase = phase.unwrap().with_zero(AngleZero::Simulated);
        let turning = TrainTurning::Shaft { shaft: train.input(), phase, stated: StatedTurning::Other };
        let recording =
            TrainRecording { signal: &signal, sampling_rate_hz, train: &train, turning: &turning };
        let records = recording.process(&TrainSettings::default()).unwrap();
        for of_wheel in &records.wheels {
            let name = &train.wheels[of_wheel.wheel].name;
            for indicator in of_wheel.records[0].indicators.table("g") {
                let unit = if indicator.unit == "g" { "_g" } else { "" };
                let column = format!("{name}_{}{unit}", indicator.name);
                let Some(expected) = indicator.value else {
                    assert_eq!(made.field(&column, row), &Field::Null, "{column}");
                    continue;
                };
                // A skewness may be almost 0: what is left of it is rounding.
                let off = (made.number(&column, row) - expected).abs() / expected.abs().max(1e-2);
                largest = largest.max(off);
                assert!(off < 1e-9, "row {row}, {column}: {expected}, off by {off}");
            }
        }
    }
    println!("largest relative deviation {largest}");
}

/// Also where a revolution of the damaged wheel is not a whole number of samples.
#[test]
fn an_aligned_record_begins_at_the_damaged_tooth_of_any_wheel() {
    let aligned = fast()
        .replace("records = 48", "records = 24")
        .replace("duration_s = 0.6     ", "aligned = true\nduration_s = 0.6     ");
    let odd = aligned.replacen("teeth = 32", "teeth = 31", 1);
    assert_ne!(odd, aligned);
    for text in [aligned, odd] {
        let made = made(&plan(&text));
        let mut wheels = BTreeSet::new();
        for row in (0..made.rows.len()).filter(|&row| made.tooth(row).is_some()) {
            let wheel = made.text("fault_wheel", row);
            assert_eq!(made.tooth(row), Some(1), "{wheel}");
            // Its tooth comes within a sample of the simulation, of which there are about 20 000 in a second.
            let angle_rev = made.number(&format!("{wheel}_angle_rev"), row);
            let sample_rev = made.number(&format!("{wheel}_speed_hz"), row) / 2e4;
            assert!(angle_rev <= 1e-9 && angle_rev > -1.1 * sample_rev, "{wheel}: {angle_rev}");
            wheels.insert(wheel);
        }
        assert_eq!(wheels, ["z1", "z2", "z4"].map(str::to_owned).into());
    }
}

/// (g) Order of an average, of which one value a point is given.
fn order(values: &[f64], order: usize) -> [f64; 2] {
    let phase = |point: usize| TAU * order as f64 * point as f64 / values.len() as f64;
    let sum = |part: fn(f64) -> f64| {
        let terms = values.iter().enumerate().map(|(point, value)| value * part(phase(point)));
        2.0 * terms.sum::<f64>() / values.len() as f64
    };
    [sum(f64::cos), sum(f64::sin)]
}

/// The average of every wheel is that of the gearbox's own simulation, which begins at the scenario's first tooth, turned as the labels say:
/// over whole cycles of the train both are averages of the same periodic motion.
#[test]
fn averages_begin_at_the_tooth_that_the_labels_count_from() {
    let text = fast()
        .replace("uniform = [25.0, 45.0]", "fixed = 30.0")
        .replace("uniform = [20.0, 40.0]", "fixed = 200.0")
        .replace("records = 48", "records = 12\nconstraints = [\"latent.load_nm > 20\"]")
        .replace("units = 10", "units = 4")
        .replace("duration_s = 0.6     ", "duration_s = 0.53    ")
        .replace("settle_tolerance = 1e-2", "settle_tolerance = 1e-6")
        // What is random is no part of the motion that repeats itself.
        .replace("log_uniform = [0.02, 0.2]", "fixed = 0.0");
    let text = text.replace("settle_fraction = 0.25", "settle_fraction = 0.95");
    let text = &text[..text.find("[[split.shift]]").unwrap()];
    let plan = plan(text);
    let made = made(&plan);
    let sampler = Sampler::new(&plan.content).unwrap();
    let mut compared = 0;
    for row in 0..made.rows.len() {
        let drawn = sampler.record(made.integer("record", row) as u64).unwrap();
        let mut gearbox = sampler.scenario(&drawn).unwrap();
        let Some(tooth) = made.tooth(row) else { continue };
        let of_scenario = gearbox.faults[0].tooth.only().unwrap();
        let wheel = made.text("fault_wheel", row);
        let number = WHEELS.iter().position(|name| *name == wheel).unwrap();
        let teeth = gearbox.wheels[number].teeth;
        // A cycle of the train, 15 revolutions of the input, after what is left of the wheel's first revolution.
        let speed_hz = made.number(&format!("{wheel}_speed_hz"), row);
        gearbox.solver.duration_s = Some(0.5005 + 1.0 / speed_hz);
        let simulation = meshtone::simulate(&gearbox).unwrap();
        let channels = &simulation.channels;
        let signal = channels.signal("output_1_vertical_g").unwrap();
        let train = GearTrain::of_layout(&gearbox, &simulation.stages.layout);
        let form = gearbox;
        let turning = TrainTurning::of_simulated(&form, channels.start_s, signal.len()).unwrap();
        let sampling_rate_hz = channels.sampling_rate_hz;
        let recording = TrainRecording { signal, sampling_rate_hz, train: &train, turning: &turning };
        let angular = recording.angular(number, &AngularSettings::default()).unwrap();
        let expected = revolution_average(&angular.values, angular.points_per_revolution);
        let found = made.signal(&format!("{wheel}_average_g"), row);
        // Tooth `tooth` of the record is tooth `of_scenario` of the scenario.
        let turn = (f64::from(of_scenario) - f64::from(tooth)) / f64::from(teeth);
        let (mut difference, mut whole) = (0.0, 0.0);
        for k in 1..=2 * teeth as usize {
            let ([a, b], [c, d]) = (order(&expected, k), order(&found, k));
            let (sin, cos) = (TAU * k as f64 * turn).sin_cos();
            // Begun so much later, a cos kθ + b sin kθ has these.
            let turned = [a * cos + b * sin, b * cos - a * sin];
            difference += (turned[0] - c).powi(2) + (turned[1] - d).powi(2);
            whole += a * a + b * b;
        }
        assert!(difference < 2e-3 * whole, "{wheel}, tooth {tooth}: {difference} of {whole}");
        compared += 1;
    }
    assert!(compared >= 6, "{compared}");
}

#[test]
fn what_a_gearbox_does_not_have_is_refused_at_its_key() {
    for (written, other, words) in [
        (
            "wheel = \"z4\", kind = \"pits\"",
            "wheel = \"z9\", kind = \"pits\"",
            vec!["class[4].fault", "z1, z2, z3, z4"],
        ),
        (
            "key = \"wheel[z3].face_width_mm\"",
            "key = \"wheel[z3].face_widht_mm\"",
            vec!["did you mean `wheel[z3].face_width_mm`"],
        ),
        (
            "key = \"wheel[z3].face_width_mm\"",
            "per = \"record\"\nkey = \"wheel[z3].face_width_mm\"",
            vec!["would differ between records of one unit"],
        ),
        (
            "[[scenario.shaft]]",
            "[scenario]\nwheels_seed = 3\n[[scenario.shaft]]",
            vec!["scenario.wheels_seed", "every unit has wheels of its own"],
        ),
        ("#wheel = [\"z1\", \"z2\", \"z3\", \"z4\"]", "wheel = [\"z1\", \"gear\"]", vec!["keep.wheel", "z3"]),
        ("duration_s = 0.6     ", "duration_s = 0.2     ", vec!["revolutions of the wheel z4"]),
        // The wheel z3 of 48 teeth is on the same shaft.
        ("#wheel = [", "wheel = \"z2\"\nsidebands = 24\n#wheel = [", vec!["keep.sidebands", "from 0 to 23"]),
        (
            "#channels = [\"input_0_vertical_g\",",
            "channels = [\"mesh_force_n\",",
            vec!["keep.channels", "input_0_vertical_g"],
        ),
        (
            "[[scenario.sensor]]\nat = \"input:0\"",
            "[scenario.gears]\nmodule_mm = 3.0\n[[scenario.sensor]]\nat = \"input:0\"",
            vec!["two forms"],
        ),
    ] {
        let text = fast();
        assert!(text.contains(written), "{written}");
        refused(&text.replacen(written, other, 1), &words);
    }
    refused(
        &of_varied_material("per = \"record\"\n"),
        &["material.density_kg_per_m3", "would differ between records of one unit"],
    );
}

/// Averages of a planetary set are those of windows, which begin with the first tooth of the record: a damaged tooth of sun and planets is where the
/// column says.
#[test]
fn damaged_teeth_of_a_planetary_set_are_where_the_record_says() {
    let mut text = planetary_template();
    for (written, other) in [
        ("records = 60\nunits = 6", "records = 6\nunits = 3"),
        ("questions = [\"detection\", \"diagnosis\", \"severity\"]", "questions = [\"diagnosis\"]"),
        ("teeth = { sun = 31, planet = 31, ring = 95 }", "teeth = { sun = 20, planet = 25, ring = 70 }"),
        ("profile_shift = { sun = 0.32, planet = 0.32, ring = -0.0611 }  # assumed\n", ""),
        ("iso_class = 5  # assumed\n", ""),
        (
            "sampling_rate_hz = 100000.0\nduration_s = 5.0",
            "sampling_rate_hz = 40000.0\nsettle_fraction = 0.2\nduration_s = 3.0",
        ),
        (
            "sampling_rate_hz = 25e3\nduration_s = 5.0",
            "difference = true\nsampling_rate_hz = 2e4\nduration_s = 3.0",
        ),
    ] {
        assert!(text.contains(written), "{written}");
        text = text.replace(written, other);
    }
    let (before, rest) = text.split_once("[[class]]\nlabel = \"healthy\"").unwrap();
    let after = &rest[rest.find("# What varies").unwrap()..];
    let class = |wheel: &str, tooth: u32| {
        format!(
            "[[class]]\nlabel = \"{wheel}\"\nfault = {{ wheel = \"{wheel}\", kind = \"missing-tooth\", tooth = {tooth} }}\nseverity = 5\n\n"
        )
    };
    let plan = plan(&format!(
        "{before}{}{}{}{after}",
        class("p.sun", 4),
        class("p.planet1", 7),
        class("p.planet2", 12)
    ));
    let made = made(&plan);
    for row in 0..made.rows.len() {
        let wheel = made.text("fault_wheel", row);
        let column = wheel.replace('.', "_");
        let tooth = f64::from(made.tooth(row).unwrap());
        let teeth = made.whole(&format!("{column}_teeth"), row) as f64;
        let difference = made.signal(&format!("{column}_difference_g"), row);
        let at = (0..difference.len())
            .max_by(|a, b| difference[*a].abs().total_cmp(&difference[*b].abs()))
            .unwrap();
        let found = 1.0 + at as f64 / difference.len() as f64 * teeth;
        // A sun's tooth is heard at each of three planets, and a planet's at sun and ring, whichever is the loudest.
        let again = teeth / if wheel == "p.sun" { 3.0 } else { 2.0 };
        let apart = (found - tooth + again / 2.0).rem_euclid(again) - again / 2.0;
        println!("{wheel}: tooth {tooth}, found at {found:.2}");
        // What the loss of the tooth leads to follows within two pitches.
        assert!((-0.5..2.5).contains(&apart), "{wheel}: {found} for {tooth}");
    }
}
