//! `meshtone indicators --bearing`: defect lines of rigs with and without gears.

use std::f64::consts::TAU;
use std::fs::File;

use meshtone::bearing::NamedBearing;
use meshtone_io::table::TableReader;
use serde_json::Value;

use crate::indicators::{csv, tacho};
use crate::support::{Workplace, stderr, stdout};

const RATE_HZ: f64 = 20_000.0;
const SHAFT_HZ: f64 = 30.0;

/// A resonance at 4.3 kHz that rings whenever a ball passes a place of the outer race, where balls slip; tones of a wheel of 17 teeth, and noise.
fn recording(seconds: usize, defect: f64, mesh: f64) -> Vec<f64> {
    let outer = NamedBearing::find("6205").unwrap().geometry.defect_orders().outer_race * SHAFT_HZ;
    let (mut last_s, mut passes) = (0.0, 0);
    let at = |i: usize| {
        let time_s = i as f64 / RATE_HZ;
        let next_s = last_s + (1.0 + 0.03 * noise(1 << 40 | passes)) / outer;
        if time_s >= next_s {
            (last_s, passes) = (next_s, passes + 1);
        }
        let since_s = time_s - last_s;
        let ringing = (-900.0 * since_s).exp() * (TAU * 4300.0 * since_s).sin();
        defect * ringing + mesh * (TAU * 17.0 * SHAFT_HZ * time_s).cos() + 0.3 * noise(i)
    };
    (0..seconds * RATE_HZ as usize).map(at).collect()
}

