//! Load that is carried by a part of the face: the time loop lets a pair act at the middle of what bears; here, in a solver of its
//! own, every slice of the face of every pair touches or does not, with the wheels' tilt.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use crate::physics::*;
use meshtone::machine::coordinates::{COORDINATES_WITH_SUPPORTS, Y_GEAR_SUPPORT, Y_PINION_SUPPORT};
use meshtone::mesh::ContactMesh;
use meshtone::scenario::*;
use meshtone::{Stages, simulate};
use nalgebra::{DVector, Matrix2, Vector2};

/// Slices of the face width.
const SLICES: usize = 15;
/// Pairs that can touch at once.
const PAIRS: i64 = 3;

/// A slice of a pair at one instant.
struct Slice {
    stiffness: f64,
    /// (m) Along the face.
    z: f64,
    separation: f64,
}

/// The slices that carry, of all pairs at a sample. The stiffness of what is left of a pair's face is spread over it.
fn slices(mesh: &ContactMesh, width_m: f64, sample: usize) -> Vec<Slice> {
    let point = sample + mesh.points_before;
    let (latest, since) = ((point / mesh.points_per_pitch) as i64, point % mesh.points_per_pitch);
    let mut all = Vec::new();
    for age in 0..PAIRS {
        let class = mesh.sequence.class(latest - age);
        let Some(state) = mesh.classes[class].states.get(since + age as usize * mesh.points_per_pitch) else {
            continue;
        };
        if state.stiffness_n_per_m == 0.0 {
            continue;
        }
        // The load's middle tells how much is missing from the end at positive z.
        let left = width_m + 2.0 * state.face_centre_m;
        for n in 0..SLICES {
            let z = -width_m / 2.0 + left * (n as f64 + 0.5) / SLICES as f64;
            all.push(Slice {
                stiffness: state.stiffness_n_per_m / SLICES as f64,
                z,
                separation: state.separation_m,
            });
        }
    }
    all
}

