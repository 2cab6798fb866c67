//! `meshtone dataset`

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

#[cfg(unix)]
use crate::support::program_with_small_files;
use crate::support::{Workplace, printed_json, program, stdout};

/// 96 records of some milliseconds each.
const PLAN: &str = r#"
records = 96
units = 12
[scenario.gears]
module_mm = 3.0
pinion_teeth = 20
gear_teeth = 40
face_width_mm = 15.0
[scenario.operation]
pinion_speed_hz = 40.0
brake_torque_nm = 200.0
[scenario.quality]
din_grade = 7
[[class]]
label = "healthy"
[[class]]
label = "chipped"
fault = { kind = "tooth-breakage", chip_height_mm = 3.0, chip_width_mm = 8.0 }
[[vary]]
key = "operation.pinion_speed_hz"
uniform = [30.0, 60.0]
[keep]
records_per_shard = 8
[scenario.solver]
sampling_rate_hz = 2e4
duration_s = 0.2
settle_fraction = 0.2
"#;

fn workplace() -> Workplace {
    let workplace = Workplace::new();
    workplace.write("plan.toml", PLAN);
    workplace
}

/// Every file of a data set, by its name.
fn bytes(directory: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    for folder in [directory.to_path_buf(), directory.join("data")] {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_file() {
                files.insert(
                    path.strip_prefix(directory).unwrap().display().to_string(),
                    std::fs::read(&path).unwrap(),
                );
            }
        }
    }
    files
}

#[track_caller]
fn assert_same(workplace: &Workplace, a: &str, b: &str) {
    let [a, b] = [a, b].map(|name| bytes(&workplace.path(name)));
    assert_eq!(a.keys().collect::<Vec<_>>(), b.keys().collect::<Vec<_>>());
    for (name, content) in &a {
        assert!(content == &b[name], "{name} differs");
    }
}

#[test]
fn a_data_set_and_what_is_said_about_it() {
    let workplace = workplace();
    let said = stdout(&workplace.succeeds(&["dataset", "plan.toml"]));
    for words in ["96 records in 12 shards written", "complete: 96 records of 12 units", "plan_dataset"] {
        assert!(said.contains(words), "{said}");
    }
    let names = [
        "README.md",
        "croissant.json",
        "data",
        "manifest.json",
        "plan.toml",
        "preview.png",
        "preview.svg",
        "scenario.toml",
    ];
    assert_eq!(workplace.names("plan_dataset"), names);
    let card = String::from_utf8(workplace.read("plan_dataset/README.md")).unwrap();
    for words in [
        "| chipped |",
        "CC-BY-4.0",
        "parquetread",
        "scan_parquet",
        "dask.dataframe",
        "`fault_tooth`",
        "| *units* |",
    ] {
        assert!(card.contains(words), "{card}");
    }
    let again = stdout(&workplace.succeeds(&["dataset", "plan.toml"]));
    assert!(again.contains("0 records in 0 shards written, 12 shards were there already"), "{again}");
    workplace.succeeds(&["dataset", "plan.toml", "-o", "quiet", "--quiet"]).stdout("");
}

