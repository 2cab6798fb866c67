//! Sensors of a scenario: they lead the results.
#![allow(clippy::unwrap_used)]

use std::fs::File;

use meshtone_io::table::TableReader;
use serde_json::Value;

use crate::support::{Workplace, fast_and, stdout};

const SENSORS: &str =
    "[[sensor]]\nname = \"casing\"\nresonance_hz = 2000.0\n[[sensor]]\nrange_g = 1.0\nbits = 8";

#[test]
fn sensors_come_first() {
    let workplace = Workplace::new();
    workplace.write("sensed.toml", fast_and(SENSORS));
    let printed = stdout(&workplace.succeeds(&["simulate", "sensed.toml", "-o", "out"]));
    let place = |words: &str| printed.find(words).unwrap_or(usize::MAX);
    assert!(place("casing_g ") < place("support_vertical_g "), "{printed}");
    assert!(place("support_vertical_g ") < place("horizontal_g "), "{printed}");
    let table = TableReader::new(File::open(workplace.path("out/signals.parquet")).unwrap()).unwrap();
    let names: Vec<&str> = table.columns().iter().map(|column| column.name.as_str()).collect();
    assert_eq!(names[..4], ["time_s", "casing_g", "pinion_support_vertical_g", "horizontal_g"]);
    let panel = String::from_utf8(workplace.read("out/panel.svg")).unwrap();
    assert!(panel.contains("Casing (g)") && !panel.contains("Vertical acceleration"));
    let summary: Value = serde_json::from_slice(&workplace.read("out/summary.json")).unwrap();
    assert_eq!(summary["indicators_of"], "casing_g");
    assert!(summary["channels"]["pinion_support_vertical_g"]["peak_g"].as_f64().unwrap() <= 1.0);

    // The indicators of the first sensor are the summary's.
    let printed = stdout(&workplace.succeeds(&["indicators", "out", "-o", "found"]));
    assert!(printed.contains("casing_g, g"), "{printed}");

    // Without sensors nothing of this is there.
    workplace.succeeds(&["simulate", "fast.toml", "-o", "plain", "--no-panel"]);
    let summary: Value = serde_json::from_slice(&workplace.read("plain/summary.json")).unwrap();
    assert_eq!(summary["indicators_of"], Value::Null);
}

#[test]
fn sensor_that_cannot_be_is_refused_with_its_line() {
    let workplace = Workplace::new();
    workplace.write("wrong.toml", fast_and("[[sensor]]\nname = \"axial\""));
    workplace.fails(2, &["simulate", "wrong.toml"], &["sensor.name = \"axial\"", "axial_g", "another name"]);
}
