//! Data sets of a gearbox whose bearings have spalls.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use std::path::Path;

use meshtone::scenario::{DefectPlace, GearboxRig, Scenario, gearbox_template};
use meshtone::signal::{FrequencyBand, ShaftPhase, squared_envelope_order_spectrum};
use meshtone_dataset::draw::Sampler;
use meshtone_dataset::plan::{Plan, gearbox_template as gearbox_plan};
use meshtone_dataset::store::Destination;
use meshtone_dataset::verify::{Check, verify};
use meshtone_io::scenario_file::ReadScenarioError;
use parquet::record::Field;

use crate::records::made;

const CLASSES: &str = r#"
questions = ["detection", "diagnosis", "severity"]
# A sound bearing has lines too, much weaker ones, as its stiffness varies with the places of its balls.
[[vary]]
key = "noise.level_g"
fixed = 0.5
[[class]]
label = "healthy"

[[class]]
label = "outer"
fault = { bearing = "input:0", race = "outer", width_mm = 1.0 }
severity = { measure = "fault.severity", breaks = [0.12, 0.16] }
[[class.vary]]
key = "fault.width_mm"
uniform = [0.8, 1.4]

[[class]]
label = "tooth and inner"
fault = [{ wheel = "z3", kind = "missing-tooth" }, { bearing = "input:0", race = "inner", severity = 0.1, depth_um = 20.0, angle_deg = 30.0 }]
[[class.vary]]
key = "fault[1].severity"
uniform = [0.1, 0.2]
"#;

/// A plan of a rig whose first bearing, at the input, is an ER-10K with these further keys.
fn plan(bearing: &str, classes: &str) -> Result<Plan, String> {
    let scenario =
        gearbox_template(Some(GearboxRig::Phm2009Helical)).replace("iso_class = 5", "iso_class = 0");
    let first = format!("[[bearing]]\n{bearing}\n");
    let mut scenario = Scenario::from_toml(&scenario.replacen("[[bearing]]\n", &first, 1)).unwrap();
    scenario.solver.sampling_rate_hz = 50_000.0;
    scenario.operation.pinion_speed_hz = 30.0;
    // Under a light load the teeth are quiet beside the bearing.
    scenario.operation.brake_torque_nm = 20.0;
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("gearbox.toml"), scenario.to_toml()).unwrap();
    let text = format!(
        "records = 6\nunits = 2\nscenario = \"gearbox.toml\"\n{classes}\n\
         [keep]\nsampling_rate_hz = 25e3\nduration_s = 0.8\nwheel = \"z3\"\nchannels = [\"input_0_vertical_g\"]\n\
         [split]\ntrain = 1.0\n"
    );
    Plan::read_text(text, &directory.path().join("plan.toml")).map_err(|error| match error {
        ReadScenarioError::Invalid { error, .. } => {
            format!("{error} ({})", error.help.clone().unwrap_or_default())
        }
        other => other.to_string(),
    })
}

const BALL: &str = "kind = \"ball\"\nname = \"ER-10K\"\nslip_percent = 0.0";

/// Largest line of the squared envelope spectrum within 0.04 orders of a place, over the median of the lines below 8 orders.
fn line(signal: &[f64], order: f64) -> f64 {
    let phase = ShaftPhase::constant(30.0, 25e3, signal.len()).unwrap();
    let band = FrequencyBand { from_hz: 2000.0, to_hz: 9000.0 };
    let spectrum = squared_envelope_order_spectrum(signal, 25e3, Some(band), &phase).unwrap();
    let place = |order: f64| (order / spectrum.step).round() as usize;
    let mut low = spectrum.amplitudes[..place(8.0)].to_vec();
    low.sort_by(f64::total_cmp);
    let near = &spectrum.amplitudes[place(order - 0.04)..=place(order + 0.04)];
    near.iter().copied().fold(0.0, f64::max) / low[low.len() / 2]
}

