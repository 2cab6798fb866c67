//! The time integration on problems whose solution is known: constant mesh stiffness.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout, clippy::panic)]

use std::f64::consts::TAU;

use meshtone::mesh::PairState;
use meshtone::scenario::{DampingRatio, GearPair, MemoryLimit, Model, Profile, Scenario};
use meshtone::solver::Output;
use meshtone::{Stages, stages_within};
use nalgebra::{DMatrix, DVector};

use crate::dense::*;
use crate::physics::mesh;

const PINION_SPEED_HZ: f64 = 1.0;
/// Number of the brake's angle among the rig's coordinates.
const THETA_BRAKE: usize = 6;

/// A pair that turns little, so that little is lost when the rigid rotation is subtracted, and starts with a push of every coordinate.
fn pushed(sampling_rate_hz: f64, damping_ratio: f64, torque_nm: f64) -> Scenario {
    let mut scenario = Scenario::new(GearPair {
        pinion_speed_hz: PINION_SPEED_HZ,
        brake_torque_nm: torque_nm,
        ..GearPair::example()
    });
    scenario.model = Model::Linear;
    scenario.gears.points_per_tooth = 1000;
    scenario.rig.damping_ratio = DampingRatio::Uniform(damping_ratio);
    scenario.solver.sampling_rate_hz = sampling_rate_hz;
    // Each mode with an amplitude of its own, and each about as fast at the flank.
    let push = |n: usize| {
        let speed = 0.02 * (1.0 + 0.5 * ((n * n) as f64 * 0.7).sin());
        if [0, 1, 2, 3, 7, 8].contains(&n) { speed } else { speed / 0.03 }
    };
    let rigid = [0.0, 0.0, 0.0, 0.0, -17.0 / 38.0, 1.0, -17.0 / 38.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    scenario.solver.initial_velocity =
        Some(std::array::from_fn(|n| push(n) + TAU * PINION_SPEED_HZ * rigid[n]));
    // From the start on: nothing has settled.
    scenario.solver.settle_tolerance = 0.0;
    scenario
}

/// The first seconds of a scenario, with the mesh's stiffness its mean at every point: each pair carries it for one pitch.
fn of_constant_stiffness(scenario: &Scenario, seconds: f64) -> Stages {
    // Some 11 GiB would be needed if all samples of the scenario were simulated; here are `seconds`.
    let limit = MemoryLimit::Given { bytes: 16 << 30 };
    let mut stages = stages_within(scenario, limit).unwrap();
    stages.time.samples = (seconds / stages.time.step_s()).round() as usize + 1;
    // Between points the last one of a pitch needs the next.
    let beyond = usize::from(!stages.is_steady());
    let mesh = &mut stages.meshes[0];
    let level =
        PairState { stiffness_n_per_m: mesh.mean_stiffness_n_per_m, separation_m: 0.0, face_centre_m: 0.0 };
    mesh.points_before = 0;
    mesh.classes[0].states = vec![level; mesh.points_per_pitch + beyond];
    stages
}

/// Displacement, velocity and acceleration of all coordinates at every sample, relative to the rigid rotation.
fn solve(stages: &Stages) -> [Vec<DVector<f64>>; 3] {
    let machine = &machine_of(stages).0.machine;
    let speed = &machine.rigid_rotation * (TAU * PINION_SPEED_HZ);
    [0, 1, 2].map(|derivative| {
        let outputs: Vec<Output> = coordinates(machine, derivative).collect();
        let recorded = outputs_from(0, stages, &outputs);
        let rigid = |sample: usize| match derivative {
            0 => &speed * (sample as f64 * stages.time.step_s()),
            1 => speed.clone(),
            _ => &speed * 0.0,
        };
        let row = |sample: usize| DVector::from_fn(outputs.len(), |n, _| recorded[n][sample]) - rigid(sample);
        (0..stages.time.samples).map(row).collect()
    })
}

/// (rad/s) Angular frequency of the brake's smooth torque.
const SWING_RAD_PER_S: f64 = TAU * 300.0;

/// The exact motion under the nominal torque and one that swings as its cosine, `swing` times as large: of
/// `M ü + C u̇ + K u = F (1 + swing cos Ωt)` as a linear system of the first order, a matrix exponential further at every sample.
fn exact(stages: &Stages, swing: f64) -> [Vec<DVector<f64>>; 3] {
    let (train, modes) = machine_of(stages);
    let (machine, mesh) = (&train.machine, mesh(stages));
    let n = machine.coordinates();
    let line = &machine.turn * &machine.lines[0].at_middle;
    let of_mesh = &line * line.transpose() * mesh.mean_stiffness_n_per_m;
    let stiffness = machine.turn_back(&machine.stiffness()) + &of_mesh;
    let damping = modes.damping_matrix(machine) + of_mesh * mesh.damping_time_s;
    let mut force = DVector::zeros(n);
    force[THETA_BRAKE] = stages.scenario.operation.brake_torque_nm;
    let at_rest = stiffness.clone().lu().solve(&force).unwrap();
    let velocity = DVector::from_row_slice(&stages.scenario.solver.initial_velocity.unwrap())
        - &machine.rigid_rotation * (TAU * PINION_SPEED_HZ);
    // Displacements times 1e5/s, and both times √m, so that all are about as large.
    let (rate, root) = (1e5, DVector::from_iterator(n, machine.mass.iter().map(|mass| mass.sqrt())));
    let by_roots =
        |matrix: &DMatrix<f64>| DMatrix::from_fn(n, n, |r, c| matrix[(r, c)] / (root[r] * root[c]));
    // Beside them 1, cos Ωt and sin Ωt.
    let mut system = DMatrix::zeros(2 * n + 3, 2 * n + 3);
    system.view_mut((0, n), (n, n)).fill_diagonal(rate);
    system.view_mut((n, 0), (n, n)).copy_from(&(by_roots(&stiffness) / -rate));
    system.view_mut((n, n), (n, n)).copy_from(&-by_roots(&damping));
    let force = force.component_div(&root);
    system.view_mut((n, 2 * n), (n, 1)).copy_from(&force);
    system.view_mut((n, 2 * n + 1), (n, 1)).copy_from(&(force * swing));
    system[(2 * n + 1, 2 * n + 2)] = -SWING_RAD_PER_S;
    system[(2 * n + 2, 2 * n + 1)] = SWING_RAD_PER_S;
    let step = (&system * stages.time.step_s()).exp();
    let mut state = DVector::zeros(2 * n + 3);
    state.rows_mut(0, n).copy_from(&(at_rest.component_mul(&root) * rate));
    state.rows_mut(n, n).copy_from(&velocity.component_mul(&root));
    state[2 * n] = 1.0;
    state[2 * n + 1] = 1.0;
    let mut motion = [const { Vec::new() }; 3];
    for _ in 0..stages.time.samples {
        let rates = &system * &state;
        motion[0].push(state.rows(0, n).component_div(&root) / rate);
        motion[1].push(state.rows(n, n).component_div(&root));
        motion[2].push(rates.rows(n, n).component_div(&root));
        state = &step * state;
    }
    motion
}

/// Rms over time of every coordinate's error in displacement, velocity and acceleration, over the rms of what is exact.
fn errors(stages: &Stages, swing: f64) -> [DVector<f64>; 3] {
    let (solved, exact) = (solve(stages), exact(stages, swing));
    [0, 1, 2].map(|d| {
        let squares = |values: &mut dyn Iterator<Item = DVector<f64>>| {
            values.map(|value| value.map(|x| x * x)).reduce(|sum, value| sum + value).unwrap()
        };
        let error = squares(&mut solved[d].iter().zip(&exact[d]).map(|(solved, exact)| solved - exact));
        error.component_div(&squares(&mut exact[d].iter().cloned())).map(f64::sqrt)
    })
}

/// Orders of convergence of successive errors, by the steps that were made.
fn orders(errors: &[f64], steps_s: &[f64]) -> Vec<f64> {
    let pairs = errors.windows(2).zip(steps_s.windows(2));
    pairs.map(|(error, step)| (error[0] / error[1]).ln() / (step[0] / step[1]).ln()).collect()
}

// Whatever the modes that the step does not resolve.
#[test]
fn error_falls_with_the_square_of_the_step() {
    let (errors, steps): (Vec<f64>, Vec<f64>) = [2e5, 4e5, 8e5]
        .into_iter()
        .map(|rate| {
            let stages = of_constant_stiffness(&pushed(rate, 0.05, 10.0), 0.02);
            assert!(stages.is_steady());
            (errors(&stages, 0.0)[0][THETA_BRAKE], stages.time.step_s())
        })
        .unzip();
    let orders = orders(&errors, &steps);
    println!("relative errors {errors:?}, orders {orders:?}");
    for order in orders {
        assert!((order - 2.0).abs() < 0.05, "{order}");
    }
}

/// Smoothly forced, all coordinates pushed, and no mode beyond what the coarsest step resolves.
fn smoothly_forced(sampling_rate_hz: f64, seconds: f64, swing: f64) -> Stages {
    let mut scenario = pushed(sampling_rate_hz, 0.05, 10.0);
    for shaft in [&mut scenario.rig.pinion_shaft, &mut scenario.rig.gear_shaft] {
        shaft.radius_mm = 6.0;
    }
    // A point at every sample: the profile's straight lines are not seen.
    let dt = 1.0 / scenario.actual_sampling_rate_hz();
    let time_s: Vec<f64> = (0..(seconds / dt) as usize + 3).map(|i| i as f64 * dt).collect();
    let value = time_s.iter().map(|t| 10.0 * (1.0 + swing * (SWING_RAD_PER_S * t).cos())).collect();
    scenario.operation.torque_profile_nm = Some(Profile { time_s, value });
    of_constant_stiffness(&scenario, seconds)
}

#[test]
fn every_coordinate_converges_with_the_square_of_the_step() {
    let swing = 0.6;
    let (errors, steps): (Vec<[DVector<f64>; 3]>, Vec<f64>) = [8e5, 1.6e6, 3.2e6]
        .into_iter()
        .map(|rate| {
            let stages = smoothly_forced(rate, 0.01, swing);
            (errors(&stages, swing), stages.time.step_s())
        })
        .unzip();
    let names = ["displacement", "velocity", "acceleration"];
    for (d, quantity) in names.into_iter().enumerate() {
        let mut all: Vec<f64> = Vec::new();
        for n in 0..errors[0][d].len() {
            let errors: Vec<f64> = errors.iter().map(|errors| errors[d][n]).collect();
            assert!(errors[0] < 0.05, "coordinate {n}, {quantity}: {errors:?}");
            for order in orders(&errors, &steps) {
                assert!((order - 2.0).abs() < 0.05, "coordinate {n}, {quantity}: {order}, {errors:?}");
                all.push(order);
            }
        }
        let least = all.iter().copied().fold(f64::INFINITY, f64::min);
        let most = all.iter().copied().fold(0.0, f64::max);
        println!(
            "{quantity} of all coordinates: orders {least:.4} to {most:.4}, largest relative errors {:?}",
            errors.iter().map(|errors| errors[d].max()).collect::<Vec<f64>>()
        );
    }
}

#[test]
fn energy_is_kept_without_damping_and_forcing() {
    let mut scenario = pushed(1e5, 0.0, 0.0);
    scenario.rig.mesh_damping_ratio = 0.0;
    let stages = of_constant_stiffness(&scenario, 1.0);
    let machine = &machine_of(&stages).0.machine;
    let stiffness = machine.turn_back(&machine.closed_stiffness(&[mesh(&stages).mean_stiffness_n_per_m]));
    let mass = DVector::from_column_slice(&machine.mass);
    let [displacement, velocity, _] = solve(&stages);
    let energies = displacement
        .iter()
        .zip(&velocity)
        .map(|(u, v)| 0.5 * v.dot(&mass.component_mul(v)) + 0.5 * u.dot(&(&stiffness * u)));
    let energies: Vec<f64> = energies.collect();
    let drift = energies.iter().map(|energy| (energy / energies[0] - 1.0).abs()).fold(0.0, f64::max);
    println!("{} steps, largest relative drift {drift:.2e}", energies.len() - 1);
    assert!(energies.len() > 100_000);
    assert!(drift < 1e-9, "{drift:.2e}");
}
