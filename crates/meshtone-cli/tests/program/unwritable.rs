//! What cannot be written is said before anything is simulated, and nothing half-written remains.

use crate::support::{Workplace, fast_with};

#[test]
fn a_directory_that_is_a_file() {
    let workplace = Workplace::new();
    workplace.write("taken", "");
    let words = ["cannot write results to the directory taken", "it is a file", "-o"];
    workplace.fails(1, &["simulate", "fast.toml", "-o", "taken"], &words);
    let words = ["cannot write results to the directory taken/below"];
    workplace.fails(1, &["simulate", "fast.toml", "-o", "taken/below"], &words);
}

#[test]
fn an_unwritable_directory_is_found_before_the_simulation() {
    let workplace = Workplace::new();
    workplace.write("taken", "");
    // Some seconds of simulation, which must not pass.
    workplace.write("long.toml", fast_with("sampling_rate_hz", "sampling_rate_hz = 4e6"));
    let start = std::time::Instant::now();
    workplace.fails(1, &["simulate", "long.toml", "-o", "taken"], &["taken"]);
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
    // The superuser may write everywhere.
    if fs::write(locked.join("probe"), "").is_ok() {
        return;
    }
    let words = ["cannot write results to the directory locked", "ermission denied"];
    workplace.fails(1, &["simulate", "fast.toml", "-o", "locked"], &words);
    assert!(crate::support::names(&locked).is_empty());
}

#[test]
fn a_trace_without_a_directory() {
    let workplace = Workplace::new();
    let words = ["cannot write", "there is no directory absent"];
    workplace.fails(1, &["simulate", "fast.toml", "--trace", "absent/t.npz", "-o", "new/deep"], &words);
}

#[test]
fn a_result_that_is_a_directory() {
    let workplace = Workplace::new();
    std::fs::create_dir_all(workplace.path("out/summary.json")).unwrap();
    let words = ["cannot write out/summary.json", "it is a directory"];
    workplace.fails(1, &["simulate", "fast.toml", "-o", "out"], &words);
    assert_eq!(workplace.names("out"), ["summary.json"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk() {
    let workplace = Workplace::new();
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let program = env!("CARGO_BIN_EXE_meshtone");
    let output = std::process::Command::new(program).args(["init", "healthy"]).stdout(full).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("cannot write to standard output"));
    drop(workplace);
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    use std::process::{Command, Stdio};

    for _ in 0..5 {
        let mut child = Command::new(env!("CARGO_BIN_EXE_meshtone"))
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
