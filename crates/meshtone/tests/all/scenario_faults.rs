//! Lists of faults: where they are, several beside each other, their keys and lines.
use crate::support::{self, appended, assert_refused};
use meshtone::scenario::{
    Damage, Fault, FaultyTeeth, MissingTooth, Model, Scenario, ToothBreakage, WheelName, damage_kinds,
};

const PIT: &str = "kind = \"through-face\"\nstart = 0.2\nend = 0.4\ndepth = 0.3";
const CHIP: &str = "kind = \"tooth-breakage\"\nchip_height_mm = 5.0\nchip_width_mm = 12.0";

/// A file with `[[fault]]` sections, each of the given lines.
fn faults(sections: &[&str]) -> String {
    let sections: Vec<String> = sections.iter().map(|keys| format!("[[fault]]\n{keys}")).collect();
    appended(&sections.join("\n"))
}

#[test]
fn a_single_section_is_a_list_of_one() {
    let single = Scenario::from_toml(&appended(&format!("[fault]\n{CHIP}"))).unwrap();
    let listed = Scenario::from_toml(&faults(&[CHIP])).unwrap();
    let chip = ToothBreakage { chip_height_mm: 5.0, chip_width_mm: 12.0, tip_loss_mm: 0.0 };
    assert_eq!(single.faults, [Fault::new(WheelName::Gear, 1, chip)]);
    assert_eq!(listed, single);
    assert!(single.to_toml().contains("\n[fault]\nwheel = \"gear\"\ntooth = 1\n"));
}

#[test]
fn faults_are_on_any_tooth_of_either_wheel() {
    let text = faults(&[
        &format!("wheel = \"pinion\"\ntooth = 17\n{PIT}"),
        "tooth = 38\nkind = \"missing-tooth\"",
        &format!("tooth = 38\nwheel = \"pinion\"\n{CHIP}").replace("38", "3"),
    ]);
    let scenario = Scenario::from_toml(&text).unwrap();
    let places: Vec<_> =
        scenario.faults.iter().map(|fault| (fault.side(), fault.tooth.only().unwrap())).collect();
    assert_eq!(places, [(WheelName::Pinion, 17), (WheelName::Gear, 38), (WheelName::Pinion, 3)]);
    assert_eq!(scenario.faults[1].damage, Damage::from(MissingTooth));
    assert_eq!(Scenario::from_toml(&scenario.to_toml()), Ok(scenario));
}

#[test]
fn errors_name_the_fault_and_its_line() {
    let text = faults(&[PIT, &format!("tooth = 2\n{CHIP}").replace("5.0", "50.0")]);
    assert_refused(
        &text,
        "fault[1].chip_height_mm",
        17,
        &["fault[1].chip_height_mm = 50.0", "less than 6.75"],
    );
    let text = faults(&[PIT, "tooth = 2\nkind = \"scuffing\""]);
    assert_refused(&text, "fault[1].kind", 16, &["must be one of", "\"missing-tooth\""]);
    let text = faults(&[PIT, "tooth = 2\nkind = \"missing-tooth\"\nwidth_mm = 2.0"]);
    assert_refused(
        &text,
        "fault[1].width_mm",
        17,
        &["unknown key", "allowed in `fault[1]`: kind, wheel, tooth"],
    );
    let text = faults(&[PIT, "tooth = 2\nkind = \"through-face\""]);
    assert_refused(&text, "fault[1].start", 14, &["missing, and circle too"]);
    let line = "kind = \"tooth-destruction\"\nstart = 0.5\nend = 0.4";
    let words = ["fault[1].end = 0.4 (the 2nd fault): must be more than fault[1].start, 0.5"];
    assert_refused(&faults(&[PIT, &format!("tooth = 2\n{line}")]), "fault[1].end", 18, &words);
    // One alone needs no number, in whichever way it is written.
    assert_refused(&faults(&[&CHIP.replace("5.0", "50.0")]), "fault.chip_height_mm", 11, &["less than 6.75"]);
    assert_refused(&format!("fault = [1, 2]\n{}", support::REQUIRED), "fault[0]", 1, &["must be a table"]);
}

