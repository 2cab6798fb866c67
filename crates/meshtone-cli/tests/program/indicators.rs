//! `meshtone indicators`

use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs::File;

use meshtone::signal::{ChainSettings, Recording, ShaftPhase, process_series};
use meshtone_io::signals::read_signals;
use meshtone_io::table::TableReader;
use ndarray::Array1;
use serde_json::Value;

use crate::support::{Workplace, fast_with, stderr, stdout};

pub const RATE_HZ: f64 = 5000.0;
const FIGURES: [&str; 2] = ["indicators.png", "indicators.svg"];
const TREND: [&str; 2] = ["trend.png", "trend.svg"];
const DATA: [&str; 4] = ["averages.parquet", "indicators.json", "indicators.parquet", "spectra.parquet"];

/// A wheel of 19 teeth at 20 Hz, one of which is heard once a revolution.
pub fn vibration(samples: usize, fault: f64) -> Vec<f64> {
    let at = |i: usize| {
        let turned = 20.0 * i as f64 / RATE_HZ;
        let since = (turned + 0.5).fract();
        let knock = fault * (-20.0 * since).exp() * (TAU * 61.0 * since).sin();
        let rough = f64::from((i as u32).wrapping_mul(2_654_435_761) >> 8) / f64::from(1 << 24) - 0.5;
        (TAU * 19.0 * turned).cos() * (1.0 + 0.1 * (TAU * turned).cos()) + knock + 0.2 * rough
    };
    (0..samples).map(at).collect()
}

/// A CSV file with time, vibration and a tachometer.
pub fn csv(rate_hz: f64, vibration: &[f64], tacho: impl Fn(usize) -> f64) -> String {
    let mut text = "time_s,bearing [g],tacho [V]\n".to_string();
    for (i, value) in vibration.iter().enumerate() {
        writeln!(text, "{:.9},{value:e},{}", i as f64 / rate_hz, tacho(i)).unwrap();
    }
    text
}

/// 5 V over the first tenth of every revolution.
pub fn tacho(hz: f64, rate_hz: f64) -> impl Fn(usize) -> f64 {
    move |i| if (hz * i as f64 / rate_hz + 1e-9).fract() < 0.1 { 5.0 } else { 0.0 }
}

fn results(workplace: &Workplace, directory: &str) -> Value {
    serde_json::from_slice(&workplace.read(&format!("{directory}/indicators.json"))).unwrap()
}

fn value(record: &Value, name: &str) -> f64 {
    record["indicators"][name].as_f64().unwrap_or(f64::NAN)
}

#[track_caller]
fn assert_alike(a: &Value, b: &Value, tolerance: f64) {
    assert_eq!(a["teeth"], b["teeth"]);
    for name in [
        "average_rms",
        "difference_rms",
        "difference_kurtosis",
        "envelope_rms",
        "residual_rms",
        "fm0",
        "fm4",
        "na4",
        "energy_ratio",
    ] {
        let (a, b) = (value(a, name), value(b, name));
        assert!((a / b - 1.0).abs() < tolerance, "{name}: {a} and {b}");
    }
}

