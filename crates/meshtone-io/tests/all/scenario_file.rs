//! Scenario files and the files that they name, on disk.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::fs::{self, File};

use meshtone::scenario::{Model, ProfileErrors, Scenario, ScenarioError, template};
use meshtone::wheel::ErrorTable;
use meshtone_io::scenario_file::{ReadScenarioError, ScenarioFile, write_wheels_npz};
use ndarray::{Array1, Array2, ArrayView2, ShapeBuilder};
use ndarray_npy::NpzWriter;
use tempfile::{TempDir, tempdir};

const REQUIRED: &str = "[gears]\nmodule_mm = 3.0\npinion_teeth = 17\ngear_teeth = 38\nface_width_mm = 15.0\n\
                        [operation]\npinion_speed_hz = 40.0\nbrake_torque_nm = 10.0\n";

fn read_with(directory: &TempDir, lines: &str) -> Result<Scenario, ReadScenarioError> {
    let path = directory.path().join("scenario.toml");
    fs::write(&path, format!("{REQUIRED}{lines}\n")).unwrap();
    Ok(ScenarioFile::read(&path)?.scenario)
}

fn with_errors(directory: &TempDir) -> Result<Scenario, ReadScenarioError> {
    read_with(directory, "[quality]\nerrors_file = \"wheels.npz\"")
}

fn with_profile(directory: &TempDir, csv: &str) -> Result<Scenario, ReadScenarioError> {
    fs::write(directory.path().join("speed.csv"), csv).unwrap();
    read_with(directory, "speed_profile_hz = { file = \"speed.csv\" }")
}

#[track_caller]
fn assert_refused(
    result: Result<Scenario, ReadScenarioError>,
    key: &str,
    line: usize,
    words: &[&str],
) -> ScenarioError {
    let ReadScenarioError::Invalid { error, text, .. } = result.unwrap_err() else {
        panic!("the scenario file itself must be readable");
    };
    assert!(text.starts_with(REQUIRED));
    assert_eq!((error.key.as_str(), error.line), (key, Some(line)), "{error}");
    let message = format!("{error} {}", error.help.as_deref().unwrap_or_default());
    for word in words {
        assert!(message.contains(word), "`{word}` is not in: {message}");
    }
    *error
}

fn errors(teeth: usize) -> Array2<f64> {
    Array2::from_shape_fn((100, teeth), |(row, tooth)| 1e-6 * (row as f64 - 3.5 * tooth as f64))
}

fn matrix(errors: ArrayView2<'_, f64>) -> ErrorTable {
    ErrorTable::from_fn(errors.nrows(), errors.ncols(), |row, column| errors[[row, column]])
}

fn archive(directory: &TempDir) -> NpzWriter<File> {
    NpzWriter::new(File::create(directory.path().join("wheels.npz")).unwrap())
}

fn save(directory: &TempDir, pinion: &Array2<f64>, gear: &Array2<f64>) {
    let mut archive = archive(directory);
    archive.add_array("note", &Array1::from_elem(3, 1i32)).unwrap();
    archive.add_array("pinion_profile_errors_mm", pinion).unwrap();
    archive.add_array("gear_profile_errors_mm", gear).unwrap();
    archive.finish().unwrap();
}

#[test]
fn scenario_files_are_read() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("breakage.toml");
    fs::write(&path, template("tooth-breakage").unwrap()).unwrap();
    let scenario = ScenarioFile::read(&path).unwrap().scenario;
    assert_eq!(scenario, Scenario::from_toml(&template("tooth-breakage").unwrap()).unwrap());
}

#[test]
fn scenario_files_that_cannot_be_read() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("absent.toml");
    let error = ScenarioFile::read(&path).unwrap_err();
    assert!(matches!(error, ReadScenarioError::Unreadable { .. }));
    assert!(error.to_string().contains("absent.toml"), "{error}");
    fs::write(&path, [0x67, 0xff, 0xfe]).unwrap();
    let error = ScenarioFile::read(&path).unwrap_err();
    assert!(error.to_string().contains("UTF-8"), "{error}");
}

#[test]
fn errors_of_a_scenario_name_the_file() {
    let directory = tempdir().unwrap();
    let error = read_with(&directory, "[rig]\ndamping_ratio = 5").unwrap_err();
    let message = error.to_string();
    assert!(message.contains("scenario.toml: line 10: rig.damping_ratio = 5: must be"), "{message}");
}

