//! The published model's outputs, stage by stage, for nine scenarios (see `published/README.md`).
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout)]

use std::collections::HashMap;
use std::fs::File;
use std::path::PathBuf;

use meshtone::scenario::*;
use meshtone::trace;
use nalgebra::DMatrix;
use ndarray::{ArrayD, IxDyn};
use ndarray_npy::NpzReader;

type Reference = HashMap<String, ArrayD<f64>>;

fn reference(name: &str) -> Reference {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/published").join(format!("{name}.npz"));
    let mut npz = NpzReader::new(File::open(path).unwrap()).unwrap();
    let names = npz.names().unwrap();
    names
        .into_iter()
        .map(|entry| {
            let values = npz
                .by_name::<ndarray::OwnedRepr<f64>, IxDyn>(&entry)
                .or_else(|_| npz.by_name::<ndarray::OwnedRepr<f32>, IxDyn>(&entry).map(|a| a.mapv(f64::from)))
                .or_else(|_| {
                    npz.by_name::<ndarray::OwnedRepr<i64>, IxDyn>(&entry).map(|a| a.mapv(|v| v as f64))
                })
                .unwrap();
            (entry.trim_end_matches(".npy").to_owned(), values)
        })
        .collect()
}

fn scenario(name: &str, reference: &Reference) -> Scenario {
    let mut scenario = if name.starts_with("destruction") {
        Scenario::new(3.0, 18, 35, 30.0, 45.0, 15.0)
    } else {
        Scenario::new(3.0, 17, 38, 15.0, 40.0, 10.0)
    };
    scenario.convention = Convention::Published;
    if name.ends_with("din7") {
        let matrix = |key: &str| {
            let values = &reference[key];
            DMatrix::from_fn(values.shape()[0], values.shape()[1], |r, c| values[[r, c]])
        };
        scenario.quality.profile_errors = Some(ProfileErrors {
            pinion_profile_errors_mm: matrix("pinion_profile_errors_mm"),
            gear_profile_errors_mm: matrix("gear_profile_errors_mm"),
        });
    }
    let pit = PitCircle::Fractions { start: 0.2, end: 0.8, depth: 0.5 };
    let destruction = |start, line| ToothDestruction { start, line, offset_mm: 0.0, noise_mm: 0.0 };
    scenario.fault = match name {
        "missing_din0" => Some(Fault::MissingTooth),
        "breakage_din7" => Some(Fault::ToothBreakage(ToothBreakage {
            chip_height_mm: 5.0,
            chip_width_mm: 12.0,
            tip_loss_mm: 3.0,
        })),
        "partial_din0" => Some(Fault::PartialFace(PartialFace { width_mm: 2.0, pit })),
        "through_din0" => Some(Fault::ThroughFace(ThroughFace { pit })),
        "through_circ_din7" => Some(Fault::ThroughFace(ThroughFace {
            pit: PitCircle::Circle { x_mm: 57.5, y_mm: 3.66, radius_mm: 2.5 },
        })),
        "destruction_din0" => {
            Some(Fault::ToothDestruction(destruction(3.0 / 14.0, DestructionLine::End(13.0 / 14.0))))
        }
        "destruction_slope_din0" => {
            Some(Fault::ToothDestruction(destruction(0.2, DestructionLine::SlopeDeg(22.0))))
        }
        _ => None,
    };
    scenario
}

/// How a field is compared.
#[derive(Debug, Clone, Copy)]
enum Measure {
    Equal,
    /// Largest difference over largest value.
    Largest(f64),
    /// Rms of the difference over rms, column by column (each moving coordinate).
    RmsOfColumns(f64),
}

/// Fields of signal processing, whose published resampler differs, and the published computing time.
const NOT_THE_MODELS: [&str; 5] =
    ["synchronous_average_g", "difference_g", "order_amplitude_g", "sa_rate_in_hz", "elapsed_s"];

fn measure(field: &str, partial_face: bool) -> Measure {
    let stiffness = field.starts_with("pair_stiffness") || field.starts_with("mesh_stiffness");
    match field {
        "first_kept_sample" | "kept_samples" | "pinion_revolutions" | "fault_indices" => Measure::Equal,
        _ if field.ends_with("_index") || field.ends_with("_len") => Measure::Equal,
        _ if field.starts_with("acceleration")
            || field.starts_with("velocity")
            || field.starts_with("displacement") =>
        {
            Measure::RmsOfColumns(if partial_face { 1e-5 } else { 1e-6 })
        }
        "rms_g_horizontal_vertical_axial" => Measure::Largest(if partial_face { 1e-5 } else { 1e-6 }),
        _ if stiffness || field.starts_with("fault_") || field.contains("force") => Measure::Largest(1e-6),
        _ => Measure::Largest(1e-8),
    }
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |largest: f64, value| largest.max(value.abs()))
}

fn difference(measure: Measure, ours: &[f64], theirs: &ArrayD<f64>) -> f64 {
    let theirs: Vec<f64> = theirs.iter().copied().collect();
    let pairs = || ours.iter().zip(&theirs).map(|(a, b)| a - b);
    match measure {
        Measure::Equal | Measure::Largest(_) => {
            let scale = largest(theirs.iter().copied());
            largest(pairs()) / if scale > 0.0 { scale } else { 1.0 }
        }
        Measure::RmsOfColumns(_) => {
            let columns = 13;
            let all = largest(theirs.iter().copied());
            let rms = |values: &mut dyn Iterator<Item = f64>| values.map(|v| v * v).sum::<f64>().sqrt();
            (0..columns)
                .map(|c| {
                    let differences: Vec<f64> = pairs().collect();
                    let scale = rms(&mut theirs.iter().skip(c).step_by(columns).copied());
                    let difference = rms(&mut differences.iter().skip(c).step_by(columns).copied());
                    // A coordinate at rest has no rms to compare with, only rounding.
                    if scale > 1e-9 * all { difference / scale } else { difference / all }
                })
                .fold(0.0, f64::max)
        }
    }
}

fn check(name: &str) {
    let reference = reference(name);
    let (_, trace) = trace(&scenario(name, &reference)).unwrap();
    let mut failures = Vec::new();
    let mut fields: Vec<&String> = reference.keys().collect();
    fields.sort();
    for field in fields {
        if NOT_THE_MODELS.contains(&field.as_str()) {
            continue;
        }
        let theirs = &reference[field];
        let Some(ours) = trace.get(field) else {
            failures.push(format!("{field}: missing"));
            continue;
        };
        if ours.values.len() != theirs.len() {
            failures.push(format!("{field}: shape {:?}, not {:?}", ours.shape, theirs.shape()));
            continue;
        }
        let measure = measure(field, name.starts_with("partial"));
        let limit = match measure {
            Measure::Equal => 0.0,
            Measure::Largest(limit) | Measure::RmsOfColumns(limit) => limit,
        };
        let difference = difference(measure, &ours.values, theirs);
        println!("{name} {field}: {difference:.2e}");
        if difference.is_nan() || difference > limit {
            failures.push(format!("{field}: {difference:.3e} > {limit:.0e}"));
        }
    }
    assert!(failures.is_empty(), "{name}:\n{}", failures.join("\n"));
}

macro_rules! scenarios {
    ($($name:ident),*) => {$(
        #[test]
        fn $name() {
            check(stringify!($name));
        }
    )*};
}

scenarios!(
    healthy_din0,
    healthy_din7,
    missing_din0,
    breakage_din7,
    partial_din0,
    through_din0,
    through_circ_din7,
    destruction_din0,
    destruction_slope_din0
);
