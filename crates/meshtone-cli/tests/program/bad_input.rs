//! What a user can get wrong is answered with key, line, value and what is allowed, and exit code 2.

use crate::support::{Workplace, fast_and, fast_with, stderr};

/// Asserts that a scenario is refused in words that contain all of `words`, and that nothing is written.
#[track_caller]
fn refused(scenario: impl AsRef<[u8]>, words: &[&str]) {
    let workplace = Workplace::new();
    workplace.write("bad.toml", scenario);
    workplace.fails(2, &["simulate", "bad.toml", "-o", "out"], &[&["bad.toml"], words].concat());
    // Not even for those scenarios that are good.
    workplace.fails(2, &["simulate", "fast.toml", "bad.toml", "-o", "out"], words);
}

#[test]
fn keys() {
    refused(fast_and("colour = 3"), &["line 11", "solver.colour = 3", "unknown key", "sampling_rate_hz"]);
    refused(
        fast_with("module_mm", "modul_mm = 3.0"),
        &["line 2", "gears.modul_mm = 3.0", "did you mean `module_mm`?", "  2 | modul_mm = 3.0"],
    );
    refused(fast_with("module_mm", ""), &["gears.module_mm", "line 1", "missing", "(mm)"]);
}

#[test]
fn numbers() {
    let speed = |value: &str| fast_with("pinion_speed_hz", &format!("pinion_speed_hz = {value}"));
    let key = "operation.pinion_speed_hz";
    refused(speed("\"fast\""), &["line 7", key, "\"fast\"", "must be a number, not text"]);
    refused(speed("nan"), &["line 7", key, "nan", "must be a finite number"]);
    refused(speed("inf"), &["line 7", key, "inf", "must be a finite number"]);
    refused(speed("0.0"), &["line 7", key, "= 0.0", "must be more than 0 rev/s"]);
    refused(speed("-40.0"), &["line 7", key, "= -40.0", "must be more than 0 rev/s"]);
}

#[test]
fn gears() {
    let teeth = |value: &str| fast_with("pinion_teeth", &format!("pinion_teeth = {value}"));
    refused(teeth("5"), &["line 3", "gears.pinion_teeth = 5", "from 6 to 10000"]);
    refused(teeth("17.5"), &["line 3", "gears.pinion_teeth = 17.5", "whole number"]);
}

#[test]
fn undercut_is_only_a_warning() {
    let workplace = Workplace::new();
    workplace.write("undercut.toml", fast_with("pinion_teeth", "pinion_teeth = 10"));
    let assert = workplace.succeeds(&["simulate", "undercut.toml", "--quiet", "--no-panel"]);
    let warning = stderr(&assert);
    for words in ["warning: undercut.toml: line 3: gears.pinion_teeth", "10 teeth", "fewer than 17"] {
        assert!(warning.contains(words), "{warning}");
    }
    assert_eq!(workplace.names("undercut_results"), ["signals.parquet", "summary.json"]);
}

#[test]
fn faults() {
    let fault = |lines: &str| fast_and(&format!("[fault]\n{lines}"));
    let circle = |circle: &str| fault(&format!("kind = \"through-face\"\ncircle = {{ {circle} }}"));
    refused(
        circle("x_mm = 90.0, y_mm = 3.0, radius_mm = 2.0"),
        &["line 13", "fault.circle", "x_mm = 90.0", "must cut the contact part of the flank in two points"],
    );
    refused(
        circle("x_mm = 60.0, y_mm = 3.0, radius_mm = 40.0"),
        &["line 13", "fault.circle", "radius_mm = 40.0", "must"],
    );
    let pit = |depth: &str| {
        fault(&format!("kind = \"partial-face\"\nwidth_mm = 2\nstart = 0.2\nend = 0.8\n{depth}"))
    };
    refused(pit("depth = 1.5"), &["line 16", "fault.depth = 1.5", "more than 0 and at most 1"]);
    refused(pit("depth = 0.5\nend_mm = 1"), &["line 17", "fault.end_mm", "unknown key"]);
    let chip = |height: &str, width: &str| {
        fault(&format!("kind = \"tooth-breakage\"\nchip_height_mm = {height}\nchip_width_mm = {width}"))
    };
    refused(chip("9.0", "2.0"), &["line 13", "fault.chip_height_mm = 9.0", "less than 6.7500 mm"]);
    refused(chip("2.0", "16.0"), &["line 14", "fault.chip_width_mm = 16.0", "at most 15 mm"]);
    let line = |start: &str, end: &str| {
        fault(&format!("kind = \"tooth-destruction\"\nstart = {start}\nend = {end}"))
    };
    refused(line("-1.5", "0.9"), &["line 13", "fault.start = -1.5", "more than -1 and less than 1"]);
    refused(line("1.0", "0.9"), &["line 13", "fault.start = 1.0", "more than -1 and less than 1"]);
    refused(line("0.8", "0.2"), &["line 14", "fault.end = 0.2", "more than fault.start, 0.8"]);
    refused(fault("kind = \"scuffing\""), &["line 12", "fault.kind = \"scuffing\"", "\"tooth-breakage\""]);
}

