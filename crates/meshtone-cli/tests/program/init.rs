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
