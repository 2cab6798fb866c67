//! The commented scenario files to start from.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use meshtone::scenario::{
    Damage, DestructionLine, GearPair, PitCircle, Scenario, WheelName, template, template_kinds,
    template_of_all_keys,
};

fn all() -> impl Iterator<Item = (&'static str, String)> {
    template_kinds().into_iter().map(|kind| (kind, template_of_all_keys(kind).unwrap()))
}

/// What `meshtone init KIND` prints fits a small window, and is the scenario of all keys.
#[test]
fn short_templates_have_what_matters() {
    for (kind, long) in all() {
        let text = template(kind).unwrap();
        assert_eq!(Scenario::from_toml(&text).unwrap(), Scenario::from_toml(&long).unwrap(), "{kind}");
        let keys = text.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
        assert!(keys.count() <= 18 && text.lines().count() <= 25, "{text}");
        assert!(text.lines().all(|line| line.chars().count() <= 140), "{text}");
        assert!(text.contains(&format!("`meshtone init {kind} --all`")), "{text}");
    }
}

/// The file with every key that is commented out as optional set.
fn uncommented(text: &str) -> String {
    let strip = |line: &str| match line.strip_prefix('#') {
        Some(key) if key.starts_with(|first: char| first.is_ascii_lowercase()) => format!("{key}\n"),
        _ => format!("{line}\n"),
    };
    text.lines().map(strip).collect()
}

#[test]
fn templates_are_valid_and_of_their_kind() {
    for (kind, text) in all() {
        let scenario = Scenario::from_toml(&text).unwrap_or_else(|error| panic!("{kind}: {error}"));
        let without_damage = if scenario.meshes[0].helix_angle_deg > 0.0 { "helical" } else { "healthy" };
        assert_eq!(scenario.faults.first().map_or(without_damage, |fault| fault.damage.kind()), kind);
        assert_eq!(scenario.validate().unwrap(), [], "{kind}");
    }
}

#[test]
fn templates_are_of_the_two_machines() {
    for (kind, text) in all().filter(|(kind, _)| *kind != "helical") {
        let scenario = Scenario::from_toml(&text).unwrap();
        let mut expected = match kind {
            "tooth-destruction" => Scenario::new(GearPair {
                module_mm: 3.0,
                pinion_teeth: 18,
                gear_teeth: 35,
                face_width_mm: 30.0,
                pinion_speed_hz: 45.0,
                brake_torque_nm: 15.0,
            }),
            _ => Scenario::new(GearPair::example()),
        };
        expected
            .wheels
            .iter_mut()
            .for_each(|wheel| wheel.din_grade = if kind == "tooth-destruction" { 8 } else { 7 });
        expected.faults.clone_from(&scenario.faults);
        assert_eq!(scenario, expected, "{kind}");
    }
}

#[test]
fn keys_that_are_commented_out_show_their_defaults() {
    for (kind, text) in all() {
        let set = uncommented(&text);
        assert!(set.lines().count() == text.lines().count() && set != text);
        let with_profiles =
            Scenario::from_toml(&set).unwrap_or_else(|error| panic!("{kind}: {error}\n{set}"));
        let mut scenario = with_profiles.clone();
        assert!(scenario.operation.speed_profile_hz.take().is_some());
        assert!(scenario.operation.torque_profile_nm.take().is_some());
        assert_eq!(scenario.solver.initial_displacement.take(), Some([0.0; 13]));
        assert_eq!(scenario.solver.duration_s.take(), Some(1.0));
        assert_eq!(scenario, Scenario::from_toml(&text).unwrap(), "{kind}");
    }
}

#[test]
fn keys_whose_default_follows_from_others_are_shown_as_well() {
    let text = template_of_all_keys("healthy").unwrap();
    let set =
        text.replace("# tip_chamfer_mm =", "tip_chamfer_mm =").replace("# backlash_mm =", "backlash_mm =");
    let default = Scenario::from_toml(&text).unwrap();
    let gears = Scenario::from_toml(&set).unwrap().gears();
    assert_eq!((gears.tip_chamfer_mm, gears.backlash_mm), ([Some(0.69); 2], Some(0.1275)));
    for wheel in WheelName::BOTH {
        assert!((gears.chamfer_mm(wheel) - default.gears().chamfer_mm(wheel)).abs() < 1e-12);
    }
    assert!((gears.normal_backlash_mm() - default.gears().normal_backlash_mm()).abs() < 1e-12);

    let mut set = text.clone();
    for wheel in ["pinion", "gear"] {
        for key in ["run_out_um", "run_out_phase_rad", "helix_slope_um"] {
            let line = format!("# {wheel}_{key} = 0.0");
            assert!(text.contains(&line), "{line}");
            set = set.replace(&line, &line[2..]);
        }
        for key in ["profile_errors_mm", "cumulative_pitch_um"] {
            assert!(text.contains(&format!("\n# {wheel}_{key} = [ ")), "{wheel}_{key}");
        }
    }
    let quality = Scenario::from_toml(&set).unwrap().quality();
    assert_eq!(
        (quality.pinion_deviations.run_out_um, quality.gear_deviations.helix_slope_um),
        (Some(0.0), Some(0.0))
    );
}

#[test]
fn alternatives_are_valid_in_place_of_what_they_replace() {
    let inertias = template_of_all_keys("healthy").unwrap().replace("# pinion_inertia", "pinion_inertia");
    let wheels = Scenario::from_toml(&inertias.replace("# gear_inertia", "gear_inertia")).unwrap().wheels;
    assert_eq!([0, 1].map(|wheel: usize| wheels[wheel].inertia.mass_kg), [Some(0.24), Some(1.2)]);

    for kind in ["partial-face", "through-face"] {
        let text = template_of_all_keys(kind).unwrap();
        let fractions = ["start = 0.2\n", "end = 0.8\n", "depth = 0.5\n"];
        let text = fractions.iter().fold(text, |text, line| text.replace(line, ""));
        let text = text.replace("# circle =", "circle =");
        let pit = match &Scenario::from_toml(&text).unwrap().faults[0].damage {
            Damage::PartialFace(face) => face.pit,
            Damage::ThroughFace(face) => face.pit,
            other => panic!("{other:?}"),
        };
        assert_eq!(pit, PitCircle::Circle { x_mm: 57.5, y_mm: 3.66, radius_mm: 2.5 });
    }

    let text = template_of_all_keys("tooth-destruction").unwrap();
    let text = text.replace("\nend = 0.9286", "").replace("# slope_deg", "slope_deg");
    let Damage::ToothDestruction(destruction) = Scenario::from_toml(&text).unwrap().faults[0].damage else {
        panic!("{text}");
    };
    assert_eq!(destruction.line, DestructionLine::SlopeDeg(22.0));
}

/// Every key that the library writes, and so knows, is explained in some template.
#[test]
fn every_key_is_in_the_templates() {
    let explained: String = all().map(|(_, text)| text).collect();
    for (_, text) in all() {
        let written = Scenario::from_toml(&uncommented(&text)).unwrap().to_toml();
        for line in written.lines().filter(|line| !line.starts_with('[')) {
            let key = line.split([' ', '.']).next().unwrap_or_default();
            assert!(explained.contains(key), "{key}");
        }
    }
    for key in
        ["errors_file", "pinion_profile_errors_mm", "gear_profile_errors_mm", "file =", "initial_velocity"]
    {
        assert!(explained.contains(key), "{key}");
    }
}

#[test]
fn other_kinds_have_no_template() {
    assert_eq!(template("scuffing"), None);
}
