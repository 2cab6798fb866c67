//! `meshtone adapt`

use std::fs;

use serde_json::Value;

use crate::path::workplace;
use crate::support::{printed_json, stdout};

/// A set of a machine is a data set like others, and the path of its sensor is in its scenario; a second run makes nothing anew.
#[test]
fn a_set_of_a_machine_is_made_and_kept() {
    let workplace = workplace();
    // A pair needs no sensor in its scenario: the path is then that of the usual place.
    let rig = fs::read_to_string(workplace.path("rig.toml")).unwrap();
    workplace.write("rig.toml", rig.replace("[[sensor]]\n", ""));
    let arguments = [
        "adapt",
        "healthy",
        "--scenario",
        "rig.toml",
        "--classes",
        "tooth-breakage,missing-tooth@pinion",
        "--units",
        "16",
        "--draws",
        "8",
        "-o",
        "set",
    ];
    let said = stdout(&workplace.succeeds(&arguments));
    assert!(
        said.contains("80 records of 3 classes: healthy, missing-tooth@pinion, tooth-breakage"),
        "{said}"
    );
    assert!(said.contains("windows of the healthy recordings and by healthy simulations"), "{said}");
    workplace.succeeds(&["dataset", "verify", "set"]);
    let scenario = fs::read_to_string(workplace.path("set/scenario.toml")).unwrap();
    assert!(scenario.contains("frequency_response"), "{scenario}");
    let written = fs::read_to_string(workplace.path("set/adaptation.json")).unwrap();
    let found: Value = serde_json::from_str(&written).unwrap();
    let number = |pointer: &str| found.pointer(pointer).and_then(Value::as_f64).unwrap();
    // A pinion without a tooth is found on any machine, and half of the damage is that.
    let area = number("/expected/area_under_curve/mean");
    assert!((0.7..=1.0).contains(&area), "{written}");
    assert!(
        number("/expected/area_under_curve/least") <= area
            && area <= number("/expected/area_under_curve/largest")
    );
    let windows: Vec<f64> =
        found["healthy_windows"].as_array().unwrap().iter().filter_map(Value::as_f64).collect();
    assert!(windows.len() > 1 && windows.iter().all(|of| *of <= number("/threshold")), "{written}");
    let first = fs::metadata(workplace.path("set/manifest.json")).unwrap().modified().unwrap();
    let again = printed_json(&workplace.succeeds(&[&arguments[..], &["--json"]].concat()));
    assert_eq!(again["threshold"], found["threshold"]);
    assert_eq!(fs::metadata(workplace.path("set/manifest.json")).unwrap().modified().unwrap(), first);
}

#[test]
fn classes_that_the_machine_cannot_have_are_refused() {
    let workplace = workplace();
    for (class, says) in [
        ("rust", "there are missing-tooth"),
        ("pits@z3", "the wheels are pinion, gear"),
        ("outer@input:0", "no ball or roller bearing"),
        ("pits,pits", "is named twice"),
        ("pits,rust", "beside healthy records"),
    ] {
        let arguments =
            ["adapt", "healthy", "--scenario", "rig.toml", "--draws", "8", "--classes", class, "-o", "set"];
        let named = class.rsplit(',').next().unwrap();
        workplace.fails(2, &arguments, &[named, says]);
        assert!(!workplace.path("set").exists());
    }
}
