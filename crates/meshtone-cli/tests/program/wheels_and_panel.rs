//! `meshtone wheels` and `meshtone panel`

use crate::support::{Workplace, fast_and, stderr};
use meshtone::scenario::ScenarioFiles;
use meshtone_io::scenario_file::{FilesBeside, ScenarioFile};

#[test]
fn wheels_are_those_that_the_scenario_draws() {
    let workplace = Workplace::new();
    workplace.write("worn.toml", fast_and("[quality]\ndin_grade = 9\n[fault]\nkind = \"missing-tooth\""));
    workplace.succeeds(&["wheels", "worn.toml", "-o", "wheels.npz"]).stdout("");
    let scenario = ScenarioFile::read(&workplace.path("worn.toml")).unwrap().scenario;
    let drawn = meshtone::stages(&scenario).unwrap().pairs[0].profile_errors.clone().unwrap();
    let written = FilesBeside::new(workplace.directory.path()).profile_errors("wheels.npz").unwrap();
    assert_eq!(written, drawn);
}

#[test]
fn ideal_wheels_have_no_errors_to_write() {
    let workplace = Workplace::new();
    workplace.write("ideal.toml", fast_and("[quality]\ndin_grade = 0"));
    let words = ["ideal.toml: line 12: quality.din_grade = 0", "from 1 (best) to 12"];
    workplace.fails(2, &["wheels", "ideal.toml", "-o", "wheels.npz"], &words);
    workplace.fails(2, &["wheels", "fast.toml", "-o", "wheels.npz"], &["quality.din_grade = 0"]);
    workplace.write("ideal.toml", fast_and("[quality]\ndin_grade = 7"));
    workplace.fails(2, &["wheels", "ideal.toml", "-o", "absent/w.npz"], &["there is no directory absent"]);
    workplace.fails(
        2,
        &["wheels", "ideal.toml", "-o", "./ideal.toml"],
        &["-o ./ideal.toml", "is the scenario file"],
    );
}

#[test]
fn wheels_may_deviate_by_their_run_out_alone() {
    let workplace = Workplace::new();
    workplace.write("off.toml", fast_and("[quality]\npinion_run_out_um = 12.0\ngear_helix_slope_um = -3.0"));
    workplace.succeeds(&["wheels", "off.toml", "-o", "wheels.npz", "-q"]).stdout("");
    let files = FilesBeside::new(workplace.directory.path());
    let [pinion, gear] = files.wheel_deviations("wheels.npz").unwrap();
    assert_eq!((pinion.run_out_um, gear.helix_slope_um), (Some(12.0), Some(-3.0)));
    let errors = files.profile_errors("wheels.npz").unwrap().gear_profile_errors_mm;
    assert!((0..errors.points()).all(|point| (0..errors.teeth()).all(|tooth| errors[(point, tooth)] == 0.0)));
}

#[test]
fn the_panel_is_drawn_again_from_the_signals_alone() {
    let workplace = Workplace::new();
    workplace.write("worn.toml", fast_and("[quality]\ndin_grade = 7"));
    workplace.succeeds(&["simulate", "worn.toml", "-o", "out"]);
    let panel = || [workplace.read("out/panel.svg"), workplace.read("out/panel.png")];
    let first = panel();
    for name in ["worn.toml", "out/panel.svg", "out/panel.png"] {
        std::fs::remove_file(workplace.path(name)).unwrap();
    }
    workplace.succeeds(&["panel", "out"]).stderr("");
    assert_eq!(panel(), first);
    assert_eq!(workplace.names("out"), ["panel.png", "panel.svg", "signals.parquet", "summary.json"]);
}

#[test]
fn a_panel_of_results_that_are_not_complete() {
    let workplace = Workplace::new();
    workplace.succeeds(&["simulate", "fast.toml", "-o", "out"]);
    let summary = workplace.path("out/summary.json");
    // As a run leaves it that is killed while it names its files.
    std::fs::remove_file(&summary).unwrap();
    let warning = stderr(&workplace.succeeds(&["panel", "out"]));
    for words in ["warning: there is no out/summary.json", "not complete", "simulate again"] {
        assert!(warning.contains(words), "{warning}");
    }
    workplace.write("other.toml", fast_and("[quality]\ndin_grade = 7"));
    workplace.succeeds(&["simulate", "other.toml", "-o", "other"]);
    std::fs::copy(workplace.path("other/summary.json"), &summary).unwrap();
    let words = ["out/summary.json is of the run", "signals.parquet beside it of the run", "simulate again"];
    workplace.fails(2, &["panel", "out"], &words);
    workplace.write("out/summary.json", "{ \"run\": 3 }");
    workplace.fails(2, &["panel", "out"], &["out/summary.json", "has no `run`"]);
}

#[test]
fn a_panel_of_something_else() {
    let workplace = Workplace::new();
    workplace.fails(
        2,
        &["panel", "absent"],
        &["there is no file absent/signals.parquet", "meshtone simulate"],
    );
    std::fs::create_dir(workplace.path("out")).unwrap();
    workplace.write("out/signals.parquet", "time,force");
    workplace.fails(2, &["panel", "out"], &["out/signals.parquet", "not a whole Parquet file"]);
}
