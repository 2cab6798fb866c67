//! Which records a plan has.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::collections::BTreeMap;

use crate::support::{FAST, pair_of, plan};
use meshtone_dataset::draw::{DrawnRecord, Sampler};
use meshtone_dataset::plan::Plan;

fn all(plan: &Plan) -> Vec<DrawnRecord> {
    let sampler = Sampler::new(&plan.content).unwrap();
    (0..plan.records()).map(|index| sampler.record(index).unwrap()).collect()
}

fn value(record: &DrawnRecord, key: &str) -> Option<f64> {
    record.values.iter().find(|(other, _)| other == key).map(|(_, value)| *value)
}

fn larger(records: u64, units: u64, more: &str) -> Plan {
    let text = FAST.replace("records = 60", &format!("records = {records}"));
    plan(
        &text
            .replace("units = 10", &format!("units = {units}"))
            .replace("[keep]", &format!("{more}\n[keep]")),
    )
}

#[test]
fn a_unit_is_in_one_split_with_the_same_wheels() {
    let more = "[[vary]]\nkey = \"quality.din_grade\"\nchoice = [5, 6, 7]\n\
                [[vary]]\nkey = \"rig.support.damping_ratio\"\nuniform = [0.02, 0.1]";
    let plan = larger(3000, 40, more);
    let mut units: BTreeMap<u64, Vec<DrawnRecord>> = BTreeMap::new();
    for record in all(&plan) {
        units.entry(record.unit).or_default().push(record);
    }
    assert_eq!(units.len(), 40);
    let sampler = Sampler::new(&plan.content).unwrap();
    let mut wheels = Vec::new();
    for records in units.values() {
        let first = &records[0];
        assert!((70..=80).contains(&records.len()), "{}", records.len());
        for key in ["quality.din_grade", "rig.support.damping_ratio"] {
            assert!(records.iter().all(|record| value(record, key) == value(first, key)));
        }
        assert!(
            records
                .iter()
                .all(|record| record.split == first.split && record.wheels_seed == first.wheels_seed)
        );
        // Every class, about evenly.
        for class in 0..3 {
            let count = records.iter().filter(|record| record.class == class).count();
            assert!((20..=30).contains(&count), "{count}");
        }
        // Their profile errors are the same, those of other units are not; their seeds differ.
        let [a, b] = [first, records.last().unwrap()].map(|record| pair_of(&sampler, record));
        assert_ne!(a.seed, b.seed);
        let errors = |scenario: &meshtone::scenario::Scenario| {
            meshtone::stages(scenario).unwrap().pairs[0].profile_errors.clone().unwrap()
        };
        assert_eq!(errors(&a), errors(&b));
        wheels.push(errors(&a));
    }
    for (i, one) in wheels.iter().enumerate() {
        assert!(wheels[..i].iter().all(|other| other != one));
    }
}

/// The base states one chamfer of both wheels and no relief.
#[test]
fn the_tips_of_either_wheel_vary() {
    let more = "[[vary]]\nkey = \"gears.gear_flank_relief.amount_um\"\nper = \"unit\"\nuniform = [10.0, 20.0]\n\
                [[vary]]\nkey = \"gears.pinion_tip_chamfer_mm\"\nuniform = [0.1, 0.4]";
    let plan = plan(
        &FAST
            .replace("points_per_tooth = 1000", "points_per_tooth = 1000\ntip_chamfer_mm = 0.5")
            .replace("[keep]", &format!("{more}\n[keep]")),
    );
    let sampler = Sampler::new(&plan.content).unwrap();
    for record in all(&plan) {
        let [pinion, gear] = &pair_of(&sampler, &record).wheels[..] else { panic!() };
        let [amount_um, chamfer_mm] = ["gears.gear_flank_relief.amount_um", "gears.pinion_tip_chamfer_mm"]
            .map(|key| value(&record, key).unwrap());
        assert!((10.0..=20.0).contains(&amount_um) && (0.1..=0.4).contains(&chamfer_mm));
        assert_eq!((pinion.flank_relief.amount_um, gear.flank_relief.amount_um), (0.0, amount_um));
        assert_eq!((pinion.tip_chamfer_mm, gear.tip_chamfer_mm), (Some(chamfer_mm), Some(0.5)));
    }
}

