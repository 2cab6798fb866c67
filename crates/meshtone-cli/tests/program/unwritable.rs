//! What cannot be written is said before anything is simulated, and nothing half-written remains.

#[cfg(target_os = "linux")]
use crate::support::program_with_small_files;
use crate::support::{Workplace, fast_and, fast_with, program};

#[test]
fn a_directory_that_is_a_file() {
    let workplace = Workplace::new();
    workplace.write("taken", "");
    let words = ["cannot write results to the directory taken", "it is a file", "-o"];
    workplace.fails(2, &["simulate", "fast.toml", "-o", "taken"], &words);
    let words = ["cannot write results to the directory taken/below"];
    workplace.fails(2, &["simulate", "fast.toml", "-o", "taken/below"], &words);
}

#[test]
fn an_unwritable_directory_is_found_before_the_simulation() {
    let workplace = Workplace::new();
    workplace.write("taken", "");
    // Some seconds of simulation, which must not pass.
    workplace.write("long.toml", fast_with("sampling_rate_hz", "sampling_rate_hz = 4e6"));
    let start = std::time::Instant::now();
    workplace.fails(2, &["simulate", "long.toml", "-o", "taken"], &["taken"]);
    assert!(start.elapsed().as_secs_f64() < 1.0, "{:?}", start.elapsed());
}

#[cfg(unix)]
#[test]
fn a_directory_without_permission() {
    use std::fs::{self, Permissions};
    use std::os::unix::fs::PermissionsExt;

    let workplace = Workplace::new();
    let locked = workplace.path("locked");
    fs::create_dir(&locked).unwrap();
    fs::set_permissions(&locked, Permissions::from_mode(0o555)).unwrap();
    // The superuser may write everywhere, but see the next test.
    if fs::write(locked.join("probe"), "").is_ok() {
        return;
    }
    let words = ["cannot write results to the directory locked", "ermission denied"];
    workplace.fails(1, &["simulate", "fast.toml", "-o", "locked"], &words);
    assert!(crate::support::names(&locked).is_empty());
}

/// `/proc` holds no files of users, not even of the superuser.
#[cfg(target_os = "linux")]
#[test]
fn a_directory_in_which_nobody_may_write() {
    let workplace = Workplace::new();
    for directory in ["/proc", "/proc/results"] {
        let words = [&format!("cannot write results to the directory {directory}: "), "-o"];
        workplace.fails(1, &["simulate", "fast.toml", "-o", directory], &words);
    }
    let trace = ["simulate", "fast.toml", "-o", "new", "--trace", "/proc/t.npz"];
    workplace.fails(1, &trace, &["--trace /proc/t.npz: cannot be written"]);
    workplace.fails(1, &["init", "healthy", "-o", "/proc/h.toml"], &["cannot write /proc/h.toml"]);
    workplace.succeeds(&["init", "dataset", "-o", "plan.toml"]);
    workplace.fails(1, &["dataset", "plan.toml", "-o", "/proc/set"], &["cannot write /proc/set"]);
}

/// A file there would take the device's place.
#[cfg(unix)]
#[test]
fn a_device_is_no_file() {
    let workplace = Workplace::new();
    workplace.fails(2, &["init", "healthy", "-o", "/dev/null", "--force"], &["it is no ordinary file"]);
    let trace = ["simulate", "fast.toml", "--trace", "/dev/null"];
    workplace.fails(2, &trace, &["--trace /dev/null", "it is no ordinary file"]);
}

#[test]
fn a_trace_without_a_directory() {
    let workplace = Workplace::new();
    let refused = |trace: &str, problem: &str| {
        let named = format!("--trace {trace}: ");
        let arguments = ["simulate", "fast.toml", "--trace", trace, "-o", "new/deep"];
        workplace.fails(2, &arguments, &[&named, problem, "help: name another file with --trace"]);
    };
    refused("absent/t.npz", "there is no directory absent");
    refused("fast.toml/t.npz", "there is no directory fast.toml");
    refused("new", "it is a directory");
    refused("t.npz/", "it is no name of a file");
}

