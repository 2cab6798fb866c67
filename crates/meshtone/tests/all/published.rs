//! The published model's outputs, stage by stage, for nine scenarios (see `tests/published/README.md`).
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout)]

use crate::published_model::{Reference, for_each_scenario, reference, scenario};
use meshtone::published::machine::coordinates::*;
use meshtone::trace_at;
use ndarray::ArrayD;

/// How a field is compared. Quantities of different units are never compared with one scale.
#[derive(Debug, Clone, Copy)]
enum Measure {
    Equal,
    /// Largest difference over largest value: fields of one unit.
    Largest(f64),
    /// Every value's difference over the value.
    Each(f64),
    /// Matrices in the 13 coordinates: the difference of entry (r, c) over the root of both diagonal entries.
    Matrix(f64),
    /// Rms over time of the difference over the rms, for each of the 13 coordinates.
    Coordinates(f64, Beside),
}

/// What is taken off a coordinate's reference before its rms is the scale: 480 rad turned, or the speed at which it turns,
/// are no measure for what a shaft does beside turning.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Beside {
    Nothing,
    Mean,
    /// The rigid rotation at the nominal speed.
    Rotation,
}

/// The published average and what follows from it, which `signal_published.rs` compares, and the computing time.
const NOT_COMPARED: [&str; 4] = ["synchronous_average_g", "difference_g", "order_amplitude_g", "elapsed_s"];

fn measure(field: &str, partial_face: bool) -> Measure {
    let stiffness = field.starts_with("pair_stiffness") || field.starts_with("mesh_stiffness");
    let motion = |beside| Measure::Coordinates(if partial_face { 1e-5 } else { 1e-6 }, beside);
    match field {
        "first_kept_sample" | "kept_samples" | "pinion_revolutions" | "fault_indices" => Measure::Equal,
        _ if field.ends_with("_index") || field.ends_with("_len") => Measure::Equal,
        _ if field.starts_with("acceleration") => motion(Beside::Nothing),
        _ if field.starts_with("velocity") => motion(Beside::Mean),
        _ if field.starts_with("displacement") => motion(Beside::Rotation),
        "rms_g_horizontal_vertical_axial" => Measure::Largest(if partial_face { 1e-5 } else { 1e-6 }),
        "force_first_200" | "force_kept_first_500" => Measure::Coordinates(1e-6, Beside::Nothing),
        "mass_diagonal" | "natural_frequencies_hz" | "shaft_stiffness_nm_per_rad" => Measure::Each(1e-8),
        _ if field == "damping_matrix" || field.starts_with("stiffness_matrix") => {
            Measure::Matrix(if partial_face { 1e-7 } else { 1e-8 })
        }
        _ if stiffness || field.starts_with("fault_") || field.contains("force") => Measure::Largest(1e-6),
        _ => Measure::Largest(1e-8),
    }
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |largest: f64, value| largest.max(value.abs()))
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt()
}

/// Angle of coordinate `n` in the rigid rotation at the nominal speed, at the first of `samples` samples of a field, and
/// what it turns in one.
fn rigid_rotation(field: &str, n: usize, samples: usize, reference: &Reference) -> [f64; 2] {
    let number = |key: &str| reference[key].first().copied().unwrap();
    // Whole revolutions: 2 z_g of the pinion, 2 z_p of the gear.
    let all = number("first_kept_sample") + number("kept_samples");
    let (pinion, gear) = (reference["pinion_radii_mm"][[0]], reference["gear_radii_mm"][[0]]);
    let revolutions = number("pinion_revolutions");
    let share = match n {
        THETA_PINION => 1.0,
        THETA_GEAR | THETA_BRAKE => -pinion / gear,
        _ => 0.0,
    };
    let step = std::f64::consts::TAU * revolutions * share / all;
    let first = if field.contains("last") { all - samples as f64 } else { number("first_kept_sample") };
    [first * step, step]
}

/// A coordinate's values less what is no measure for its vibration.
fn without(beside: Beside, values: &[f64], rotation: [f64; 2]) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let part = |i: usize| match beside {
        Beside::Nothing => 0.0,
        Beside::Mean => mean,
        Beside::Rotation => rotation[0] + rotation[1] * i as f64,
    };
    values.iter().enumerate().map(|(i, v)| v - part(i)).collect()
}

