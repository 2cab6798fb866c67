//! The preview of a data set.

#![allow(clippy::unwrap_used)]

use crate::support::check;
use meshtone_plot::Figure;
use meshtone_plot::dataset::*;

/// Numbers from 0 to 1.
fn spread(i: usize, by: f64) -> f64 {
    (i as f64 * by).fract()
}

fn preview(classes: &[&str], keys: &[&str], records: usize) -> DatasetPreview {
    let texts = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<String>>();
    let example = |label: &&str| Example {
        label: (*label).to_owned(),
        conditions: "17/38 teeth, 31.9 Hz, 4.4 N m, severity 2".to_owned(),
        signal: (0..2048).map(|i| (i as f64 * 0.7).sin() * 300.0 * spread(i, 0.31)).collect(),
    };
    let key = |(k, name): (usize, &&str)| PreviewColumn {
        name: (*name).to_owned(),
        values: (0..records)
            .map(|i| if k == 3 { f64::NAN } else { 10f64.powf(2.0 * spread(i, 0.618 + k as f64)) })
            .collect(),
    };
    let indicator = |name: &&str| PreviewColumn {
        name: (*name).to_owned(),
        // One record is far away from all others.
        values: (0..records).map(|i| if i == 7 { 1e9 } else { 10f64.powf(2.0 * spread(i, 0.414)) }).collect(),
    };
    DatasetPreview {
        title: "Six faults of a gear".to_owned(),
        facts: format!("{records} records of 20 units, 3 shards"),
        classes: texts(classes),
        splits: texts(&["train", "validation", "test", "fast", "light", "other_teeth", "severe"]),
        signal_name: "difference_g".to_owned(),
        over_angle: true,
        examples: classes.iter().map(example).collect(),
        class_of: (0..records).map(|i| i % classes.len()).collect(),
        split_of: (0..records).map(|i| (spread(i, 0.77) * 7.0) as usize).collect(),
        keys: keys.iter().enumerate().map(key).collect(),
        indicators: ["average_rms_g", "difference_rms_g", "fm4", "energy_ratio"]
            .iter()
            .map(indicator)
            .collect(),
    }
}

fn drawn(preview: &DatasetPreview) -> Figure {
    let figure = dataset_figure(preview);
    check(&figure, LARGEST);
    figure
}

fn has(figure: &Figure, text: &str) -> bool {
    figure.labels().iter().any(|label| label.text == text)
}

const CLASSES: [&str; 6] =
    ["healthy", "tooth-breakage", "missing-tooth", "partial-face", "through-face", "tooth-destruction"];

/// (bytes) Largest SVG of a preview.
const LARGEST: usize = 1_000_000;

#[test]
fn everything_has_its_place() {
    let keys = ["pinion_speed_hz", "brake_torque_nm", "module_mm", "fault_chip_height_mm"];
    let figure = drawn(&preview(&CLASSES, &keys, 500));
    for text in [
        "Six faults of a gear",
        "healthy",
        "pinion_speed_hz",
        "fm4",
        "train",
        "severe",
        "Shaft angle from the mark (rev)",
    ] {
        assert!(has(&figure, text), "{text}");
    }
    // A key that no record has is left out; the record that is far away does not stretch the axis.
    assert!(!has(&figure, "fault_chip_height_mm"));
    assert!(!figure.labels().iter().any(|label| label.text.contains("1.00e")));
    assert_eq!(&figure.png().unwrap()[1..4], b"PNG");
}

#[test]
fn many_classes_and_keys_and_none() {
    let many: Vec<String> = (0..14).map(|i| format!("a_class_with_a_long_name_{i}")).collect();
    let many: Vec<&str> = many.iter().map(String::as_str).collect();
    let figure = drawn(&preview(&many, &many, 100));
    assert!(has(&figure, "and 5 more classes") && has(&figure, "and 2 more keys"));
    drawn(&preview(&["healthy"], &[], 1));
    drawn(&DatasetPreview::default());
}