#[test]
fn what_is_held_out_is_nowhere_else() {
    let text = "[[split.shift]]\nname = \"severe\"\npart = 0.1\nwhen = \"severity == 3\"\n\
                [[split.shift]]\nname = \"teeth\"\npart = 0.1\nwhen = [\"gears.pinion_teeth == 18\", \"gears.gear_teeth == 36\"]\n";
    let pairs = "[[vary]]\nkeys = [\"gears.pinion_teeth\", \"gears.gear_teeth\"]\nchoice = [[20, 40], [18, 36], [19, 38]]";
    let text = format!(
        "{}{text}",
        FAST.replace("train = 0.5", "train = 0.3").replace("[keep]", &format!("{pairs}\n[keep]"))
    );
    let plan = plan(&text.replace("records = 60", "records = 3000").replace("units = 10", "units = 50"));
    let names = plan.content.splits.names();
    let mut counts: BTreeMap<&str, u32> = BTreeMap::new();
    for record in all(&plan) {
        let split = names[record.split];
        *counts.entry(split).or_default() += 1;
        let is = |name: &str| split == name;
        let speed = value(&record, "operation.pinion_speed_hz").unwrap();
        assert_eq!(speed > 50.0, is("fast"), "{record:?}");
        let teeth = value(&record, "gears.pinion_teeth").unwrap();
        assert_eq!(teeth == 18.0, is("teeth"), "{record:?}");
        // Only chipped teeth can be held out by their severity; the other classes are in every split.
        match record.class {
            1 => assert_eq!(record.severity == 3, is("severe"), "{record:?}"),
            2 => assert_eq!(record.severity, 4),
            _ => assert_eq!(record.severity, 0),
        }
    }
    assert_eq!(counts.len(), 6);
    assert!(counts["train"] > 800 && counts["fast"] > 500 && counts["teeth"] > 200, "{counts:?}");
}

#[test]
fn a_record_depends_on_its_number_alone() {
    let plan = larger(500, 20, "");
    let sampler = Sampler::new(&plan.content).unwrap();
    let forwards = all(&plan);
    for record in forwards.iter().rev() {
        assert_eq!(sampler.record(record.index).unwrap(), *record);
    }
    let mut seeds: Vec<u64> = forwards.iter().map(|record| record.seed).collect();
    seeds.sort_unstable();
    seeds.dedup();
    assert_eq!(seeds.len(), 500);
    assert!(seeds.iter().all(|&seed| seed < 1 << 53));
}

/// Of every class the values fill their range evenly; where a tenth of the range is held out, the rest of it.
#[test]
fn designs_fill_the_ranges_in_every_class_and_unit() {
    for design in ["sobol", "latin-hypercube", "independent"] {
        let text = FAST.replace("seed = 3", &format!("seed = 3\ndesign = \"{design}\""));
        let alone = text[..text.find("[split]").unwrap()].to_owned() + "[split]\ntrain = 1.0\n";
        let plan = plan(&alone.replace("records = 60", "records = 3072").replace("units = 10", "units = 16"));
        let records = all(&plan);
        for class in 0..3 {
            let mut speeds: Vec<f64> = records
                .iter()
                .filter(|record| record.class == class)
                .map(|record| (value(record, "operation.pinion_speed_hz").unwrap() - 30.0) / 30.0)
                .collect();
            speeds.sort_by(f64::total_cmp);
            let count = speeds.len() as f64;
            let largest = speeds
                .iter()
                .enumerate()
                .map(|(i, x)| (x - (i as f64 + 0.5) / count).abs())
                .fold(0.0, f64::max);
            // Kolmogorov's statistic of independent draws is 1.36/√1024 = 0.043 in one of 20 cases.
            let allowed = if design == "independent" { 0.07 } else { 0.002 };
            assert!(largest < allowed, "{design} {class}: {largest}");
        }
        // Units are not tied to places of the design.
        for unit in 0..16 {
            let speeds: Vec<f64> = records
                .iter()
                .filter(|record| record.unit == unit)
                .map(|record| value(record, "operation.pinion_speed_hz").unwrap())
                .collect();
            let mean = speeds.iter().sum::<f64>() / speeds.len() as f64;
            // Standard deviation of the mean of 192: 8.66/√192 = 0.63.
            assert!((mean - 45.0).abs() < 2.5, "{design} {unit}: {mean}");
        }
    }
}

