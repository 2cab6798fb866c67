//! `meshtone simulate`

use std::fs::File;

use crate::support::{Workplace, fast_and, fast_with, printed_json, stderr, stdout};
use meshtone::InstructionSet;
use meshtone_io::recording::{RecordingOptions, read_recording};
use meshtone_io::run_identity::RunIdentity;
use meshtone_io::scenario_file::ScenarioFile;
use meshtone_io::signals::read_signals;
use meshtone_io::table::{FoundColumn, TableReader};
use ndarray::{ArrayD, IxDyn};
use ndarray_npy::NpzReader;
use serde_json::{Value, json};

const ALL_FILES: [&str; 4] = ["panel.png", "panel.svg", "signals.parquet", "summary.json"];

fn summary(workplace: &Workplace, directory: &str) -> Value {
    serde_json::from_slice(&workplace.read(&format!("{directory}/summary.json"))).unwrap()
}

#[test]
fn signals_are_those_of_the_library() {
    let workplace = Workplace::new();
    workplace.write("worn.toml", fast_and("[quality]\ndin_grade = 7"));
    workplace.succeeds(&["simulate", "worn.toml", "-o", "out"]);
    assert_eq!(workplace.names("out"), ALL_FILES);
    let scenario = ScenarioFile::read(&workplace.path("worn.toml")).unwrap().scenario;
    let recorded = read_signals(&workplace.path("out/signals.parquet")).unwrap();
    assert_eq!(recorded.scenario, scenario.clone());
    assert_eq!(recorded.channels, meshtone::simulate(&scenario).unwrap().channels);
}

/// One line for each scenario, with the numbers of the file, and nothing else.
#[test]
fn numbers_are_printed_as_json() {
    let workplace = Workplace::new();
    let without = |mut numbers: Value, key: &str| {
        let value = numbers.as_object_mut().unwrap().remove(key).unwrap();
        (numbers, value)
    };
    let (simulated, output) =
        without(printed_json(&workplace.succeeds(&["simulate", "fast.toml", "--json"])), "output");
    assert_eq!(output, "fast_results");
    assert_eq!(simulated, without(summary(&workplace, "fast_results"), "files").0);
    let (indicators, output) =
        without(printed_json(&workplace.succeeds(&["indicators", "fast_results", "--json"])), "output");
    assert_eq!(output, "fast_results_indicators");
    let file = workplace.read("fast_results_indicators/indicators.json");
    assert_eq!(indicators, serde_json::from_slice::<Value>(&file).unwrap());
    workplace.write("again.toml", fast_and("[quality]\ndin_grade = 7"));
    let both = stdout(&workplace.succeeds(&["simulate", "fast.toml", "again.toml", "-o", "out", "--json"]));
    let lines = both.lines().map(|line| serde_json::from_str(line).unwrap());
    assert_eq!(
        lines.map(|line: Value| line["output"].clone()).collect::<Vec<_>>(),
        ["out/fast", "out/again"]
    );
    workplace.fails(2, &["simulate", "fast.toml", "--json", "--quiet"], &["--json", "--quiet"]);
}

/// All sets with fused multiply-add give the same bits; products that are rounded before they are added differ by rounding, which grows
/// with no number of samples while the mesh is linear.
#[test]
fn the_variable_chooses_the_instructions() {
    let workplace = Workplace::new();
    let run = |instructions: &str| {
        let arguments = ["simulate", "fast.toml", "--model", "linear", "-o", "out", "--no-panel"];
        workplace.command(&arguments).env("MESHTONE_INSTRUCTIONS", instructions).assert().success();
        let channels = read_signals(&workplace.path("out/signals.parquet")).unwrap().channels;
        ["vertical_g", "mesh_force_n"].map(|name| channels[name].to_vec())
    };
    let [plain, fastest] = ["plain", ""].map(run);
    for set in InstructionSet::available() {
        if set != InstructionSet::Plain {
            assert_eq!(run(set.name()), fastest, "{}", set.name());
        }
    }
    for (plain, fused) in plain.iter().zip(&fastest) {
        let largest =
            |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |most, x: f64| x.abs().max(most));
        let difference = largest(&mut plain.iter().zip(fused).map(|(a, b)| a - b));
        assert!(difference < 1e-9 * largest(&mut fused.iter().copied()), "{difference:e}");
    }
    if InstructionSet::in_use() != InstructionSet::Plain {
        assert_ne!(plain, fastest, "nothing was chosen");
    }
    let refused = workplace
        .command(&["init", "healthy"])
        .env("MESHTONE_INSTRUCTIONS", "sse")
        .assert()
        .code(2)
        .stdout("");
    assert!(
        stderr(&refused).contains("MESHTONE_INSTRUCTIONS = \"sse\": must be one of "),
        "{}",
        stderr(&refused)
    );
}