/// Where only the draw shows that two faults meet on one tooth, what is missing is reported, and by the exit code too.
#[test]
fn missing_records_are_reported_every_time() {
    let workplace = workplace();
    let chip = "fault = { kind = \"tooth-breakage\", chip_height_mm = 3.0, chip_width_mm = 8.0 }";
    let two = "fault = [{ kind = \"missing-tooth\" }, { kind = \"missing-tooth\", tooth = 2 }]
               [[class.vary]]
               key = \"fault[0].tooth\"
               choice = [1, 2, 3, 4, 5, 6]
               [[class.vary]]
               key = \"fault[1].tooth\"
               choice = [1, 2, 3, 4, 5, 6]";
    let plan = PLAN
        .replace(chip, two)
        .replace("records = 96", "records = 48")
        .replace("per_shard = 8", "per_shard = 48");
    workplace.write("plan.toml", &plan);
    let run = |options: &[&str]| {
        let command =
            program().arg("dataset").args(options).current_dir(workplace.directory.path()).output().unwrap();
        assert_eq!(command.status.code(), Some(2));
        [command.stdout, command.stderr].map(|text| String::from_utf8(text).unwrap())
    };
    let [_, message] = run(&["plan.toml"]);
    assert!(message.contains("error: plan.toml: ") && message.contains("fault[0] already"), "{message}");
    let numbers = message.split(" missing: ").nth(1).and_then(|rest| rest.split(';').next()).unwrap();
    let missing =
        numbers.matches(|c: char| c.is_ascii_digit() || c == ',').collect::<String>().split(',').count();
    assert!(missing > 0 && missing < 20, "{message}");
    assert!(message.contains(&format!("{missing} record")), "{message}");
    // What is there is complete, and says so; and the next time too.
    let manifest = String::from_utf8(workplace.read("plan_dataset/manifest.json")).unwrap();
    assert_eq!(manifest.matches("\"reason\"").count(), missing);
    let [said, _] = run(&["plan.toml"]);
    let complete = format!("complete: {} records of the plan's 48 of 12 units", 48 - missing);
    for words in [complete.as_str(), "0 records in 0 shards written, 3 shards were there already"] {
        assert!(said.contains(words), "{said}");
    }
    let [said, quiet] = run(&["plan.toml", "--quiet"]);
    assert!(said.is_empty() && quiet.contains(numbers), "{said}{quiet}");
    // A tooth that there is not is reported before anything is made.
    workplace.write("plan.toml", plan.replacen("5, 6]", "5, 41]", 1));
    workplace.fails(
        2,
        &["dataset", "plan.toml", "-o", "other"],
        &["line 21", "choice[5]", "must be at most 40"],
    );
    assert!(!workplace.path("other").exists());
}

#[test]
fn killed_ten_times_and_gone_on_with() {
    let workplace = workplace();
    let start = Instant::now();
    workplace.succeeds(&["dataset", "plan.toml", "-o", "whole", "--jobs", "1"]);
    let whole_s = start.elapsed().as_secs_f64();
    let mut killed = 0;
    // At any moments: multiples of the golden ratio leave no pattern.
    for moment in 1..=10 {
        let part = (f64::from(moment) * 0.618_033_988_749_895).fract();
        let mut child = program()
            .args(["dataset", "plan.toml", "-o", "killed", "--jobs", if moment % 2 == 0 { "1" } else { "3" }])
            .current_dir(workplace.directory.path())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_secs_f64(0.3 * whole_s * part));
        killed += usize::from(child.try_wait().unwrap().is_none());
        child.kill().unwrap();
        child.wait().unwrap();
    }
    assert!(killed > 0);
    workplace.succeeds(&["dataset", "plan.toml", "-o", "killed"]);
    assert_same(&workplace, "whole", "killed");
}

#[test]
fn parts_are_merged() {
    let workplace = workplace();
    workplace.succeeds(&["dataset", "plan.toml", "-o", "whole"]);
    for part in ["1", "2", "3"] {
        let said = stdout(&workplace.succeeds(&[
            "dataset",
            "plan.toml",
            "-o",
            part,
            "--part",
            &format!("{part}/3"),
        ]));
        assert!(said.contains("not complete"), "{said}");
    }
    workplace.fails(
        2,
        &["dataset", "merge", "1", "3", "-o", "merged"],
        &["4 of 12 shards are in none of the parts"],
    );
    workplace.succeeds(&["dataset", "merge", "1", "2", "3", "-o", "merged"]);
    assert_same(&workplace, "whole", "merged");
    workplace.fails(2, &["dataset", "merge", "absent", "-o", "merged"], &["absent is no data set"]);
    workplace.fails(2, &["dataset", "plan.toml", "--part", "4/3"], &["2/8"]);
}

#[test]
fn one_record_can_be_looked_at() {
    let workplace = workplace();
    let scenario = stdout(&workplace.succeeds(&["dataset", "scenario", "plan.toml", "5"]));
    assert!(scenario.starts_with("# Record 5 of plan.toml: \""), "{scenario}");
    workplace.write("record.toml", &scenario);
    workplace.succeeds(&["simulate", "record.toml", "--no-panel"]);
    workplace.fails(
        2,
        &["dataset", "scenario", "plan.toml", "96"],
        &["there are 96 records, counted from 0"],
    );
}