#[test]
fn joint_rules() {
    let more = "[[vary]]\nkey = \"gears.module_mm\"\ngrid = [2, 3, 4]\n\
                [[vary]]\nkey = \"gears.face_width_mm\"\nuniform = [4, 6]\ntimes = \"gears.module_mm\"\n\
                [[vary]]\nkey = \"rig.eccentricity_mm\"\nfixed = 0.01\nplus = \"0.001 * gears.module_mm\"";
    let text =
        FAST.replace("uniform = [1.0, 5.0]", "uniform = [0.2, 0.6]\nfraction_of = \"tooth.height_mm\"");
    let text = text
        .replace("seed = 3", "seed = 3\nconstraints = [\"gears.face_width_mm > 9\"]")
        .replace("chip_width_mm = 8.0", "chip_width_mm = 5.0");
    let plan = plan(&text.replace("[keep]", &format!("{more}\n[keep]")));
    for record in all(&plan) {
        let [module, width, eccentricity] = ["gears.module_mm", "gears.face_width_mm", "rig.eccentricity_mm"]
            .map(|key| value(&record, key).unwrap());
        assert!([2.0, 3.0, 4.0].contains(&module));
        assert!(width > 9.0 && (4.0..6.0).contains(&(width / module)), "{width} {module}");
        assert!((eccentricity - 0.01 - 0.001 * module).abs() < 1e-15);
        if let Some(height) = value(&record, "fault.chip_height_mm") {
            assert!((0.2..0.6).contains(&(height / (2.25 * module))));
        }
    }
}

#[test]
fn cracks_are_drawn_and_graded_by_their_depth() {
    let crack = "fault = { kind = \"root-crack\", depth_mm = 1.0 }\n\
                 severity = { measure = \"fault.depth_mm / tooth.thickness_mm\", breaks = [0.25, 0.5] }\n\
                 [[class.vary]]\nkey = \"fault.depth_mm\"\nuniform = [0.2, 4.0]\n";
    let missing = "fault = { kind = \"missing-tooth\" }\nseverity = 4\n";
    let plan = plan(&FAST.replace(missing, crack));
    let mut grades = [0; 4];
    for record in all(&plan).iter().filter(|record| record.class == 2) {
        let depth_mm = value(record, "fault.depth_mm").unwrap();
        let thickness_mm = std::f64::consts::FRAC_PI_2 * 3.0;
        let share = depth_mm / thickness_mm;
        assert_eq!(record.severity, 1 + u8::from(share >= 0.25) + u8::from(share >= 0.5), "{share}");
        grades[usize::from(record.severity)] += 1;
    }
    assert!(grades[1..].iter().all(|&records| records > 0), "{grades:?}");
}

