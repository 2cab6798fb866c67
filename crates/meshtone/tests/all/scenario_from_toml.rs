//! Scenario files: every fault is read, and what is wrong is refused with its key and line.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::support::{REQUIRED, appended, assert_refused, gears, replaced};
use meshtone::scenario::{
    Damage, DestructionLine, Fault, FileProblem, MissingTooth, Model, PartialFace, PitCircle, Profile,
    ProfileErrors, RootCrack, Scenario, ScenarioFiles, ScenarioNumber, ThroughFace, ToothBreakage,
    ToothDestruction, Wear,
};
use meshtone::wheel::ErrorTable;

#[test]
fn every_fault_is_read() {
    let fractions = PitCircle::Fractions { start: 0.2, end: 0.8, depth: 0.5 };
    let circle = PitCircle::Circle { x_mm: 57.5, y_mm: 3.66, radius_mm: 2.5 };
    let destruction = ToothDestruction {
        start: -0.2,
        line: DestructionLine::SlopeDeg(22.0),
        offset_mm: 0.1,
        noise_mm: 0.01,
    };
    let to_end =
        ToothDestruction { start: 0.2, line: DestructionLine::End(0.9), offset_mm: 0.0, noise_mm: 0.0 };
    let breakage = ToothBreakage { chip_height_mm: 5.0, chip_width_mm: 15.0, tip_loss_mm: 0.0 };
    for (keys, damage) in [
        ("kind = \"missing-tooth\"", Damage::from(MissingTooth)),
        ("kind = \"tooth-breakage\"\nchip_height_mm = 5\nchip_width_mm = 15", Damage::from(breakage)),
        (
            "kind = \"root-crack\"\ndepth_mm = 2",
            Damage::from(RootCrack { depth_mm: 2.0, angle_deg: 45.0, length_mm: None }),
        ),
        (
            "kind = \"root-crack\"\ndepth_mm = 2\nangle_deg = 60\nlength_mm = 7.5",
            Damage::from(RootCrack { depth_mm: 2.0, angle_deg: 60.0, length_mm: Some(7.5) }),
        ),
        ("kind = \"wear\"\ndepth_um = 12.5", Damage::from(Wear { depth_um: 12.5 })),
        (
            "kind = \"partial-face\"\nwidth_mm = 2\nstart = 0.2\nend = 0.8\ndepth = 0.5",
            Damage::from(PartialFace { width_mm: 2.0, pit: fractions }),
        ),
        (
            "kind = \"through-face\"\nstart = 0.2\nend = 0.8\ndepth = 0.5",
            Damage::from(ThroughFace { pit: fractions }),
        ),
        (
            "kind = \"through-face\"\ncircle = { x_mm = 57.5, y_mm = 3.66, radius_mm = 2.5 }",
            Damage::from(ThroughFace { pit: circle }),
        ),
        (
            "kind = \"tooth-destruction\"\nstart = -0.2\nslope_deg = 22\noffset_mm = 0.1\nnoise_mm = 0.01",
            Damage::from(destruction),
        ),
        ("kind = \"tooth-destruction\"\nstart = 0.2\nend = 0.9", Damage::from(to_end)),
    ] {
        let scenario = Scenario::from_toml(&appended(&format!("[fault]\n{keys}"))).unwrap();
        assert_eq!(scenario.faults, [Fault::at_usual_place(damage)]);
    }
}

