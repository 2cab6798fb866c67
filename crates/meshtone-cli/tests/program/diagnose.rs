//! `meshtone diagnose`

use std::fmt::Write;
use std::fs;
use std::process::Stdio;

use crate::plain::plain;
use meshtone::scenario::{Scenario, gearbox_template};
use meshtone_io::signals::read_signals;
use serde_json::Value;

use crate::indicators::{csv, tacho};
use crate::support::{Workplace, fast_with, names, program, stderr, stdout};

const DATA: &str = "diagnosis.json";
const FIGURES: [&str; 2] = ["diagnosis.png", "diagnosis.svg"];
/// So few simulations that a test can wait for them, and enough for what these tests ask.
const FEW: &str = "512";

fn workplace() -> Workplace {
    let workplace = Workplace::new();
    let rig = fast_with("sampling_rate_hz", "sampling_rate_hz = 8000.0");
    let rig = format!("model = \"linear\"\n{rig}[quality]\ndin_grade = 6\n");
    workplace.write("rig.toml", &rig);
    workplace.write("other.toml", rig.clone() + "seed = 7\n");
    workplace.write("gone.toml", rig + "[fault]\nkind = \"missing-tooth\"\ntooth = 8\n");
    for (scenario, to) in [("rig.toml", "sound"), ("gone.toml", "gone"), ("other.toml", "other")] {
        workplace.succeeds(&["simulate", scenario, "-o", to, "--no-panel", "-q"]);
    }
    workplace
}

/// What was simulated, as a CSV file with a tachometer.
fn as_measured(workplace: &Workplace, of: &str) {
    let channels = read_signals(&workplace.path(&format!("{of}/signals.parquet"))).unwrap().channels;
    let rate = channels.sampling_rate_hz;
    workplace.write(&format!("{of}.csv"), csv(rate, &channels["vertical_g"], tacho(40.0, rate)));
}

fn answer(workplace: &Workplace, directory: &str) -> Value {
    serde_json::from_slice(&workplace.read(&format!("{directory}/{DATA}"))).unwrap()
}

fn likeliest(answer: &Value) -> (String, Value) {
    let (label, said) = answer["kinds"].as_object().unwrap().iter().next().unwrap();
    (label.clone(), said.clone())
}