#[test]
fn a_tooth_must_exist() {
    let at = |wheel: &str, tooth: &str| faults(&[&format!("wheel = \"{wheel}\"\ntooth = {tooth}\n{CHIP}")]);
    assert_refused(&at("gear", "39"), "fault.tooth", 11, &["at most 38, the gear's teeth"]);
    assert_refused(&at("pinion", "18"), "fault.tooth", 11, &["at most 17, the pinion's teeth"]);
    assert_refused(&at("gear", "0"), "fault.tooth", 11, &["at least 1"]);
    assert_refused(
        &at("gear", "-1"),
        "fault.tooth",
        11,
        &["fault.tooth = -1: must be at least 1, the first tooth"],
    );
    assert_refused(&at("gear", "1.0"), "fault.tooth", 11, &["whole number"]);
    assert_refused(&at("wheel", "1"), "fault.wheel", 10, &["\"pinion\", \"gear\""]);
}

#[test]
fn a_fault_may_be_on_several_teeth() {
    let at = |tooth: &str| faults(&[&format!("wheel = \"pinion\"\ntooth = {tooth}\n{CHIP}")]);
    for (written, teeth) in [
        ("[1, 2, 9]", FaultyTeeth::These(vec![1, 2, 9])),
        ("[4]", FaultyTeeth::One(4)),
        ("\"all\"", FaultyTeeth::All),
    ] {
        let scenario = Scenario::from_toml(&at(written)).unwrap();
        assert_eq!(scenario.faults[0].tooth, teeth);
        assert_eq!(Scenario::from_toml(&scenario.to_toml()).unwrap(), scenario);
        // Of several there is no single number.
        assert_eq!(scenario.number("fault.tooth"), teeth.only().map(f64::from));
    }
    let pinion = ["fault.tooth[1] = 18: must be at most 17, the pinion's teeth"];
    assert_refused(&at("[2, 18]"), "fault.tooth[1]", 11, &pinion);
    assert_refused(&at("[3, 2, 3]"), "fault.tooth[2]", 11, &["= 3: is named twice; must be named once"]);
    assert_refused(&at("[0, 2]"), "fault.tooth[0]", 11, &["at least 1, the first tooth"]);
    assert_refused(&at("[2, -3]"), "fault.tooth[1]", 11, &["at least 1, the first tooth"]);
    assert_refused(&at("[]"), "fault.tooth", 11, &["at least one tooth", "\"all\""]);
    assert_refused(&at("[1.0]"), "fault.tooth[0]", 11, &["whole number"]);
    assert_refused(&at("\"al\""), "fault.tooth", 11, &["must be one of \"all\"", "did you mean \"all\""]);
    assert_refused(
        &at("\"ALL\""),
        "fault.tooth",
        11,
        &["must be one of \"all\"", "write \"all\": large and small letters"],
    );
    assert_refused(&at("true"), "fault.tooth", 11, &["a whole number, an array of them or \"all\""]);
    // A tooth of both has no room for the second.
    let missing = "kind = \"missing-tooth\"";
    let second = format!("tooth = [8, 7]\n{missing}");
    let words = ["tooth 7 of the gear has fault[0] already (missing-tooth)"];
    assert_refused(&faults(&[&format!("tooth = [6, 7]\n{missing}"), &second]), "fault[1].kind", 14, &words);
    assert_refused(
        &faults(&[&format!("tooth = \"all\"\n{CHIP}"), missing]),
        "fault[1].kind",
        15,
        &["tooth 1"],
    );
}

#[test]
fn a_missing_tooth_has_no_other_damage_and_a_tooth_breaks_once() {
    let missing = "kind = \"missing-tooth\"";
    let twice = ["tooth 1 of the gear has fault[0] already", "another tooth"];
    for (one, other, line) in
        [(missing, PIT, 12), (PIT, missing, 15), (missing, missing, 12), (CHIP, CHIP, 14)]
    {
        assert_refused(&faults(&[one, other]), "fault[1].kind", line, &twice);
    }
    let chipped = ["(the 2nd fault)", "has fault[0] already (tooth-breakage)"];
    assert_refused(&faults(&[CHIP, missing]), "fault[1].kind", 14, &chipped);
    // What leaves room for the other may be on one tooth; and anything on another.
    for (one, other) in [(CHIP, PIT.to_string()), (missing, format!("tooth = 2\n{missing}"))] {
        assert!(Scenario::from_toml(&faults(&[one, &other])).is_ok());
    }
}

