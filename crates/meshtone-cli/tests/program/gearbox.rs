//! Gearboxes: `meshtone init gearbox`, `simulate`, `panel`, and the commands that know one pair only.

use std::f64::consts::TAU;

use crate::indicators::{csv, tacho};
use crate::support::{Workplace, stderr, stdout};
use meshtone_io::signals::read_signals;
use serde_json::Value;

/// An example of 0.1 s with a broken tooth.
fn broken(workplace: &Workplace) {
    workplace.succeeds(&["init", "gearbox", "-o", "gearbox.toml"]);
    let text = String::from_utf8(workplace.read("gearbox.toml")).unwrap();
    let fault =
        "\n[[fault]]\nwheel = \"z3\"\ntooth = 2\nkind = \"tooth-breakage\"\nseverity = 0.5\n\n[[sensor]]";
    let text = text.replacen("\n[[sensor]]", fault, 1).replace("duration_s = 1.0", "duration_s = 0.1");
    workplace.write("gearbox.toml", text);
}

#[test]
fn every_mesh_is_in_every_result() {
    let workplace = Workplace::new();
    broken(&workplace);
    let output = workplace.succeeds(&["simulate", "gearbox.toml", "-o", "out", "--trace", "trace.npz"]);
    for mesh in ["mesh z1-z2", "mesh z3-z4", "tooth-breakage (severity 0.500) on tooth 2 of z3"] {
        assert!(stdout(&output).contains(mesh), "{}", stdout(&output));
    }
    let summary: Value = serde_json::from_slice(&workplace.read("out/summary.json")).unwrap();
    let meshes = summary["meshes"].as_array().unwrap();
    assert_eq!(meshes.len(), 2);
    assert_eq!(meshes[1]["wheels"], serde_json::json!(["z3", "z4"]));
    for (mesh, expected_n) in meshes.iter().zip([502.761_152_35, 1_005.522_304_70]) {
        let mean_n = mesh["mesh_force"]["mean_n"].as_f64().unwrap();
        assert!((mean_n / expected_n - 1.0).abs() < 0.02, "{mean_n} N");
        let static_n = mesh["static_force_n"].as_f64().unwrap();
        assert!((static_n / expected_n - 1.0).abs() < 1e-9, "{static_n} N");
        assert!(mesh["mesh_stiffness"]["mean_n_per_mm"].as_f64().unwrap() > 1e5);
        assert!(mesh["transmission_error_um"]["static_peak_to_peak"].as_f64().unwrap() > 0.0);
    }
    assert!(summary.get("mesh_force").is_none());
    assert_eq!(summary["wheels"][2], serde_json::json!({ "name": "z3", "shaft": "middle", "teeth": 48 }));
    assert_eq!(summary["faults"][0]["wheel"], "z3");
    let path = workplace.path("out/signals.parquet");
    let recorded = read_signals(&path).unwrap();
    for name in ["force_n.z3-z4", "speed_hz.output"] {
        assert!(recorded.channels.signal(name).is_some(), "{name}");
    }
    let gearbox = &recorded.scenario;
    assert_eq!(recorded.channels, meshtone::simulate(gearbox).unwrap().channels);
    let panel = String::from_utf8(workplace.read("out/panel.svg")).unwrap();
    for words in ["z1-z2", "z3-z4", "Tooth breakage on tooth 2 of z3"] {
        assert!(panel.contains(words), "{words}");
    }
}