/// A severity is drawn where the fault is given by it, and found where it is given by its sizes; both grade a class.
#[test]
fn severities_of_a_kinds_own_scale() {
    let measure = "severity = { measure = \"fault.severity\", breaks = [0.3, 0.6] }";
    let drawn = "fault = { kind = \"root-crack\", severity = 0.5 }";
    let vary = "[[class.vary]]\nkey = \"fault.severity\"\nuniform = [0.1, 0.9]\n\
                [[class.vary]]\nkey = \"fault.angle_deg\"\nuniform = [40.0, 60.0]";
    let text = FAST
        .replace("fault = { kind = \"missing-tooth\" }\nseverity = 4", &format!("{drawn}\n{measure}\n{vary}"))
        .replace("severity = { measure = \"fault.chip_height_mm\", breaks = [2.0, 4.0] }", measure)
        .replace("[keep]", "[[vary]]\nkey = \"gears.module_mm\"\nuniform = [2.5, 4.0]\n[keep]")
        .replace("seed = 3", "seed = 3\nconstraints = [\"fault.severity < 0.8\"]");
    let plan = plan(&text);
    let sampler = Sampler::new(&plan.content).unwrap();
    let mut grades = [[0; 4]; 3];
    for record in all(&plan).iter().filter(|record| record.class > 0) {
        let severity = sampler.scenario(record).unwrap().fault_severities().unwrap()[0];
        assert!(severity > 0.0 && severity < 0.8);
        assert_eq!(record.severity_measure, Some(severity));
        assert_eq!(value(record, "fault.severity"), (record.class == 2).then_some(severity));
        assert_eq!(record.severity, 1 + u8::from(severity >= 0.3) + u8::from(severity >= 0.6));
        grades[record.class][usize::from(record.severity)] += 1;
    }
    assert!(grades[2][1..].iter().all(|&count| count > 3), "{grades:?}");
}

#[test]
fn a_mounting_has_its_own_values_and_every_class() {
    let more = "[[vary]]\nkey = \"rig.support.base_hz\"\nlog_uniform = [350, 550]\nper = \"mounting\"\n\
                [[vary]]\nkey = \"path.ripple_db\"\nfixed = 3\nper = \"mounting\"\n\
                [[vary]]\nkey = \"rig.support.mass_kg\"\nuniform = [1, 2]\n\
                [[vary]]\nkey = \"latent.load\"\nuniform = [50, 250]\nper = \"mounting\"\n\
                [[vary]]\nkey = \"operation.brake_torque_nm\"\nuniform = [0.95, 1.05]\ntimes = \"latent.load\"";
    let mounted = |by: &str| {
        let plan = larger(3000, 40, more);
        let text = plan.files[0].text.replace("units = 40", "units = 40\nmountings = 3");
        crate::support::plan(&text.replace("[split]", &format!("[split]\nby = \"{by}\"")))
    };
    let plan = mounted("unit");
    let records = all(&plan);
    let sampler = Sampler::new(&plan.content).unwrap();
    let mut mountings: BTreeMap<u64, Vec<&DrawnRecord>> = BTreeMap::new();
    for record in &records {
        assert_eq!(record.mounting / 3, record.unit);
        mountings.entry(record.mounting).or_default().push(record);
    }
    assert_eq!(mountings.len(), 120);
    let stiffness = |record: &DrawnRecord| value(record, "rig.support.base_hz").unwrap();
    for of_mounting in mountings.values() {
        let first = of_mounting[0];
        assert!((20..=30).contains(&of_mounting.len()), "{}", of_mounting.len());
        assert!(of_mounting.iter().all(|record| stiffness(record) == stiffness(first)));
        assert!(of_mounting.iter().all(|record| record.mounting_seed == first.mounting_seed));
        for class in 0..3 {
            let count = of_mounting.iter().filter(|record| record.class == class).count();
            assert!((5..=12).contains(&count), "{count}");
        }
        for record in of_mounting {
            let load = value(record, "latent.load").unwrap();
            assert_eq!(load, value(first, "latent.load").unwrap());
            let torque = pair_of(&sampler, record).operation.brake_torque_nm;
            assert!((0.95..=1.05).contains(&(torque / load)), "{torque} {load}");
        }
    }
    let of_unit: Vec<f64> = (0..3).map(|mounting| stiffness(mountings[&mounting][0])).collect();
    assert!(of_unit[0] != of_unit[1] && of_unit[1] != of_unit[2]);
    let mass = |mounting: u64| value(mountings[&mounting][0], "rig.support.mass_kg");
    assert!(mass(0) == mass(1) && mass(1) == mass(2) && mass(2) != mass(3));
    // By unit all mountings of one are in one split; by mounting each is, and units are in several.
    let splits_of_units = |records: &[DrawnRecord]| {
        let mut splits: BTreeMap<u64, std::collections::BTreeSet<usize>> = BTreeMap::new();
        records.iter().for_each(|record| _ = splits.entry(record.unit).or_default().insert(record.split));
        splits.values().map(std::collections::BTreeSet::len).max().unwrap()
    };
    assert_eq!(splits_of_units(&records), 1);
    let remounted = all(&mounted("mounting"));
    assert!(splits_of_units(&remounted) > 1);
    let mut split_of_mounting = BTreeMap::new();
    for record in &remounted {
        assert_eq!(*split_of_mounting.entry(record.mounting).or_insert(record.split), record.split);
    }
    // What a shift's condition says holds there alone.
    let speed = |record: &DrawnRecord| value(record, "operation.pinion_speed_hz").unwrap();
    assert!(remounted.iter().all(|record| (record.split == 3) == (speed(record) > 50.0)));
}

