//! `meshtone path`

use std::fs;

use crate::support::{Workplace, fast_with, printed_json, stdout};

/// A rig, and what its sensor shows of other wheels behind a path.
pub fn workplace() -> Workplace {
    let workplace = Workplace::new();
    let rig = fast_with("sampling_rate_hz", "sampling_rate_hz = 20000.0");
    let rig = format!("{rig}duration_s = 2.0\n[quality]\ndin_grade = 6\n");
    let sensor = "[[sensor]]\nfrequency_response = { frequency_hz = [0.0, 10000.0], magnitude = [3.0, 3.0], phase_deg = [0.0, 0.0] }\n";
    workplace.write("rig.toml", rig.clone() + "[[sensor]]\n");
    workplace.write("healthy.toml", format!("{rig}seed = 7\n{sensor}"));
    workplace.succeeds(&["simulate", "healthy.toml", "-o", "healthy", "--no-panel", "-q"]);
    workplace
}

#[test]
fn a_path_is_what_a_scenario_takes() {
    let workplace = workplace();
    let arguments = ["path", "healthy", "--scenario", "rig.toml", "--draws", "8", "-o", "path.csv"];
    let said = stdout(&workplace.succeeds(&arguments));
    assert!(said.contains("1000") && said.contains("frequency_response = { file = \"path.csv\" }"), "{said}");
    let text = fs::read_to_string(workplace.path("path.csv")).unwrap();
    let printed = printed_json(&workplace.succeeds(&[&arguments[..], &["--json"]].concat()));
    assert_eq!(printed["frequency_hz"].as_array().unwrap().len(), text.lines().count() - 1);
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("frequency_hz,magnitude,phase_deg,magnitude_db,low_db,high_db"));
    // The sensor of the recording shows three times the motion, 9.5 dB.
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').map(|field| field.parse().unwrap()).collect()).collect();
    let inside = rows.iter().filter(|row| (700.0..4000.0).contains(&row[0]));
    let errors: Vec<f64> = inside.map(|row| row[3] - 9.54).collect();
    let rms = (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt();
    assert!(rms < 4.0, "{rms}");
    let rig = fs::read_to_string(workplace.path("rig.toml")).unwrap();
    workplace.write("tuned.toml", rig + "frequency_response = { file = \"path.csv\" }\n");
    workplace.succeeds(&["simulate", "tuned.toml", "-o", "tuned", "--no-panel", "-q"]);
}

#[test]
fn what_does_not_fit_is_refused() {
    let workplace = workplace();
    let rig = fs::read_to_string(workplace.path("rig.toml")).unwrap();
    workplace.write("other.toml", rig.replace("gear_teeth = ", "gear_teeth = 1"));
    workplace.fails(
        2,
        &["path", "healthy", "--scenario", "other.toml", "-o", "path.csv"],
        &["teeth", "own rig"],
    );
    workplace.fails(
        2,
        &["path", "healthy", "--scenario", "rig.toml", "-o", "rig.toml"],
        &["is read", "another file"],
    );
    // The pinion's speed, stated of the gear.
    workplace.fails(
        2,
        &[
            "path",
            "healthy",
            "--scenario",
            "rig.toml",
            "--shaft",
            "gear",
            "--shaft-hz",
            "40",
            "-o",
            "path.csv",
        ],
        &["healthy: does not fit the scenario", "check --shaft"],
    );
    workplace.write("ideal.toml", rig.replace("din_grade = 6", "din_grade = 0"));
    workplace.fails(
        2,
        &["path", "healthy", "--scenario", "ideal.toml", "-o", "path.csv"],
        &["ideal.toml: line", "quality.din_grade = 0"],
    );
}
