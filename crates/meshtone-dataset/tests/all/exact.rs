//! A data set has the same bytes however it was made.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::fs;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use crate::support::{FAST, SHARDS, bytes, differing, plan, run};
use meshtone_dataset::DatasetError;
use meshtone_dataset::generate::{GenerateControl, Part, generate};
use meshtone_dataset::merge::merge;
use meshtone_dataset::store::Destination;
use meshtone_dataset::verify::Check;

#[test]
fn jobs_and_parts_do_not_show() {
    let plan = plan(FAST);
    let directory = tempfile::tempdir().unwrap();
    let place = |name: &str| directory.path().join(name);
    let to = |name: &str| Destination::directory(place(name));
    assert!(run(&plan, &to("one"), Part::WHOLE, 1).unwrap().complete);
    let whole = bytes(&place("one"));
    assert_eq!(whole.keys().filter(|name| name.starts_with("data/")).count(), SHARDS.len());

    assert!(run(&plan, &to("three"), Part::WHOLE, 3).unwrap().complete);
    assert_eq!(differing(&whole, &bytes(&place("three"))), [""; 0]);

    // Apart, and merged.
    let parts: Vec<Destination> = (1..=3).map(|number| to(&format!("part_{number}"))).collect();
    for (number, part) in (1..).zip(&parts) {
        let generated = run(&plan, part, Part { number, of: 3 }, 2).unwrap();
        assert!(!generated.complete && generated.written_shards >= 2);
    }
    let refused = merge(&parts[..2], &to("merged"), Check::Sizes).unwrap_err();
    assert!(refused.to_string().contains("3 of 9 shards are in none of the parts"), "{refused}");
    assert!(!place("merged").exists());
    assert!(merge(&parts, &to("merged"), Check::Sizes).unwrap().complete);
    assert_eq!(differing(&whole, &bytes(&place("merged"))), [""; 0]);

    // In one directory, the last of them completes it.
    for number in [2, 1, 3] {
        let complete = run(&plan, &to("together"), Part { number, of: 3 }, 2).unwrap().complete;
        assert_eq!(complete, number == 3);
    }
    assert_eq!(differing(&whole, &bytes(&place("together"))), [""; 0]);

    // Once more there is nothing to do.
    let again = run(&plan, &to("one"), Part::WHOLE, 2).unwrap();
    assert_eq!((again.kept_shards, again.written_shards, again.complete), (9, 0, true));
}

#[test]
fn stopped_damaged_and_gone_on_with() {
    let plan = plan(FAST);
    let directory = tempfile::tempdir().unwrap();
    let [whole, stopped] = ["whole", "stopped"].map(|name| directory.path().join(name));
    run(&plan, &Destination::directory(&whole), Part::WHOLE, 2).unwrap();
    let to = Destination::directory(&stopped);
    for after in [1, 20, 21, 40] {
        let (cancelled, done) = (AtomicBool::new(false), AtomicU64::new(0));
        let progress = |_: u64, _: u64| {
            if done.fetch_add(1, Ordering::Relaxed) + 1 == after {
                cancelled.store(true, Ordering::Relaxed);
            }
        };
        let control = GenerateControl { progress: &progress, cancelled: &cancelled };
        let result = generate(&plan, &to, Part::WHOLE, &control);
        assert!(matches!(result, Err(DatasetError::Stopped)) || after == 40, "{result:?}");
    }
    // A shard that is no whole file, and what a killed run leaves.
    fs::write(
        stopped.join("data/train-000001.parquet"),
        &fs::read(whole.join("data/train-000001.parquet")).unwrap()[..99],
    )
    .unwrap();
    fs::write(stopped.join("data/.meshtone-unfinished"), "half a shard").unwrap();
    fs::remove_file(stopped.join("README.md")).ok();
    // The manifest still says that all is there, which it is not.
    assert!(run(&plan, &to, Part::WHOLE, 2).unwrap().complete);
    assert_eq!(differing(&bytes(&whole), &bytes(&stopped)), [""; 0]);
}

#[test]
fn other_plans_and_other_files_are_refused() {
    let directory = tempfile::tempdir().unwrap();
    let to = Destination::directory(directory.path().join("set"));
    run(&plan(FAST), &to, Part { number: 1, of: 8 }, 1).unwrap();
    let before = bytes(&directory.path().join("set"));
    // Layout, comments and words for the data card change nothing.
    let words = format!("title = \"Gears\" # a title\n{FAST}");
    run(&plan(&words), &to, Part { number: 1, of: 8 }, 1).unwrap();
    for (from, into) in
        [("seed = 3", "seed = 4"), ("uniform = [30.0, 60.0]", "uniform = [30.0, 61.0]"), ("8e3", "9e3")]
    {
        let refused = run(&plan(&FAST.replace(from, into)), &to, Part::WHOLE, 1).unwrap_err();
        assert!(refused.to_string().contains("begun with another plan"), "{refused}");
    }
    let after = bytes(&directory.path().join("set"));
    assert_eq!(differing(&before, &after), ["manifest.json", "plan.toml"]);

    let other = directory.path().join("other");
    fs::create_dir(&other).unwrap();
    fs::write(other.join("thesis.tex"), "").unwrap();
    let refused = run(&plan(FAST), &Destination::directory(&other), Part::WHOLE, 1).unwrap_err();
    assert!(refused.to_string().contains("has another file in it: thesis.tex"), "{refused}");
    assert_eq!(bytes_of_names(&other), ["thesis.tex"]);
}

fn bytes_of_names(directory: &std::path::Path) -> Vec<String> {
    fs::read_dir(directory)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .collect()
}

#[test]
fn records_that_fail_are_listed_and_the_rest_is_made() {
    // Some chips are wider than the face, some pits no circle of the flank.
    let text = FAST.replace("uniform = [1.0, 5.0]", "uniform = [5.0, 7.5]");
    let plan = plan(&text);
    let directory = tempfile::tempdir().unwrap();
    let to = Destination::directory(directory.path().join("set"));
    let generated = run(&plan, &to, Part::WHOLE, 2).unwrap();
    assert!(generated.complete);
    let failed = &generated.failures;
    assert!(!failed.is_empty() && failed.len() < 20, "{}", failed.len());
    assert!(failed.iter().all(|failed| failed.reason.contains("fault.chip_height_mm")), "{failed:?}");
    let manifest = fs::read_to_string(directory.path().join("set/manifest.json")).unwrap();
    let manifest: serde_json::Value = serde_json::from_str(&manifest).unwrap();
    assert_eq!(manifest["failures"].as_array().unwrap().len(), failed.len());
    let rows: u64 =
        manifest["files"].as_array().unwrap().iter().map(|file| file["rows"].as_u64().unwrap()).sum();
    assert_eq!(rows + failed.len() as u64, 60);
    // The same when it is gone on with.
    let again = Destination::directory(directory.path().join("again"));
    run(&plan, &again, Part { number: 2, of: 2 }, 1).unwrap();
    run(&plan, &again, Part::WHOLE, 2).unwrap();
    let [set, again] = ["set", "again"].map(|name| bytes(&directory.path().join(name)));
    assert_eq!(differing(&set, &again), [""; 0]);
}