/// Labels, columns and signals say the same about a healthy gearbox, one with a spall, and one with a missing tooth and a spall.
#[test]
fn records_say_which_bearing_has_which_spall_and_their_envelopes_show_it() {
    let made = made(&plan(BALL, CLASSES).unwrap_or_else(|error| panic!("{error}")));
    assert_eq!(made.rows.len(), 6);
    for row in 0..6 {
        let label = made.text("label", row);
        let outer = line(&made.signal("input_0_vertical_g", row), 3.05231);
        println!("{label}: BPFO {outer:.1} times the median");
        // The orders of an ER-10K, and its balls of 7.9375 mm.
        let is_spall = |fault: &str, kind: &str, order: f64| {
            let number = |name: &str| made.number(&format!("{fault}_{name}"), row);
            assert_eq!(made.text(&format!("{fault}_kind"), row), kind);
            assert_eq!(made.text(&format!("{fault}_bearing"), row), "input:0");
            assert!((number("spall_order") - order).abs() < 1e-5);
            assert!((number("spall_width_mm") / 7.9375 - number("severity")).abs() < 1e-12);
        };
        let is_null = |names: &[&str]| names.iter().all(|name| made.field(name, row) == &Field::Null);
        match label.as_str() {
            "healthy" => {
                assert!(is_null(&[
                    "fault_kind",
                    "fault_bearing",
                    "fault_severity",
                    "fault_2_kind",
                    "fault_2_bearing"
                ]));
                assert_eq!(made.whole("severity", row), 0);
                assert!(outer < 10.0);
            }
            "outer" => {
                is_spall("fault", "outer-race", 3.05231);
                assert!(is_null(&["fault_wheel", "fault_tooth", "fault_2_kind"]));
                let severity = made.number("fault_severity", row);
                assert_eq!(made.number("fault_width_mm", row), made.number("fault_spall_width_mm", row));
                assert_eq!(
                    made.whole("severity", row),
                    1 + i64::from(severity >= 0.12) + i64::from(severity >= 0.16)
                );
                assert!(outer > 20.0);
            }
            _ => {
                assert_eq!(
                    (made.text("fault_kind", row), made.text("fault_wheel", row)),
                    ("missing-tooth".into(), "z3".into())
                );
                assert!(is_null(&["fault_bearing", "fault_spall_width_mm"]));
                is_spall("fault_2", "inner-race", 4.94769);
                assert_eq!(made.number("fault_2_spall_angle_deg", row), 30.0);
                assert!((made.number("fault_2_spall_drop_um", row) - 20.0).abs() < 1e-9);
            }
        }
    }
    let set = Destination::directory(made.directory.path().join("set"));
    assert!(verify(&set, Check::Bytes).unwrap().is_good());
    let card = std::fs::read_to_string(made.directory.path().join("set/README.md")).unwrap();
    assert!(card.contains("missing-tooth of z3 + inner-race of input:0"), "{card}");
}

/// The scenario has the keys of a spall at its bearing, after the spalls that all records share, and counts the faults of teeth alone.
#[test]
fn keys_of_each_fault_reach_its_part_in_any_order() {
    let classes = r#"
[[class]]
label = "element and tooth"
fault = [{ bearing = "input:0", race = "element", severity = 0.1 }, { wheel = "z1", kind = "missing-tooth" }]
[[class.vary]]
key = "fault[0].severity"
uniform = [0.2, 0.3]
[[class.vary]]
key = "fault[1].tooth"
choice = [7, 9]
"#;
    let base = format!("{BALL}\ndefect = [{{ race = \"outer\", width_mm = 0.5 }}]");
    let plan = plan(&base, classes).unwrap();
    let sampler = Sampler::new(&plan.content).unwrap();
    for index in 0..6 {
        let record = sampler.record(index).unwrap();
        let gearbox = sampler.scenario(&record).unwrap();
        let [shared, own] = &gearbox.bearings()[0].defect[..] else {
            panic!("{:?}", gearbox.bearings()[0].defect)
        };
        assert_eq!((shared.race, shared.width_mm), (DefectPlace::Outer, Some(0.5)));
        assert_eq!((own.race, own.severity), (DefectPlace::Element, Some(record.values[0].1)));
        assert_eq!(gearbox.faults[0].tooth.only().map(f64::from), Some(record.values[1].1));
    }
}

/// What the template comments can be used after its comment signs are taken away.
#[test]
fn the_example_of_the_template_is_a_class() {
    let text = gearbox_plan();
    let (before, rest) = text.split_once("#[[class]]\n#label = \"outer-race\"").unwrap();
    let (example, after) = rest.split_once("\n\n").unwrap();
    let class = format!("[[class]]\nlabel = \"outer-race\"{}", example.replace("\n#", "\n"));
    let place = "shaft = \"input\"\nat = 1.0\n";
    let before = before.replacen(place, &format!("{place}kind = \"ball\"\nname = \"ER-10K\"\n"), 1);
    let plan = Plan::read_text(format!("{before}{class}\n\n{after}"), Path::new("plan.toml")).unwrap();
    let class = plan.content.classes.iter().find(|class| class.label == "outer-race").unwrap();
    assert_eq!(class.faults[0].kind(), "outer-race");
}

#[test]
fn spalls_that_cannot_be_are_refused() {
    let refused = |bearing: &str, written: &str, other: &str, words: &[&str]| {
        assert!(CLASSES.contains(written));
        let error = plan(bearing, &CLASSES.replacen(written, other, 1)).unwrap_err();
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    };
    refused(
        "",
        "outer",
        "outer",
        &["is a linear bearing", "set kind = \"ball\" or kind = \"roller\" of bearing[input:0]"],
    );
    refused(BALL, "input:0", "input:1", &["is a linear bearing", "bearing[input:1]"]);
    refused(BALL, "input:0", "z1", &["does not exist; must be one of input:0, input:1, middle:0"]);
    refused(BALL, "width_mm = 1.0", "widht_mm = 1.0", &["widht_mm"]);
    refused(
        BALL,
        "uniform = [0.8, 1.4]",
        "fixed = 9.0",
        &["must be at most 7.9375 mm, the diameter of an element"],
    );
    refused(BALL, "race = \"outer\"", "race = \"cage\"", &["outer", "inner", "element"]);
    let growth = "growth = { law = \"pits\", start = 0.0, life_rev = 1e6 }";
    refused(
        BALL,
        "severity = { measure = \"fault.severity\", breaks = [0.12, 0.16] }",
        growth,
        &["grows from a width of more"],
    );
}