#[test]
fn what_is_wrong_is_said_and_nothing_is_written() {
    let workplace = workplace();
    workplace.fails(
        2,
        &["dataset", "absent.toml"],
        &["there is no plan absent.toml", "meshtone init dataset"],
    );
    workplace.write("wrong.toml", PLAN.replace("uniform = [30.0, 60.0]", "uniform = [60.0, 30.0]"));
    workplace.fails(2, &["dataset", "wrong.toml"], &["wrong.toml", "line 21", "write [30.0, 60.0]"]);
    workplace.write("wrong.toml", PLAN.replace("pinion_speed_hz\"", "pinion_sped_hz\""));
    workplace.fails(2, &["dataset", "wrong.toml"], &["did you mean `operation.pinion_speed_hz`?"]);
    workplace.write(
        "wrong.toml",
        PLAN.replace("units = 12", "units = 12\nconstraints = [\"operation.pinion_speed_hz > 99\"]"),
    );
    workplace.fails(2, &["dataset", "wrong.toml"], &["line 4", "was not met by 10000"]);
    workplace.fails(2, &["dataset", "plan.toml", "-o", "."], &["has another file in it: fast.toml", "-o"]);
    workplace.fails(2, &["dataset", "plan.toml", "-o", "fast.toml"], &["fast.toml"]);
    for url in ["s3://bucket/gears", "gs://bucket/gears", "az://container/gears", "https://host/gears"] {
        let problem = format!("this build has no object stores, such as that of {url}");
        workplace.fails(2, &["dataset", "plan.toml", "-o", url], &[&problem, "--features cloud"]);
    }
}

#[test]
fn another_plan_in_the_same_place() {
    let workplace = workplace();
    workplace.succeeds(&["dataset", "plan.toml", "-o", "set", "--part", "1/12"]);
    workplace.write("other.toml", PLAN.replace("records = 96", "records = 97"));
    workplace.fails(
        2,
        &["dataset", "other.toml", "-o", "set"],
        &["begun with another plan", "name another directory"],
    );
}

#[test]
fn the_first_look() {
    let workplace = workplace();
    let plan = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/datasets/first_look.toml");
    let said = stdout(&workplace.succeeds(&["dataset", plan.to_str().unwrap(), "-o", "look"]));
    assert!(said.contains("complete: 200 records of 10 units"), "{said}");
}

/// Only whether it can be made: making it takes minutes.
#[test]
fn the_benchmark_and_the_template_are_plans() {
    let workplace = workplace();
    let plan = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../python/meshtone/benchmark/pairs-1.toml");
    let scenario = stdout(&workplace.succeeds(&["dataset", "scenario", plan.to_str().unwrap(), "7999"]));
    assert!(scenario.contains("[gears]"), "{scenario}");
    workplace.succeeds(&["init", "dataset", "-o", "template.toml"]);
    workplace.succeeds(&["dataset", "scenario", "template.toml", "0"]);
}

/// The template as it is printed, shortened: no record fails.
#[test]
fn the_template_makes_a_data_set() {
    let workplace = workplace();
    let template = stdout(&workplace.succeeds(&["init", "dataset"]));
    let short = template.replace("records = 600", "records = 40");
    assert_ne!(short, template);
    workplace.write("plan.toml", short);
    let said = stdout(&workplace.succeeds(&["dataset", "plan.toml", "-o", "set"]));
    assert!(said.contains("complete: 40 records of 20 units"), "{said}");
    let card = String::from_utf8(workplace.read("set/README.md")).unwrap();
    for words in
        ["each mounted 2 times", "## Questions", "| detection |", "`path_ripple_db`", "`latent_load_nm`"]
    {
        assert!(card.contains(words), "{words}");
    }
}

/// A limit of the size of files stands in for a full disk: writing beyond it fails just so.
#[cfg(unix)]
#[test]
fn a_full_disk_leaves_what_can_be_gone_on_with() {
    let workplace = workplace();
    workplace.succeeds(&["dataset", "plan.toml", "-o", "whole"]);
    let output = program_with_small_files(100)
        .args(["dataset", "plan.toml", "-o", "full"])
        .current_dir(workplace.directory.path())
        .output()
        .unwrap();
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{message}");
    for words in ["cannot write full/data/train-000000.parquet", "run the same command again"] {
        assert!(message.contains(words), "{message}");
    }
    workplace.succeeds(&["dataset", "plan.toml", "-o", "full"]);
    assert_same(&workplace, "whole", "full");
}