#[test]
fn a_trace_in_the_place_of_another_file() {
    let workplace = Workplace::new();
    workplace.write("worn.toml", fast_and("[quality]\ndin_grade = 7"));
    workplace.succeeds(&["wheels", "worn.toml", "-o", "wheels.npz"]);
    workplace.write("given.toml", fast_and("[quality]\nerrors_file = \"wheels.npz\""));
    let refused = |arguments: &[&str], trace: &str, words: &str| {
        let arguments = [&["simulate", "-o", "out", "--trace", trace], arguments].concat();
        workplace.fails(2, &arguments, &["--trace", trace, words, "a file of its own"]);
    };
    for result in ["out/signals.parquet", "out/summary.json", "out/panel.svg", "out/../out/panel.png"] {
        refused(&["fast.toml"], result, "another of its results");
    }
    refused(&["fast.toml"], "./fast.toml", "the run reads");
    refused(&["fast.toml", "--errors-file", "wheels.npz"], "wheels.npz", "the run reads");
    refused(&["given.toml"], "wheels.npz", "the run reads");
    assert_eq!(workplace.read("fast.toml"), crate::support::FAST.as_bytes());
}

#[test]
fn results_in_the_place_of_what_is_read() {
    let workplace = Workplace::new();
    workplace.write("summary.json", crate::support::FAST);
    let words = ["summary.json would replace a file that is read", "-o"];
    workplace.fails(2, &["simulate", "summary.json", "-o", "."], &words);
    assert_eq!(workplace.read("summary.json"), crate::support::FAST.as_bytes());
}

#[test]
fn a_result_that_is_a_directory() {
    let workplace = Workplace::new();
    std::fs::create_dir_all(workplace.path("out/summary.json")).unwrap();
    let words = ["cannot write out/summary.json", "it is a directory"];
    workplace.fails(2, &["simulate", "fast.toml", "-o", "out"], &words);
    assert_eq!(workplace.names("out"), ["summary.json"]);
}

#[cfg(target_os = "linux")]
#[test]
fn standard_output_on_a_full_disk() {
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = program().args(["init", "healthy"]).stdout(full).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("cannot write to standard output"));
}

/// A limit of the size of files stands in for a full disk: writing beyond it fails just so.
#[cfg(target_os = "linux")]
#[test]
fn results_on_a_full_disk() {
    let workplace = Workplace::new();
    workplace.write("worn.toml", fast_and("[quality]\ndin_grade = 7"));
    let all = ["panel.png", "panel.svg", "signals.parquet", "summary.json"];
    // Less than the signals need.
    let simulate = |blocks: u32, scenario: &str, directory: &str| {
        let output = program_with_small_files(blocks)
            .args(["simulate", scenario, "-o", directory])
            .current_dir(workplace.directory.path())
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(1), "{output:?}");
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let message = simulate(16, "fast.toml", "new");
    assert!(message.contains("cannot write new/signals.parquet"), "{message}");
    assert!(!workplace.path("new").exists());

    // One sentence, whatever is written.
    for arguments in [&["init", "healthy", "-o", "new.toml"][..], &["wheels", "worn.toml", "-o", "new.npz"]] {
        let output = program_with_small_files(1)
            .args(arguments)
            .current_dir(workplace.directory.path())
            .output()
            .unwrap();
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!((output.status.code(), message.lines().count()), (Some(1), 1), "{message}");
        assert!(message.starts_with(&format!("error: cannot write {}: ", arguments[3])), "{message}");
        assert!(!workplace.path(arguments[3]).exists());
    }

    workplace.succeeds(&["simulate", "fast.toml", "-o", "old"]);
    let before = all.map(|name| workplace.read(&format!("old/{name}")));
    let message = simulate(16, "worn.toml", "old");
    assert!(message.contains("cannot write old/signals.parquet"), "{message}");
    assert_eq!(workplace.names("old"), all);
    assert_eq!(all.map(|name| workplace.read(&format!("old/{name}"))), before);
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    use std::process::Stdio;

    for _ in 0..5 {
        let mut child = program()
            .args(["init", "healthy"])
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!((output.status.code(), String::from_utf8_lossy(&output.stderr).as_ref()), (Some(0), ""));
    }
}

#[cfg(unix)]
#[test]
fn a_closed_standard_output() {
    let workplace = Workplace::new();
    let printing = [vec!["init", "healthy"], vec!["--help"], vec!["simulate", "fast.toml", "-o", "out"]];
    for arguments in printing {
        let mut shell = std::process::Command::new("sh");
        let closed = shell.args(["-c", "exec \"$0\" \"$@\" >&-", crate::support::PROGRAM]).args(&arguments);
        let output = closed.current_dir(workplace.directory.path()).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(message.contains("cannot write to standard output: it is closed"), "{message}");
    }
    // Who reads nothing has not closed it.
    let null = program().args(["init", "healthy"]).stdout(std::process::Stdio::null()).status().unwrap();
    assert!(null.success());
}