/// Signals in other formats take the place of Parquet, and a later run leaves none of an earlier one's.
#[test]
fn signals_in_other_formats() {
    let workplace = Workplace::new();
    let run = |arguments: &[&str]| {
        workplace.succeeds(&[&["simulate", "fast.toml", "-o", "out", "--no-panel"], arguments].concat());
    };
    run(&[]);
    let recorded = read_signals(&workplace.path("out/signals.parquet")).unwrap();
    run(&["--format", "mat,wav"]);
    assert_eq!(workplace.names("out"), ["signals.mat", "signals.wav", "summary.json"]);
    let recording = read_recording(&workplace.path("out"), &RecordingOptions::default()).unwrap();
    assert_eq!(recording.source, workplace.path("out/signals.mat"));
    assert_eq!(recording.channel("vertical_g").unwrap().samples, recorded.channels["vertical_g"]);
    workplace.fails(2, &["simulate", "out"], &["is what `meshtone simulate` wrote"]);
    workplace.succeeds(&[
        "indicators",
        "out",
        "-c",
        "vertical_g",
        "-o",
        "of_folder",
        "--teeth",
        "40",
        "--shaft-hz",
        "40",
        "--no-figure",
    ]);
    run(&["--format", "parquet"]);
    assert_eq!(workplace.names("out"), ["signals.parquet", "summary.json"]);
    workplace.fails(2, &["simulate", "fast.toml", "--format", "xlsx"], &["parquet, csv, mat, npz, wav"]);
}

#[test]
fn parquet_panel_and_summary_carry_the_runs_identity() {
    let workplace = Workplace::new();
    let runs = ["linear", "published"].map(|model| {
        workplace.succeeds(&["simulate", "fast.toml", "--model", model, "-o", "out"]);
        let run = summary(&workplace, "out")["run"].as_str().unwrap().to_string();
        let recorded = read_signals(&workplace.path("out/signals.parquet")).unwrap();
        assert_eq!(recorded.run.to_string(), run);
        assert_eq!(recorded.run, RunIdentity::of_toml(&recorded.scenario.to_toml()));
        for panel in ["out/panel.svg", "out/panel.png"] {
            let bytes = workplace.read(panel);
            assert!(bytes.windows(run.len()).any(|part| part == run.as_bytes()), "{panel}");
        }
        run
    });
    assert_ne!(runs[0], runs[1]);
}

#[test]
fn files_of_another_origin_stay() {
    let workplace = Workplace::new();
    std::fs::create_dir(workplace.path("out")).unwrap();
    workplace.write("out/signals.csv", "measured");
    workplace.succeeds(&["simulate", "fast.toml", "-o", "out", "--format", "mat", "--no-panel"]);
    assert_eq!(summary(&workplace, "out")["files"], serde_json::json!(["signals.mat"]));
    workplace.succeeds(&["simulate", "fast.toml", "-o", "out", "--no-panel"]);
    assert_eq!(workplace.names("out"), ["signals.csv", "signals.parquet", "summary.json"]);
    assert_eq!(workplace.read("out/signals.csv"), b"measured");
}

