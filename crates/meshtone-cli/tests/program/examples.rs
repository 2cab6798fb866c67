//! The scenarios in `examples/`.

use std::path::{Path, PathBuf};

use crate::support::Workplace;
use meshtone::scenario::{Scenario, template};
use meshtone_io::scenario_file::ScenarioFile;

fn examples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples")
}

const NAMES: [&str; 9] = [
    "healthy",
    "missing_tooth",
    "partial_face",
    "pits",
    "root_crack",
    "through_face",
    "tooth_breakage",
    "tooth_destruction",
    "wear",
];

// The templates describe the same cases, but for a pit that is given by its circle here.
#[test]
fn examples_are_the_cases_of_the_templates() {
    for name in NAMES {
        let example = ScenarioFile::read(&examples().join(name).with_extension("toml")).unwrap().scenario;
        let mut case = Scenario::from_toml(&template(&name.replace('_', "-")).unwrap()).unwrap();
        if name == "through_face" {
            case.faults.clone_from(&example.faults);
        }
        assert_eq!(example, case, "{name}");
    }
}

#[test]
fn every_example_is_simulated() {
    let workplace = Workplace::new();
    let scenarios: Vec<String> = crate::support::names(&examples())
        .into_iter()
        .filter_map(|name| name.strip_suffix(".toml").map(str::to_owned))
        .collect();
    assert!(NAMES.iter().all(|name| scenarios.iter().any(|scenario| scenario == name)), "{scenarios:?}");
    for name in scenarios {
        let path = examples().join(&name).with_extension("toml");
        workplace.succeeds(&["simulate", path.to_str().unwrap()]);
        assert_eq!(workplace.names(&format!("{name}_results")).len(), 4);
    }
}

#[test]
fn the_same_wheels() {
    let workplace = Workplace::new();
    let directory = examples().join("same_wheels");
    let names = crate::support::names(&directory).into_iter().filter(|name| name.ends_with(".toml"));
    let paths: Vec<String> = names.map(|name| directory.join(name).to_str().unwrap().to_string()).collect();
    let arguments: Vec<&str> = ["simulate", "-o", "out", "--quiet", "--no-panel"]
        .into_iter()
        .chain(paths.iter().map(String::as_str))
        .collect();
    workplace.succeeds(&arguments);
    let expected = ["healthy", "missing_tooth", "partial_face", "through_face", "tooth_breakage"];
    assert_eq!(workplace.names("out"), expected);
    // They are the wheels that the healthy example draws.
    let healthy = examples().join("healthy.toml");
    workplace.succeeds(&["simulate", healthy.to_str().unwrap(), "--no-panel"]);
    let read = |path: &str| meshtone_io::signals::read_signals(&workplace.path(path)).unwrap().channels;
    assert_eq!(read("out/healthy/signals.parquet"), read("healthy_results/signals.parquet"));
}