#[test]
fn from_recordings_to_an_answer() {
    let workplace = workplace();
    let shared_arguments = ["--scenario", "rig.toml", "--records", FEW, "--reference", "kept"];

    // What is finished stays where the program is killed, and the next question goes on with it.
    let mut child = program()
        .args([
            "diagnose",
            "gone",
            "-q",
            "--scenario",
            "rig.toml",
            "--records",
            "20480",
            "--reference",
            "kept",
        ])
        .current_dir(workplace.directory.path())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let batches = || names_within(&workplace, "kept");
    while batches().is_empty() && child.try_wait().unwrap().is_none() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(!workplace.path("gone_diagnosis").join(DATA).exists());
    let first = batches()[0].clone();
    let made = fs::metadata(&first).unwrap().modified().unwrap();

    let diagnose = |of: &[&str]| workplace.succeeds(&[&["diagnose"], of, &shared_arguments].concat());
    let assert = diagnose(&["gone", "--healthy", "sound"]);
    assert_eq!(fs::metadata(&first).unwrap().modified().unwrap(), made, "it was made again");
    assert_eq!(workplace.names("gone_diagnosis"), [DATA, FIGURES[0], FIGURES[1]]);
    let found = answer(&workplace, "gone_diagnosis");
    let (label, said) = likeliest(&found);
    assert!(["missing-tooth", "tooth-destruction", "tooth-breakage"].contains(&label.as_str()), "{found:#}");
    assert_eq!((&said["wheel"], &said["tooth"]), (&"gear".into(), &8.into()), "{said:#}");
    assert!(found["damaged"].as_f64().unwrap() > 0.9 && found["outside_model"].as_f64().unwrap() > 0.01);
    for words in [
        "gone -> gone_diagnosis",
        "damaged with a probability of",
        "tooth 8 at 63°",
        "teeth are counted as in the simulation",
        "simulations; the others are what these are compared with",
        "given the scenario",
        "by the indicators alone it is damaged: ",
        "p = ",
    ] {
        assert!(stdout(&assert).contains(words), "{words} in {}", stdout(&assert));
    }

    // The schema.
    let sum: f64 =
        found["kinds"].as_object().unwrap().values().map(|kind| kind["probability"].as_f64().unwrap()).sum();
    assert!((sum - 1.0).abs() < 1e-9 && found["kinds"]["healthy"]["severity"].is_null());
    assert_eq!((&found["signal"], &found["has_healthy"]), (&"recording".into(), &true.into()));
    assert_eq!((&found["recordings"][0], &found["healthy"][0]), (&"gone".into(), &"sound".into()));
    assert_eq!((&found["any_damage"]["wheel"], &found["any_damage"]["tooth"]), (&"gear".into(), &8.into()));
    assert_eq!(found["teeth_counted_from"]["gear"], "simulation");
    assert_eq!(found["reference"]["asked"].to_string(), FEW);
    assert_eq!((&found["scenario"], &found["tuned"]), (&"rig.toml".into(), &Value::Null));
    let severity = &found["kinds"]["tooth-breakage"]["severity"];
    assert!(severity["within_90"][0].as_f64().unwrap() <= severity["median"].as_f64().unwrap());
    assert!(found["kinds"]["tooth-breakage"]["sizes"]["chip_height_mm"]["within_50"].is_array());

    // A measurement with a tachometer.
    for of in ["other", "sound"] {
        as_measured(&workplace, of);
    }
    let assert = diagnose(&["other.csv", "--tach", "tacho", "--healthy", "sound.csv", "--no-figure"]);
    let healthy = answer(&workplace, "other_diagnosis");
    assert_eq!(workplace.names("other_diagnosis"), [DATA]);
    assert_eq!(likeliest(&healthy).0, "healthy", "{healthy:#}");
    assert!(!stderr(&assert).contains("when it was healthy"));

    // A healthy recording of another speed, rate, column and unit, without a tachometer.
    let rig = String::from_utf8(workplace.read("rig.toml")).unwrap();
    let slow = rig.replace("pinion_speed_hz = 40.0", "pinion_speed_hz = 28.0").replace("8000.0", "6000.0");
    workplace.write("slow.toml", slow);
    workplace.succeeds(&["simulate", "slow.toml", "-o", "slow", "--no-panel", "-q"]);
    let slow = read_signals(&workplace.path("slow/signals.parquet")).unwrap().channels;
    let values = slow["vertical_g"].iter().map(|value| format!("{:e}\n", 9.80665 * value));
    workplace.write("slow.csv", "acc\n".to_owned() + &values.collect::<String>());
    as_measured(&workplace, "gone");
    let of_slow =
        ["gone.csv", "-c", "bearing", "--tach", "tacho", "--healthy", "slow.csv", "--healthy-channel", "acc"];
    // Of whole samples a revolution, so not the scenario's.
    let rate = slow.sampling_rate_hz.to_string();
    let as_slow = ["--healthy-sampling-rate-hz", &rate, "--healthy-unit", "m/s²", "--healthy-shaft-hz", "28"];
    let assert = diagnose(&[&of_slow[..], &as_slow, &["--no-figure"]].concat());
    let found = answer(&workplace, "gone_diagnosis");
    assert!(found["damaged"].as_f64().unwrap() > 0.9 && found["is_outside"] == false, "{found:#}");
    let gear = &found["rule"]["wheels"]["gear"]["fm4"];
    assert_eq!((&found["rule"]["is_damaged"], &gear["is_above"]), (&true.into(), &true.into()), "{found:#}");
    let said = stderr(&assert);
    assert!(
        said.contains("Hz in the healthy recording, at 40.0") && !said.contains("times as loud"),
        "{said}"
    );

    // One revolution of the gear; the same bits, whatever the number of threads.
    let mut text = "angle_deg,difference [m/s²]\n".to_owned();
    for point in 0..1024 {
        let since = (f64::from(point) / 1024.0 - 0.4).rem_euclid(1.0);
        let burst = 80.0 * (-60.0 * since).exp() * (std::f64::consts::TAU * 130.0 * since).sin();
        writeln!(text, "{},{burst:e}", 360.0 * f64::from(point) / 1024.0).unwrap();
    }
    workplace.write("figure.csv", text);
    let answers = ["1", "2"].map(|threads| {
        let arguments = ["diagnose", "figure.csv", "--signal", "difference", "--no-figure", "-q"];
        let mut command = workplace.command(&[&arguments[..], &shared_arguments].concat());
        let assert = command.env("RAYON_NUM_THREADS", threads).assert().success().stdout("");
        assert!(stderr(&assert).contains("when it was healthy"), "{}", stderr(&assert));
        answer(&workplace, "figure_diagnosis")
    });
    assert_eq!(answers[0], answers[1]);
    assert_eq!(answers[0]["signal"], "difference");
}