#[test]
fn the_wheels_of_a_pair_may_have_tips_of_their_own() {
    let text = gears(
        "flank_relief = { length_mm = 2.0, amount_um = 10.0 }\ngear_flank_relief = { amount_um = 20.0 }\npinion_tip_chamfer_mm = 0.3",
    );
    let mut scenario = Scenario::from_toml(&text).unwrap();
    let reliefs = |of: &Scenario| {
        let wheels = of.wheels.iter();
        wheels.map(|wheel| [wheel.flank_relief.length_mm, wheel.flank_relief.amount_um]).collect::<Vec<_>>()
    };
    let chamfers = |of: &Scenario| of.wheels.iter().map(|wheel| wheel.tip_chamfer_mm).collect::<Vec<_>>();
    assert_eq!(reliefs(&scenario), [[2.0, 10.0], [2.0, 20.0]]);
    assert_eq!(chamfers(&scenario), [Some(0.3), None]);
    let written = scenario.to_toml();
    assert_eq!(Scenario::from_toml(&written).unwrap(), scenario);
    assert!(written.contains("\ngear_flank_relief") && !written.contains("\nflank_relief"), "{written}");
    assert_eq!(scenario.number("gears.gear_flank_relief.amount_um"), Some(20.0));
    scenario.model = Model::Published;
    let ignored: Vec<_> = scenario.ignored_by_model().into_iter().map(|warning| warning.key).collect();
    assert_eq!(ignored, ["gears.flank_relief", "gears.tip_chamfer_mm"]);

    // Of wheels that are alike one key is written, and its number can be set; of others that of either.
    let alike = Scenario::from_toml(&gears("tip_chamfer_mm = 0.5\ngear_tip_chamfer_mm = 0.5")).unwrap();
    assert!(alike.to_toml().contains("\ntip_chamfer_mm = 0.5") && !alike.to_toml().contains("gear_tip"));
    assert_eq!(
        chamfers(&alike.with_number("gears.gear_tip_chamfer_mm", 0.2).unwrap()),
        [Some(0.5), Some(0.2)]
    );
    let listed =
        |numbers: Vec<ScenarioNumber>| numbers.iter().filter(|of| of.key.contains("chamfer")).count();
    assert_eq!((listed(alike.numbers()), listed(alike.settable_numbers())), (1, 3));
    let numbers = [("gears.gear_flank_relief.amount_um", 20.0), ("gears.flank_relief.length_mm", 2.0)];
    assert_eq!(reliefs(&alike.with_numbers(&numbers).unwrap()), [[2.0, 0.0], [2.0, 20.0]]);
    assert!(alike.with_number("gears.gear_face_width_mm", 20.0).is_err());
    assert_eq!(chamfers(&alike.with_number("gears.tip_chamfer_mm", 0.4).unwrap()), [Some(0.4); 2]);
    let apart = Scenario::from_toml(&gears("tip_chamfer_mm = 0.5\ngear_tip_chamfer_mm = 0.3")).unwrap();
    let changed = apart.with_number("gears.gear_tip_chamfer_mm", 0.2).unwrap();
    assert_eq!(chamfers(&changed), [Some(0.5), Some(0.2)]);

    let of_gear = "tip_chamfer_mm = 0.5\ngear_tip_chamfer_mm = 4.0";
    assert_refused(&gears(of_gear), "gears.gear_tip_chamfer_mm", 7, &["the module"]);
    let of_both = "tip_chamfer_mm = 4.0";
    assert_refused(&gears(of_both), "gears.tip_chamfer_mm", 6, &["the module"]);
    let of_pinion = "pinion_flank_relief = { amount_um = -1.0 }";
    assert_refused(&gears(of_pinion), "gears.pinion_flank_relief.amount_um", 6, &["0 µm or more"]);
    let too_long = "gear_flank_relief = { amount_um = 1.0, length_mm = 7.0 }";
    assert_refused(&gears(too_long), "gears.gear_flank_relief.length_mm", 6, &["2 modules"]);
}

/// No model heeds it: the published one always has the same, as its code.
#[test]
fn a_relief_that_thins_the_tips_is_no_key() {
    for value in ["false", "{ length_mm = 0.5, depth_mm = 0.25 }"] {
        assert_refused(&gears(&format!("tip_relief = {value}")), "gears.tip_relief", 6, &["flank_relief"]);
    }
}

#[test]
fn missing_keys() {
    for (line_text, key, line) in [
        ("module_mm = 3.0\n", "gears.module_mm", 1),
        ("pinion_teeth = 17\n", "gears.pinion_teeth", 1),
        ("gear_teeth = 38\n", "gears.gear_teeth", 1),
        ("face_width_mm = 15.0\n", "gears.face_width_mm", 1),
        ("pinion_speed_hz = 40.0\n", "operation.pinion_speed_hz", 6),
        ("brake_torque_nm = 10.0\n", "operation.brake_torque_nm", 6),
    ] {
        assert_refused(&replaced(line_text, ""), key, line, &["missing", "no default"]);
    }
    let error = Scenario::from_toml("").unwrap_err();
    assert_eq!(error.key, "gears.module_mm");
}