#[test]
fn profile_errors_in_row_or_column_order() {
    let directory = tempdir().unwrap();
    let (pinion, gear) = (errors(17), errors(38));
    let mut by_column = Array2::zeros((100, 17).f());
    by_column.assign(&pinion);
    assert!(!by_column.is_standard_layout());
    for pinion in [&pinion, &by_column] {
        save(&directory, pinion, &gear);
        let read = with_errors(&directory).unwrap().quality().profile_errors.unwrap();
        assert_eq!(read.pinion_profile_errors_mm, matrix(pinion.view()));
        assert_eq!(read.gear_profile_errors_mm, matrix(gear.view()));
    }
}

#[test]
fn profile_errors_in_single_precision() {
    let directory = tempdir().unwrap();
    let mut archive = archive(&directory);
    let single = |teeth| errors(teeth).mapv(|error| error as f32);
    archive.add_array("pinion_profile_errors_mm", &single(17)).unwrap();
    archive.add_array("gear_profile_errors_mm", &single(38)).unwrap();
    archive.finish().unwrap();
    let read = with_errors(&directory).unwrap().quality().profile_errors.unwrap();
    assert_eq!(read.pinion_profile_errors_mm[(7, 3)], f64::from(single(17)[[7, 3]]));
}

#[test]
fn profile_errors_written_are_read_back() {
    let directory = tempdir().unwrap();
    let written = ProfileErrors {
        pinion_profile_errors_mm: matrix(errors(17).view()),
        gear_profile_errors_mm: matrix(errors(38).view()),
    };
    write_wheels_npz(&directory.path().join("wheels.npz"), &written, &Default::default()).unwrap();
    let scenario = with_errors(&directory).unwrap();
    assert_eq!(scenario.quality().profile_errors.as_ref(), Some(&written));
    let alone = Scenario::from_toml(&scenario.to_toml()).unwrap();
    assert_eq!(alone, scenario);
}

#[test]
fn deviations_that_were_drawn_make_the_same_signal_from_a_file() {
    let directory = tempdir().unwrap();
    const CONTACT: &str = "[solver]\nsampling_rate_hz = 2e4\n[quality]\n";
    let contact = |lines: &str| {
        let mut scenario = read_with(&directory, &format!("{CONTACT}{lines}")).unwrap();
        scenario.model = Model::Contact;
        scenario
    };
    let drawn = contact("din_grade = 7\nhelix_share = 0.5");
    let simulation = meshtone::simulate(&drawn).unwrap();
    let errors = simulation.stages.pairs[0].profile_errors.as_ref().unwrap();
    let deviations = simulation.stages.wheel_deviations().swap_remove(0);
    assert!(deviations.iter().all(|given| given.run_out_um > Some(1.0) && given.helix_slope_um != Some(0.0)));
    write_wheels_npz(&directory.path().join("wheels.npz"), errors, &deviations).unwrap();
    let given = contact("errors_file = \"wheels.npz\"");
    let again = meshtone::simulate(&given).unwrap();
    assert_eq!(again.channels, simulation.channels);
    let mut alone = Scenario::from_toml(&given.to_toml()).unwrap();
    assert_eq!(alone, given);
    // What the file has is not drawn.
    alone.wheels.iter_mut().for_each(|wheel| wheel.run_out_share = 0.1);
    let warnings = alone.validate().unwrap();
    assert!(warnings.iter().any(|warning| warning.key == "quality.run_out_share"), "{warnings:?}");
}

