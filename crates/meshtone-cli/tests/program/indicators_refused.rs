//! What is wrong with a recording is answered with the file, the place, what is allowed and exit code 2; nothing is
//! written.

use crate::indicators::{RATE_HZ, csv, tacho, vibration};
use crate::support::{Workplace, fast_and, fast_with};

/// A directory with `run.csv`, which is good.
fn workplace() -> Workplace {
    let workplace = Workplace::new();
    workplace.write("run.csv", csv(RATE_HZ, &vibration(5000, 1.0), tacho(20.0, RATE_HZ)));
    workplace
}

#[track_caller]
fn refused(workplace: &Workplace, arguments: &[&str], words: &[&str]) {
    workplace.fails(2, &[&["indicators"], arguments, &["-o", "out"]].concat(), words);
}

const CONSTANT: [&str; 4] = ["--teeth", "19", "--shaft-hz", "20"];

#[test]
fn what_is_missing_or_contradicts() {
    let workplace = workplace();
    let bearing = ["run.csv", "-c", "bearing"];
    refused(&workplace, &bearing, &["run.csv", "teeth", "not stated", "--teeth"]);
    refused(&workplace, &[&bearing[..], &["--shaft-hz", "20"]].concat(), &["--teeth"]);
    let teeth = [&bearing[..], &["--teeth", "19"]].concat();
    refused(&workplace, &teeth, &["how far the shaft has turned", "--shaft-hz", "--tach"]);
    let several = [&["run.csv"], &CONSTANT[..]].concat();
    refused(&workplace, &several, &["2 channels", "bearing, tacho", "--channel"]);
    let both = [&teeth[..], &["--tach", "tacho", "--pulse-times", "p.txt"]].concat();
    refused(&workplace, &both, &["--tach", "--pulse-times"]);
    refused(&workplace, &[&teeth[..], &["--from-mesh-tone"]].concat(), &["--shaft-hz"]);
    refused(&workplace, &[&teeth[..], &["--shaft-hz", "20", "--pulses-per-rev", "2"]].concat(), &["--tach"]);
    refused(&workplace, &[&teeth[..], &["--shaft-hz", "-20"]].concat(), &["--shaft-hz"]);
    refused(&workplace, &[&teeth[..], &["--shaft-hz=nan"]].concat(), &["--shaft-hz", "above 0"]);
    refused(&workplace, &[&teeth[..], &["--shaft-rpm", "1200"]].concat(), &["write --shaft-hz 20"]);
    let all = [&bearing[..], &CONSTANT].concat();
    refused(
        &workplace,
        &[&all[..], &["--sidebands", "9"]].concat(),
        &["sidebands is 9", "less than half the teeth"],
    );
    for few in ["0", "1", "x"] {
        let words = ["--revolutions", "at least 2: of one revolution there is nothing to average"];
        refused(&workplace, &[&all[..], &["--revolutions", few]].concat(), &words);
    }
    refused(&workplace, &[&all[..], &["--revolutions", "50"]].concat(), &["revolutions", "at least 50"]);
}

#[test]
fn columns_and_files() {
    let workplace = workplace();
    let named = |name: &'static str| [&["run.csv", "-c", name], &CONSTANT[..]].concat();
    refused(
        &workplace,
        &named("bering"),
        &["no column `bering`", "did you mean `bearing`", "bearing [g], tacho [V]"],
    );
    refused(&workplace, &named("7"), &["run.csv", "7"]);
    refused(
        &workplace,
        &named("1"),
        &["column `time_s` is the time", "(--channel)", "bearing [g], tacho [V]"],
    );
    let of = |name: &'static str| [&[name], &CONSTANT[..]].concat();
    refused(&workplace, &of("absent.csv"), &["there is no recording absent.csv"]);
    refused(&workplace, &of("."), &["."]);
    workplace.write("one.csv", "1\n2\n3\n");
    refused(
        &workplace,
        &of("one.csv"),
        &["has one column alone; give the sampling rate (--sampling-rate-hz)"],
    );
    let kilohertz = [&of("one.csv")[..], &["--sampling-rate-hz", "25.6"]].concat();
    refused(&workplace, &kilohertz, &["for 25.6 kHz write --sampling-rate-hz 25600"]);
    workplace.write("empty.csv", "");
    refused(&workplace, &of("empty.csv"), &["empty.csv", "is empty"]);
    let whole = workplace.read("run.csv");
    workplace.write("cut.csv", &whole[..whole.len() - 9]);
    refused(&workplace, &[&["cut.csv", "-c", "bearing"], &CONSTANT[..]].concat(), &["cut.csv", "line 5001"]);
    workplace.write("bare.csv", "a,b\n1,2\n3,4\n");
    refused(
        &workplace,
        &[&["bare.csv", "-c", "a"], &CONSTANT[..]].concat(),
        &["sampling rate", "(--sampling-rate-hz)", "(--time-column)"],
    );
    workplace.write(
        "truncated.npy",
        b"\x93NUMPY\x01\x00v\x00{'descr': '<f8', 'fortran_order': False, 'shape': (60,), }",
    );
    refused(
        &workplace,
        &[&["truncated.npy", "--sampling-rate-hz", "1000"], &CONSTANT[..]].concat(),
        &["truncated.npy", "NPY"],
    );
    // A good one before does not help.
    let series = [&["run.csv", "absent.csv", "-c", "bearing"], &CONSTANT[..]].concat();
    refused(&workplace, &series, &["absent.csv"]);
}