#[test]
fn unknown_keys() {
    let error = assert_refused(
        &gears("pressure_angle = 20"),
        "gears.pressure_angle",
        6,
        &["unknown key", "uniform_flank_reduction_mm"],
    );
    assert_eq!(error.help.as_deref(), Some("did you mean `pressure_angle_deg`?"));
    for (key, words) in [
        ("crowning_mm", "is now called uniform_flank_reduction_mm"),
        ("internal", "is not modelled: both wheels are external gears"),
    ] {
        assert_refused(&gears(&format!("{key} = 0.01")), &format!("gears.{key}"), 6, &[words]);
    }
    assert_refused(&replaced("[gears]", "[gear]"), "gear", 1, &["unknown key", "did you mean `gears`?"]);
    assert_refused(&appended("[rigs]\na = 1"), "rigs", 9, &["unknown key", "did you mean `rig`?"]);
    let breakage_key = "[fault]\nkind = \"missing-tooth\"\nchip_height_mm = 1";
    assert_refused(
        &appended(breakage_key),
        "fault.chip_height_mm",
        11,
        &["unknown key", "allowed in `fault`: kind"],
    );
    assert_refused(
        &gears("foundation = { L = [1,2,3,4,5,6], l = [1,2,3,4,5,6] }"),
        "gears.foundation.l",
        6,
        &["unknown key", "L, M, P, Q"],
    );
    let shaft = appended("[rig]\npinion_shaft = { lenght_mm = 100.0 }");
    assert_refused(&shaft, "rig.pinion_shaft.lenght_mm", 10, &["did you mean `length_mm`?"]);
    let of_drawing = replaced("pinion_speed_hz = 40.0", "pinion_speed_rpm = 1476");
    let words = ["while `pinion_speed_hz` is missing, which is (rev/s)", "did you mean `pinion_speed_hz`?"];
    assert_refused(&of_drawing, "operation.pinion_speed_rpm", 7, &words);
    // Both a misspelt and a missing key: the misspelt one is what the user has to mend.
    assert_refused(&replaced("gear_teeth = 38", "gear_width = 38"), "gears.gear_teeth", 1, &["missing"]);
}

#[test]
fn wrong_types() {
    assert_refused(&replaced("17", "17.0"), "gears.pinion_teeth", 3, &["17.0", "whole number"]);
    assert_refused(
        &replaced("15.0", "\"15\""),
        "gears.face_width_mm",
        5,
        &["\"15\"", "must be a number, not text"],
    );
    assert_refused(&replaced("40.0", "nan"), "operation.pinion_speed_hz", 7, &["nan", "finite"]);
    assert_refused(&replaced("10.0", "inf"), "operation.brake_torque_nm", 8, &["inf", "finite"]);
    assert_refused(
        &gears("material = \"steal\""),
        "gears.material",
        6,
        &["\"steel\"", "did you mean \"steel\"?"],
    );
    assert_refused(&format!("model = \"old\"\n{REQUIRED}"), "model", 1, &["\"linear\", \"published\""]);
    assert_refused(&format!("seed = -1\n{REQUIRED}"), "seed", 1, &["from 0 to"]);
    assert_refused(&gears("foundation = { L = [1, 2] }"), "gears.foundation.L", 6, &["has 2", "exactly 6"]);
    let damping = appended("[rig]\ndamping_ratio = [0.05, 0.05]");
    assert_refused(&damping, "rig.damping_ratio", 10, &["has 2 numbers", "exactly 13", "one per mode"]);
    let state = appended("[solver]\ninitial_velocity = [0.0]");
    assert_refused(&state, "solver.initial_velocity", 10, &["has 1 numbers", "exactly 13"]);
    assert_refused(&appended("[quality]\ndin_grade = 13"), "quality.din_grade", 10, &["from 0 to 12"]);
}