// The file of a pair of wheels holds those of a mesh, and what its wheels have beside it is refused.
#[test]
fn wheels_of_a_file_are_those_of_a_mesh() {
    let workplace = Workplace::new();
    workplace.succeeds(&["init", "healthy", "-o", "pair.toml"]);
    let pair = String::from_utf8(workplace.read("pair.toml")).unwrap();
    let of_mesh = |key: &str, teeth: u32| {
        let line = pair.lines().find(|line| line.starts_with(key)).unwrap().to_owned();
        (line, format!("{key} = {teeth}"))
    };
    let changes = [of_mesh("pinion_teeth", 32), of_mesh("gear_teeth", 96)];
    let text = changes.iter().fold(pair.clone(), |text, (from, to)| text.replace(from, to));
    workplace.write("pair.toml", text);
    workplace.succeeds(&["wheels", "pair.toml", "-o", "wheels.npz"]);
    workplace.succeeds(&["init", "gearbox", "-o", "gearbox.toml"]);
    let text = String::from_utf8(workplace.read("gearbox.toml")).unwrap();
    let text = text.replace("duration_s = 1.0", "duration_s = 0.1");
    let with_file = text.replacen("iso_class = 5", "errors_file = \"wheels.npz\"", 2);
    workplace.write("file.toml", &with_file);
    workplace.succeeds(&["simulate", "file.toml", "-o", "out", "--no-panel", "--trace", "trace.npz"]);
    let recorded = read_signals(&workplace.path("out/signals.parquet")).unwrap();
    let gearbox = &recorded.scenario;
    let stages = meshtone::stages(gearbox).unwrap();
    let read = meshtone_io::scenario_file::ScenarioFile::read(&workplace.path("pair.toml")).unwrap();
    let of_pair = meshtone::stages(&read.scenario).unwrap();
    let errors = of_pair.pairs[0].profile_errors.clone().unwrap();
    assert_eq!(gearbox.wheels[0].profile_errors_mm.as_ref(), Some(&errors.pinion_profile_errors_mm));
    assert_eq!(gearbox.wheels[1].profile_errors_mm.as_ref(), Some(&errors.gear_profile_errors_mm));
    assert_eq!(stages.pairs[0].profile_errors.as_ref(), Some(&errors));
    assert_eq!(stages.pairs[0].run_out, of_pair.pairs[0].run_out);
    workplace
        .write("both.toml", text.replacen("iso_class = 5", "iso_class = 5\nerrors_file = \"wheels.npz\"", 1));
    workplace.fails(2, &["simulate", "both.toml"], &["wheel[0].iso_class", "given beside profile errors"]);
    workplace.write("run_out.toml", with_file.replacen("errors_file", "run_out_um = 5.0\nerrors_file", 1));
    workplace.fails(2, &["simulate", "run_out.toml"], &["wheel[0].run_out_um", "given beside errors_file"]);
    workplace.write("other.toml", with_file.replace("teeth = 32", "teeth = 33"));
    let line = text.lines().position(|line| line == "iso_class = 5").unwrap() + 1;
    let words = [
        &format!("line {line}: wheel[0].errors_file = \"wheels.npz\" (the 1st wheel)"),
        "profile_errors_mm: is 100 × 32; must be 100 × 33",
    ];
    workplace.fails(2, &["simulate", "other.toml"], &words);
}

#[test]
fn published_rigs_are_printed_and_simulate() {
    let workplace = Workplace::new();
    for rig in ["phm2009-spur", "phm2009-helical", "uconn", "tecnalia"] {
        let output = workplace.succeeds(&["init", "gearbox", "--rig", rig]);
        let text = stdout(&output);
        assert!(text.contains("# assumed") && text.contains("# Published:"), "{text}");
        workplace.write("rig.toml", text.replace("duration_s = 1.0", "duration_s = 0.05"));
        workplace.succeeds(&["simulate", "rig.toml", "-o", rig, "--no-panel"]);
    }
    workplace.fails(2, &["init", "healthy", "--rig", "uconn"], &["only a gearbox has published rigs"]);
}

/// Uncommented, the fault of a template stands out on the sensor that comes first, and a template has nothing to warn of. The broken tooth of
/// Tecnalia's rig is on a wheel of the slower mesh, behind the vibration of the faster one: there it hardly shows. Twelve revolutions of the wheel show as
/// much as the thirty of the templates.
#[test]
fn faults_of_templates_show() {
    let workplace = Workplace::new();
    for rig in [&[][..], &["--rig", "phm2009-spur"], &["--rig", "phm2009-helical"], &["--rig", "uconn"]] {
        let sound = stdout(&workplace.succeeds(&[&["init", "gearbox"], rig].concat()));
        assert!(sound.contains("duration_s = 1.0"), "{sound}");
        let sound = sound.replace("duration_s = 1.0", "duration_s = 0.4");
        let (head, rest) = sound.split_once("# [[fault]]").unwrap();
        let (fault, rest) = rest.split_once("\n\n").unwrap();
        let broken = format!("{head}[[fault]]{}\n\n{rest}", fault.replace("\n# ", "\n"));
        let [sound, broken] = [("sound", sound), ("broken", broken)].map(|(name, text)| {
            let file = format!("{name}.toml");
            workplace.write(&file, text);
            let output = workplace.succeeds(&["simulate", &file, "-o", name, "--no-panel", "-q"]);
            assert_eq!(stderr(&output), "");
            let of = ["indicators", name, "-c", "input_0_vertical_g", "-o", "shown", "--no-figure", "-q"];
            workplace.succeeds(&of);
            let shown: Value = serde_json::from_slice(&workplace.read("shown/indicators.json")).unwrap();
            shown["records"][0]["indicators"]["fm4"].as_f64().unwrap()
        });
        println!("{rig:?}: FM4 {sound:.2}, with the fault {broken:.2}");
        assert!(broken > 3.0 * sound);
    }
}