#[test]
fn wrong_statements_about_a_recording_are_warned_of_with_code_and_numbers() {
    let workplace = Workplace::new();
    // The pair that is stated, and noise: the sum of the digits of a multiplicative generator.
    let mut state = 1_u64;
    let mut noise = || {
        let digits = (0..4).map(|_| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / f64::from(1 << 24) - 0.5
        });
        digits.sum::<f64>()
    };
    let mesh = |turned: f64| -> f64 {
        (1..=3).map(|harmonic| (TAU * 19.0 * f64::from(harmonic) * turned).cos() / f64::from(harmonic)).sum()
    };
    let pair =
        |turned: f64| mesh(turned) * (1.0 + 0.2 * (TAU * turned).cos() + 0.2 * (TAU * 0.5 * turned).cos());
    let mut signal: Vec<f64> =
        (0..20_000).map(|i| pair(20.0 * f64::from(i) / RATE_HZ) + 0.3 * noise()).collect();
    workplace.write("run.csv", csv(RATE_HZ, &signal, |_| 0.0));
    let tone = |i: usize| 2.0 * (TAU * 683.0 * i as f64 / RATE_HZ).cos();
    signal.iter_mut().enumerate().for_each(|(i, value)| *value += tone(i));
    workplace.write("tone.csv", csv(RATE_HZ, &signal, |_| 0.0));
    let common = ["-c", "bearing", "--teeth", "19", "--no-figure", "-o", "out"];
    let warnings = |arguments: &[&str]| {
        let assert = workplace.succeeds(&[&["indicators"], arguments, &common].concat());
        (results(&workplace, "out")["warnings"].clone(), stderr(&assert))
    };
    let (none, _) = warnings(&["run.csv", "--shaft-hz", "20", "--mate-teeth", "38"]);
    assert_eq!(none, Value::Array(Vec::new()));
    let (nothing, words) = warnings(&["run.csv", "--shaft-hz", "31", "--mate-teeth", "38"]);
    assert!(nothing.as_array().unwrap().iter().any(|warning| {
        warning["code"] == "nothing-synchronous" && warning["values"]["of_mean_square"].as_f64() < Some(0.02)
    }));
    assert!(words.contains("noise alone leaves") && words.contains("--sampling-rate-hz"), "{words}");
    // Tones of the wheel alone show nothing of the mate.
    let turn = |i: usize, order: f64| (TAU * order * 20.0 * i as f64 / RATE_HZ).cos();
    let wheel: Vec<f64> =
        (0..20_000).map(|i| (1..=6).map(|k| turn(i, f64::from(k))).sum::<f64>() + noise()).collect();
    workplace.write("wheel.csv", csv(RATE_HZ, &wheel, |_| 0.0));
    let (mate, words) = warnings(&["wheel.csv", "--shaft-hz", "20", "--mate-teeth", "37"]);
    let codes: Vec<&str> =
        mate.as_array().unwrap().iter().map(|warning| warning["code"].as_str().unwrap()).collect();
    assert_eq!(codes, ["nothing-synchronous"], "{words}");
    assert_eq!(mate[0]["values"]["teeth"], 37.0);
    for words_of_mate in
        ["the wheel of 37 teeth", "(19 teeth), whose damage may hide this wheel", "--mate-teeth"]
    {
        assert!(words.contains(words_of_mate), "{words}");
    }
    let (tones, words) = warnings(&["tone.csv", "--shaft-hz", "20", "--mate-teeth", "38"]);
    assert_eq!(tones[0]["code"], "foreign-tones");
    assert!((tones[0]["values"]["frequency_hz_1"].as_f64().unwrap() - 683.0).abs() < 0.1);
    assert!(words.contains("683.00 Hz (order 34.150"), "{words}");
}

