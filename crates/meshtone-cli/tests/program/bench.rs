//! `meshtone bench`: simulated recordings under the names of public sets.

use std::f64::consts::TAU;
use std::fs::{self, File};

use meshtone::bearing::NamedBearing;
use meshtone::scenario::{GearboxRig, gearbox_template};
use meshtone_io::signals::read_signals;
use ndarray::{Array1, arr1};
use ndarray_npy::NpzWriter;
use serde_json::{Value, json};

use crate::bearings::noise;
use crate::support::{Workplace, printed_json, stderr, stdout};

const RATE_HZ: f64 = 12_000.0;

/// Noise, and a resonance that rings at multiples of an order of a shaft, which turns `shaft_hz` times a second.
fn ringing(order: f64, shaft_hz: f64) -> Array1<f64> {
    let at = |i: usize| {
        let passes = order * shaft_hz * i as f64 / RATE_HZ;
        let since_s = passes.fract() / (order * shaft_hz);
        let struck =
            if order > 0.0 { (-900.0 * since_s).exp() * (TAU * 3300.0 * since_s).sin() } else { 0.0 };
        struck + 0.3 * noise(i)
    };
    (0..3 * RATE_HZ as usize).map(at).collect()
}

/// A file that says of itself what it is, whatever its name.
fn file(workplace: &Workplace, name: &str, arrays: &[(&str, Array1<f64>)]) {
    let path = workplace.path(name);
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    let mut archive = NpzWriter::new(File::create(path).unwrap());
    arrays.iter().for_each(|(name, values)| archive.add_array(*name, values).unwrap());
    archive.finish().unwrap();
}

fn of<'v>(results: &'v Value, file: &str) -> &'v Value {
    let all = results["recordings"].as_array().unwrap();
    all.iter().find(|of| of["file"] == file).unwrap()
}

#[test]
fn bearings_are_scored_beside_the_rule() {
    let workplace = Workplace::new();
    let orders = NamedBearing::find("6205").unwrap().geometry.defect_orders();
    let [outer, inner] = [orders.outer_race, orders.inner_race];
    file(&workplace, "set/97.mat", &[("X097_DE_time", ringing(0.0, 29.95)), ("X097RPM", arr1(&[1796.0]))]);
    file(&workplace, "set/within/12k_IR007_105.mat", &[("X105_DE_time", ringing(inner, 29.95))]);
    file(&workplace, "set/133.mat", &[("X133_DE_time", ringing(outer, 28.833333))]);
    // What says it is of an inner race is of an outer one.
    file(&workplace, "set/172.mat", &[("X172_DE_time", ringing(outer, 28.833333))]);
    file(&workplace, "set/106.mat", &[("X105_DE_time", ringing(inner, 29.95))]);
    workplace.write("set/107.mat", "no recording");
    workplace.write("set/._97.mat", "of the system");
    workplace.write("set/1105.mat", "of no set");
    let run = || workplace.succeeds(&["bench", "set"]);
    let output = run();
    let results: Value = serde_json::from_slice(&workplace.read("set_bench/bench.json")).unwrap();
    assert_eq!((&results["set"], &results["scored"]), (&json!("cwru"), &json!(4)), "{results:#}");
    let files: Vec<&Value> = results["recordings"].as_array().unwrap().iter().map(|of| &of["file"]).collect();
    assert_eq!(
        json!(files),
        json!(["97.mat", "within/12k_IR007_105.mat", "106.mat", "107.mat", "172.mat", "133.mat"])
    );
    let outcomes = ["97.mat", "within/12k_IR007_105.mat", "133.mat", "172.mat"]
        .map(|file| [&of(&results, file)["outcome"], &of(&results, file)["rule"]["outcome"]]);
    assert_eq!(
        json!(outcomes),
        json!([["right", "right"], ["right", "right"], ["right", "right"], ["wrong race", "wrong race"]])
    );
    // The file's own speed, or that of its load.
    let speeds = ["97.mat", "133.mat"].map(|file| of(&results, file)["shaft_hz"].as_f64().unwrap());
    assert!(
        (speeds[0] - 1796.0 / 60.0).abs() < 1e-9 && (speeds[1] - 1730.0 / 60.0).abs() < 1e-5,
        "{speeds:?}"
    );
    let missing = of(&results, "106.mat")["not_scored"].as_str().unwrap();
    assert!(missing.contains("has no column `X106_DE_time`") && !missing.contains("106.mat"), "{missing}");
    let sums = &results["scores"]["verdict"];
    assert_eq!(
        [&sums["right"], &sums["wrong_race"], &sums["balanced_accuracy"]],
        [&json!(3), &json!(1), &json!(2.5 / 3.0)]
    );
    for words in ["inner race, 7 mil", "1 of 2", "not scored: ", "2 of 6 not scored", "0.83", "-> set_bench"]
    {
        assert!(stdout(&output).contains(words), "{words} in {}", stdout(&output));
    }
    assert_eq!(stderr(&output), "");

    // The same again; then with a file that is another.
    let sums = String::from_utf8(workplace.read("set_bench/SHA256SUMS")).unwrap();
    assert!(sums.lines().count() == 6 && sums.contains("  within/12k_IR007_105.mat\n"), "{sums}");
    assert_eq!(stderr(&run()), "");
    file(&workplace, "set/133.mat", &[("X133_DE_time", ringing(outer, 28.8))]);
    let warned = stderr(&run());
    assert!(
        warned.starts_with("warning: 133.mat is not what it was at its first use")
            && warned.lines().count() == 1,
        "{warned}"
    );
    assert_eq!(String::from_utf8(workplace.read("set_bench/SHA256SUMS")).unwrap(), sums);
}

