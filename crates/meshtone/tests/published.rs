//! The published model's outputs, stage by stage, for nine scenarios (see `published/README.md`).
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout)]

mod published_model;

use meshtone::trace_at;
use ndarray::ArrayD;
use published_model::{reference, scenario};

/// How a field is compared.
#[derive(Debug, Clone, Copy)]
enum Measure {
    Equal,
    /// Largest difference over largest value.
    Largest(f64),
    /// Rms of the difference over rms, column by column (each moving coordinate).
    RmsOfColumns(f64),
}

/// The published average and what follows from it, which `signal_published.rs` compares, and the computing time.
const NOT_COMPARED: [&str; 4] = ["synchronous_average_g", "difference_g", "order_amplitude_g", "elapsed_s"];

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
    let rate_hz = reference["sa_rate_in_hz"].sum();
    let (_, trace) = trace_at(&scenario(name, &reference), rate_hz).unwrap();
    let mut failures = Vec::new();
    let mut fields: Vec<&String> = reference.keys().collect();
    fields.sort();
    for field in fields {
        let theirs = &reference[field];
        let Some(ours) = trace.get(field) else {
            failures.push(format!("{field}: missing"));
            continue;
        };
        if ours.values.len() != theirs.len() {
            failures.push(format!("{field}: shape {:?}, not {:?}", ours.shape, theirs.shape()));
            continue;
        }
        if NOT_COMPARED.contains(&field.as_str()) {
            assert!(ours.values.iter().all(|value| value.is_finite()), "{field}");
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