fn names_within(workplace: &Workplace, folder: &str) -> Vec<std::path::PathBuf> {
    let folder = workplace.path(folder);
    let sets = if folder.is_dir() { names(&folder) } else { Vec::new() };
    let files = sets.iter().flat_map(|set| {
        let set = folder.join(set);
        names(&set).into_iter().map(move |name| set.join(name))
    });
    files.filter(|path| path.extension().is_some_and(|ending| ending == "npz")).collect()
}

#[test]
fn what_is_refused() {
    let workplace = workplace();
    workplace.write("volts.csv", "time_s,bearing [V]\n0,1\n1e-4,0\n2e-4,1\n");
    workplace.write("plain.csv", "time_s,bearing\n0,1\n1e-4,0\n2e-4,1\n");
    workplace.write("more_teeth.toml", fast_with("gear_teeth", "gear_teeth = 41"));
    let tuned = "model = \"published\"\n[enhancement]\nwidth_ratio = 0.2\nfault_to_harmonics_ratio = 2.0\nnoise_level = 1.0\n\
                 [signal]\nsampling_rate_hz = 25000.0\n";
    workplace.write("tuned.toml", tuned);
    as_measured(&workplace, "other");
    // Noise alone, as of a rig that stands still: a sequence that is as good as random.
    let mut state = 1_u32;
    let noise: Vec<f64> = (0..16_000)
        .map(|_| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1 << 24) - 0.5
        })
        .collect();
    workplace.write("noise.csv", csv(8000.0, &noise, |_| 0.0));
    let here = workplace.path("").display().to_string();
    for (arguments, words) in [
        (&["absent.csv"][..], &["there is no recording absent.csv"][..]),
        (&["."], &["a recording is expected here"]),
        (&["volts.csv"], &["channel bearing is in V", "must be g or m/s²", "--sensitivity-mv-per-unit"]),
        // With nothing said the speed is the scenario's, about which the mesh tone is looked for.
        (&["noise.csv", "-c", "bearing"], &["no mesh tone at 800.00 Hz"]),
        (&["plain.csv"], &["has no stated unit", "--unit g"]),
        (&["plain.csv", "--unit", "g", "--teeth", "19"], &["--teeth 19", "there are 20, 40"]),
        (
            &["plain.csv", "--unit", "g", "--teeth", "20", "--mate-teeth", "41"],
            &["--mate-teeth 41", "there are 20, 40"],
        ),
        (&["gone", "--scenario", "absent.toml"], &["there is no scenario file absent.toml"]),
        (&["gone", "--scenario", "more_teeth.toml"], &["20/40 teeth", "20/41"]),
        (&["gone", "--tuned", "tuned.toml"], &["published", "linear"]),
        (&["plain.csv", "--signal", "average", "--teeth", "20"], &["--signal average", "needs no phase"]),
        (&["gone", "--records", "100"], &["100", "512"]),
        (&["gone", "--records", "30000"], &["30000", "20480"]),
        (
            &["other.csv", "-c", "bearing", "--shaft-hz", "80"],
            &["80.0000 Hz", "40.0000 Hz", "not of the gear's"],
        ),
        (&["plain.csv", "--sensitivity-mv-per-unit", "100"], &["per which unit is not said", "--unit g"]),
        (
            &["gone", "-c", "vertical_g", "--signal", "average"],
            &["revolutions of the gear", "leave out --signal"],
        ),
        (&["gone", "--signal", "spectrum"], &["difference"]),
        (&["gone", "--healthy-shaft-hz", "28"], &["--healthy"]),
        (&["gone", "-o", "rig.toml"], &["it is a file"]),
        (&[], &["RECORDING"]),
    ] {
        let mut all = [&["diagnose"], arguments, &["--reference", &here]].concat();
        if !arguments.contains(&"--scenario") {
            all.extend(["--scenario", "rig.toml"]);
        }
        workplace.fails(2, &all, words);
    }
    workplace.fails(2, &["diagnose", "gone"], &["--scenario"]);
}

