//! `meshtone tune` and `meshtone enhance`.

use std::fmt::Write as _;

use meshtone::scenario::{GearboxRig, Scenario, WheelName, gearbox_template};
use meshtone::signal::{Edge, kurtosis, resample};
use meshtone::tuning::{DifferenceChain, difference_signals};
use serde_json::Value;

use crate::support::{FAST, Workplace, printed_json, stderr, stdout};

const RMS: [f64; 3] = [0.0, 0.3, 0.8];
const KURTOSIS: [f64; 3] = [0.5, 0.9, 1.2];

/// Indicators of three cases, ten records each.
fn table(change: impl Fn(usize, &'static str, usize) -> Option<String>) -> String {
    let mut text = String::from("experiment,indicator,series,severity,log10_value\n");
    for case in 0..3 {
        for (name, means) in [("rms", RMS), ("kurtosis", KURTOSIS)] {
            for record in 0..10 {
                let value = means[case] + 0.01 * (record as f64 - 4.5);
                let value = change(case, name, record).unwrap_or_else(|| format!("{value}"));
                writeln!(text, "rig,{name},measured,{case},{value}").unwrap();
            }
        }
    }
    text
}

const HEAD: &str = "scenario = \"fast.toml\"\n[signal]\nsampling_rate_hz = 10e3\n";
const MEASURED: &str = "[measured]\nindicators_file = \"table.csv\"\nexperiment = \"rig\"\n";
const CASES_START: &str = "[[case]]\nlabel = \"healthy\"\n";
const CASES: &str = "[[case]]\nlabel = \"healthy\"\nseverity = 0\n\
                     [[case]]\nlabel = \"chipped\"\nseverity = 1\n\
                     fault = { kind = \"tooth-breakage\", chip_height_mm = 4.0, chip_width_mm = 10.0, tip_loss_mm = 1.0 }\n\
                     [[case]]\nlabel = \"missing\"\nseverity = 2\nfault = { kind = \"missing-tooth\" }\n";

fn experiment(tune: &str) -> String {
    format!("{HEAD}{MEASURED}[tune]\n{tune}{CASES}")
}

fn workplace() -> Workplace {
    let workplace = Workplace::new();
    workplace.write("fast.toml", format!("model = \"linear\"\n{FAST}[quality]\ndin_grade = 8\n"));
    workplace.write("table.csv", table(|_, _, _| None));
    workplace.write("rig.toml", experiment(""));
    workplace
}

fn json(workplace: &Workplace, name: &str) -> Value {
    serde_json::from_slice(&workplace.read(name)).unwrap()
}

#[test]
fn a_rig_is_tuned_and_signals_are_enhanced() {
    let workplace = workplace();
    let keys = "candidates = 16\n[[tune.key]]\nkey = \"rig.damping_ratio\"\nleast = 0.02\nlargest = 0.2\n\
                [[tune.key]]\nkey = \"fault.tip_loss_mm\"\nleast = 1.0\nlargest = 4.0\n";
    workplace.write("rig.toml", experiment(keys));
    let output = stdout(&workplace.succeeds(&["tune", "rig.toml", "-o", "out"]));
    for word in ["width ratio", "rig.damping_ratio", "leave one out", "chipped"] {
        assert!(output.contains(word), "{output}");
    }
    let tuning = json(&workplace, "out/tuning.json");
    let number =
        |path: &str| tuning.pointer(path).and_then(Value::as_f64).unwrap_or_else(|| panic!("{path}"));
    for name in ["width_ratio", "fault_to_harmonics_ratio", "noise_level"] {
        let value = number(&format!("/parameters/{name}"));
        assert!(number(&format!("/intervals/{name}/0")) <= value, "{name}");
        assert!(number(&format!("/intervals/{name}/1")) >= value, "{name}");
    }
    let enhanced = number("/error/enhanced");
    assert!(enhanced < number("/error/original"));
    assert!(enhanced <= number("/enhancement_alone/error/enhanced"));
    assert!(number("/error/leave_one_out") >= number("/error/measurements_own_scatter"));
    assert!((0.02..=0.2).contains(&number("/scenario_keys/rig.damping_ratio")));
    // The mean over cases and indicators of what is given for each.
    let mean = (0..3)
        .flat_map(|case| {
            ["rms", "kurtosis"].map(|name| format!("/cases/{case}/indicators/{name}/error/enhanced"))
        })
        .map(|path| number(&path))
        .sum::<f64>()
        / 6.0;
    assert!((mean - enhanced).abs() < 1e-9);

    // The same bits again, for one thread as for several.
    let mut again = workplace.command(&["tune", "rig.toml", "-o", "again", "-q"]);
    again.env("RAYON_NUM_THREADS", "1").assert().success().stdout("");
    for name in ["tuning.json", "tuned.toml", "tuning.svg"] {
        assert!(workplace.read(&format!("out/{name}")) == workplace.read(&format!("again/{name}")), "{name}");
    }

    let grade_and_fault = "[quality]\ndin_grade = 8\n[fault]\nkind = \"missing-tooth\"\n";
    workplace.write("broken.toml", format!("model = \"linear\"\n{FAST}{grade_and_fault}"));
    let enhance = ["enhance", "broken.toml", "--tuned", "out/tuned.toml", "--draws", "7", "-o", "enhanced"];
    assert!(stdout(&workplace.succeeds(&enhance)).contains("7 draws"));
    let first = workplace.read("enhanced/enhanced.parquet");
    assert_eq!(printed_json(&workplace.succeeds(&[&enhance[..], &["--json"]].concat()))["draws"], 7);
    workplace.succeeds(&enhance);
    assert!(workplace.read("enhanced/enhanced.parquet") == first);
    // Every draw has the indicators that tuning promised, to their scatter.
    let promised = number("/cases/2/indicators/kurtosis/enhanced");
    let output = stdout(&workplace.succeeds(&enhance));
    let mean: f64 =
        output.split("mean kurtosis").nth(1).unwrap().split_whitespace().next().unwrap().parse().unwrap();
    assert!((mean.log10() - promised).abs() < 0.1, "{mean} {promised}");

    let simulate = ["simulate", "broken.toml", "--tuned", "out/tuned.toml", "--no-panel", "-o", "simulated"];
    workplace.succeeds(&simulate);
    // As if the number had been in the scenario.
    // By its digits: the JSON reader of this test may round the last one.
    let tuned = String::from_utf8(workplace.read("out/tuned.toml")).unwrap();
    let (_, after_key) = tuned.split_once("key = \"rig.damping_ratio\"\nvalue = ").unwrap();
    let damping = after_key.lines().next().unwrap();
    let broken = String::from_utf8(workplace.read("broken.toml")).unwrap();
    workplace.write("damped.toml", format!("{broken}[rig]\ndamping_ratio = {damping}\n"));
    workplace.succeeds(&["simulate", "damped.toml", "--no-panel", "-o", "damped"]);
    let run = |name: &str| json(&workplace, name)["run"].clone();
    assert!(run("simulated/summary.json").is_string());
    assert_eq!(run("simulated/summary.json"), run("damped/summary.json"));
}

#[track_caller]
fn refused(workplace: &Workplace, text: &str, words: &[&str]) {
    workplace.write("rig.toml", text);
    workplace.fails(2, &["tune", "rig.toml", "-o", "out"], words);
}

#[test]
fn wrong_experiments_are_refused() {
    let workplace = workplace();
    let good = experiment("");
    let with = |from: &str, to: &str| {
        assert!(good.contains(from), "{from}");
        good.replacen(from, to, 1)
    };
    refused(
        &workplace,
        &experiment("indicators = [\"rms\", \"kurtossis\"]\n"),
        &["tune.indicators", "did you mean \"kurtosis\""],
    );
    refused(&workplace, &experiment("indicators = []\n"), &["tune.indicators", "one or more"]);
    refused(
        &workplace,
        &experiment("width_ratio = [1.0, 0.1]\n"),
        &["line 8", "tune.width_ratio", "[least, largest]"],
    );
    refused(&workplace, &experiment("noise_level = [nan, 0.1]\n"), &["tune.noise_level", "finite"]);
    refused(&workplace, &experiment("candidats = 3\n"), &["candidats", "candidates"]);
    let key = |lines: &str| experiment(&format!("[[tune.key]]\n{lines}\n"));
    refused(&workplace, &key("key = \"rig.dampin\"\nleast = 0.1\nlargest = 0.2"), &["rig.dampin"]);
    // Each at its own line, also in a second table.
    let second = |lines: &str| {
        key(&format!("key = \"seed\"\none_of = [1, 2]\n[[tune.key]]\nkey = \"rig.damping_ratio\"\n{lines}"))
    };
    refused(&workplace, &second("lest = 0.1\nlargest = 0.2"), &["line 13", "tune.key[1].lest", "`least`"]);
    refused(
        &workplace,
        &second("least = 0.1\nlargest = 7.0"),
        &["line 12", "tune.key[1]", "damping_ratio = 7"],
    );
    refused(
        &workplace,
        &second("least = 0.1\nlargest = 0.2").replace("rig.damping_ratio", "rig.dampin"),
        &["line 12", "tune.key[1].key", "rig.dampin"],
    );
    refused(
        &workplace,
        &second("one_of = [1, 2]").replace("rig.damping_ratio", "seed"),
        &["line 12", "tune.key[1].key", "given twice"],
    );
    refused(&workplace, &experiment("candidates = 100001\n"), &["tune.candidates", "from 1 to 100000"]);
    refused(&workplace, &key("key = \"seed\"\none_of = []"), &["seed", "one value or more"]);
    refused(&workplace, &key("key = \"seed\""), &["one_of", "least and largest"]);
    refused(
        &workplace,
        &key("key = \"rig.damping_ratio\"\nleast = 0.2\nlargest = 0.1"),
        &["the smaller first"],
    );
    refused(&workplace, &with("fault = { kind = \"missing-tooth\" }\n", ""), &["missing", "has no fault"]);
    let twice = "fault = [{ kind = \"missing-tooth\" }, { kind = \"missing-tooth\" }]\n";
    refused(
        &workplace,
        &with("fault = { kind = \"missing-tooth\" }\n", twice),
        &["case[2]", "tooth 1 of the gear has fault[0] already"],
    );
    let no_healthy = with(
        "label = \"healthy\"\nseverity = 0\n",
        "label = \"x\"\nseverity = 0\nfault = { kind = \"missing-tooth\" }\n",
    );
    refused(&workplace, &no_healthy, &["case[0]", "must be the healthy one"]);
    refused(
        &workplace,
        &with("severity = 2", "severity = 7"),
        &["table.csv", "severity 7", "missing", "rig measured rms 2"],
    );
    refused(&workplace, &with("severity = 2", "severity = 1"), &["case[2]", "must have its own"]);
    refused(
        &workplace,
        &with("experiment = \"rig\"", "experiment = \"gir\""),
        &["table.csv", "has no rms of severity 0", "it holds rig measured"],
    );
    refused(&workplace, &with("tip_loss_mm = 1.0", "tip_loss_mm = 40.0"), &["case[1]", "tip_loss_mm"]);
    refused(&workplace, &with("fast.toml", "slow.toml"), &["rig.toml", "line 1", "slow.toml"]);
    workplace.write("wrong.toml", "[gear]\n");
    refused(
        &workplace,
        &with("fast.toml", "wrong.toml"),
        &["wrong.toml: line 1: gear", "rig.toml names this file in line 1"],
    );
    workplace.fails(2, &["tune", "rig.toml", "-o", "out"], &["rig.toml"]);
    refused(
        &workplace,
        &with("sampling_rate_hz = 10e3", "sampling_rate_hz = 1e3"),
        &["signal.sampling_rate_hz", "mesh frequency"],
    );
    refused(
        &workplace,
        &with("sampling_rate_hz = 10e3", "sampling_rate_hz = 50e3"),
        &["line 3", "signal.sampling_rate_hz", "solver.sampling_rate_hz"],
    );
    refused(
        &workplace,
        &with("sampling_rate_hz = 10e3", "sampling_rate_hz = 10e3\nwheel = \"pinon\""),
        &["line 4", "signal.wheel", "did you mean \"pinion\"?"],
    );
    refused(&workplace, &with(MEASURED, ""), &["no measurements are given"]);
    workplace.write(
        "table.csv",
        table(|case, name, record| (case == 1 && name == "rms" && record == 3).then(|| "NaN".into())),
    );
    refused(&workplace, &good, &["table.csv", "line 25", "NaN", "finite"]);
    workplace.write("table.csv", "indicator,value\nrms,0.1\n");
    refused(&workplace, &good, &["missing field `severity`"]);
    workplace.fails(2, &["tune", "absent.toml"], &["absent.toml"]);
}

#[test]
fn difference_signals_must_be_of_one_length_and_whole() {
    let workplace = workplace();
    let signal = |rows: usize, gap: bool| {
        let mut text = String::from("a,b\n");
        for row in 0..rows {
            let value = (row as f64 * 0.3).sin();
            let second = if gap && row == 7 {
                "nan".to_owned()
            } else {
                format!("{}", value * 1.1 + 0.01 * (row % 3) as f64)
            };
            writeln!(text, "{value},{second}").unwrap();
        }
        text
    };
    let text = format!("{HEAD}{CASES}")
        .replace("severity = 0\n", "severity = 0\ndifference_file = \"h.csv\"\n")
        .replace("severity = 1\n", "severity = 1\ndifference_file = \"c.csv\"\n");
    workplace.write("h.csv", signal(512, false));
    workplace.write("c.csv", signal(512, false));
    refused(&workplace, &text, &["case[2]", "has no difference_file"]);
    let text = text.replace("severity = 2\n", "severity = 2\ndifference_file = \"m.csv\"\n");
    workplace.write("m.csv", signal(500, false));
    refused(&workplace, &text, &["512", "500"]);
    workplace.write("m.csv", signal(512, true));
    refused(&workplace, &text, &["m.csv", "case[2].difference_file"]);
    workplace.write("m.csv", signal(512, false));
    workplace.write("rig.toml", &text);
    let warned = stderr(&workplace.succeeds(&["tune", "rig.toml", "-o", "out", "--no-figure"]));
    assert!(warned.contains("only 2 records"), "{warned}");
    assert!(!warned.contains("measured ones"), "{warned}");
    // As many numbers as were measured.
    workplace.write(
        "rig.toml",
        text.replace(CASES_START, &format!("[tune]\nindicators = [\"rms\"]\n{CASES_START}")),
    );
    let warned = stderr(&workplace.succeeds(&["tune", "rig.toml", "-o", "out", "--no-figure"]));
    assert!(warned.contains("3 numbers are tuned to 3 measured ones"), "{warned}");
    assert_eq!(workplace.names("out"), ["tuned.toml", "tuning.json"]);
}

#[test]
fn recordings_are_taken_to_difference_signals() {
    let workplace = workplace();
    for (case, fault) in [
        ("healthy", ""),
        (
            "chipped",
            "[fault]\nkind = \"tooth-breakage\"\nchip_height_mm = 4.0\nchip_width_mm = 10.0\ntip_loss_mm = 1.0\n",
        ),
        ("missing", "[fault]\nkind = \"missing-tooth\"\n"),
    ] {
        for seed in 1..=3 {
            let name = format!("{case}{seed}");
            workplace.write(
                &format!("{name}.toml"),
                format!("model = \"linear\"\nseed = {seed}\n{FAST}[quality]\ndin_grade = 8\n{fault}"),
            );
            workplace.succeeds(&["simulate", &format!("{name}.toml"), "--no-panel", "-q", "-o", &name]);
        }
    }
    let head = HEAD.replace("10e3", "11200.0");
    let mut text = format!("{head}[measured]\nchannel = \"vertical_g\"\n{CASES}");
    for (severity, case) in ["healthy", "chipped", "missing"].iter().enumerate() {
        let files =
            (1..=3).map(|seed| format!("\"{case}{seed}/signals.parquet\"")).collect::<Vec<_>>().join(", ");
        text = text.replace(
            &format!("severity = {severity}\n"),
            &format!("severity = {severity}\nrecordings = [{files}]\n"),
        );
    }
    workplace.write("rig.toml", &text);
    workplace.succeeds(&["tune", "rig.toml", "-o", "out", "-q", "--no-figure"]);
    let tuning = json(&workplace, "out/tuning.json");
    // The "measured" ones are simulated: nothing needs to be changed.
    let error = tuning.pointer("/error/original").and_then(Value::as_f64).unwrap();
    assert!(error < 0.5, "{tuning:#}");
    assert!(!tuning.to_string().contains("signals.parquet"), "{tuning:#}");
    refused(&workplace, &text.replace("vertical_g", "vertikal"), &["healthy1", "vertikal"]);
    // A speed that is not the simulations'.
    let slow = text.replace("channel = \"vertical_g\"", "channel = \"vertical_g\"\ngear_shaft_hz = 15.0");
    workplace.write("slow.toml", slow);
    let warned = stderr(&workplace.succeeds(&["tune", "slow.toml", "-o", "slow", "-q", "--no-figure"]));
    for words in ["at 15.0000 Hz", "(-", "operation.pinion_speed_hz = ", "likewise of 8 other recordings"] {
        assert!(warned.contains(words), "{warned}");
    }
}

const RIG_HZ: f64 = 8000.0;
const FAULTS: [&str; 3] = [
    "",
    "[fault]\nkind = \"tooth-breakage\"\nchip_height_mm = 4.0\nchip_width_mm = 10.0\ntip_loss_mm = 1.0\n",
    "[fault]\nkind = \"missing-tooth\"\n",
];

/// Stiff ones, so that little is left of the motion above the rig's band.
const SUPPORTS: &str =
    "[rig]\nsupport = { mass_kg = 1.5, stiffness_n_per_m = 1.5e8, coupling_n_per_m = 5.1e8 }\n";

fn rig(fault: &str, seed: u64) -> Scenario {
    // Finer than the base scenario of the experiment.
    let fine = FAST.replace("sampling_rate_hz = 11200.0", "sampling_rate_hz = 40e3");
    Scenario::from_toml(&format!(
        "model = \"contact\"\nseed = {seed}\n{fine}{SUPPORTS}[quality]\ndin_grade = 8\n{fault}"
    ))
    .unwrap()
}

/// Nine revolutions of the gear at the rig's sampling rate, begun anywhere, with a pulse of the pinion's tachometer.
fn recording(scenario: &Scenario, offset: usize) -> String {
    let simulation = meshtone::simulate(scenario).unwrap();
    let per_revolution = (simulation.stages.time.sampling_rate_hz / 20.0).round() as usize;
    let revolution = &simulation.channels["vertical_g"][..per_revolution];
    let resampled = resample(revolution, 400, per_revolution, Edge::Periodic).unwrap();
    let mut text = String::from("acc,tacho\n");
    for i in offset..offset + 9 * resampled.len() {
        let pulse = if (i + 31) % 200 < 6 { 5.0 } else { 0.0 };
        writeln!(text, "{},{pulse}", resampled[i % resampled.len()]).unwrap();
    }
    text
}

/// What a rig with a known severity shows is explained by about that severity; sizes are not touched by it.
#[test]
fn severity_is_tuned_as_other_keys_are() {
    let workplace = workplace();
    let broken = |severity: f64| format!("[fault]\nkind = \"wear\"\ntooth = 1\nseverity = {severity}\n");
    let of = |faults: &str, value: fn(&[f64]) -> f64| {
        let scenario =
            Scenario::from_toml(&format!("model = \"linear\"\n{FAST}[quality]\ndin_grade = 8\n{faults}"));
        let chain = DifferenceChain::new(10e3);
        value(&difference_signals(vec![scenario.unwrap()], &chain).unwrap()[0]).log10()
    };
    let rms = |signal: &[f64]| (signal.iter().map(|x| x * x).sum::<f64>() / signal.len() as f64).sqrt();
    // As in every table: the rms is over that of the healthy state.
    let healthy_rms = of("", rms);
    let measured = [String::new(), broken(0.6)]
        .map(|faults| [of(&faults, rms) - healthy_rms, of(&faults, |x| kurtosis(x).unwrap())]);
    let mut table = String::from("experiment,indicator,series,severity,log10_value\n");
    for (case, [rms, kurtosis]) in measured.iter().enumerate() {
        for spread in [-0.005, 0.0, 0.005] {
            writeln!(table, "rig,rms,measured,{case},{}", rms + spread).unwrap();
            writeln!(table, "rig,kurtosis,measured,{case},{}", kurtosis + spread).unwrap();
        }
    }
    workplace.write("table.csv", table);
    let experiment = |fault: &str| {
        format!(
            "{HEAD}{MEASURED}[tune]\ncandidates = 24\nwidth_ratio = 1.0\nfault_to_harmonics_ratio = 1.0\n\
             [[tune.key]]\nkey = \"fault.severity\"\nleast = 0.2\nlargest = 0.9\n\
             [[case]]\nlabel = \"healthy\"\nseverity = 0\n\
             [[case]]\nlabel = \"worn\"\nseverity = 1\nfault = {{ kind = \"wear\", tooth = 1, {fault} }}\n"
        )
    };
    workplace.write("rig.toml", experiment("severity = 0.3"));
    workplace.succeeds(&["tune", "rig.toml", "-o", "out", "-q", "--no-figure"]);
    let tuning = json(&workplace, "out/tuning.json");
    let found = tuning.pointer("/scenario_keys/fault.severity").and_then(Value::as_f64).unwrap();
    assert!((found - 0.6).abs() < 0.06, "{found}");
    // A fault by its sizes has no severity that could be set.
    refused(&workplace, &experiment("depth_um = 30.0"), &["tune.key", "fault.severity"]);
}

/// The rig's shaft phase and sampling rate are its own; its indicators are not changed by them.
#[test]
fn recordings_have_their_own_phase_and_sampling_rate() {
    recordings_are_as_simulated(WheelName::Gear);
}

#[test]
fn recordings_of_a_damaged_pinion_are_averaged_over_its_revolutions() {
    recordings_are_as_simulated(WheelName::Pinion);
}

fn recordings_are_as_simulated(wheel: WheelName) {
    let workplace = workplace();
    workplace.write("fast.toml", format!("model = \"contact\"\n{FAST}{SUPPORTS}[quality]\ndin_grade = 8\n"));
    let on = |fault: &str, between: &str| match wheel {
        WheelName::Pinion => {
            fault.replace("kind", &format!("wheel = \"pinion\"{between}tooth = 7{between}kind"))
        }
        WheelName::Gear => fault.to_owned(),
    };
    let faults = FAULTS.map(|fault| on(fault, "\n"));
    let mut cases = on(CASES, ", ");
    for (case, fault) in faults.iter().enumerate() {
        for seed in 1..=3 {
            let offset = 57 * seed as usize + 101 * case;
            workplace.write(&format!("{case}{seed}.csv"), recording(&rig(fault, seed), offset));
        }
        let files = (1..=3).map(|seed| format!("\"{case}{seed}.csv\"")).collect::<Vec<_>>().join(", ");
        cases = cases.replace(
            &format!("severity = {case}\n"),
            &format!("severity = {case}\nrecordings = [{files}]\n"),
        );
    }
    // As the simulation itself has them, at the rig's rate.
    let chain = DifferenceChain { wheel: wheel.into(), ..DifferenceChain::new(RIG_HZ) };
    let expected: Vec<f64> = faults
        .iter()
        .map(|fault| {
            let scenarios = (1..=3).map(|seed| rig(fault, seed)).collect();
            let signals = difference_signals(scenarios, &chain).unwrap();
            let mut values: Vec<f64> =
                signals.iter().map(|signal| kurtosis(signal).unwrap().log10()).collect();
            values.sort_by(f64::total_cmp);
            values[1]
        })
        .collect();
    for (name, phase) in [
        ("constant", ""),
        ("tachometer", "tachometer_channel = \"tacho\"\ntachometer_shaft = \"pinion\"\n"),
        ("tone", "phase_from_mesh_tone = true\n"),
    ] {
        let measured = format!("[measured]\nchannel = \"acc\"\nsampling_rate_hz = {RIG_HZ}\n{phase}");
        let head = HEAD.replace("10e3", &format!("8e3\nwheel = \"{}\"", wheel.name()));
        workplace.write("rig.toml", format!("{head}{measured}{cases}"));
        workplace.succeeds(&["tune", "rig.toml", "-o", name, "-q", "--no-figure"]);
        let tuning = json(&workplace, &format!("{name}/tuning.json"));
        for (case, expected) in expected.iter().enumerate() {
            let path = format!("/cases/{case}/indicators/kurtosis/measured_median");
            let median = tuning.pointer(&path).and_then(Value::as_f64).unwrap();
            assert!((median - expected).abs() < 0.02, "{name}, case {case}: {median} instead of {expected}");
        }
        // Simulated as well: nothing needs to be changed.
        let error = tuning.pointer("/error/original").and_then(Value::as_f64).unwrap();
        assert!(error < 0.5, "{name}: {error}");
        let tuned = String::from_utf8(workplace.read(&format!("{name}/tuned.toml"))).unwrap();
        assert!(tuned.contains(&format!("\nwheel = \"{}\" ", wheel.name())), "{tuned}");
    }
    // Signals of the same wheel's revolutions.
    workplace.succeeds(&["enhance", "fast.toml", "--tuned", "tone/tuned.toml", "-o", "enhanced"]);
    let metadata = String::from_utf8_lossy(&workplace.read("enhanced/enhanced.parquet")).into_owned();
    assert!(metadata.contains(&format!("over one revolution of the {}", wheel.name())));
}

/// The experiment names the wheel of a gearbox, and tuning finds a hidden severity of its damage in recordings with other random forces.
#[test]
fn a_gearbox_is_tuned_over_the_revolutions_of_a_wheel() {
    let workplace = workplace();
    let gearbox = |seed: u64, severity: f64| {
        let fault = match severity {
            0.0 => String::new(),
            _ => format!("[[fault]]\nwheel = \"z2\"\nkind = \"tooth-breakage\"\nseverity = {severity}\n"),
        };
        let text = gearbox_template(None)
            .replace("seed = 1\n", &format!("seed = {seed}\nwheels_seed = 5\n"))
            .replace("sampling_rate_hz = 100000.0", "sampling_rate_hz = 12800.0")
            .replace("duration_s = 1.0", "duration_s = 2.0")
            .replace("speed_wander_percent = 0.03", "")
            .replace("at = \"input:0\"", "at = \"middle:0\"");
        text.replace("[solver]", &format!("{fault}[solver]"))
    };
    workplace.write("gearbox.toml", gearbox(1, 0.0));
    workplace.write("broken.toml", gearbox(1, 0.8));
    let mut cases = String::new();
    let mut rate_hz = 0.0;
    for (case, severity) in [0.0, 0.8].into_iter().enumerate() {
        for seed in 2..=3 {
            let simulation =
                meshtone::simulate(Scenario::from_toml(&gearbox(seed, severity)).unwrap()).unwrap();
            rate_hz = simulation.channels.sampling_rate_hz;
            // With six pulses a turn of the middle shaft, which turns at 10 Hz.
            let pulse = |n: usize| if (60.0 * n as f64 / rate_hz).fract() < 0.2 { 5.0 } else { 0.0 };
            let mut text = String::from("acc,tacho\n");
            for (n, value) in simulation.channels["middle_0_vertical_g"].iter().enumerate() {
                writeln!(text, "{value},{}", pulse(n)).unwrap();
            }
            workplace.write(&format!("{case}{seed}.csv"), text);
        }
        let fault = ["", "fault = { wheel = \"z2\", kind = \"tooth-breakage\", severity = 0.5 }\n"][case];
        cases += &format!(
            "[[case]]\nlabel = \"case {case}\"\nseverity = {case}\n{fault}\
             recordings = [\"{case}2.csv\", \"{case}3.csv\"]\n"
        );
    }
    let experiment = |wheel: &str, phase: &str| {
        format!(
            "scenario = \"gearbox.toml\"\n[signal]\nsampling_rate_hz = {rate_hz}\n{wheel}channel = \"middle_0_vertical_g\"\n\
             [measured]\nchannel = \"acc\"\nsampling_rate_hz = {rate_hz}\nrevolutions_per_record = 6\n{phase}\
             [tune]\nwidth_ratio = 1.0\nfault_to_harmonics_ratio = 1.0\ncandidates = 10\n\
             [[tune.key]]\nkey = \"fault.severity\"\nleast = 0.3\nlargest = 0.95\n{cases}"
        )
    };
    let tachometer =
        "tachometer_channel = \"tacho\"\npulses_per_revolution = 6\ntachometer_shaft = \"middle\"\n";
    for (name, phase) in [("constant", ""), ("tachometer", tachometer)] {
        workplace.write("rig.toml", experiment("wheel = \"z2\"\n", phase));
        let warned = stderr(&workplace.succeeds(&["tune", "rig.toml", "-o", name, "-q"]));
        assert!(!warned.contains("fades"), "{warned}");
        let tuning = json(&workplace, &format!("{name}/tuning.json"));
        let found = tuning.pointer("/scenario_keys/fault.severity").and_then(Value::as_f64).unwrap();
        println!("{name}: {found}, {warned}");
        assert!((found - 0.8).abs() < 0.1, "{name}: {tuning:#}");
    }
    let enhance = ["enhance", "broken.toml", "--tuned", "constant/tuned.toml", "-o", "enhanced"];
    workplace.succeeds(&enhance);
    let metadata = String::from_utf8_lossy(&workplace.read("enhanced/enhanced.parquet")).into_owned();
    assert!(metadata.contains("over one revolution of z2"));
    workplace.succeeds(&[
        "simulate",
        "broken.toml",
        "--tuned",
        "constant/tuned.toml",
        "--no-panel",
        "-q",
        "-o",
        "tuned",
    ]);
    workplace.write("pair.toml", format!("model = \"contact\"\n{FAST}"));
    let of_pair = ["enhance", "pair.toml", "--tuned", "constant/tuned.toml", "-o", "enhanced"];
    workplace.fails(2, &of_pair, &["constant/tuned.toml", "no wheel `z2`", "pinion, gear"]);

    let slow = experiment("wheel = \"z2\"\n", "input_shaft_hz = 26.0\n");
    workplace.write("slow.toml", slow);
    let warned = stderr(&workplace.succeeds(&["tune", "slow.toml", "-o", "slow", "-q", "--no-figure"]));
    assert!(
        warned.contains("shaft input turns at 26.0000 Hz, but in the scenario at 30.0000 Hz"),
        "{warned}"
    );
    // In a revolution of the input the broken tooth meets it at another place each time; and what a faster shaft repeats is no fault of z2.
    let of_input = experiment("wheel = \"z2\"\n", "").replace("wheel = \"z2\", kind", "wheel = \"z1\", kind");
    for (text, damaged, averaged) in
        [(experiment("wheel = \"z1\"\n", ""), "z2", "z1"), (of_input, "z1", "z2")]
    {
        workplace.write("other.toml", text);
        let warned = stderr(&workplace.succeeds(&["tune", "other.toml", "-o", "other", "-q", "--no-figure"]));
        let words = format!(
            "damaged on {damaged} alone, but its signals are averaged over revolutions of {averaged}"
        );
        assert!(warned.contains(&words), "{warned}");
    }
    let misspelt = experiment("wheel = \"z2\"\n", "").replace("fault.severity", "mesh[z1-z2].damping");
    refused(&workplace, &misspelt, &["did you mean `mesh[z1-z2].damping_ratio`?"]);
    workplace.write("tuned.toml", "model = \"contact\"\n[enhancement]\nwidth_ratio = 1.0\nfault_to_harmonics_ratio = 1.0\nnoise_level = 1.0\n[signal]\nsampling_rate_hz = 10e3\n[[key]]\nkey = \"mesh[z1-z2].damping_ratio\"\nvalue = 0.1\n");
    let other = stderr(&workplace.succeeds(&[
        "simulate",
        "pair.toml",
        "--tuned",
        "tuned.toml",
        "--no-panel",
        "-q",
        "-o",
        "pair",
    ]));
    assert!(
        other.contains("is of another machine") && other.contains("mesh[z1-z2].damping_ratio"),
        "{other}"
    );
    refused(&workplace, &experiment("", ""), &["signal.wheel", "missing"]);
    refused(&workplace, &experiment("wheel = \"gear\"\n", ""), &["\"z1\", \"z2\""]);
    workplace.write("gearbox.toml", gearbox_template(Some(GearboxRig::PlanetaryLab)));
    refused(&workplace, &experiment("wheel = \"z2\"\n", ""), &["planetary set"]);
}

#[test]
fn enhance_finds_the_place_of_a_fault_itself() {
    let workplace = workplace();
    workplace
        .write("broken.toml", format!("{FAST}[quality]\ndin_grade = 8\n[fault]\nkind = \"missing-tooth\"\n"));
    let mean = |scenario: &str, centre: f64| {
        workplace.write(
            "tuned.toml",
            format!("model = \"linear\"\n[enhancement]\nwidth_ratio = 0.2\nfault_to_harmonics_ratio = 1.0\nnoise_level = 0.1\ncentre_rev = {centre}\n[signal]\nsampling_rate_hz = 10e3\n"),
        );
        stdout(&workplace.succeeds(&["enhance", scenario, "--tuned", "tuned.toml", "-o", "out"]))
    };
    assert_eq!(mean("broken.toml", 0.1), mean("broken.toml", 0.7));
    // A healthy signal does not show it.
    assert_ne!(mean("fast.toml", 0.1), mean("fast.toml", 0.7));
}

#[test]
fn what_enhance_refuses() {
    let workplace = workplace();
    workplace.write("tuned.toml", "model = \"linear\"\n[enhancement]\nwidth_ratio = 0.2\nfault_to_harmonics_ratio = 2.0\nnoise_level = 1.0\n[signal]\nsampling_rate_hz = 10e3\n");
    let enhance = |tuned: &'static str, draws: &'static str| {
        ["enhance", "fast.toml", "--tuned", tuned, "--draws", draws, "-o", "out"]
    };
    workplace.fails(2, &enhance("tuned.toml", "0"), &["--draws"]);
    workplace.fails(2, &enhance("absent.toml", "1"), &["absent.toml"]);
    workplace.write("wrong.toml", "model = \"linear\"\n[enhancement]\nwidth_ratio = -0.2\nfault_to_harmonics_ratio = 2.0\nnoise_level = 1.0\n[signal]\nsampling_rate_hz = 10e3\n");
    workplace.fails(
        2,
        &enhance("wrong.toml", "1"),
        &["wrong.toml", "line 3", "enhancement.width_ratio", "more than 0"],
    );
    let other = ["other.toml", "no wheel `rack`", "pinion, gear"];
    let with_wheel = [workplace.read("tuned.toml"), b"wheel = \"rack\"\n".to_vec()].concat();
    workplace.write("other.toml", with_wheel);
    workplace.fails(2, &enhance("other.toml", "1"), &other);
    workplace.succeeds(&enhance("tuned.toml", "3"));
}