#[test]
fn a_simulation_and_the_same_signal_from_other_files() {
    let workplace = Workplace::new();
    let faulty = fast_with("sampling_rate_hz", "sampling_rate_hz = 4e4")
        + "[quality]\ndin_grade = 7\n[fault]\nkind = \"missing-tooth\"\n";
    workplace.write("gone.toml", faulty);
    // Teeth that part do not move alike in every revolution.
    let simulate = ["simulate", "gone.toml", "--model", "published", "-o", "gone", "--no-panel", "-q"];
    workplace.succeeds(&simulate);
    // A channel's name without its unit is answered with those that there are.
    let words = ["has no column `vertical`", "did you mean `vertical_g`?", "pinion_shaft_speed_hz"];
    workplace.fails(2, &["indicators", "gone", "-c", "vertical"], &words);
    let assert = workplace.succeeds(&["indicators", "gone"]);
    for words in ["gone -> gone_indicators", "vertical_g, g", "gear, 40 teeth", "kurtosis", "FM4"] {
        assert!(stdout(&assert).contains(words), "{words}");
    }
    assert_eq!(
        workplace.names("gone_indicators"),
        [DATA[0], DATA[1], DATA[2], FIGURES[0], FIGURES[1], DATA[3]]
    );
    let simulated = results(&workplace, "gone_indicators");
    let [pinion, gear] = [0, 1].map(|place| &simulated["records"][place]);
    assert_eq!((&gear["wheel"], &gear["revolutions"]), (&Value::from("gear"), &Value::from(20)));
    assert!(value(gear, "fm4") > 2.0 * value(pinion, "fm4"));

    // The summary has the same numbers.
    let summary: Value = serde_json::from_slice(&workplace.read("gone/summary.json")).unwrap();
    for (wheel, record) in [("pinion", pinion), ("gear", gear)] {
        let of_summary = &summary["indicators"][wheel];
        assert_eq!(of_summary["difference_kurtosis"], record["indicators"]["difference_kurtosis"]);
        assert_eq!(of_summary["average_rms_g"], record["indicators"]["average_rms"]);
        assert_eq!(of_summary["fm4"], record["indicators"]["fm4"]);
        assert!(of_summary.get("residual_rms_g").is_none());
    }

    let channels = read_signals(&workplace.path("gone/signals.parquet")).unwrap().channels;
    let rate = channels.sampling_rate_hz;
    workplace.write("gone.csv", csv(rate, &channels["vertical_g"], tacho(40.0, rate)));
    ndarray_npy::write_npy(workplace.path("gone.npy"), &Array1::from(channels["vertical_g"].to_vec()))
        .unwrap();
    let rate = rate.to_string();
    let wheels = ["--teeth", "20", "--mate-teeth", "40", "-o", "out"];
    for arguments in [
        &["gone.csv", "-c", "bearing", "--shaft-hz", "40"][..],
        &["gone.csv", "--tach", "tacho"],
        &["gone.csv", "--tach", "tacho", "--shaft-hz", "39.5"],
        &["gone.csv", "-c", "2", "--tach", "3", "--edge", "falling", "--threshold", "2", "--hysteresis", "1"],
        &["gone.npy", "--sampling-rate-hz", &rate, "--shaft-hz", "40"],
        &["gone/signals.parquet", "-c", "vertical_g", "--shaft-hz", "40"],
    ] {
        let arguments = [&["indicators"], arguments, &wheels].concat();
        let assert = workplace.succeeds(&arguments);
        let measured = results(&workplace, "out");
        assert_eq!(measured["records"].as_array().unwrap().len(), 2);
        // Without what the simulation knows, the last revolution is not whole: 39 of 40, 20 of which the gap is in.
        let tolerance = 0.03;
        assert_alike(&measured["records"][0], pinion, tolerance);
        assert_alike(&measured["records"][1], gear, tolerance);
        assert!(!stderr(&assert).contains("error"));
    }
}

#[test]
fn a_series_with_a_growing_fault() {
    let workplace = Workplace::new();
    let signals: Vec<Vec<f64>> = (0..5).map(|day| vibration(10_000, 0.3 * f64::from(day))).collect();
    let mut arguments = vec!["indicators".to_string()];
    for (day, signal) in signals.iter().enumerate() {
        let name = format!("day{day}.npy");
        ndarray_npy::write_npy(workplace.path(&name), &Array1::from(signal.clone())).unwrap();
        arguments.push(name);
    }
    let settings = ["--sampling-rate-hz", "5000", "--shaft-hz", "20", "--teeth", "19", "-o", "trend"];
    arguments.extend(settings.map(str::to_string));
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let assert = workplace.succeeds(&arguments).stderr("");
    for words in ["5 recordings -> trend", "day0.npy", "day4.npy", "NA4"] {
        assert!(stdout(&assert).contains(words), "{words}");
    }
    assert_eq!(workplace.names("trend").len(), 8);

    let phase = ShaftPhase::constant(20.0, RATE_HZ, 10_000).unwrap();
    let recordings: Vec<_> = signals.iter().map(|signal| Recording { signal, phase: &phase }).collect();
    let expected = process_series(&recordings, 19, &ChainSettings::default()).unwrap();
    let found = results(&workplace, "trend");
    let found = found["records"].as_array().unwrap();
    assert_eq!(found.len(), 5);
    for (found, expected) in found.iter().zip(&expected) {
        for entry in expected.indicators.table("") {
            let found = found["indicators"][&entry.name].as_f64();
            // Reading the text may be off by a last digit, and a line of the spectrum by one of the whole signal, whose size is about 1.
            let close = match (found, entry.value) {
                (Some(a), Some(b)) => (a - b).abs() <= 1e-14 * b.abs().max(1.0),
                (found, expected) => found == expected,
            };
            assert!(close, "{}: {found:?} {:?}", entry.name, entry.value);
        }
    }
    let na4: Vec<f64> = found.iter().map(|record| value(record, "na4")).collect();
    assert!(na4[4] > 2.0 * na4[0], "{na4:?}");

    // The table for other programs has the same.
    let file = File::open(workplace.path("trend/indicators.parquet")).unwrap();
    let table = TableReader::new(file).unwrap();
    assert_eq!(table.metadata().file_metadata().num_rows(), 5);
    let column = table.numbers(table.column("na4").unwrap(), 0).unwrap();
    assert!(column.values.iter().zip(&na4).all(|(a, b)| (a - b).abs() <= 1e-14 * b.abs()), "{column:?}");
}