/// Every wheel of a planetary set has an average: the simulation says where the planets stand; by the speed of a shaft it is found, and said.
#[test]
fn indicators_of_a_planetary_set() {
    let workplace = Workplace::new();
    workplace.succeeds(&["init", "gearbox", "--rig", "planetary-lab", "-o", "set.toml"]);
    let text = String::from_utf8(workplace.read("set.toml")).unwrap();
    let changes = [
        ("teeth = { sun = 31, planet = 31, ring = 95 }", "teeth = { sun = 20, planet = 25, ring = 70 }"),
        ("profile_shift = { sun = 0.32, planet = 0.32, ring = -0.0611 }", ""),
        ("100_000.0", "40_000.0"),
        ("duration_s = 4.0", "duration_s = 2.5\nsettle_fraction = 0.2"),
        ("speed_wander_percent = 0.03", ""),
    ];
    let text = changes.iter().fold(text, |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    });
    workplace.write("set.toml", &text);
    workplace.succeeds(&["simulate", "set.toml", "-o", "out", "--no-panel", "-q"]);
    let by_speed = ["--scenario", "set.toml", "--shaft", "output", "--shaft-hz", "8.8888888889"];
    for options in [&[][..], &by_speed] {
        let command = ["indicators", "out", "-o", "shown", "--no-figure", "-q"];
        workplace.succeeds(&[&command[..], options].concat());
        let shown: Value = serde_json::from_slice(&workplace.read("shown/indicators.json")).unwrap();
        let of = |list: &str, key: &str| -> Vec<String> {
            shown[list]
                .as_array()
                .unwrap()
                .iter()
                .map(|of| of[key].as_str().unwrap_or_default().to_owned())
                .collect()
        };
        assert_eq!(of("records", "wheel"), ["p.sun", "p.planet1", "p.planet2", "p.planet3", "p.ring"]);
        let is_found = of("warnings", "code").iter().any(|code| code == "planets-found");
        assert_eq!(is_found, !options.is_empty(), "{}", shown["warnings"]);
    }
    let broken =
        format!("{text}\n[[fault]]\nwheel = \"p.planet2\"\nkind = \"tooth-breakage\"\nseverity = 0.7\n");
    let along = "at = \"ring:p:90\"\ndirection = \"tangential\"";
    workplace.write("broken.toml", broken.replace("at = \"ring:p:90\"", along));
    workplace.succeeds(&["simulate", "broken.toml", "-o", "broken", "--no-panel", "-q"]);
    let said = |run: &str| {
        let assert = workplace.succeeds(&["indicators", run, "-o", "shown", "--no-figure"]);
        String::from_utf8(assert.get_output().stdout.clone()).unwrap()
    };
    assert!(said("out").contains("no wheel of a planetary set stands out"));
    assert!(said("broken").contains("p.planet2 stands out: kurtosis of the difference"));
    let diagnose = ["diagnose", "out", "--scenario", "set.toml"];
    workplace.fails(2, &diagnose, &["is a planetary set", "init dataset --planetary"]);
}

