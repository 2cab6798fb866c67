//! `meshtone init`, `--version` and `--help`

use crate::support::{Workplace, stdout};
use meshtone::scenario::{template, template_kinds};
use meshtone_io::scenario_file::read_scenario;

#[test]
fn every_kind_is_printed_and_can_be_read() {
    let workplace = Workplace::new();
    for kind in template_kinds() {
        assert_eq!(stdout(&workplace.succeeds(&["init", kind])), template(kind).unwrap());
        let file = format!("{kind}.toml");
        workplace.succeeds(&["init", kind, "-o", &file]).stdout("");
        read_scenario(&workplace.path(&file)).unwrap();
    }
}

/// A file handed to the command of another kind is told what it is and what reads it.
#[test]
fn files_of_other_kinds_are_named() {
    let workplace = Workplace::new();
    for kind in ["healthy", "dataset", "experiment"] {
        workplace.succeeds(&["init", kind, "-o", &format!("{kind}.toml")]);
    }
    let read = [("simulate", "healthy"), ("dataset", "dataset"), ("tune", "experiment")];
    for (command, _) in read {
        for (reader, kind) in read.into_iter().filter(|(reader, _)| *reader != command) {
            let file = format!("{kind}.toml");
            let words = ["is expected here", &format!("`meshtone {reader} {file}` reads it")];
            workplace.fails(2, &[command, &file], &words);
        }
    }
}

#[test]
fn an_experiment_to_start_from_can_be_read_where_its_files_are() {
    let workplace = Workplace::new();
    workplace.succeeds(&["init", "experiment", "-o", "experiment.toml"]);
    workplace.fails(2, &["tune", "experiment.toml"], &["rig.toml"]);
    workplace.succeeds(&["init", "healthy", "-o", "rig.toml"]);
    for (number, name) in (1..).zip(["healthy_1", "healthy_2", "chipped_1", "chipped_2"]) {
        let noise = |i: u32| (f64::from(i * 7919 % 1001) / 1000.0).powi(number);
        let lines = (0..7500).map(|i| format!("{},{}\n", f64::from(i) / 25e3, noise(i)));
        let recording: String = std::iter::once("time_s,bearing\n".to_owned()).chain(lines).collect();
        workplace.write(&format!("{name}.csv"), recording);
    }
    let read = meshtone_io::experiment::read_experiment(&workplace.path("experiment.toml")).unwrap();
    assert_eq!(read.experiment.cases.len(), 2);
}

#[test]
fn completions_and_the_manual_know_all_commands() {
    let workplace = Workplace::new();
    for kind in ["bash", "elvish", "fish", "powershell", "zsh", "man"] {
        let text = stdout(&workplace.succeeds(&["completions", kind]));
        for word in ["simulate", "indicators", "verify", "merge", "sampling"] {
            assert!(text.contains(word), "{kind}: {word}");
        }
    }
    workplace.fails(2, &["completions", "tcsh"], &["bash", "zsh", "man"]);
}

#[test]
fn an_existing_file_is_not_replaced_by_accident() {
    let workplace = Workplace::new();
    let words = ["fast.toml exists already", "--force"];
    workplace.fails(2, &["init", "healthy", "-o", "fast.toml"], &words);
    assert_eq!(workplace.read("fast.toml"), crate::support::FAST.as_bytes());
    workplace.succeeds(&["init", "healthy", "-o", "fast.toml", "--force"]);
    assert_eq!(workplace.read("fast.toml"), template("healthy").unwrap().as_bytes());
    workplace.fails(2, &["init", "healthy", "-o", "absent/h.toml"], &["there is no directory absent"]);
}

#[test]
fn an_unknown_kind_lists_the_kinds() {
    let workplace = Workplace::new();
    workplace.fails(2, &["init", "scuffing"], &template_kinds());
    workplace.fails(2, &["init"], &["KIND"]);
}

#[test]
fn version_and_help() {
    let workplace = Workplace::new();
    let version = format!("meshtone {}\n", env!("CARGO_PKG_VERSION"));
    workplace.succeeds(&["--version"]).stdout(version);
    for command in ["simulate", "init", "wheels", "panel", "dataset"] {
        let help = stdout(&workplace.succeeds(&[command, "--help"]));
        assert!(help.contains("Example") && help.contains("Usage: meshtone"), "{help}");
        assert!(stdout(&workplace.succeeds(&["--help"])).contains(command));
    }
}