#[test]
fn signals() {
    let workplace = workplace();
    let all = |name: &'static str| [&[name, "-c", "bearing"], &CONSTANT[..]].concat();
    let mut gap = vibration(5000, 1.0);
    gap[1233] = f64::NAN;
    workplace.write("gap.csv", csv(RATE_HZ, &gap, |_| 0.0));
    refused(&workplace, &all("gap.csv"), &["gap.csv", "line 1235", "bearing", "NaN"]);
    workplace.write("dead.csv", csv(RATE_HZ, &[0.25; 5000], |_| 0.0));
    refused(
        &workplace,
        &all("dead.csv"),
        &["dead.csv", "channel bearing", "all 5000 samples are 0.25", "--channel"],
    );
    let tach = ["dead.csv", "-c", "bearing", "--teeth", "19", "--tach", "tacho"];
    refused(&workplace, &tach, &["dead.csv: --tach tacho: all 5000 samples are 0", "--from-mesh-tone"]);
    workplace.write("short.csv", csv(RATE_HZ, &vibration(450, 1.0), |_| 0.0));
    refused(&workplace, &all("short.csv"), &["short.csv", "revolutions", "at least 2"]);
    let many = ["run.csv", "-c", "bearing", "--teeth", "200", "--shaft-hz", "20"];
    refused(
        &workplace,
        &many,
        &["mesh order 200", "Nyquist order 125", "--teeth", "20.0000 Hz by the constant speed"],
    );
    let mate = [&all("run.csv")[..], &["--mate-teeth", "1000"]].concat();
    workplace.succeeds(&[&["indicators"], &all("run.csv")[..], &["-o", "kept", "-q"]].concat());
    // The mate turns too little for an average, the wheel does not.
    let said = workplace.succeeds(&[&["indicators"], &mate[..], &["-o", "mate", "-q"]].concat());
    let said = String::from_utf8_lossy(&said.get_output().stderr).into_owned();
    assert!(said.contains("there is no result of mate of 1000 teeth"), "{said}");
}