#[test]
fn measured_deviations_in_a_file() {
    let directory = tempdir().unwrap();
    let write = |pitches: usize| {
        let mut archive = archive(&directory);
        archive.add_array("pinion_profile_errors_mm", &errors(17)).unwrap();
        archive.add_array("gear_profile_errors_mm", &errors(38)).unwrap();
        let pitches = Array1::from_shape_fn(pitches, |tooth| tooth as f64);
        archive.add_array("gear_cumulative_pitch_um", &pitches).unwrap();
        archive.add_array("gear_run_out_um", &ndarray::arr0(12.5)).unwrap();
        archive.finish().unwrap();
    };
    write(38);
    let quality = with_errors(&directory).unwrap().quality();
    assert_eq!(quality.gear_deviations.run_out_um, Some(12.5));
    assert_eq!(quality.gear_deviations.cumulative_pitch_um.as_ref().unwrap()[37], 37.0);
    assert_eq!(quality.pinion_deviations, Default::default());
    let beside = "[quality]\nerrors_file = \"wheels.npz\"\n";
    let helix = read_with(&directory, &format!("{beside}pinion_helix_slope_um = -3.0")).unwrap();
    assert_eq!(helix.wheels[0].deviations.helix_slope_um, Some(-3.0));
    assert_refused(
        read_with(&directory, &format!("{beside}gear_run_out_um = 3.0")),
        "quality.gear_run_out_um",
        11,
        &["given beside errors_file", "only one source"],
    );
    write(37);
    assert_refused(
        with_errors(&directory),
        "quality.errors_file",
        10,
        &["gear_cumulative_pitch_um: has 37 numbers; must have 38"],
    );
}

#[test]
fn profile_errors_that_cannot_be_used() {
    let key = "quality.errors_file";
    let directory = tempdir().unwrap();
    assert_refused(
        with_errors(&directory),
        key,
        10,
        &["\"wheels.npz\"", "there is no file", "relative to the scenario"],
    );

    fs::write(directory.path().join("wheels.npz"), "time,value").unwrap();
    assert_refused(with_errors(&directory), key, 10, &["not an .npz archive", "numpy.savez"]);

    let mut empty = archive(&directory);
    empty.add_array("errors", &errors(17)).unwrap();
    empty.add_array("gear_profile_errors_mm", &errors(38)).unwrap();
    empty.finish().unwrap();
    let words = ["no entry pinion_profile_errors_mm", "it has errors, gear_profile_errors_mm"];
    assert_refused(with_errors(&directory), key, 10, &words);

    // A few bytes that stand for many numbers are not decompressed.
    let mut many = NpzWriter::new_compressed(File::create(directory.path().join("wheels.npz")).unwrap());
    many.add_array("pinion_profile_errors_mm", &Array2::<f64>::zeros((100, 10_001))).unwrap();
    many.finish().unwrap();
    let words = ["pinion_profile_errors_mm that cannot be read", "1000100 numbers; must be at most 1000000"];
    assert_refused(with_errors(&directory), key, 10, &words);

    save(&directory, &errors(16), &errors(38));
    let shapes = ["pinion_profile_errors_mm: is 100 × 16; must be 100 × 17"];
    assert_refused(with_errors(&directory), key, 10, &shapes);

    let mut hole = errors(38);
    hole[[41, 7]] = f64::NAN;
    save(&directory, &errors(17), &hole);
    let position = ["gear_profile_errors_mm[41][7]: point 42 of tooth 8 is NaN"];
    assert_refused(with_errors(&directory), key, 10, &position);

    let mut flat = archive(&directory);
    flat.add_array("pinion_profile_errors_mm", &Array1::from_elem(1700, 0.0)).unwrap();
    flat.add_array("gear_profile_errors_mm", &errors(38)).unwrap();
    flat.finish().unwrap();
    assert_refused(with_errors(&directory), key, 10, &["shape [1700]", "100 × teeth"]);

    let mut whole = archive(&directory);
    whole.add_array("pinion_profile_errors_mm", &Array2::from_elem((100, 17), 1i32)).unwrap();
    whole.add_array("gear_profile_errors_mm", &errors(38)).unwrap();
    whole.finish().unwrap();
    assert_refused(with_errors(&directory), key, 10, &["pinion_profile_errors_mm that cannot be read"]);
}

#[test]
fn profiles_with_and_without_a_header() {
    let directory = tempdir().unwrap();
    for csv in [
        "time_s,value\n0,38\n1.5, 40.5\n",
        "0,38\n1.5,40.5",
        "# rig 2\ntime_s,speed_hz\r\n0,38\r\n1.5,40.5\r\n",
    ] {
        let profile = with_profile(&directory, csv).unwrap().operation.speed_profile_hz.unwrap();
        assert_eq!((profile.time_s, profile.value), (vec![0.0, 1.5], vec![38.0, 40.5]), "{csv}");
    }
}