#[test]
fn quality_and_rig() {
    let grade = fast_and("[quality]\ndin_grade = 13");
    refused(grade, &["line 12", "quality.din_grade = 13", "from 0 to 12"]);
    let damping = fast_and(&format!("[rig]\ndamping_ratio = {:?}", [0.05; 12]));
    refused(damping, &["line 12", "rig.damping_ratio", "has 12 numbers", "exactly 13"]);
    let absent = fast_and("[quality]\nerrors_file = \"absent.npz\"");
    refused(absent, &["line 12", "quality.errors_file", "absent.npz", "there is no file"]);
}

#[test]
fn wheels_of_another_pair() {
    let workplace = Workplace::new();
    workplace
        .write("other.toml", fast_with("gear_teeth", "gear_teeth = 60\n") + "[quality]\ndin_grade = 7\n");
    workplace.succeeds(&["wheels", "other.toml", "-o", "other.npz"]);
    workplace.write("bad.toml", fast_and("[quality]\nerrors_file = \"other.npz\""));
    let words = ["gear_profile_errors_mm", "is 100 × 60; must be 100 × 40"];
    let in_file = [&words[..], &["bad.toml", "line 12", "quality.errors_file = \"other.npz\""]].concat();
    workplace.fails(2, &["simulate", "bad.toml"], &in_file);
    let in_argument = [&words[..], &["--errors-file other.npz", "fast.toml"]].concat();
    workplace.fails(2, &["simulate", "fast.toml", "--errors-file", "other.npz"], &in_argument);
    let absent = ["--errors-file", "there is no file absent.npz"];
    workplace.fails(2, &["simulate", "fast.toml", "--errors-file", "absent.npz"], &absent);
}

#[test]
fn more_memory_than_there_is() {
    let greedy = fast_with("sampling_rate_hz", "sampling_rate_hz = 1e12");
    let words =
        ["line 10", "solver.sampling_rate_hz = 1e12", "would need 94175.3 GiB", "of memory", "lower it"];
    refused(&greedy, &words);
    let slow = fast_with("pinion_speed_hz", "pinion_speed_hz = 1e-6");
    refused(slow, &["line 7", "operation.pinion_speed_hz = 1e-6", "GiB of memory", "raise it"]);
    let long = fast_and("[operation.speed_profile_hz]\ntime_s = [0.0, 1e9]\nvalue = [40.0, 41.0]");
    refused(long, &["line 11", "operation.speed_profile_hz", "GiB of memory", "shorten the profile"]);
    // Where the system reports how much is free, so does the message.
    #[cfg(target_os = "linux")]
    refused(greedy, &["GiB", "free on this machine"]);
}

#[test]
fn a_limit_of_memory_is_given() {
    let workplace = Workplace::new();
    let limited = |limit: &'static str| ["simulate", "fast.toml", "--no-panel", "--memory-limit", limit];
    let words = ["fast.toml: ", "MiB of memory", "at most 1.0 MiB are allowed", "or raise --memory-limit"];
    workplace.fails(2, &limited("1MiB"), &words);
    workplace.fails(2, &limited("much"), &["--memory-limit", "such as 2GB, 1.5GiB or 300MB"]);
    workplace.succeeds(&["--memory-limit", "1GB", "simulate", "fast.toml", "--no-panel"]);
    // Typed by mistake: hunting periods of seconds at millions of samples.
    workplace.write("teeth.toml", fast_with("gear_teeth", "gear_teeth = 10000").replace("= 20", "= 17"));
    let words = ["line 4", "gears.gear_teeth = 10000", "would need", "common factor"];
    workplace.fails(2, &["simulate", "teeth.toml", "--memory-limit", "1GiB"], &words);
}