#[test]
fn pulses() {
    let workplace = workplace();
    let base = ["run.csv", "-c", "bearing", "--teeth", "19"];
    let with = |more: &[&'static str]| [&base[..], more].concat();
    let wrong = with(&["--tach", "tacho", "--shaft-hz", "40"]);
    refused(
        &workplace,
        &wrong,
        &["--tach tacho", "give 20.0000 Hz", "40.0000 Hz is stated", "--pulses-per-rev"],
    );
    refused(&workplace, &with(&["--tach", "taco"]), &["no column `taco`", "did you mean"]);
    refused(&workplace, &with(&["--tach", "tacho", "--threshold", "9"]), &["threshold is 9", "crosses"]);
    // 1.6 revolutions.
    workplace.write("short.csv", csv(RATE_HZ, &vibration(400, 1.0), tacho(20.0, RATE_HZ)));
    let short = ["short.csv", "--tach", "tacho", "--teeth", "19"];
    refused(
        &workplace,
        &short,
        &["--tach tacho", "there are 1, but at least 3", "record for longer", "three pulses"],
    );
    for same in [["-c", "tacho", "--tach", "tacho"], ["-c", "tacho", "--tach", "3"]] {
        let same = [&["run.csv", "--teeth", "19"], &same[..]].concat();
        refused(
            &workplace,
            &same,
            &["channel tacho is both processed and what gives the phase", "--channel"],
        );
    }
    let mut waveform = csv(RATE_HZ, &vibration(5000, 1.0), tacho(20.0, RATE_HZ));
    waveform.push_str("1.0,0.5,nan\n");
    workplace.write("gap.csv", waveform);
    refused(
        &workplace,
        &["gap.csv", "--tach", "tacho", "--teeth", "19"],
        &["line 5002 of column tacho [V] is NaN", "(--tach)"],
    );
    workplace.write("nan.txt", "0.1\nnan\n0.2\n0.4\n");
    refused(
        &workplace,
        &with(&["--pulse-times", "nan.txt"]),
        &["nan.txt: line 2 of column 1 is NaN", "fill the gap\n"],
    );
    workplace.write("pulses.txt", "0.1\n0.3\n0.2\n0.4\n");
    refused(&workplace, &with(&["--pulse-times", "pulses.txt"]), &["pulses.txt", "order of time"]);
    workplace.write("two.csv", "a,b\n0.1,2\n0.2,3\n");
    refused(&workplace, &with(&["--pulse-times", "two.csv"]), &["two.csv", "2 columns", "must be one"]);
    refused(
        &workplace,
        &with(&["--speed-profile", "pulses.txt"]),
        &["pulses.txt", "1 columns", "must be two"],
    );
    workplace.write("volts.csv", "t [s],speed [V]\n0,2\n1,3\n");
    refused(&workplace, &with(&["--speed-profile", "volts.csv"]), &["volts.csv", "in v", "Hz or rpm"]);
}

#[test]
fn series_of_different_things() {
    let workplace = workplace();
    workplace.write("other.toml", fast_with("gear_teeth", "gear_teeth = 60"));
    workplace.succeeds(&["simulate", "fast.toml", "other.toml", "-o", "out_s", "--no-panel", "-q"]);
    refused(&workplace, &["out_s/fast", "-c", "axial_g"], &["all", "samples are 0", "leave out --channel"]);
    refused(&workplace, &["out_s/fast", "--revolutions", "60"], &["at least 60", "fewer --revolutions"]);
    // The advice is about the simulation where no segments are asked for.
    workplace.write("short.toml", fast_and("pinion_revolutions = 1.0"));
    workplace.succeeds(&["simulate", "short.toml", "-o", "short", "--no-panel", "-q"]);
    refused(&workplace, &["short"], &["covers 1 whole revolution of the shaft", "raise solver.duration_s"]);
    refused(
        &workplace,
        &["out_s/fast", "--teeth", "20"],
        &["how far the shaft has turned", "leave out --teeth"],
    );
    let rate = ["out_s/fast", "--sampling-rate-hz", "11200"];
    refused(&workplace, &rate, &["out_s/fast", "--sampling-rate-hz", "leave them out"]);
    let words = ["out_s/other", "20 and 60 teeth", "20 and 40 teeth", "same in a series"];
    refused(&workplace, &["out_s/fast", "out_s/other"], &words);
    workplace.write("indicators.csv", "a\n1\n");
    let copy = workplace.read("out_s/fast/signals.parquet");
    workplace.write("indicators.parquet", copy);
    workplace.fails(
        2,
        &["indicators", "indicators.parquet", "-o", "."],
        &["would replace a file that is read"],
    );
}

/// A name in a file neither moves the terminal's cursor nor begins a line of its own.
#[cfg(unix)]
#[test]
fn names_with_control_characters() {
    let workplace = Workplace::new();
    let file = "run\x1b[2J\nerror: b.csv";
    workplace.write(file, "time_s,a\x1b]0;title\x07 [g],b\u{9b}2J\n0,1,2\n0.1,2,3\n0.2,1,2\n");
    let assert = workplace.command(&["indicators", file, "-o", "out"]).assert().code(2);
    let message = crate::support::stderr(&assert);
    for word in ["run\\u{1b}[2J\\nerror: b.csv", "a\\u{1b}]0;title\\u{7}", "b\\u{9b}2J"] {
        assert!(message.contains(word), "`{word}` is not in: {message}");
    }
    assert!(message.lines().all(|line| !line.contains(char::is_control)), "{message:?}");
}