#[test]
fn a_unit_runs_to_failure_in_one_mounting() {
    let grown = "fault = { kind = \"root-crack\", severity = 0.5 }\n\
                 growth = { law = \"paris\", start = 0.05, failure = 0.9, life_rev = { log_uniform = [1e6, 1e7] }, censored = 0.3 }";
    let text = larger(1500, 25, "").files[0].text.clone();
    let text = text
        .replace("fault = { kind = \"missing-tooth\" }\nseverity = 4", grown)
        .replace("units = 25", "units = 25\nmountings = 2");
    let plan = plan(&text);
    let mut runs: BTreeMap<u64, Vec<DrawnRecord>> = BTreeMap::new();
    for record in all(&plan) {
        assert_eq!(record.age.is_some(), record.class == 2);
        if record.class == 2 {
            runs.entry(record.unit).or_default().push(record);
        }
    }
    assert_eq!(runs.len(), 25);
    let mut censored = 0;
    for records in runs.values_mut() {
        records.sort_by(|a, b| a.age.unwrap().age_rev.total_cmp(&b.age.unwrap().age_rev));
        assert_eq!(records.len(), 20);
        assert!(records.iter().all(|record| record.mounting == records[0].mounting));
        let severities: Vec<f64> =
            records.iter().map(|record| value(record, "fault.severity").unwrap()).collect();
        assert!(severities.windows(2).all(|pair| pair[0] < pair[1]), "{severities:?}");
        let last = records[19].age.unwrap();
        let end = last.age_rev + last.remaining_rev;
        censored += u32::from(last.is_censored);
        // One in each twentieth of its time.
        for (place, record) in records.iter().enumerate() {
            let part = 20.0 * record.age.unwrap().age_rev / end;
            assert!((place as f64..=place as f64 + 1.0).contains(&part));
        }
    }
    assert!((1..20).contains(&censored), "{censored}");
}

/// A wall and a housing that the plan draws stand instead of the sensor's own, not beside them.
#[test]
fn a_drawn_wall_replaces_the_sensors_own() {
    let sensor = "[[scenario.sensor]]\npath = { plate_hz = 5000.0, strength = 0.2, seed = 3 }\n\n[[class]]";
    let own = |more: &str| {
        let text = FAST.replacen("[[class]]", sensor, 1).replace("[keep]", &format!("{more}\n[keep]"));
        let plan = plan(&text);
        let sampler = Sampler::new(&plan.content).unwrap();
        let path = pair_of(&sampler, &sampler.record(0).unwrap()).sensors[0].path;
        (path.plate_hz, path.strength)
    };
    assert_eq!(own(""), (5000.0, 0.2));
    assert_eq!(own("[[vary]]\nkey = \"path.plate_hz\"\nuniform = [2000.0, 8000.0]"), (0.0, 0.2));
    assert_eq!(own("[[vary]]\nkey = \"path.strength\"\nuniform = [0.1, 0.4]"), (5000.0, 0.0));
}