/// Some kilobytes that stand for 16 MB.
#[test]
fn recordings_that_inflate() {
    use ndarray::{Array1, Array2};
    use ndarray_npy::NpzWriter;

    let workplace = Workplace::new();
    let file = std::fs::File::create(workplace.path("zeros.npz")).unwrap();
    let mut npz = NpzWriter::new_compressed(file);
    npz.add_array("sensors", &Array2::<f64>::zeros((2, 1_000_000))).unwrap();
    npz.add_array("short", &Array1::<f64>::zeros(1000)).unwrap();
    npz.finish().unwrap();
    let process = |channel: &'static str, limit: &'static str| {
        let of_wheel = ["--teeth", "38", "--shaft-hz", "17.9", "--sampling-rate-hz", "5e4"];
        [&["indicators", "zeros.npz", "-c", channel, "--memory-limit", limit], &of_wheel[..]].concat()
    };
    let words = [
        "zeros.npz: one column of 1000000 samples",
        "would take 68.7 MiB of memory",
        "at most 57.2 MiB",
        "raise --memory-limit",
    ];
    workplace.fails(2, &process("sensors 2", "60MB"), &words);
    workplace.fails(2, &process("sensors", "72MB"), &["2 columns of 1000000 samples", "76.3 MiB"]);
    workplace.fails(2, &process("sensors 2", "80MB"), &["channel sensors 2", "all 1000000 samples are 0"]);
    workplace.fails(2, &process("short", "1MB"), &["channel short"]);
}

/// What has no end, or never begins.
#[cfg(unix)]
#[test]
fn what_is_no_file() {
    let workplace = Workplace::new();
    let made = std::process::Command::new("mkfifo").arg(workplace.path("pipe")).status().unwrap();
    assert!(made.success());
    for (file, what) in [("pipe", "it is a pipe"), ("/dev/zero", "it is a device")] {
        workplace.fails(2, &["indicators", file], &[file, what, "write its content into one first"]);
        let wheels = fast_and(&format!("[quality]\nerrors_file = \"{file}\""));
        workplace.write("wheels.toml", wheels);
        workplace.fails(2, &["simulate", "wheels.toml"], &["line 12", "quality.errors_file", file, what]);
        workplace.write("speed.toml", fast_and(&format!("[operation.speed_profile_hz]\nfile = \"{file}\"")));
        workplace.fails(
            2,
            &["simulate", "speed.toml"],
            &["line 12", "operation.speed_profile_hz", file, what],
        );
        for command in ["simulate", "dataset", "tune"] {
            workplace.fails(2, &[command, file], &[file, what]);
        }
    }
    // What a shell hands over has an end.
    let mut command = workplace.command(&["simulate", "/dev/stdin", "-o", "out", "--no-panel", "--quiet"]);
    command.write_stdin(fast_and("")).assert().success();
}

#[test]
fn nothing_left_after_settling() {
    let settling = fast_and("settle_fraction = 0.99999");
    refused(
        settling,
        &["line 11", "solver.settle_fraction = 0.99999", "leaves no sample to keep", "lower it"],
    );
    refused(
        fast_and("duration_s = 1e-9"),
        &["line 11", "solver.duration_s = 1e-9", "leaves no sample to keep", "raise it"],
    );
    refused(
        fast_and("duration_s = 1.0\npinion_revolutions = 20"),
        &["line 12", "solver.pinion_revolutions = 20", "given beside solver.duration_s", "remove one"],
    );
}

#[test]
fn files_that_are_no_scenarios() {
    refused("[gears\nmodule_mm = 3", &["line 1", "not valid TOML"]);
    refused(b"# pr\xfcfstand\n", &["line 1", "not UTF-8", "0xfc"]);
    refused("", &["gears.module_mm", "missing"]);
    let workplace = Workplace::new();
    workplace.fails(2, &["simulate", "absent.toml"], &["no scenario file absent.toml", "meshtone init"]);
    workplace.fails(2, &["simulate", "."], &["no scenario file"]);
}

#[test]
fn arguments() {
    let workplace = Workplace::new();
    let two = ["simulate", "fast.toml", "fast.toml"];
    workplace.fails(2, &two, &["would both write to fast_results"]);
    let other = ["simulate", "fast.toml", "other.toml", "--trace", "t.npz"];
    workplace.fails(2, &other, &["--trace", "2 scenarios", "must be one"]);
    workplace.fails(2, &["simulate", "fast.toml", "--model", "both"], &["linear, published"]);
    workplace.fails(2, &["simulate", "fast.toml", "--outptu", "x"], &["--outptu", "--output"]);
    workplace.fails(2, &["simulate"], &["SCENARIO.toml"]);
    workplace.fails(2, &["simulat", "fast.toml"], &["simulate"]);
}
