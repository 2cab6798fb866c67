//! What is damaged, lost or foreign does not pass.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use crate::support::{FAST, SHARDS, bytes, differing, plan, run};
use meshtone_dataset::DatasetError;
use meshtone_dataset::generate::{GenerateControl, Part, generate};
use meshtone_dataset::merge::merge;
use meshtone_dataset::store::Destination;
use meshtone_dataset::verify::{Check, Verified, verify};

/// A complete data set.
fn made() -> (tempfile::TempDir, Destination) {
    let directory = tempfile::tempdir().unwrap();
    let to = Destination::directory(directory.path());
    assert!(run(&plan(FAST), &to, Part::WHOLE, 2).unwrap().complete);
    (directory, to)
}

/// Turns over one bit of a file: multiples of the golden ratio leave no pattern.
fn flip(path: &Path, number: u32) {
    let mut content = fs::read(path).unwrap();
    let bit = ((f64::from(number) * 0.618_033_988_749_895).fract() * 8.0 * content.len() as f64) as usize;
    content[bit / 8] ^= 1 << (bit % 8);
    fs::write(path, content).unwrap();
}

fn bytes_of(place: &Destination) -> Verified {
    verify(place, Check::Bytes).unwrap()
}

#[track_caller]
fn assert_only(found: &Verified, name: &str, problem: &str) {
    assert_eq!((found.problems.len(), found.missing.len()), (1, 0), "{found:?}");
    assert!(found.problems.get(name).is_some_and(|text| text.contains(problem)), "{found:?}");
}

#[test]
fn every_flipped_bit_of_a_shard_is_found_and_the_shard_made_again() {
    let (directory, to) = made();
    let before = bytes(directory.path());
    assert!(bytes_of(&to).is_good());
    for number in 1..=30 {
        let name = SHARDS[number as usize % SHARDS.len()].to_owned();
        flip(&directory.path().join(&name), number);
        // Of a shard its metadata are always read.
        let quickly = verify(&to, Check::Sizes).unwrap();
        assert!(quickly.is_good() || quickly.problems.keys().eq([&name]), "{quickly:?}");
        assert_only(&bytes_of(&to), &name, "SHA-256 differs");
        if number % 6 == 0 {
            let again = run(&plan(FAST), &to, Part::WHOLE, 2).unwrap();
            assert_eq!((again.kept_shards, again.written_shards, again.complete), (8, 1, true), "{number}");
            assert_eq!(again.remade[0].file, name);
            assert!(again.remade[0].reason.contains("SHA-256 differs"));
        } else {
            fs::write(directory.path().join(&name), &before[&name]).unwrap();
        }
        assert_eq!(differing(&before, &bytes(directory.path())), [""; 0], "{number}");
    }
}

#[test]
fn every_flipped_bit_of_another_file_is_found() {
    let (directory, to) = made();
    for name in ["manifest.json", "README.md", "croissant.json", "preview.svg", "preview.png", "plan.toml"] {
        let path = directory.path().join(name);
        let before = fs::read(&path).unwrap();
        for number in 1..=20 {
            flip(&path, number);
            match verify(&to, Check::Bytes) {
                Ok(found) => assert!(found.problems.contains_key(name), "{name} {number}: {found:?}"),
                Err(error) => assert!(error.to_string().contains(name), "{name} {number}: {error}"),
            }
            fs::write(&path, &before).unwrap();
        }
    }
    assert!(bytes_of(&to).is_good());
}

#[test]
fn what_is_written_beside_the_shards_is_made_again() {
    let (directory, to) = made();
    let before = bytes(directory.path());
    for name in ["README.md", "croissant.json", "preview.svg", "preview.png", "plan.toml"] {
        fs::remove_file(directory.path().join(name)).unwrap();
        assert_only(&verify(&to, Check::Sizes).unwrap(), name, "it is missing");
        let again = run(&plan(FAST), &to, Part::WHOLE, 2).unwrap();
        assert_eq!((again.kept_shards, again.written_shards, again.complete), (9, 0, true));
        assert_eq!(differing(&before, &bytes(directory.path())), [""; 0], "{name}");
        flip(&directory.path().join(name), 5);
        let again = run(&plan(FAST), &to, Part::WHOLE, 2).unwrap();
        assert_eq!(again.remade.iter().map(|remade| &remade.file[..]).collect::<Vec<_>>(), [name]);
        assert_eq!(differing(&before, &bytes(directory.path())), [""; 0], "{name}");
    }
}

/// Also where what has changed says nothing of a shard.
#[test]
fn a_changed_manifest_is_made_again() {
    let (directory, to) = made();
    let before = bytes(directory.path());
    let path = directory.path().join("manifest.json");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.replacen("CC-BY-4.0", "CC-BY-4.1", 1)).unwrap();
    let again = run(&plan(FAST), &to, Part::WHOLE, 2).unwrap();
    assert_eq!(again.remade.iter().map(|remade| &remade.file[..]).collect::<Vec<_>>(), ["manifest.json"]);
    assert_eq!((again.kept_shards, again.written_shards), (9, 0));
    assert_eq!(differing(&before, &bytes(directory.path())), [""; 0]);
}