/// Every shaft of a simulation, and of a recording with a tachometer on one shaft and a bearing's tone.
#[test]
fn indicators_of_every_shaft() {
    let workplace = Workplace::new();
    broken(&workplace);
    let text = String::from_utf8(workplace.read("gearbox.toml")).unwrap();
    let text = text.replace("duration_s = 0.1", "duration_s = 2.0");
    let text = text.replace("sampling_rate_hz = 100000.0", "sampling_rate_hz = 20000.0");
    // The tachometer's pulses are those of a constant speed.
    let text = text.replace("speed_wander_percent = 0.03\n", "");
    workplace.write("gearbox.toml", text.clone());
    workplace.succeeds(&["simulate", "gearbox.toml", "-o", "out", "--no-panel", "-q"]);
    let results = |directory: &str| -> Value {
        serde_json::from_slice(&workplace.read(&format!("{directory}/indicators.json"))).unwrap()
    };
    let said = stdout(&workplace.succeeds(&["indicators", "out", "-o", "simulated"]));
    // The same teeth of all wheels meet again every 0.5 s, and in four of these periods, of whole revolutions, their lines are distinguished.
    for words in ["shaft middle with z2, 96 teeth, and z3, 48 teeth", "hunting-tooth orders: it needs 2."] {
        assert!(said.contains(words), "{said}");
    }
    let simulated = results("simulated");
    let of = |results: &Value, key: &str| -> Vec<String> {
        results["records"].as_array().unwrap().iter().map(|record| record[key].to_string()).collect()
    };
    assert_eq!(of(&simulated, "shaft"), ["\"input\"", "\"middle\"", "\"middle\"", "\"output\""]);
    assert_eq!(of(&simulated, "revolutions"), ["59", "19", "19", "11"]);
    assert_eq!(simulated["recordings"][0]["foreign_lines"], serde_json::json!([]));
    let figure = String::from_utf8(workplace.read("simulated/indicators.svg")).unwrap();
    for words in [
        "z3, 48 teeth, on shaft middle",
        "z4, 80 teeth, on shaft output",
        "orders of other shafts and meshes",
    ] {
        assert!(figure.contains(words), "{words}");
    }

    let recorded = read_signals(&workplace.path("out/signals.parquet")).unwrap();
    let rate_hz = recorded.channels.sampling_rate_hz;
    let tone = |(i, value): (usize, &f64)| value + 8.0 * (TAU * 91.57 * i as f64 / rate_hz).cos();
    let values: Vec<f64> = recorded.channels.signals[0].values.iter().enumerate().map(tone).collect();
    workplace.write("run.csv", csv(rate_hz, &values, tacho(6.0, rate_hz)));
    let run = [
        "indicators",
        "run.csv",
        "-c",
        "bearing",
        "--scenario",
        "gearbox.toml",
        "-o",
        "measured",
        "--no-figure",
    ];
    let with = |more: &[&str]| stdout(&workplace.succeeds(&[&run, more].concat()));
    for more in [&["--tach", "tacho", "--shaft", "output"][..], &["--mesh", "z3-z4"], &["--shaft-hz", "30"]] {
        let said = with(more);
        assert!(said.contains("that belong to no shaft and no mesh") && said.contains("3.05"), "{said}");
        let measured = results("measured");
        let line = &measured["recordings"][0]["foreign_lines"][0];
        assert!((line["frequency_hz"].as_f64().unwrap() - 91.57).abs() < 0.2, "{line}");
        for (record, expected) in measured["records"].as_array().unwrap().iter().zip([30.0, 10.0, 10.0, 6.0])
        {
            assert!((record["mean_speed_hz"].as_f64().unwrap() / expected - 1.0).abs() < 1e-3, "{record}");
        }
    }
    let fails = |more: &[&str], words: &[&str]| {
        workplace.fails(2, &[&run, more].concat(), words);
    };
    fails(&["--tach", "tacho", "--shaft", "outptu"], &["--shaft outptu", "input, middle, output"]);
    fails(&["--mesh", "z1-z4"], &["--mesh z1-z4", "z1-z2, z3-z4"]);
    fails(&["--teeth", "32"], &["--teeth", "--scenario"]);
    workplace.write("other.toml", text.replacen("teeth = 80", "teeth = 81", 1));
    let other = ["indicators", "out", "--scenario", "other.toml", "-o", "other"];
    workplace.fails(2, &other, &["48/80", "48/81", "own rig"]);
    workplace.fails(
        2,
        &["indicators", "out", "--teeth", "32", "--shaft-hz", "30", "--shaft", "input"],
        &["--scenario"],
    );
}

#[test]
fn what_knows_one_pair_says_so() {
    let workplace = Workplace::new();
    broken(&workplace);
    for arguments in [
        &["simulate", "gearbox.toml", "--model", "published"][..],
        &["simulate", "gearbox.toml", "--model", "linear"],
        &["wheels", "gearbox.toml", "-o", "wheels.npz"],
    ] {
        workplace.fails(2, arguments, &["of a gearbox"]);
    }
    let experiment = stdout(&workplace.succeeds(&["init", "experiment"]));
    let line = experiment.lines().find(|line| line.starts_with("scenario = ")).unwrap();
    workplace.write("experiment.toml", experiment.replace(line, "scenario = \"gearbox.toml\""));
    // Tuning asks for the wheel.
    workplace.fails(2, &["tune", "experiment.toml", "-o", "tuned"], &["signal.wheel", "missing"]);
}