/// White noise from −0.5 to 0.5: the output function of SplitMix64.
pub fn noise(i: usize) -> f64 {
    let mix = |z: u64, shift: u32, factor: u64| (z ^ (z >> shift)).wrapping_mul(factor);
    let z = (i as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    (mix(mix(z, 30, 0xbf58_476d_1ce4_e5b9), 27, 0x94d0_49bb_1331_11eb) >> 11) as f64 / (1u64 << 53) as f64
        - 0.5
}

fn results(workplace: &Workplace) -> Value {
    serde_json::from_slice(&workplace.read("out/indicators.json")).unwrap()
}

fn over_median(bearing: &Value, line: &str) -> f64 {
    let lines = bearing["lines"].as_array().unwrap();
    lines.iter().find(|of| of["line"] == line).unwrap()["over_median"].as_f64().unwrap()
}

#[test]
fn a_bearing_of_a_rig_without_gears() {
    let workplace = Workplace::new();
    workplace.write("run.csv", csv(RATE_HZ, &recording(3, 1.0, 0.0), tacho(SHAFT_HZ, RATE_HZ)));
    workplace.write("sound.csv", csv(RATE_HZ, &recording(3, 0.0, 0.0), tacho(SHAFT_HZ, RATE_HZ)));
    let common = ["-c", "bearing", "--tach", "tacho", "--bearing", "6205", "-o", "out"];
    let output = workplace.succeeds(&[&["indicators", "run.csv"], &common[..]].concat());
    for words in [
        "bearing 6205 on shaft at 30.00 Hz: outer race",
        "false alarm below 1 in 100",
        "2 BPFO",
        "velocity from 10 to 1000 Hz",
    ] {
        assert!(stdout(&output).contains(words), "{}", stdout(&output));
    }
    let all = results(&workplace);
    let bearing = &all["bearings"][0];
    assert!((bearing["defect_orders"]["BPFO"].as_f64().unwrap() - 3.58478).abs() < 1e-5);
    assert!(bearing["source"].as_str().unwrap().contains("Case Western"));
    assert_eq!(
        (&bearing["verdict"], &bearing["races"][0]["race"]),
        (&"outer race".into(), &"outer race".into())
    );
    assert_eq!(
        (&bearing["races"][0]["false_alarm_probability"], &bearing["unexplained"]),
        (&0.01.into(), &Value::Null)
    );
    assert!(bearing["races"][0]["slip"].as_f64().unwrap().abs() < 0.01 && bearing["band_kurtosis"].is_null());
    let band_hz = [0, 1].map(|end| bearing["band_hz"][end].as_f64().unwrap());
    assert!(band_hz[0] < 4300.0 && band_hz[1] > 4300.0, "{band_hz:?}");
    assert!(over_median(bearing, "BPFO") > 30.0 && over_median(bearing, "BPFI") < 10.0, "{bearing}");
    assert_eq!(all["records"], Value::Array(Vec::new()));
    assert!(all["recordings"][0]["velocity_rms_mm_per_s"].as_f64() > Some(0.0));
    assert_eq!(all["settings"]["bearing_separation"], "averages");
    let figure = String::from_utf8(workplace.read("out/bearings.svg")).unwrap();
    for words in ["Kurtogram", "3 BPFI", "4 BSF", "Order of shaft", "separation: averages"] {
        assert!(figure.contains(words), "{words}");
    }
    assert!(!workplace.path("out/indicators.svg").exists());
    let table = TableReader::new(File::open(workplace.path("out/bearings.parquet")).unwrap()).unwrap();
    let column = table.numbers(table.column("over_median").unwrap(), 0).unwrap();
    assert_eq!(column.values.len(), 10);
    let names = table.texts(table.column("line").unwrap()).unwrap();
    let outer = names.iter().position(|name| name.as_deref() == Some("BPFO")).unwrap();
    assert!((column.values[outer] / over_median(bearing, "BPFO") - 1.0).abs() < 1e-12);

    // The kurtogram is a tool for people who look; the verdict does not depend on it.
    workplace.succeeds(
        &[&["indicators", "run.csv", "--band-hz", "kurtogram", "--no-figure"], &common[..]].concat(),
    );
    let all = results(&workplace);
    assert!(all["bearings"][0]["verdict"] == "outer race" && all["bearings"][0]["band_kurtosis"].is_number());
    assert_eq!(all["settings"]["band_hz"], "kurtogram");

    // A series has every recording's lines, and a stated band is kept.
    let stated = ["indicators", "sound.csv", "run.csv", "--band-hz", "3000,6000", "--no-figure"];
    let output = workplace.succeeds(&[&stated, &common[..]].concat());
    assert!(
        stdout(&output).contains("in sound.csv: nothing")
            && stdout(&output).contains("squared envelope of 3000 to 6000 Hz"),
        "{}",
        stdout(&output)
    );
    let all = results(&workplace);
    let outer = [0, 1].map(|recording| over_median(&all["bearings"][recording], "BPFO"));
    assert!(outer[0] < 6.0 && outer[1] > 30.0, "{outer:?}");
    assert_eq!(
        (&all["bearings"][1]["recording"], &all["bearings"][1]["band_kurtosis"]),
        (&2.into(), &Value::Null)
    );
}

#[test]
fn bearings_of_a_gearbox_are_on_its_shafts() {
    let workplace = Workplace::new();
    workplace.succeeds(&["init", "gearbox", "-o", "gearbox.toml"]);
    workplace.write("run.csv", csv(RATE_HZ, &recording(4, 1.0, 5.0), tacho(SHAFT_HZ, RATE_HZ)));
    let command = |bearings: &[&'static str]| {
        let all = [
            "indicators",
            "run.csv",
            "-c",
            "bearing",
            "--tach",
            "tacho",
            "--scenario",
            "gearbox.toml",
            "-o",
            "out",
            "--no-figure",
        ];
        let bearings = bearings.iter().flat_map(|name| ["--bearing", name]);
        all.into_iter().chain(bearings).collect::<Vec<_>>()
    };
    for separation in ["averages", "discrete-random", "prewhitening", "none"] {
        let mut named = command(&["6205", "9,7.94,39.04@output"]);
        // Once with figures.
        named.retain(|argument| *argument != "--no-figure" || separation != "averages");
        workplace.succeeds(&[&named[..], &["--bearing-separation", separation]].concat());
        let all = results(&workplace);
        let [input, output] = [0, 1].map(|bearing| &all["bearings"][bearing]);
        assert_eq!((&input["shaft"], &output["shaft"]), (&"input".into(), &"output".into()));
        assert!((output["mean_speed_hz"].as_f64().unwrap() - 6.0).abs() < 1e-3, "{output}");
        assert!(over_median(input, "BPFO") > 10.0, "{separation}: {}", over_median(input, "BPFO"));
        let figures =
            ["out/indicators.svg", "out/bearings.png"].map(|figure| workplace.path(figure).exists());
        assert_eq!(figures, [separation == "averages"; 2]);
    }
    workplace.fails(
        2,
        &command(&["6205@shaft7"]),
        &["--bearing 6205@shaft7: the machine has no shaft shaft7", "name one of input, middle, output"],
    );
    for (band, words) in [
        ("3000,12000", "must be within 0 to 10000 Hz"),
        ("6000,3000", "the lower one first, both from 0 to half the sampling rate"),
    ] {
        workplace.fails(
            2,
            &[&command(&["6205"])[..], &["--band-hz", band]].concat(),
            &[words, "leave the option out"],
        );
    }
    // In a second the output turns six times, which is no average.
    workplace.write("short.csv", csv(RATE_HZ, &recording(1, 1.0, 5.0), tacho(SHAFT_HZ, RATE_HZ)));
    let mut short = command(&["6205"]);
    short[1] = "short.csv";
    let output = workplace.succeeds(&short);
    assert!(
        stderr(&output).contains(
            "5.6 revolutions of shaft output, and an average needs at least 8: its average is not removed"
        ),
        "{}",
        stderr(&output)
    );
    assert_eq!(results(&workplace)["bearings"][0]["verdict"], "cannot tell");
    assert!(stdout(&output).contains("1.8 hunting-tooth periods"), "{}", stdout(&output));
    workplace.fails(2, &command(&["6206"]), &["must be one of 6203, 6205, ER-10K"]);
    // The bearings of this gearbox are linear.
    workplace.fails(
        2,
        &[&command(&[])[..], &["--band-hz", "3000,6000"]].concat(),
        &["--band-hz: no bearing is looked for"],
    );
    // Two of one geometry on the input have the same lines; another one is on the output.
    let own = "elements = 9\nelement_mm = 7.94\npitch_mm = 39.04\nkind = \"ball\"";
    let text = String::from_utf8(workplace.read("gearbox.toml")).unwrap();
    let mut sections = text.split("[[bearing]]\n");
    let head = sections.next().unwrap().to_owned();
    let kinds = ["kind = \"ball\"\nname = \"6205\"", own, "", "", "kind = \"ball\"\nname = \"ER-10K\"", ""];
    let rolling = sections.zip(kinds).map(|(section, kind)| format!("[[bearing]]\n{kind}\n{section}"));
    workplace.write("gearbox.toml", head + &rolling.collect::<String>());
    workplace.succeeds(&command(&[]));
    let all = results(&workplace);
    assert_eq!(all["settings"]["bearings"], serde_json::json!(["6205@input", "ER-10K@output"]));
    assert_eq!(all["settings"]["bearing_separation"], "averages");
    assert_eq!(all["bearings"].as_array().unwrap().len(), 2);
    assert!(over_median(&all["bearings"][0], "BPFO") > 10.0, "{}", all["bearings"][0]);
    workplace.succeeds(&command(&["ER-16K"]));
    assert_eq!(results(&workplace)["settings"]["bearings"], serde_json::json!(["ER-16K"]));
    // A list of the user's own, as a workbook exports it.
    let head = "\u{feff}maker;designation;elements;element_mm;pitch_mm;contact_angle_deg";
    workplace.write("ours.csv", format!("{head}\nSome Ltd;6308;8;15.08;65.0;0\nSome Ltd;6309;8;;72.5;0\nSome Ltd;\"6310\";8;19,05;80,5;0\n"));
    workplace.succeeds(&command(&["ours.csv:6308@output"]));
    assert_eq!(results(&workplace)["settings"]["bearings"], serde_json::json!(["6308@output"]));
    // Beside semicolons a comma is the decimal sign.
    workplace.succeeds(&command(&["ours.csv:6310@output"]));
    let listed = results(&workplace)["bearings"].clone();
    workplace.succeeds(&command(&["8,19.05,80.5@output"]));
    assert_eq!(listed[0]["lines"], results(&workplace)["bearings"][0]["lines"]);
    workplace.fails(2, &command(&["ours.csv:6311"]), &["ours.csv has no bearing 6311"]);
    workplace.fails(2, &command(&["ours.csv:6309"]), &["ours.csv, 6309: element_mm = \"\" must be a number"]);
    workplace.fails(2, &command(&["absent.csv:6308"]), &["absent.csv: No such file"]);
    workplace.write("short.csv", "designation,elements\n6308,8\n");
    workplace.fails(2, &command(&["short.csv:6308"]), &["the first line of short.csv must name", "pitch_mm"]);
}