#[test]
fn columns_and_metadata() {
    let workplace = Workplace::new();
    workplace.succeeds(&["simulate", "fast.toml", "-o", "out", "--no-panel"]);
    let file = File::open(workplace.path("out/signals.parquet")).unwrap();
    let table = TableReader::new(file).unwrap();
    let unit = |column: &FoundColumn| {
        let entry = column.metadata.iter().find(|(key, _)| key == "unit").unwrap();
        (column.name.clone(), entry.1.clone())
    };
    let columns: Vec<_> = table.columns().iter().map(unit).collect();
    let expected = [
        ("time_s", "s"),
        ("horizontal_g", "g"),
        ("vertical_g", "g"),
        ("axial_g", "g"),
        ("pinion_shaft_speed_hz", "Hz"),
        ("gear_shaft_speed_hz", "Hz"),
        ("mesh_force_n", "N"),
    ];
    assert_eq!(columns, expected.map(|(name, unit)| (name.to_string(), unit.to_string())));
    let metadata = table.metadata().file_metadata().key_value_metadata().unwrap();
    let value = |key: &str| {
        let entry = metadata.iter().find(|entry| entry.key == key).unwrap();
        entry.value.clone().unwrap()
    };
    assert_eq!(value("meshtone.sampling_rate_hz"), "11200.0");
    assert_eq!(value("meshtone.run"), summary(&workplace, "out")["run"]);
    assert_eq!(value("meshtone.version"), env!("CARGO_PKG_VERSION"));
    assert!(value("meshtone.scenario").contains("pinion_teeth = 20\n"));
    assert_eq!(table.metadata().file_metadata().num_rows(), 11_200);
}

#[test]
fn the_same_scenario_gives_the_same_bytes() {
    let workplace = Workplace::new();
    let noisy = "[quality]\ndin_grade = 7\n[fault]\nkind = \"tooth-destruction\"\nstart = 0.2\nend = 0.9\n\
                 noise_mm = 0.01";
    workplace.write("noisy.toml", fast_and(noisy));
    for directory in ["a", "b"] {
        workplace.succeeds(&["simulate", "noisy.toml", "-o", directory, "--no-panel"]);
    }
    assert_eq!(workplace.read("a/signals.parquet"), workplace.read("b/signals.parquet"));
}

#[test]
fn summary_of_a_healthy_pair() {
    let workplace = Workplace::new();
    workplace.succeeds(&["simulate", "fast.toml", "-o", "out", "--no-panel"]);
    let summary = summary(&workplace, "out");
    assert_eq!(summary["format_version"], 2);
    assert_eq!(summary["model"], "contact");
    assert_eq!(summary["seed"], 1);
    assert_eq!(summary["faults"], json!([]));
    assert_eq!(summary["sampling_rate_hz"], 11_200.0);
    assert_eq!(summary["samples"], 11_200);
    assert_eq!(summary["natural_frequencies_hz"].as_array().unwrap().len(), 17);
    // The mean force balances the brake: T/(r_g cos α), r_g = 60 mm.
    let mean = summary["mesh_force"]["mean_n"].as_f64().unwrap();
    assert!((mean / (200.0 / (0.06 * 20f64.to_radians().cos())) - 1.0).abs() < 0.01, "{mean}");
    let stiffness = |key: &str| summary["mesh_stiffness"][key].as_f64().unwrap();
    assert!(stiffness("min_n_per_mm") < stiffness("mean_n_per_mm"));
    assert!(stiffness("mean_n_per_mm") < stiffness("max_n_per_mm"));
    // A pair is a train with one mesh, whose numbers stand beside the lists too.
    let mesh = &summary["meshes"][0];
    for key in ["contact_ratio", "helix", "face_load_factor", "mesh_stiffness", "mesh_force"] {
        assert!(mesh[key] == summary[key] && summary.get(key).is_some(), "{key}");
    }
    assert_eq!((&mesh["wheels"], &mesh["mesh_frequency_hz"]), (&json!(["pinion", "gear"]), &json!(800.0)));
    assert_eq!(summary["shafts"][1], json!({ "name": "gear", "speed_hz": 20.0, "speed_ratio": "-1/2" }));
    assert_eq!(summary["wheels"][1], json!({ "name": "gear", "shaft": "gear", "teeth": 40 }));
    assert_eq!((&summary["bearings"], &summary["cycle_input_revolutions"]), (&json!([]), &json!(2)));
    let channels = &summary["channels"];
    let speed = channels["pinion_shaft_speed_hz"]["rms_hz"].as_f64().unwrap();
    assert!((speed - 40.0).abs() < 0.1, "{speed}");
    assert!(channels["vertical_g"]["kurtosis"].is_f64());
    // Nothing pushes along the axis.
    assert_eq!(channels["axial_g"]["rms_g"], 0.0);
    assert_eq!(channels["axial_g"]["kurtosis"], Value::Null);
    assert!(summary["computing_time_ms"]["time_integration"].is_f64());
    // So few samples shift the mode in which the supports oppose each other.
    let warnings = summary["warnings"].as_array().unwrap();
    assert!(warnings.iter().all(|warning| warning["code"] == "step-error"), "{warnings:?}");
}