#[test]
fn the_published_model_knows_one_fault_in_one_place() {
    let published = |sections: &[&str]| format!("model = \"published\"\n{}", faults(sections));
    let words = ["only one fault, on the gear's first tooth", "model = \"linear\""];
    assert!(Scenario::from_toml(&published(&[CHIP])).is_ok());
    assert_refused(&published(&[&format!("tooth = 2\n{CHIP}")]), "fault.tooth", 11, &words);
    assert_refused(&published(&[&format!("tooth = [1, 2]\n{CHIP}")]), "fault.tooth", 11, &words);
    assert_refused(&published(&[&format!("tooth = \"all\"\n{CHIP}")]), "fault.tooth", 11, &words);
    assert!(Scenario::from_toml(&published(&[&format!("tooth = [1]\n{CHIP}")])).is_ok());
    assert_refused(&published(&[&format!("wheel = \"pinion\"\n{CHIP}")]), "fault.wheel", 11, &words);
    assert_refused(&published(&[CHIP, &format!("tooth = 2\n{CHIP}")]), "fault[1]", 14, &words);
}

#[test]
fn numbers_of_faults_are_edited_by_their_keys() {
    let single = Scenario::from_toml(&faults(&[CHIP])).unwrap();
    let wider = single.with_number("fault.chip_width_mm", 14.0).unwrap();
    assert_eq!((wider.number("fault.chip_width_mm"), wider.number("fault.tooth")), (Some(14.0), Some(1.0)));

    let several = Scenario::from_toml(&faults(&[PIT, &format!("tooth = 2\n{CHIP}")])).unwrap();
    assert_eq!(several.number("fault.chip_width_mm"), None);
    assert_eq!(several.number("fault[0].depth"), Some(0.3));
    assert_eq!(several.number("fault[2].depth"), None);
    let wider = several.with_numbers(&[("fault[1].chip_width_mm", 14.0), ("fault[1].tooth", 5.0)]).unwrap();
    assert_eq!((wider.number("fault[1].chip_width_mm"), wider.faults[1].tooth.only()), (Some(14.0), Some(5)));
    assert!(
        wider.numbers().iter().any(|number| number.key == "fault[1].chip_width_mm" && number.value == 14.0)
    );
    let error = several.with_number("fault[1].chip_width_mm", 20.0).unwrap_err();
    assert_eq!((error.key.as_str(), error.line), ("fault[1].chip_width_mm", None));
    assert!(several.with_number("fault[2].depth", 0.1).is_err());
    // What is not set stays as it was, a seed that no float can hold too.
    let large = several.with_seed(u64::MAX);
    let changed = large.with_known_numbers(&[("fault[1].tooth", 5.0), ("fault[9].tooth", 5.0)]).unwrap();
    assert_eq!((changed.seed, changed.number("fault[1].tooth")), (u64::MAX, Some(5.0)));
}

#[test]
fn the_model_is_read_by_its_name() {
    let named = |line: &str| format!("{line}\n{}", support::REQUIRED);
    assert_refused(&named("model = \"contacts\""), "model", 1, &["\"linear\", \"published\""]);
    assert_eq!(Scenario::from_toml(&named("model = \"contact\"")).unwrap().model, Model::Contact);
    assert_eq!(Scenario::from_toml(&named("model = \"published\"")).unwrap().model, Model::Published);
}

#[test]
fn every_kind_is_described_and_its_example_is_valid() {
    for kind in damage_kinds() {
        let fault = Fault::on_first_gear_tooth(kind.example.clone());
        assert_eq!((fault.damage.kind(), fault.damage.summary()), (kind.name, kind.summary));
        for key in &kind.keys {
            assert!(!key.meaning.is_empty() && !key.meaning.ends_with('.'), "{}.{}", kind.name, key.key);
        }
    }
}
