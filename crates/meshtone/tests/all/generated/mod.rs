//! What is written from the rows of the scenario's keys: parts of the Python package and lists of the guide.
//!
//! `cargo xtask generate` writes them; these tests fail where they are stale.
#![allow(clippy::unwrap_used, clippy::panic)]

mod both_wheels;
mod damage_py;
mod gearbox_keys;
mod guide;
mod keys_py;
mod python;
mod sensor_py;

use std::fs;
use std::path::{Path, PathBuf};

/// Set to write what is stale instead of failing.
const WRITE: &str = "MESHTONE_GENERATE";

fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Compares a file with what it must be, or writes it.
fn check(name: &str, expected: &str) {
    let path = workspace().join(name);
    let found = fs::read_to_string(&path).unwrap_or_default();
    if found == expected {
        return;
    }
    assert!(std::env::var_os(WRITE).is_some(), "{name} is stale: `cargo xtask generate` writes it");
    fs::write(&path, expected).unwrap();
}

#[test]
fn python_arguments_of_a_scenario() {
    check("python/meshtone/_keys.py", &keys_py::text());
}

#[test]
fn python_classes_of_damage() {
    check("python/meshtone/_damage.py", &damage_py::text());
}

#[test]
fn python_class_of_a_sensor() {
    check("python/meshtone/_sensor.py", &sensor_py::text());
}

#[test]
fn lists_of_the_guide() {
    for name in guide::PAGES {
        let text = fs::read_to_string(workspace().join(name)).unwrap();
        check(name, &guide::with_lists(&text));
    }
}