/// Turns over one bit in the middle of a file.
fn flip(path: &Path) {
    let mut content = std::fs::read(path).unwrap();
    let middle = content.len() / 2;
    content[middle] ^= 4;
    std::fs::write(path, content).unwrap();
}

#[test]
fn a_data_set_is_verified() {
    let workplace = workplace();
    let printed = printed_json(&workplace.succeeds(&["dataset", "plan.toml", "-o", "set", "--json"]));
    assert_eq!((&printed["written_records"], &printed["complete"]), (&96.into(), &true.into()));
    let whole = bytes(&workplace.path("set"));
    let good = stdout(&workplace.succeeds(&["dataset", "verify", "set"]));
    assert!(good.contains("96 records in 12 shards") && good.contains("every byte is as written"), "{good}");
    workplace.succeeds(&["dataset", "verify", "set", "--quiet"]).stdout("");
    let printed = printed_json(&workplace.succeeds(&["dataset", "verify", "set", "--json"]));
    assert_eq!((&printed["records"], &printed["output"]), (&96.into(), &"set".into()));
    flip(&workplace.path("set/data/train-000004.parquet"));
    std::fs::remove_file(workplace.path("set/data/train-000007.parquet")).unwrap();
    std::fs::remove_file(workplace.path("set/README.md")).unwrap();
    let output = workplace.command(&["dataset", "verify", "set"]).assert().code(1).stdout("");
    let message = crate::support::stderr(&output);
    for words in [
        "data/train-000004.parquet: its bytes are not those that were written: the SHA-256 differs",
        "data/train-000007.parquet: it is missing",
        "README.md: it is missing",
        "error: set: 3 files are not as written",
        "help: put the files back",
    ] {
        assert!(message.contains(words), "`{words}` is not in: {message}");
    }
    // Without reading, what is missing is seen, and what is damaged is not.
    let output = workplace.command(&["dataset", "verify", "set", "--sizes-only"]).assert().code(1);
    assert!(crate::support::stderr(&output).contains("error: set: 2 files are not as written"));
    let again = workplace.succeeds(&["dataset", "plan.toml", "-o", "set"]);
    let message = crate::support::stderr(&again);
    assert!(
        message.contains("warning: data/train-000004.parquet was made again: its bytes are not those"),
        "{message}"
    );
    assert!(stdout(&again).contains("16 records in 2 shards written, 10 shards were there already"));
    assert!(bytes(&workplace.path("set")) == whole);
    workplace.fails(2, &["dataset", "verify", "absent"], &["absent is no data set"]);

    workplace.write("set/data/notes.txt", "mine");
    let words = ["set has another file in it: data/notes.txt", "move that file elsewhere"];
    workplace.fails(2, &["dataset", "plan.toml", "-o", "set"], &words);
    // A manifest that is damaged itself is reported first: what it says of the others may be wrong.
    let manifest = String::from_utf8(workplace.read("set/manifest.json")).unwrap();
    workplace.write("set/manifest.json", manifest.replacen("000004", "000044", 1));
    let output = workplace.command(&["dataset", "verify", "set"]).assert().code(1);
    let message = crate::support::stderr(&output);
    assert!(message.starts_with("manifest.json: it is not as it was written"), "{message}");
    assert!(message.contains("data/notes.txt: the manifest does not name it"), "{message}");
}

/// A part of it is as it was written, and is not what the plan asks for. Scripts see that by the exit code.
#[test]
fn an_incomplete_data_set_is_not_verified() {
    let workplace = workplace();
    workplace.succeeds(&["dataset", "plan.toml", "-o", "set", "--part", "1/2"]);
    let output = workplace.command(&["dataset", "verify", "set"]).assert().code(1);
    assert!(stdout(&output).contains("48 records in 6 shards"), "{}", stdout(&output));
    assert!(crate::support::stderr(&output).contains("error: set: the data set is not complete"));
    workplace.succeeds(&["dataset", "plan.toml", "-o", "set", "--part", "2/2"]);
    workplace.succeeds(&["dataset", "verify", "set"]);
}