#[test]
fn every_field_of_the_trace() {
    let workplace = Workplace::new();
    workplace.write("pit.toml", fast_and("[quality]\ndin_grade = 6\n[fault]\nkind = \"missing-tooth\""));
    workplace.succeeds(&["simulate", "pit.toml", "-o", "out", "--trace", "out/all.npz", "--no-panel"]);
    let scenario = ScenarioFile::read(&workplace.path("pit.toml")).unwrap().scenario;
    let (simulation, trace) = meshtone::trace(&scenario).unwrap();
    let mut archive = NpzReader::new(File::open(workplace.path("out/all.npz")).unwrap()).unwrap();
    assert_eq!(archive.names().unwrap().len(), trace.fields.len() + 1);
    let run: ArrayD<u64> = archive.by_name("run").unwrap();
    assert_eq!(run, ndarray::arr0(RunIdentity::of(&scenario).number()).into_dyn());
    for field in &trace.fields {
        let array: ArrayD<f64> = archive.by_name(&field.name).unwrap();
        let expected = ArrayD::from_shape_vec(IxDyn(&field.shape), field.values.clone()).unwrap();
        // The computing time is each run's own.
        if field.name == "elapsed_s" {
            assert!(array.len() == 1 && array.iter().all(|&seconds| seconds > 0.0));
            continue;
        }
        assert_eq!(array, expected, "{}", field.name);
    }
    let recorded = read_signals(&workplace.path("out/signals.parquet")).unwrap();
    assert_eq!(recorded.channels, simulation.channels);
}

#[test]
fn several_scenarios_on_the_same_wheels() {
    let workplace = Workplace::new();
    workplace.write("worn.toml", fast_and("[quality]\ndin_grade = 9"));
    workplace.write("gone.toml", fast_and("[fault]\nkind = \"missing-tooth\""));
    workplace.succeeds(&["wheels", "worn.toml", "-o", "wheels.npz"]);
    let both = ["simulate", "fast.toml", "gone.toml", "--errors-file", "wheels.npz", "-o", "out/deep"];
    workplace.succeeds(&both);
    assert_eq!(workplace.names("out/deep"), ["fast", "gone"]);
    let read =
        |name: &str| read_signals(&workplace.path(&format!("out/deep/{name}/signals.parquet"))).unwrap();
    let [healthy, gone] = ["fast", "gone"].map(|name| read(name).scenario);
    assert_eq!(healthy.quality(), gone.quality());
    assert!(healthy.quality().profile_errors.is_some());
    // The wheels are those that the grade draws.
    workplace.succeeds(&["simulate", "worn.toml", "--quiet", "--no-panel"]);
    let drawn = read_signals(&workplace.path("worn_results/signals.parquet")).unwrap();
    assert_eq!(drawn.channels, read("fast").channels);
}

#[test]
fn model_of_the_command_line_and_what_it_ignores() {
    let workplace = Workplace::new();
    workplace.write("bent.toml", fast_and("[rig]\neccentricity_mm = 0.02"));
    let assert = workplace.succeeds(&["simulate", "bent.toml", "--model", "published", "--no-panel"]);
    assert!(
        stderr(&assert).contains("bent.toml: line 12: rig.eccentricity_mm: is ignored"),
        "{}",
        stderr(&assert)
    );
    let summary = summary(&workplace, "bent_results");
    assert_eq!(summary["model"], "published");
    assert_eq!(summary["warnings"][0]["key"], "rig.eccentricity_mm");
    let assert = workplace.succeeds(&["simulate", "bent.toml", "--no-panel"]);
    assert!(!stderr(&assert).contains("ignored"));
}