#[test]
fn names_and_sizes_are_always_looked_at() {
    let (directory, to) = made();
    let path = |name: &str| directory.path().join(name);
    let (first, extra) = (SHARDS[0], "data/train-000009.parquet");
    fs::copy(path(first), path(extra)).unwrap();
    assert_only(&verify(&to, Check::Sizes).unwrap(), extra, "the manifest does not name it");
    let refused = run(&plan(FAST), &to, Part::WHOLE, 1).unwrap_err();
    assert!(
        refused.to_string().contains("a shard that is none of this data set: data/train-000009"),
        "{refused}"
    );
    fs::remove_file(path(extra)).unwrap();

    let whole = fs::read(path(first)).unwrap();
    fs::write(path(first), &whole[1..]).unwrap();
    let problem = format!("it has {} bytes instead of {}", whole.len() - 1, whole.len());
    assert_only(&verify(&to, Check::Sizes).unwrap(), first, &problem);
    fs::remove_file(path(first)).unwrap();
    let found = verify(&to, Check::Sizes).unwrap();
    assert!(found.problems.is_empty() && found.missing == [first] && found.shards.len() == 8, "{found:?}");
}

#[test]
fn manifests_that_cannot_be_are_refused() {
    let (directory, to) = made();
    let path = directory.path().join("manifest.json");
    let text = fs::read_to_string(&path).unwrap();
    let with = |from: &str, into: &str| {
        assert!(text.contains(from), "{from}");
        fs::write(&path, text.replacen(from, into, 1)).unwrap();
    };
    with("\"format_version\": 5", "\"format_version\": 4");
    for refused in [
        verify(&to, Check::Sizes).unwrap_err(),
        run(&plan(FAST), &to, Part::WHOLE, 1).unwrap_err(),
        merge(std::slice::from_ref(&to), &to, Check::Sizes).unwrap_err(),
    ] {
        assert!(
            refused.to_string().contains("has the format 4; this version of Meshtone knows format 5"),
            "{refused}"
        );
        let DatasetError::Refused { help, .. } = refused else { unreachable!("{refused}") };
        assert!(help.contains("use version"), "{help}");
    }
    with("\"records\": 60", "\"records\": 61");
    assert!(!verify(&to, Check::Sizes).unwrap().is_good());
    with("\"rows\": 8", "\"rows\": \"8\"");
    assert!(
        verify(&to, Check::Sizes).unwrap_err().to_string().contains("is damaged, or not one of Meshtone")
    );
    fs::remove_file(&path).unwrap();
    assert!(verify(&to, Check::Sizes).unwrap_err().to_string().contains("is no data set"));
    let refused = run(&plan(FAST), &to, Part::WHOLE, 1).unwrap_err();
    assert!(refused.to_string().contains("but no manifest.json"), "{refused}");
}

/// Each shard proves itself: nothing else says what it holds as long as others are missing.
#[test]
fn a_part_is_verified_and_what_is_damaged_is_made_again() {
    let plan = plan(FAST);
    let directory = tempfile::tempdir().unwrap();
    let to = Destination::directory(directory.path());
    run(&plan, &to, Part { number: 1, of: 2 }, 2).unwrap();
    let found = bytes_of(&to);
    assert!(found.is_good() && !found.complete && found.shards.len() == 5, "{found:?}");
    let path = |name: &str| directory.path().join(name);
    let whole = fs::read(path(SHARDS[2])).unwrap();
    for number in 1..=16 {
        flip(&path(SHARDS[2]), number);
        assert!(bytes_of(&to).problems.contains_key(SHARDS[2]), "{number}");
        if number < 16 {
            fs::write(path(SHARDS[2]), &whole).unwrap();
        }
    }
    // Another one under its name is as it was written, and yet not what it should be.
    fs::copy(path(SHARDS[4]), path(SHARDS[0])).unwrap();
    let again = run(&plan, &to, Part { number: 1, of: 2 }, 2).unwrap();
    let reasons: Vec<(&str, &str)> =
        again.remade.iter().map(|remade| (&remade.file[..], &remade.reason[..])).collect();
    assert_eq!((again.kept_shards, reasons.len()), (3, 2), "{reasons:?}");
    assert!(reasons[0].0 == SHARDS[0] && reasons[0].1.contains("another shard"), "{reasons:?}");
    assert!(reasons[1].0 == SHARDS[2] && reasons[1].1.contains("SHA-256 differs"), "{reasons:?}");
    assert_eq!(fs::read(path(SHARDS[2])).unwrap(), whole);
    assert!(run(&plan, &to, Part { number: 2, of: 2 }, 2).unwrap().complete);
    assert!(bytes_of(&to).is_good());
}