/// The program prints how many records have each warning of the column, since a warning may spoil all records.
#[test]
fn doubtful_records_are_counted() {
    let workplace = workplace();
    workplace.write("plan.toml", PLAN.replace("pinion_teeth = 20", "pinion_teeth = 14"));
    let said = crate::support::stderr(&workplace.succeeds(&["dataset", "plan.toml", "-o", "set", "-q"]));
    assert!(said.contains("warning: 96 records have the warning undercut: "), "{said}");
    // Those that are there already are not told of again.
    workplace.succeeds(&["dataset", "plan.toml", "-o", "set", "-q"]).stderr("");
}

#[test]
fn a_data_set_without_a_record_is_a_failure() {
    let workplace = workplace();
    // There is no mesh frequency at this rate.
    workplace.write("plan.toml", PLAN.replace("[keep]", "[keep]\nsampling_rate_hz = 100.0"));
    for _ in 0..2 {
        let output = workplace.command(&["dataset", "plan.toml", "-o", "set"]).assert().code(2).stdout("");
        let message = crate::support::stderr(&output);
        assert!(
            message.contains("error: none of the plan's 96 records could be simulated; record 0: "),
            "{message}"
        );
    }
}

/// The signal by which a program is asked to end leaves nothing unfinished; killed, it leaves what the next one removes.
#[cfg(unix)]
#[test]
fn nothing_unfinished_stays() {
    let workplace = workplace();
    let unfinished = || {
        let hidden = |name: &String| name.starts_with(".meshtone-");
        let folders = ["set", "set/data"].into_iter().filter(|folder| workplace.path(folder).exists());
        folders.flat_map(|folder| workplace.names(folder)).filter(hidden).count()
    };
    let end = |signal: &str, part: f64| {
        let mut child = program()
            .args(["dataset", "plan.toml", "-o", "set", "--jobs", "1"])
            .current_dir(workplace.directory.path())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        while unfinished() == 0 && child.try_wait().unwrap().is_none() {}
        std::thread::sleep(Duration::from_secs_f64(0.02 * part));
        let status = std::process::Command::new("kill").args([signal, &child.id().to_string()]).status();
        let running = status.unwrap().success();
        let ended = child.wait().unwrap();
        running && !ended.success()
    };
    let mut ended = 0;
    for number in 1..=12 {
        ended += usize::from(end("-TERM", (f64::from(number) * 0.618_033_988_749_895).fract()));
        assert_eq!(unfinished(), 0, "{number}");
    }
    assert!(ended > 0);
    std::fs::remove_dir_all(workplace.path("set")).unwrap();
    let mut left = 0;
    for number in 1..=12 {
        end("-KILL", (f64::from(number) * 0.618_033_988_749_895).fract());
        left += unfinished();
    }
    assert!(left > 0);
    workplace.succeeds(&["dataset", "plan.toml", "-o", "set"]);
    assert_eq!(unfinished(), 0);
    workplace.succeeds(&["dataset", "verify", "set"]);
}

/// Four programs that all want to make the same: one does, the others report it; nothing is lost. Four parts work side by side.
#[test]
fn several_at_once() {
    let workplace = workplace();
    workplace.succeeds(&["dataset", "plan.toml", "-o", "whole"]);
    let start = |to: &str, part: Option<u32>| {
        let mut command = program();
        command
            .args(["dataset", "plan.toml", "-o", to, "--jobs", "1"])
            .current_dir(workplace.directory.path());
        if let Some(part) = part {
            command.args(["--part", &format!("{part}/4")]);
        }
        command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
    };
    for round in 0..2 {
        let to = format!("same_{round}");
        let all: Vec<_> = (0..4).map(|_| start(&to, None)).collect();
        let mut made = 0;
        for child in all {
            let output = child.wait_with_output().unwrap();
            let message = String::from_utf8(output.stderr).unwrap();
            match output.status.code() {
                Some(0) => made += 1,
                Some(1) => {
                    assert!(message.contains("another program is making a data set in same_"), "{message}")
                }
                _ => panic!("{:?}: {message}", output.status),
            }
        }
        assert!(made > 0);
        assert_same(&workplace, "whole", &to);
        let to = format!("parts_{round}");
        let all: Vec<_> = (1..=4).map(|part| start(&to, Some(part))).collect();
        for child in all {
            let output = child.wait_with_output().unwrap();
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        }
        assert_same(&workplace, "whole", &to);
    }
}