#[test]
fn a_model_that_there_is_not_is_answered_with_those_that_there_are() {
    let workplace = Workplace::new();
    workplace.fails(2, &["simulate", "fast.toml", "--model", "both"], &["linear, published"]);
}

#[test]
fn faults_on_several_teeth_of_both_wheels() {
    let workplace = Workplace::new();
    let chip = "[[fault]]\nkind = \"tooth-breakage\"\nwheel = \"pinion\"\ntooth = 3\nchip_height_mm = 3.0\nchip_width_mm = 8.0\n";
    workplace.write("two.toml", fast_and(&format!("{chip}[[fault]]\nkind = \"missing-tooth\"\ntooth = 7\n")));
    let text = stdout(&workplace.succeeds(&["simulate", "two.toml", "-o", "out"]));
    for words in [
        "tooth-breakage (severity 0.1",
        ") on tooth 3 of pinion, missing-tooth (severity 1.000) on tooth 7 of gear",
    ] {
        assert!(text.contains(words), "{text}");
    }
    let mut faults = summary(&workplace, "out")["faults"].clone();
    let severities = [0, 1].map(|fault| faults[fault]["severity"].take().as_f64().unwrap());
    assert!((0.1..0.2).contains(&severities[0]) && severities[1] == 1.0, "{severities:?}");
    let expected = json!([
        { "kind": "tooth-breakage", "wheel": "pinion", "tooth": 3, "severity": null },
        { "kind": "missing-tooth", "wheel": "gear", "tooth": 7, "severity": null },
    ]);
    assert_eq!(faults, expected);
    workplace.succeeds(&["indicators", "out", "-o", "indicators"]);
    let figure = String::from_utf8(workplace.read("indicators/indicators.svg")).unwrap();
    assert!(figure.contains("; 3 is damaged") && figure.contains("; 7 is missing"));
}

#[test]
fn a_pulling_mesh_is_warned_of() {
    let workplace = Workplace::new();
    workplace.write(
        "light.toml",
        fast_with("brake_torque_nm", "brake_torque_nm = 1.0") + "[quality]\ndin_grade = 9\n",
    );
    let assert = workplace
        .succeeds(&["simulate", "light.toml", "--model", "linear", "--quiet", "--no-panel"])
        .stdout("");
    let warning = stderr(&assert);
    assert!(
        warning.contains("line 8: operation.brake_torque_nm: the mesh force is negative for"),
        "{warning}"
    );
    // Teeth that part do not pull.
    let assert = workplace.succeeds(&["simulate", "light.toml", "--quiet", "--no-panel"]).stdout("");
    assert!(!stderr(&assert).contains("the mesh force is negative"), "{}", stderr(&assert));
    let figures = &summary(&workplace, "light_results")["mesh_force"];
    assert!(figures["apart_fraction"].as_f64().unwrap() > 0.0 && figures.get("tension_fraction").is_none());
}

#[test]
fn the_table() {
    let workplace = Workplace::new();
    let text = stdout(&workplace.succeeds(&["simulate", "fast.toml"]));
    for words in
        ["fast.toml -> fast_results", "mesh stiffness", "contact ratio", "natural frequencies", "rms"]
    {
        assert!(text.contains(words), "`{words}` is not in {text}");
    }
    workplace.write("fine.toml", fast_with("sampling_rate_hz", "sampling_rate_hz = 1e5"));
    workplace.succeeds(&["simulate", "fine.toml", "--quiet", "--no-panel"]).stdout("").stderr("");
}

#[test]
fn a_run_without_a_panel_leaves_none_of_another_run() {
    let workplace = Workplace::new();
    workplace.succeeds(&["simulate", "fast.toml"]);
    workplace.succeeds(&["simulate", "fast.toml", "--no-panel"]);
    assert_eq!(workplace.names("fast_results"), ["signals.parquet", "summary.json"]);
}

#[test]
fn a_byte_order_mark_is_no_part_of_the_text() {
    let workplace = Workplace::new();
    workplace.write("windows.toml", format!("\u{feff}{}", crate::support::FAST.replace('\n', "\r\n")));
    workplace.succeeds(&["simulate", "windows.toml", "--no-panel"]);
}