#[test]
fn limits_zones_and_tables_as_text() {
    let workplace = Workplace::new();
    let faults = [0.0, 0.03, 0.06, 0.02, 2.0, 3.0];
    let mut arguments: Vec<String> = vec!["indicators".to_owned()];
    for (day, fault) in faults.iter().enumerate() {
        let name = format!("rig_2026-11-0{}.csv", day + 1);
        workplace.write(&name, csv(RATE_HZ, &vibration(10_000, *fault), tacho(20.0, RATE_HZ)));
        arguments.push(name);
    }
    let options =
        ["-c", "bearing", "--tach", "tacho", "--teeth", "19", "-o", "out", "--csv", "--sound-records", "3"];
    arguments.extend(options.map(str::to_owned));
    arguments.extend(["--iso-20816", "medium-rigid"].map(str::to_owned));
    let assert = workplace.succeeds(&arguments.iter().map(String::as_str).collect::<Vec<_>>());
    let said = stdout(&assert);
    for words in [
        "RMS of the difference of wheel: first above",
        "at rig_2026-11-05.csv",
        "(zone ",
        "ISO 20816-3, medium-rigid: A/B 1.4, B/C 2.8, C/D 4.5 mm/s",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
    let found = results(&workplace, "out");
    let limits = found["limits"].as_array().unwrap();
    let limit = limits.iter().find(|limit| limit["indicator"] == "RMS of the difference").unwrap();
    let first: Vec<f64> = (0..3).map(|record| value(&found["records"][record], "difference_rms")).collect();
    let mean = first.iter().sum::<f64>() / 3.0;
    let deviation = (first.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 2.0).sqrt();
    assert!((limit["limit"].as_f64().unwrap() / (mean + 3.0 * deviation) - 1.0).abs() < 1e-12);
    assert_eq!(limit["crossed_at"], serde_json::json!([5, null]));
    // The axis of the trend has the dates in the names.
    let trend = String::from_utf8(workplace.read("out/trend.svg")).unwrap();
    assert!(trend.contains("2026-11-01") && trend.contains("mean + 3 σ of the first 3"));
    // Tables as text have what those in Parquet have.
    let text = String::from_utf8(workplace.read("out/indicators.csv")).unwrap();
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    let place = rows[0].iter().position(|name| *name == "difference_rms").unwrap();
    assert!((rows[1][place].parse::<f64>().unwrap() - first[0]).abs() < 1e-12 && rows.len() == 7);
    let averages = String::from_utf8(workplace.read("out/averages.csv")).unwrap();
    let first = "recording,segment,wheel,revolution,average,regular,difference,envelope\n6,,wheel,0,";
    assert!(averages.starts_with(first), "{}", &averages[..200]);
    let spectra = TableReader::new(File::open(workplace.path("out/spectra.parquet")).unwrap()).unwrap();
    let amplitude = spectra.numbers(spectra.column("amplitude").unwrap(), 0).unwrap().values;
    // The mesh tone of 19 teeth has an amplitude of 1.
    assert!((amplitude[19] - 1.0).abs() < 0.05, "{}", amplitude[19]);
    // What the recordings cannot answer is refused.
    let of_one = ["indicators", "rig_2026-11-01.csv", "-c", "bearing", "--tach", "tacho", "--teeth", "19"];
    let asked = |more: &[&'static str]| [&of_one[..], more].concat();
    let words = ["--sound-records 3: a wheel has 1 at most, so that none is judged", "fewer"];
    workplace.fails(2, &asked(&["--sound-records", "3"]), &words);
    let words = ["--iso-20816: bearing is not known to be an acceleration", "--unit, g or m/s2"];
    let volts = String::from_utf8(workplace.read("rig_2026-11-01.csv")).unwrap().replacen("[g]", "[V]", 1);
    workplace.write("rig_2026-11-01.csv", volts);
    workplace.fails(2, &asked(&["--iso-20816", "large-rigid"]), &words);
    // Without limits there are none, and no text.
    workplace.succeeds(&[
        "indicators",
        "rig_2026-11-01.csv",
        "-c",
        "bearing",
        "--tach",
        "tacho",
        "--teeth",
        "19",
        "-o",
        "out",
    ]);
    assert_eq!(results(&workplace, "out")["limits"], serde_json::json!([]));
    assert!(!workplace.names("out").iter().any(|name| name.ends_with(".csv")));
}

/// Speed and pulses of the recording's own file, at another rate than the vibration.
#[test]
fn the_phase_may_be_of_another_rate_in_the_same_file() {
    let workplace = Workplace::new();
    let mut archive = ndarray_npy::NpzWriter::new(File::create(workplace.path("run.npz")).unwrap());
    let samples = 20_000;
    let times = |count: usize, rate_hz: f64| Array1::from_shape_fn(count, |i| i as f64 / rate_hz);
    archive.add_array("t", &times(samples, RATE_HZ)).unwrap();
    archive.add_array("acc", &Array1::from(vibration(samples, 1.0))).unwrap();
    archive.add_array("t_speed", &times(400, 100.0)).unwrap();
    archive.add_array("speed", &Array1::from_elem(400, 20.0)).unwrap();
    archive.add_array("pulses", &times(80, 20.0)).unwrap();
    archive.finish().unwrap();
    let of = |phase: [&str; 2]| {
        let assert = workplace.succeeds(&[
            "indicators",
            "run.npz",
            "-c",
            "acc",
            "--teeth",
            "19",
            "-o",
            "out",
            phase[0],
            phase[1],
        ]);
        (value(&results(&workplace, "out")["records"][0], "fm4"), stderr(&assert))
    };
    let (by_constant, _) = of(["--shaft-hz", "20"]);
    let (by_speed, said) = of(["--speed-channel", "speed"]);
    assert!((by_speed / by_constant - 1.0).abs() < 1e-6, "{by_speed} {by_constant}");
    assert!(said.contains("speed was recorded at 100 S/s and is interpolated to 5000 S/s"), "{said}");
    assert!(said.contains("speed has no unit and is taken in Hz; of rpm call it speed [rpm]"), "{said}");
    let (by_pulses, _) = of(["--pulse-times", "pulses"]);
    assert!((by_pulses / by_constant - 1.0).abs() < 1e-3, "{by_pulses} {by_constant}");
}

/// What a sensor did wrong is said with its code; the recordings of `meshtone init recordings` have nothing of it.
#[test]
fn faults_of_sensors_are_said() {
    let workplace = Workplace::new();
    let sound = vibration(20_000, 1.0);
    let clipped = sound.iter().map(|x| x.clamp(-0.9, 0.9)).collect();
    let biased = sound.iter().map(|x| 0.01 * x + 11.8).collect();
    for (name, signal, code) in [
        ("sound", sound.clone(), None),
        ("clipped", clipped, Some("clipped")),
        ("biased", biased, Some("biased")),
    ] {
        let file = format!("{name}.csv");
        workplace.write(&file, csv(RATE_HZ, &signal, tacho(20.0, RATE_HZ)));
        workplace.succeeds(&[
            "indicators",
            &file,
            "-c",
            "bearing",
            "--tach",
            "tacho",
            "--teeth",
            "19",
            "-o",
            "out",
            "--no-figure",
        ]);
        let warnings = results(&workplace, "out")["warnings"].clone();
        let codes: Vec<Option<&str>> =
            warnings.as_array().unwrap().iter().map(|warning| warning["code"].as_str()).collect();
        assert_eq!(codes, code.map_or(Vec::new(), |code| vec![Some(code)]), "{name}: {warnings}");
    }
    workplace.succeeds(&["init", "recordings"]);
    let codes = ["clipped", "biased", "dropped-out", "repeated-block", "coarse-steps"];
    for name in ["first", "run", "run_up", "day12", "bearing", "gearbox"] {
        let file = format!("recordings/{name}.csv");
        workplace.succeeds(&[
            "indicators",
            &file,
            "-c",
            "bearing",
            "--tach",
            "tacho",
            "--teeth",
            "17",
            "-o",
            "out",
            "--no-figure",
        ]);
        let warnings = results(&workplace, "out")["warnings"].to_string();
        assert!(!codes.iter().any(|code| warnings.contains(code)), "{name}: {warnings}");
    }
}

#[test]
fn segments_of_one_recording_are_a_series() {
    let workplace = Workplace::new();
    workplace.write("run.csv", csv(RATE_HZ, &vibration(20_000, 1.0), tacho(20.0, RATE_HZ)));
    let base = ["indicators", "run.csv", "--tach", "tacho", "--teeth", "19", "-o", "out", "-q"];
    workplace.succeeds(&[&base[..], &["--revolutions", "10"]].concat()).stdout("").stderr("");
    let found = results(&workplace, "out");
    assert_eq!(found["records"].as_array().unwrap().len(), 7);
    assert_eq!(found["records"][6]["segment"], 7);
    assert_eq!(found["settings"]["revolutions_of_a_segment"], 10);
    assert_eq!(found["settings"]["phase"], "tachometer");
    assert_eq!(found["unit"], "g");
    assert!(workplace.names("out").contains(&TREND[0].to_string()));
    // What no longer belongs there goes.
    workplace.succeeds(&base);
    assert_eq!(workplace.names("out").len(), 6);
    workplace.succeeds(&[&base[..], &["--no-figure"]].concat());
    assert_eq!(workplace.names("out"), DATA);
}

#[test]
fn pulses_and_speeds_from_other_files() {
    let workplace = Workplace::new();
    workplace.write("run.csv", csv(RATE_HZ, &vibration(20_000, 1.0), |_| 1200.0).replace("[V]", "[rpm]"));
    let base = ["indicators", "run.csv", "-c", "bearing", "--teeth", "19", "--no-figure"];
    workplace.succeeds(&[&base[..], &["--shaft-hz", "20", "-o", "constant"]].concat());
    let expected = results(&workplace, "constant");
    let times: String = (0..160).map(|pulse| format!("{:.6}\n", f64::from(pulse) / 40.0)).collect();
    workplace.write("pulses.txt", format!("pulse [s]\n{times}"));
    workplace.write("speed.csv", "time [s],speed [rpm]\n0,1200\n9,1200\n");
    // A run-up, and no other, has an order map.
    workplace.write("run_up.csv", "time [s],speed [rpm]\n0,600\n9,1800\n");
    let run_up = ["indicators", "run.csv", "-c", "bearing", "--teeth", "19", "--speed-profile"];
    workplace.succeeds(&[&run_up[..], &["run_up.csv", "-o", "run_up"]].concat());
    assert!(workplace.names("run_up").iter().any(|name| name == "order_map.svg"));
    workplace.succeeds(&[&run_up[..], &["speed.csv", "-o", "run_up"]].concat());
    assert!(!workplace.names("run_up").iter().any(|name| name.starts_with("order_map")));
    for arguments in [
        &["--pulse-times", "pulses.txt", "--pulses-per-rev", "2", "-o", "pulses"][..],
        &["--speed-profile", "speed.csv", "-o", "profile"],
        &["--speed-channel", "tacho", "-o", "channel"],
        &["--from-mesh-tone", "--shaft-hz", "20.1", "-o", "tone"],
    ] {
        workplace.succeeds(&[&base[..], arguments].concat()).stderr("");
        let found = results(&workplace, arguments[arguments.len() - 1]);
        // What the fault does to the mesh tone is taken for speed.
        let tolerance = if arguments.contains(&"tone") { 0.3 } else { 0.02 };
        assert_alike(&found["records"][0], &expected["records"][0], tolerance);
    }
}

#[test]
fn the_only_channel_that_is_alive_needs_no_name() {
    let workplace = Workplace::new();
    let rows: String = vibration(8000, 1.0).iter().map(|value| format!("{value},0\n")).collect();
    workplace.write("two.csv", format!("left,right\n{rows}"));
    let rows: String = vibration(8000, 1.0).iter().map(|value| format!("{value}\n")).collect();
    workplace.write("one.csv", format!("left\n{rows}"));
    let calibrated = ["--sensitivity-mv-per-unit", "500", "--unit", "m/s²"];
    let constant = ["--teeth", "19", "--shaft-hz", "20", "--sampling-rate-hz", "5000", "--no-figure"];
    let of = |file: &str, named: &[&str]| {
        let all = [&["indicators", file, "-o", "out"], named, &calibrated, &constant].concat();
        let warnings = stderr(&workplace.succeeds(&all));
        (results(&workplace, "out"), warnings)
    };
    let (named, _) = of("one.csv", &["-c", "left"]);
    let (unnamed, warnings) = of("one.csv", &[]);
    assert_eq!((&unnamed["records"], warnings.as_str()), (&named["records"], ""));
    assert!(unnamed.to_string().contains("m/s²"));
    let (beside_a_dead_one, warnings) = of("two.csv", &[]);
    assert!(warnings.contains("two.csv: right is 0 throughout and left out"), "{warnings}");
    assert_eq!(beside_a_dead_one["records"][0]["indicators"], named["records"][0]["indicators"]);
}

#[test]
fn what_is_doubtful_is_said() {
    let workplace = Workplace::new();
    let pulses = tacho(20.0, RATE_HZ);
    let missing = |i: usize| if (5000..5100).contains(&i) { 0.0 } else { pulses(i) };
    workplace.write("run.csv", csv(RATE_HZ, &vibration(20_000, 1.0), missing));
    let base = ["indicators", "run.csv", "--tach", "tacho", "--teeth", "19", "-q", "--no-figure"];
    let said = stderr(&workplace.succeeds(&base));
    assert!(said.contains("warning: run.csv: 1 pulse(s) missing after 0.9"), "{said}");
    let found = results(&workplace, "run_indicators");
    assert_eq!(found["warnings"][0]["recording"], "run.csv");
    // A file that was cut off within its last number, and one of pulses.
    let whole = csv(RATE_HZ, &vibration(5000, 1.0), |_| 1200.25).replace("[V]", "[rpm]");
    workplace.write("cut.csv", &whole[..whole.len() - 2]);
    let times: String = (0..20).map(|pulse| format!("{:.6}\n", 0.05 * f64::from(pulse))).collect();
    workplace.write("pulses.txt", &times[..times.len() - 3]);
    let cut = ["indicators", "cut.csv", "-c", "bearing", "--teeth", "19", "--no-figure"];
    let said = stderr(&workplace.succeeds(&[&cut[..], &["--speed-channel", "tacho"]].concat()));
    assert!(said.contains("warning: cut.csv: line 5001, the last, has no end of line"), "{said}");
    let said = stderr(&workplace.succeeds(&[&cut[..], &["--pulse-times", "pulses.txt"]].concat()));
    assert!(said.contains("warning: pulses.txt: line 20, the last, has no end of line"), "{said}");
    for name in ["run1.csv", "run2.csv", "run10.csv"] {
        workplace.write(name, csv(RATE_HZ, &vibration(5000, 1.0), |_| 0.0));
    }
    let series =
        ["indicators", "run1.csv", "run10.csv", "run2.csv", "-c", "2", "--teeth", "19", "--shaft-hz", "20"];
    let said = stderr(&workplace.succeeds(&series));
    assert!(said.contains("run10.csv comes before run2.csv"), "{said}");
}