#[test]
fn what_cannot_be_scored_is_refused() {
    let workplace = Workplace::new();
    fs::create_dir(workplace.path("none")).unwrap();
    workplace.write("none/run.csv", "1\n");
    workplace.write("105.mat", "no recording");
    let fails =
        |arguments: &[&str], words: &[&str]| workplace.fails(2, &[&["bench"], arguments].concat(), words);
    fails(&["absent"], &["cannot read the folder absent"]);
    fails(
        &["none"],
        &["none of the 1 files in it has a name of a set", "cwru (97.mat, 98.mat", "oedi-623 (h30hz*.csv"],
    );
    fails(&[".", "--set", "cwr"], &["--set cwr: there is no such set", "cwru, mfpt, oedi-623"]);
    fs::create_dir(workplace.path("sums")).unwrap();
    workplace.write("sums/SHA256SUMS", "of the download\n");
    fails(&[".", "-o", "sums"], &["sums has a SHA256SUMS of another program"]);
    fails(&[".", "--set", "mfpt"], &["looked for are mfpt (baseline_*.mat"]);
    fails(&[".", "--records", "512"], &["--diagnose"]);
    fails(&[".", "--diagnose"], &["--diagnose: cwru is of a bearing"]);
    fails(&[".", "--adapt"], &["--adapt: cwru is of a bearing"]);
    let assert = workplace.command(&["bench", ".", "-o", "out"]).assert().code(1);
    assert!(stderr(&assert).contains("none of 1 recordings could be scored"), "{}", stderr(&assert));
    assert!(stdout(&assert).contains("105.mat    inner race, 7 mil  not scored: "), "{}", stdout(&assert));
}

/// Of a gearbox whose second load is heavier, healthy and with a broken tooth.
#[test]
fn gears_are_compared_with_the_healthy_ones_at_other_loads() {
    let workplace = Workplace::new();
    let rig = gearbox_template(Some(GearboxRig::Oedi623));
    let rig = rig.replace(
        "sampling_rate_hz = 100000.0\nduration_s = 1.0",
        "sampling_rate_hz = 12800.0\nduration_s = 1.2",
    );
    fs::create_dir(workplace.path("set")).unwrap();
    let fault = "[[fault]]\nwheel = \"z1\"\nkind = \"missing-tooth\"\n\n[solver]";
    for (state, load, torque) in [("h", 0, "60.0"), ("h", 90, "70.0"), ("b", 0, "60.0"), ("b", 90, "70.0")] {
        let text = rig.replace("brake_torque_nm = 60.0", &format!("brake_torque_nm = {torque}"));
        workplace.write("run.toml", if state == "b" { text.replace("[solver]", fault) } else { text });
        workplace.succeeds(&["simulate", "run.toml", "-o", "run", "--no-panel", "-q"]);
        let channels = read_signals(&workplace.path("run/signals.parquet")).unwrap().channels;
        let values = &channels["input_0_vertical_g"];
        let lines: String = values.iter().map(|value| format!("{value:e},0.5\n")).collect();
        workplace.write(&format!("set/{state}30hz{load}.csv"), format!("a1,a2\n{lines}"));
    }
    let results = printed_json(&workplace.succeeds(&["bench", "set", "--json"]));
    assert_eq!((&results["set"], &results["scored"]), (&json!("oedi-623"), &json!(4)), "{results:#}");
    let recordings = results["recordings"].as_array().unwrap();
    assert_eq!(recordings.len(), 16);
    let of = |file: &str, key: &str| {
        let fits = |of: &&Value| of["file"] == file && of["channel"] == "a1";
        recordings.iter().find(fits).unwrap()["indicators"][key].as_f64().unwrap()
    };
    // Each beside the one healthy recording at another load.
    let logarithms = |from: &str, to: &str| {
        let keys =
            ["FM0", "FM4"].iter().flat_map(|name| [1, 2, 3, 4].map(|wheel| format!("{name} z{wheel}")));
        let squares: Vec<f64> = keys.map(|key| (of(from, &key) / of(to, &key)).ln().powi(2)).collect();
        (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
    };
    for (from, to) in
        [("h30hz0.csv", "h30hz90.csv"), ("b30hz0.csv", "h30hz90.csv"), ("b30hz90.csv", "h30hz0.csv")]
    {
        assert!((of(from, "distance") - logarithms(from, to)).abs() < 1e-12, "{from}");
    }
    let areas = &results["scores"]["areas"];
    assert_eq!((&areas["a1"]["distance"], &areas["a1"]["FM4 z1"]), (&json!(1.0), &json!(1.0)), "{areas:#}");
    assert_eq!(areas["a2"]["distance"], Value::Null);
    let silent = recordings.iter().find(|of| of["channel"] == "a2").unwrap();
    assert!(silent["not_scored"].as_str().unwrap().contains("constant"), "{silent}");
}