/// A gearbox of two stages that is quick to simulate.
fn small_gearbox() -> Scenario {
    let mut gearbox = plain(Scenario::from_toml(&gearbox_template(None)).unwrap());
    for (wheel, teeth) in gearbox.wheels.iter_mut().zip([20, 50, 20, 60]) {
        wheel.teeth = teeth;
    }
    gearbox.faults.clear();
    gearbox.sensors.truncate(1);
    let solver = &mut gearbox.solver;
    (solver.sampling_rate_hz, solver.duration_s, solver.settle_fraction) = (1.2e4, Some(0.8), 0.3);
    gearbox
}

// The wheel that lacks a tooth is named. The scenario of one of its pairs is another machine.
#[test]
fn the_damaged_wheel_of_a_gearbox_is_named() {
    let workplace = Workplace::new();
    // Of shafts in few elements hundreds are simulated soon.
    let mut gearbox = small_gearbox();
    gearbox.structure.shafts_mut().unwrap().shafts.iter_mut().for_each(|shaft| shaft.elements = 2);
    let gone = "\n[[fault]]\nwheel = \"z3\"\nkind = \"missing-tooth\"\ntooth = 8\n";
    workplace.write("box.toml", gearbox.to_toml());
    workplace.write("gone.toml", gearbox.to_toml() + gone);
    for scenario in ["box", "gone"] {
        let toml = format!("{scenario}.toml");
        workplace.succeeds(&["simulate", &toml, "-o", scenario, "--no-panel", "-q"]);
    }
    let asked = ["--records", FEW, "--reference", "kept", "-q"];
    let of_box = ["--scenario", "box.toml", "--healthy", "box", "-o", "found"];
    workplace.succeeds(&[&["diagnose", "gone"][..], &of_box, &asked].concat());
    let found = answer(&workplace, "found");
    let any = &found["any_damage"];
    assert_eq!((&any["wheel"], &any["tooth"]), (&"z3".into(), &8.into()), "{found:#}");
    assert!(found["damaged"].as_f64().unwrap() > 0.9, "{found:#}");
    assert_eq!(found["shown_wheel"], "z3");

    // The same as measured signals, with pulses of the input alone: from them the angle of the third wheel follows, but not which tooth
    // is the first.
    let speed_hz = gearbox.operation.pinion_speed_hz;
    for of in ["box", "gone"] {
        let recorded = read_signals(&workplace.path(&format!("{of}/signals.parquet"))).unwrap().channels;
        let rate = recorded.sampling_rate_hz;
        workplace.write(&format!("{of}.csv"), csv(rate, &recorded.signals[0].values, tacho(speed_hz, rate)));
    }
    let of_box = [
        "--scenario",
        "box.toml",
        "--healthy",
        "box.csv",
        "-o",
        "measured",
        "-c",
        "bearing",
        "--tach",
        "tacho",
    ];
    workplace.succeeds(&[&["diagnose", "gone.csv"][..], &of_box, &asked].concat());
    let measured = answer(&workplace, "measured");
    assert_eq!(measured["any_damage"]["wheel"], "z3", "{measured:#}");
    assert!(measured["damaged"].as_f64().unwrap() > 0.9, "{measured:#}");
    assert_eq!(measured["is_outside"], false);

    workplace.write("pair.toml", fast_with("gear_teeth", "gear_teeth = 50"));
    let asked = [&["diagnose", "gone", "--scenario", "pair.toml"][..], &asked].concat();
    workplace.fails(2, &asked, &["20/50, 20/60 teeth, but the scenario has 20/50"]);

    // A measured file does not say what it is of: the output's orders, which the teeth's deviations have, do.
    let mut rough = small_gearbox();
    rough.solver.duration_s = Some(1.6);
    workplace.write("rough.toml", rough.to_toml());
    workplace.succeeds(&["simulate", "rough.toml", "-o", "rough", "--no-panel", "-q"]);
    let recorded = read_signals(&workplace.path("rough/signals.parquet")).unwrap().channels;
    let rate = recorded.sampling_rate_hz;
    workplace.write("rough.csv", csv(rate, &recorded.signals[0].values, tacho(speed_hz, rate)));
    let measured =
        ["rough.csv", "--scenario", "pair.toml", "-c", "bearing", "--tach", "tacho", "-o", "as_pair"];
    let asked = ["--records", FEW, "--reference", "kept", "-q"];
    let said = workplace.succeeds(&[&["diagnose"][..], &measured, &asked].concat());
    let said = String::from_utf8_lossy(&said.get_output().stderr).into_owned();
    assert_eq!(answer(&workplace, "as_pair")["is_outside"], true, "{said}");
    assert!(said.contains("at no order of any shaft"), "{said}");
}