/// (m/s²) Mean vertical acceleration of both supports.
fn by_slices(stages: &Stages, samples: usize) -> Vec<f64> {
    let structure = stages.structure.as_ref().unwrap();
    let mesh = stages.mesh.contact().unwrap();
    let model = stages.reduced_model();
    let width_m = stages.teeth.gear.face_width_mm * 1e-3;
    let (n, h) = (COORDINATES_WITH_SUPPORTS, stages.time.step_s() / 2.0);
    let omega2 = DVector::from_fn(n, |m, _| structure.angular_frequencies[m].powi(2));
    let damping = DVector::from_fn(n, |m, _| structure.modal_damping(m));
    let lines = structure.line_of_action.each_ref().map(|line| structure.shapes.transpose() * line);
    let e = DVector::from_fn(n, |m, _| 1.0 / (1.0 + h * damping[m] + h * h * omega2[m]));
    let tau = mesh.damping_time_s;
    let lead = 1.0 + tau / h;
    let gamma =
        Matrix2::from_fn(|r, c| lead * h * h * (0..n).map(|m| lines[r][m] * e[m] * lines[c][m]).sum::<f64>());
    let force = model.static_mesh_force_n;
    let torque = stages.scenario.operation.brake_torque_nm;
    let brake = structure.shapes.row(meshtone::machine::coordinates::THETA_BRAKE).transpose() * torque;
    let steady = DVector::from_fn(n, |m, _| {
        if omega2[m] == 0.0 { 0.0 } else { (brake[m] - lines[0][m] * force) / omega2[m] }
    });
    let of_static = Vector2::new(lines[0].dot(&steady), lines[1].dot(&steady));
    let row = DVector::from_fn(n, |m, _| {
        let mean = |coordinate| (structure.turn.row(coordinate) * structure.shapes.column(m))[0];
        0.5 * (mean(Y_GEAR_SUPPORT) + mean(Y_PINION_SUPPORT))
    });
    let solve = |all: &[Slice], rates: &[f64], free: Vector2<f64>| -> Vector2<f64> {
        let offset = |i: usize| -all[i].separation + tau * rates[i];
        let load = free + gamma * Vector2::new(force, 0.0);
        let mut touching = vec![true; all.len()];
        let mut forces = Vector2::<f64>::zeros();
        for _ in 0..60 {
            let (mut stiffness, mut constant) = (Matrix2::<f64>::zeros(), Vector2::<f64>::zeros());
            for (i, slice) in all.iter().enumerate().filter(|(i, _)| touching[*i]) {
                let arm = Vector2::new(1.0, slice.z);
                stiffness += arm * arm.transpose() * slice.stiffness;
                constant += arm * slice.stiffness * offset(i);
            }
            let deflection =
                (Matrix2::identity() + gamma * stiffness).try_inverse().unwrap() * (load - gamma * constant);
            forces = stiffness * deflection + constant;
            let now: Vec<bool> =
                (0..all.len()).map(|i| deflection[0] + all[i].z * deflection[1] + offset(i) > 0.0).collect();
            if now == touching {
                break;
            }
            touching = now;
        }
        Vector2::new(force - forces[0], -forces[1])
    };
    let (mut q, mut s) = (DVector::<f64>::zeros(n), DVector::<f64>::zeros(n));
    let first = slices(mesh, width_m, 0);
    let (stiffness, offsets) = first
        .iter()
        .filter(|slice| slice.separation < 1e-7)
        .fold((0.0, 0.0), |(k, o), slice| (k + slice.stiffness, o - slice.stiffness * slice.separation));
    q[0] = ((force - offsets) / stiffness - of_static[0]) / lines[0][0];
    let mut w = Vector2::<f64>::zeros();
    let mut before: Vec<f64> = Vec::new();
    let mut output = Vec::with_capacity(samples);
    for sample in 0..samples {
        let modal = &lines[0] * w[0] + &lines[1] * w[1];
        let acceleration = DVector::from_fn(n, |m, _| modal[m] - omega2[m] * q[m] - damping[m] * s[m] / h);
        output.push(row.dot(&acceleration));
        let all = slices(mesh, width_m, sample + 1);
        let separations =
            |slices: &[Slice]| -> Vec<f64> { slices.iter().map(|slice| slice.separation).collect() };
        let (now, after) = (separations(&all), separations(&slices(mesh, width_m, sample + 2)));
        let same = now.len() == before.len() && now.len() == after.len();
        // Central differences, over two steps of 2 h.
        let rates: Vec<f64> =
            (0..now.len()).map(|i| if same { (before[i] - after[i]) / (4.0 * h) } else { 0.0 }).collect();
        before = now;
        let change = DVector::from_fn(n, |m, _| {
            e[m] * (2.0 * s[m] - 2.0 * h * h * omega2[m] * q[m] + h * h * modal[m])
        });
        let free = Vector2::from_fn(|r, _| {
            let ahead = &q + &change + (&change - &s) * (tau / h);
            of_static[r] + lines[r].dot(&ahead)
        });
        let next = solve(&all, &rates, free);
        let pushed = &lines[0] * next[0] + &lines[1] * next[1];
        let change = DVector::from_fn(n, |m, _| change[m] + h * h * e[m] * pushed[m]);
        q += &change;
        s = change - s;
        w = next;
    }
    output
}

// A pit over a part of the face, and a broken corner: the mean of what bears suffices.
#[test]
fn the_middle_of_what_bears_acts_as_its_slices_do() {
    let pit = PitCircle::Fractions { start: 0.3, end: 0.7, depth: 0.5 };
    let damages: [(&str, Damage); 3] = [
        ("pit over 5 of 15 mm", PartialFace { width_mm: 5.0, pit }.into()),
        ("pit over 10 of 15 mm", PartialFace { width_mm: 10.0, pit }.into()),
        (
            "corner of 5 x 12 mm",
            ToothBreakage { chip_height_mm: 5.0, chip_width_mm: 12.0, tip_loss_mm: 2.0 }.into(),
        ),
    ];
    for (name, damage) in damages {
        let mut scenario = Scenario::new(GearPair {
            module_mm: 3.0,
            pinion_teeth: 17,
            gear_teeth: 38,
            face_width_mm: 15.0,
            pinion_speed_hz: 40.0,
            brake_torque_nm: 10.0,
        });
        scenario.model = Model::Contact;
        scenario.solver.settle_fraction = 0.0;
        scenario.faults = vec![Fault::on_first_gear_tooth(damage)];
        let simulation = simulate(&scenario).unwrap();
        let samples = 3 * simulation.stages.time.samples_per_pinion_revolution;
        let mean: Vec<f64> = simulation.channels.vertical_g[..samples].iter().map(|g| g * 9.81).collect();
        let sliced = by_slices(&simulation.stages, samples);
        let difference: Vec<f64> = mean.iter().zip(&sliced).map(|(a, b)| a - b).collect();
        let off = rms(&difference) / rms(&sliced);
        println!(
            "{name}: {:.3} g, by slices {:.3} g, difference {:.2} %",
            rms(&mean) / 9.81,
            rms(&sliced) / 9.81,
            100.0 * off
        );
        assert!(off < 0.01, "{name}: {off}");
    }
}