#[test]
fn faults_described_twice_or_not_at_all() {
    let fault = |keys: &str| appended(&format!("[fault]\n{keys}"));
    let circle = "circle = { x_mm = 57.5, y_mm = 3.66, radius_mm = 2.5 }";
    let both = fault(&format!("kind = \"through-face\"\n{circle}\nstart = 0.2"));
    assert_refused(&both, "fault.circle", 11, &["only one way", "remove circle"]);
    assert_refused(
        &fault("kind = \"through-face\""),
        "fault.start",
        9,
        &["missing, and circle too", "circle = {"],
    );
    let no_depth = fault("kind = \"through-face\"\nstart = 0.2\nend = 0.8");
    assert_refused(&no_depth, "fault.depth", 9, &["missing"]);
    let no_radius = fault("kind = \"through-face\"\ncircle = { x_mm = 57.5, y_mm = 3.66 }");
    assert_refused(&no_radius, "fault.circle.radius_mm", 11, &["missing"]);
    let two_lines = fault("kind = \"tooth-destruction\"\nstart = 0.2\nend = 0.8\nslope_deg = 22");
    assert_refused(&two_lines, "fault.slope_deg", 13, &["exactly one", "remove slope_deg"]);
    let no_line = fault("kind = \"tooth-destruction\"\nstart = 0.2");
    assert_refused(&no_line, "fault.end", 9, &["slope_deg", "exactly one"]);
    assert_refused(&fault("start = 0.2"), "fault.kind", 9, &["missing", "\"missing-tooth\"", "healthy"]);
    let misspelt = fault("kind = \"missing-teeth\"");
    assert_refused(&misspelt, "fault.kind", 10, &["\"tooth-breakage\"", "did you mean \"missing-tooth\"?"]);
}

#[test]
fn profiles_with_two_sources_or_half_of_one() {
    let key = "operation.speed_profile_hz";
    let both = appended("speed_profile_hz = { file = \"a.csv\", value = [1, 2] }");
    assert_refused(&both, &format!("{key}.file"), 9, &["only one source"]);
    let half = appended("speed_profile_hz = { value = [1, 2] }");
    assert_refused(&half, &format!("{key}.time_s"), 9, &["missing", "file = "]);
    let other_half = appended("speed_profile_hz = { time_s = [1, 2] }");
    assert_refused(&other_half, &format!("{key}.value"), 9, &["missing"]);
    assert_refused(&appended("speed_profile_hz = \"a.csv\""), key, 9, &["must be a table"]);
}

#[test]
fn files_need_a_directory() {
    let errors = appended("[quality]\nerrors_file = \"wheels.npz\"");
    assert_refused(
        &errors,
        "quality.errors_file",
        10,
        &["\"wheels.npz\"", "text alone", "gear_profile_errors_mm"],
    );
    let profile = appended("speed_profile_hz = { file = \"a.csv\" }");
    assert_refused(&profile, "operation.speed_profile_hz.file", 9, &["text alone", "time_s = "]);
}

/// Files that exist in the test alone.
struct Shelf {
    errors: ProfileErrors,
}

impl ScenarioFiles for Shelf {
    fn profile_errors(&self, name: &str) -> Result<ProfileErrors, FileProblem> {
        match name {
            "wheels.npz" => Ok(self.errors.clone()),
            _ => Err(FileProblem::new("there is no such file", "check the name")),
        }
    }

    fn profile(&self, name: &str) -> Result<Profile, FileProblem> {
        let value = if name == "negative.csv" { vec![40.0, -40.0] } else { vec![38.0, 40.0] };
        Ok(Profile { time_s: vec![0.0, 1.0], value })
    }
}

fn shelf() -> Shelf {
    let errors = |teeth| ErrorTable::from_fn(100, teeth, |row, column| 1e-5 * (row * 100 + column) as f64);
    Shelf {
        errors: ProfileErrors { pinion_profile_errors_mm: errors(17), gear_profile_errors_mm: errors(38) },
    }
}

#[test]
fn the_content_of_files_becomes_part_of_the_scenario() {
    let text = appended(
        "speed_profile_hz = { file = \"a.csv\" }\n[quality]\ndin_grade = 0\nerrors_file = \"wheels.npz\"",
    );
    let scenario = Scenario::from_toml_with_files(&text, &shelf()).unwrap();
    assert_eq!(scenario.quality().profile_errors, Some(shelf().errors));
    let profile = scenario.operation.speed_profile_hz.unwrap();
    assert_eq!(profile.value, [38.0, 40.0]);
}