#[test]
fn profiles_that_cannot_be_used() {
    let directory = tempdir().unwrap();
    let key = "operation.speed_profile_hz";
    let file = &format!("{key}.file");
    let absent = read_with(&directory, "speed_profile_hz = { file = \"speed.csv\" }");
    assert_refused(absent, file, 9, &["speed.csv", "there is no file"]);
    for (csv, words) in [
        ("value,time_s\n38,0\n40,1\n", "names its first column `value`; it must be time_s"),
        ("0,38\n1,fast\n", "has `fast` in line 2; must be a finite number"),
        ("0,38\nnan,40\n", "has `nan` in line 2"),
        ("0,38\n1,40,2\n", "has 3 columns in line 2; must have 2"),
        ("0;38\n1;40\n", "has 1 columns in line 1; must have 2"),
    ] {
        assert_refused(with_profile(&directory, csv), file, 9, &[words, "separated by a comma"]);
    }
    assert_refused(with_profile(&directory, "0,38\n"), key, 9, &["has 1 points", "at least 2"]);
    assert_refused(with_profile(&directory, ""), key, 9, &["has 0 points"]);
    let backwards = with_profile(&directory, "0,38\n2,40\n1,40\n");
    assert_refused(backwards, &format!("{key}.time_s[2]"), 9, &["times increase"]);
}

#[test]
fn names_are_relative_to_the_scenario_file() {
    let directory = tempdir().unwrap();
    fs::create_dir(directory.path().join("wheels")).unwrap();
    let written = ProfileErrors {
        pinion_profile_errors_mm: matrix(errors(17).view()),
        gear_profile_errors_mm: matrix(errors(38).view()),
    };
    write_wheels_npz(&directory.path().join("wheels/a.npz"), &written, &Default::default()).unwrap();
    let scenario = read_with(&directory, "[quality]\nerrors_file = \"wheels/a.npz\"").unwrap();
    assert_eq!(scenario.quality().profile_errors, Some(written));
}

fn with_response(directory: &TempDir, csv: &str) -> Result<Scenario, ReadScenarioError> {
    fs::write(directory.path().join("path.csv"), csv).unwrap();
    read_with(directory, "[[sensor]]\nfrequency_response = { file = \"path.csv\" }")
}

/// What a file says becomes part of the scenario, whose text then needs no file.
#[test]
fn frequency_responses_are_read() {
    let directory = tempdir().unwrap();
    let csv = "# measured\nfrequency_hz, magnitude, phase_deg\n0, 1, 0\n10.5, 2e-3, -170\n";
    let scenario = with_response(&directory, csv).unwrap();
    let response = scenario.sensors[0].frequency_response.clone().unwrap();
    let columns = [response.frequency_hz, response.magnitude, response.phase_deg];
    assert_eq!(columns, [vec![0.0, 10.5], vec![1.0, 2e-3], vec![0.0, -170.0]]);
    assert_eq!(Scenario::from_toml(&scenario.to_toml()), Ok(scenario));
}

#[test]
fn frequency_responses_that_are_none() {
    let directory = tempdir().unwrap();
    let file = "sensor.frequency_response.file";
    let head = "frequency_hz,magnitude,phase_deg\n";
    let cases: [(&str, &[&str]); 6] = [
        ("0,1,0\n1,1,0\n", &["first column `0`", "frequency_hz,magnitude,phase_deg"]),
        ("frequency_hz,real,imaginary\n0,1,0\n", &["second column `real`", "must be magnitude"]),
        ("frequency_hz,magnitude,phase_rad\n0,1,0\n", &["third column `phase_rad`"]),
        (&format!("{head}0,1\n"), &["2 columns in line 2", "must have 3"]),
        (&format!("{head}0,1,east\n"), &["has `east` in line 2", "finite number"]),
        (&format!("{head}0,1,inf\n"), &["has `inf` in line 2"]),
    ];
    for (csv, words) in cases {
        assert_refused(with_response(&directory, csv), file, 10, words);
    }
    let short = with_response(&directory, &format!("{head}0,1,0\n"));
    assert_refused(short, "sensor.frequency_response", 10, &["1 rows", "at least 2"]);
    let falling = with_response(&directory, &format!("{head}2,1,0\n1,1,0\n"));
    let entry = "sensor.frequency_response.frequency_hz[1]";
    assert_refused(falling, entry, 10, &["more than the frequency before it, 2.0 Hz"]);
    let absent = read_with(&directory, "[sensor]\nfrequency_response = { file = \"absent.csv\" }");
    assert_refused(absent, file, 10, &["there is no file", "absent.csv"]);
}