/// `MESHTONE_SHARDS=10000 cargo test --release -p meshtone-tests --test dataset very_many -- --nocapture --ignored` prints times.
#[test]
#[ignore = "a measurement: cargo xtask measure"]
fn very_many_shards_are_scanned() {
    let count = std::env::var("MESHTONE_SHARDS").map_or(1000, |count| count.parse().unwrap());
    let keep = "channels = []\nindicators = false\npoints_per_revolution = 64\nrevolutions = 2\nrecords_per_shard = 1";
    let text =
        FAST.replace("records = 60", &format!("records = {count}")).replace("records_per_shard = 8", keep);
    let (plan, directory) = (plan(&text), tempfile::tempdir().unwrap());
    let to = Destination::directory(directory.path().join("set"));
    let seconds = |what: &str, work: &mut dyn FnMut()| {
        let start = std::time::Instant::now();
        work();
        println!("{what}: {:.1} s", start.elapsed().as_secs_f64());
    };
    seconds("made", &mut || assert!(run(&plan, &to, Part::WHOLE, 2).unwrap().complete));
    seconds("names, sizes and footers", &mut || assert!(verify(&to, Check::Sizes).unwrap().is_good()));
    seconds("every byte", &mut || assert!(bytes_of(&to).is_good()));
    seconds("merged in place: every footer", &mut || {
        assert_eq!(merge(std::slice::from_ref(&to), &to, Check::Sizes).unwrap().kept_shards, count);
    });
    fs::remove_file(to.path().unwrap().join("README.md")).unwrap();
    seconds("finished again: every byte, and the scan", &mut || {
        assert_eq!(run(&plan, &to, Part::WHOLE, 2).unwrap().kept_shards, count);
    });
}

#[test]
fn merging_takes_what_is_as_it_was_written() {
    let plan = plan(FAST);
    let directory = tempfile::tempdir().unwrap();
    let to = |name: &str| Destination::directory(directory.path().join(name));
    for (name, number) in [("a", 1), ("b", 2), ("c", 2)] {
        run(&plan, &to(name), Part { number, of: 2 }, 2).unwrap();
    }
    // One of two copies is damaged.
    flip(&directory.path().join("b/data/train-000003.parquet"), 11);
    let refused = merge(&[to("a"), to("b")], &to("merged"), Check::Sizes).unwrap_err();
    assert!(refused.to_string().contains("data/train-000003.parquet is damaged in"), "{refused}");
    let merged = merge(&[to("a"), to("b"), to("c")], &to("merged"), Check::Sizes).unwrap();
    // What the merge that failed has copied is kept, because its bytes are right.
    assert_eq!((merged.kept_shards, merged.written_shards), (3, 6));
    run(&plan, &to("whole"), Part::WHOLE, 2).unwrap();
    let [merged, whole] = ["merged", "whole"].map(|name| bytes(&directory.path().join(name)));
    assert_eq!(differing(&merged, &whole), [""; 0]);
    // In the whole's own place bytes are read where that is asked for.
    run(&plan, &to("b"), Part { number: 1, of: 2 }, 2).unwrap();
    flip(&directory.path().join("b/data/test-000005.parquet"), 12);
    let refused = merge(&[to("b")], &to("b"), Check::Bytes).unwrap_err();
    assert!(refused.to_string().contains("is damaged in"), "{refused}");
}

#[test]
fn another_generator_in_the_same_place_is_reported() {
    let plan = plan(FAST);
    let directory = tempfile::tempdir().unwrap();
    let to = Destination::directory(directory.path());
    let refusals = std::sync::Mutex::new(Vec::new());
    let progress = |done: u64, _: u64| {
        if done == 9 {
            // Another part may be made at the same time.
            assert!(!run(&plan, &to, Part { number: 1, of: 8 }, 1).unwrap().complete);
            refusals.lock().unwrap().push(run(&plan, &to, Part::WHOLE, 1).unwrap_err());
        }
    };
    let control = GenerateControl { progress: &progress, cancelled: &AtomicBool::new(false) };
    assert!(generate(&plan, &to, Part::WHOLE, &control).unwrap().complete);
    let refusals = refusals.into_inner().unwrap();
    assert!(matches!(refusals[..], [DatasetError::Busy { .. }]), "{refusals:?}");
    assert!(
        refusals[0].to_string().starts_with("another program is making a data set in "),
        "{}",
        refusals[0]
    );
    assert!(bytes_of(&to).is_good());
}

/// What only the signals show: at 100 S/s there is no mesh frequency.
#[test]
fn a_data_set_without_a_record_is_none() {
    let plan = plan(&FAST.replace("sampling_rate_hz = 8e3", "sampling_rate_hz = 100.0"));
    let directory = tempfile::tempdir().unwrap();
    let to = Destination::directory(directory.path());
    for _ in 0..2 {
        match run(&plan, &to, Part::WHOLE, 2) {
            Err(DatasetError::NoRecord { records: 60, first }) => {
                assert!(first.reason.contains("the sampling rate is too low"))
            }
            other => panic!("{other:?}"),
        }
    }
    assert!(!bytes_of(&to).complete);
}