/// Values of each of the 13 coordinates: from 13 numbers, 13 × samples or samples × 13.
fn by_coordinate(values: &[f64], shape: &[usize]) -> Vec<Vec<f64>> {
    let across = shape.len() == 2 && shape[1] == COORDINATES;
    assert!(across || shape[0] == COORDINATES, "{shape:?}");
    let samples = values.len() / COORDINATES;
    let at = |n: usize, i: usize| if across { i * COORDINATES + n } else { n * samples + i };
    (0..COORDINATES).map(|n| (0..samples).map(|i| values[at(n, i)]).collect()).collect()
}

/// What a unit of each coordinate is at the gear's pitch circle: metres for angles, newtons for moments.
fn at_the_pitch_circle(reference: &Reference, force: bool) -> [f64; COORDINATES] {
    let radius_m = reference["gear_radii_mm"][[0]] * 1e-3;
    std::array::from_fn(|n| match n {
        X_GEAR | Y_GEAR | X_PINION | Y_PINION | Z_GEAR | Z_PINION => 1.0,
        _ if force => 1.0 / radius_m,
        _ => radius_m,
    })
}

fn coordinates_difference(
    field: &str,
    beside: Beside,
    ours: &[f64],
    theirs: &ArrayD<f64>,
    reference: &Reference,
) -> f64 {
    let ours = by_coordinate(ours, theirs.shape());
    let flat: Vec<f64> = theirs.iter().copied().collect();
    let theirs = by_coordinate(&flat, theirs.shape());
    // Means beside zero: how much the coordinate moves is their scale.
    let scaling = if field == "velocity_mean" { "velocity" } else { field };
    let flat: Vec<f64> = reference[scaling].iter().copied().collect();
    let scales: Vec<f64> = by_coordinate(&flat, reference[scaling].shape())
        .iter()
        .enumerate()
        .map(|(n, v)| rms(&without(beside, v, rigid_rotation(field, n, v.len(), reference))))
        .collect();
    let unit = at_the_pitch_circle(reference, field.starts_with("force"));
    let most = largest((0..COORDINATES).map(|n| scales[n] * unit[n]));
    (0..COORDINATES)
        .map(|n| {
            let difference: Vec<f64> = ours[n].iter().zip(&theirs[n]).map(|(a, b)| a - b).collect();
            // A coordinate at rest has nothing to be compared with but the largest of the others, at the pitch circle.
            let at_rest = scales[n] * unit[n] < 1e-9 * most;
            rms(&difference) / if at_rest { most / unit[n] } else { scales[n] }
        })
        .fold(0.0, f64::max)
}

fn difference(
    field: &str,
    measure: Measure,
    ours: &[f64],
    theirs: &ArrayD<f64>,
    reference: &Reference,
) -> f64 {
    let flat: Vec<f64> = theirs.iter().copied().collect();
    let pairs = || ours.iter().zip(&flat).map(|(a, b)| a - b);
    match measure {
        Measure::Equal | Measure::Largest(_) => {
            let scale = largest(flat.iter().copied());
            largest(pairs()) / if scale > 0.0 { scale } else { 1.0 }
        }
        Measure::Each(_) => largest(pairs().zip(&flat).map(|(difference, theirs)| difference / theirs)),
        Measure::Matrix(_) => {
            let root = |entry: usize| {
                let diagonal = |n: usize| theirs[[n, n]];
                (diagonal(entry / COORDINATES) * diagonal(entry % COORDINATES)).sqrt()
            };
            largest(pairs().enumerate().map(|(entry, difference)| difference / root(entry)))
        }
        Measure::Coordinates(_, beside) => coordinates_difference(field, beside, ours, theirs, reference),
    }
}

fn check(name: &str) {
    let reference = reference(name);
    let rate_hz = reference["sa_rate_in_hz"].sum();
    let (_, trace) = trace_at(scenario(name, &reference), rate_hz).unwrap();
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
            Measure::Largest(limit)
            | Measure::Each(limit)
            | Measure::Matrix(limit)
            | Measure::Coordinates(limit, _) => limit,
        };
        let difference = difference(field, measure, &ours.values, theirs, &reference);
        println!("{name} {field}: {difference:.1e} of {limit:.0e}");
        if difference.is_nan() || difference > limit {
            failures.push(format!("{field}: {difference:.3e} > {limit:.0e}"));
        }
    }
    assert!(failures.is_empty(), "{name}:\n{}", failures.join("\n"));
}

for_each_scenario!(check);