#[test]
fn problems_of_files_are_reported_at_the_key_that_names_them() {
    let refused = |text: &str, shelf: &Shelf| Scenario::from_toml_with_files(text, shelf).unwrap_err();
    let missing = refused(&appended("[quality]\nerrors_file = \"other.npz\""), &shelf());
    assert_eq!((missing.key.as_str(), missing.line), ("quality.errors_file", Some(10)));
    assert_eq!(
        (missing.problem.as_str(), missing.help.as_deref()),
        ("there is no such file", Some("check the name"))
    );

    let with_errors = appended("[quality]\nerrors_file = \"wheels.npz\"");
    let mut short = shelf();
    short.errors.gear_profile_errors_mm = ErrorTable::filled(99, 38, 0.0);
    let shape = refused(&with_errors, &short);
    assert_eq!((shape.key.as_str(), shape.line), ("quality.errors_file", Some(10)));
    assert!(shape.problem.starts_with("gear_profile_errors_mm: is 99 × 38; must be 100 × 38"), "{shape}");

    let mut hole = shelf();
    hole.errors.pinion_profile_errors_mm[(3, 5)] = f64::NAN;
    let not_a_number = refused(&with_errors, &hole);
    assert_eq!(not_a_number.key, "quality.errors_file");
    assert!(
        not_a_number.problem.contains("pinion_profile_errors_mm[3][5]: point 4 of tooth 6 is NaN"),
        "{not_a_number}"
    );

    let negative = refused(&appended("speed_profile_hz = { file = \"negative.csv\" }"), &shelf());
    assert_eq!((negative.key.as_str(), negative.line), ("operation.speed_profile_hz.value[1]", Some(9)));
}

fn inline_errors(teeth: usize, rows: usize) -> String {
    let row = format!("[{}]", vec!["0.001"; teeth].join(","));
    format!("[{}]", vec![row; rows].join(",\n"))
}

#[test]
fn profile_errors_inline() {
    let text = |pinion: &str, gear: &str| {
        appended(&format!("[quality]\npinion_profile_errors_mm = {pinion}\ngear_profile_errors_mm = {gear}"))
    };
    let good = (inline_errors(17, 100), inline_errors(38, 100));
    let errors = Scenario::from_toml(&text(&good.0, &good.1)).unwrap().quality().profile_errors.unwrap();
    assert_eq!(errors.gear_profile_errors_mm, ErrorTable::filled(100, 38, 0.001));

    let pinion = "quality.pinion_profile_errors_mm";
    let shape = ["is 100 × 16; must be 100 × 17"];
    assert_refused(&text(&inline_errors(16, 100), &good.1), pinion, 10, &shape);
    let ragged = good.0.replacen("0.001,", "", 1);
    let rows = ["has 17 numbers", "the first row has 16"];
    assert_refused(&text(&ragged, &good.1), &format!("{pinion}[1]"), 11, &rows);
    let alone = appended(&format!("[quality]\npinion_profile_errors_mm = {}", good.0));
    assert_refused(&alone, "quality.gear_profile_errors_mm", 9, &["missing", "both wheels"]);
    let microns = good.0.replacen("0.001", "4.5", 1);
    let unit = ["point 1 of tooth 1 is 4.5 mm", "smaller than the module", "µm"];
    assert_refused(&text(&microns, &good.1), &format!("{pinion}[0][0]"), 10, &unit);

    let with_file = format!("{}errors_file = \"wheels.npz\"\n", text(&good.0, &good.1));
    let error = Scenario::from_toml(&with_file).unwrap_err();
    assert_eq!(error.key, "quality.errors_file");
    assert!(error.problem.contains("only one source"), "{error}");
    let with_grade = format!("{}din_grade = 7\n", text(&good.0, &good.1));
    let error = Scenario::from_toml(&with_grade).unwrap_err();
    assert_eq!((error.key.as_str(), error.value.as_str()), ("quality.din_grade", "7"));
    assert!(error.problem.contains("beside profile errors"), "{error}");
}

#[test]
fn text_that_is_not_toml() {
    assert_refused(&replaced("= 17", "17"), "", 3, &["not valid TOML", "pinion_teeth 17"]);
    assert_refused(&gears("module_mm = 4.0"), "", 6, &["not valid TOML", "duplicate key"]);
}
