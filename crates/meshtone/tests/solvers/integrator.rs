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

/// Speeds of the rig's coordinates per speed of the pinion, while all turns rigidly.
fn rigid_rotation() -> [f64; 13] {
    [0.0, 0.0, 0.0, 0.0, -17.0 / 38.0, 1.0, -17.0 / 38.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
}

/// A pair that turns little, so that little is lost when the rigid rotation is subtracted, and starts with a push of every coordinate.
fn pushed(sampling_rate_hz: f64, damping_ratio: f64, torque_nm: f64) -> Scenario {
    let mut scenario = Scenario::new(GearPair {
        pinion_speed_hz: PINION_SPEED_HZ,
        brake_torque_nm: torque_nm,
        ..GearPair::example()
    });
    scenario.model = Model::Linear;
    scenario.meshes[0].points_per_tooth = 1000;
    scenario.rig_mut().unwrap().damping_ratio = DampingRatio::Uniform(damping_ratio);
    scenario.solver.sampling_rate_hz = sampling_rate_hz;
    // Each mode with an amplitude of its own, and each about as fast at the flank.
    let push = |n: usize| {
        let speed = 0.02 * (1.0 + 0.5 * ((n * n) as f64 * 0.7).sin());
        if [0, 1, 2, 3, 7, 8].contains(&n) { speed } else { speed / 0.03 }
    };
    let rigid = rigid_rotation();
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
    let mesh = &mut stages.meshes[0];
    let level =
        PairState { stiffness_n_per_m: mesh.mean_stiffness_n_per_m, separation_m: 0.0, face_centre_m: 0.0 };
    mesh.points_before = 0;
    mesh.classes[0].states = vec![level; mesh.points_per_pitch];
    stages
}

/// Displacement, velocity and acceleration of all coordinates at every sample, relative to the rigid rotation.
fn solve(stages: &Stages) -> [Vec<DVector<f64>>; 3] {
    let machine = machine_of(stages).0;
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
const SWING_RAD_PER_S: f64 = TAU * 3000.0;

/// The exact motion under the nominal torque and one that swings as its cosine, `swing` times as large: of
/// `M ü + C u̇ + K u = F (1 + swing cos Ωt)` as a linear system of the first order, a matrix exponential further at every sample.
fn exact(stages: &Stages, swing: f64) -> [Vec<DVector<f64>>; 3] {
    let (machine, modes) = machine_of(stages);
    let mesh = mesh(stages);
    let n = machine.coordinates();
    let line = &machine.turn * &machine.lines[0].at_middle;
    let of_mesh = &line * line.transpose() * mesh.mean_stiffness_n_per_m;
    let stiffness = machine.turn_back(&machine.stiffness()) + &of_mesh;
    let damping = modes.damping_matrix(machine) + of_mesh * mesh.damping_time_s;
    let mut force = DVector::zeros(n);
    force[THETA_BRAKE] = stages.scenario.operation.brake_torque_nm;
    // Under the torque with which it begins.
    let at_rest = stiffness.clone().lu().solve(&(&force * (1.0 + swing))).unwrap();
    let velocity = DVector::from_row_slice(&stages.scenario.solver.initial_velocity.unwrap())
        - &machine.rigid_rotation * (TAU * PINION_SPEED_HZ);
    // Displacements times 1e5/s, and both times √m, so that all are about as large.
    let (rate, root) =
        (1e5, DVector::from_iterator(n, machine.mass.diagonal().iter().map(|mass| mass.sqrt())));
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

/// Smoothly forced from rest, and no mode beyond what the coarsest step resolves.
fn smoothly_forced(sampling_rate_hz: f64, seconds: f64, swing: f64, damping_ratio: f64) -> Stages {
    let mut scenario = pushed(sampling_rate_hz, damping_ratio, 10.0);
    // A push would be falsified with the square of the step: a velocity of the steps is that of the trapezoidal rule.
    scenario.solver.initial_velocity = Some(rigid_rotation().map(|ratio| TAU * PINION_SPEED_HZ * ratio));
    scenario.meshes[0].damping_ratio = damping_ratio;
    let rig = scenario.rig_mut().unwrap();
    for shaft in [&mut rig.pinion_shaft, &mut rig.gear_shaft] {
        shaft.radius_mm = 6.0;
    }
    // A point at every sample: the profile's straight lines are not seen.
    let dt = 1.0 / scenario.actual_sampling_rate_hz();
    let time_s: Vec<f64> = (0..(seconds / dt) as usize + 3).map(|i| i as f64 * dt).collect();
    let value = time_s.iter().map(|t| 10.0 * (1.0 + swing * (SWING_RAD_PER_S * t).cos())).collect();
    scenario.operation.torque_profile_nm = Some(Profile { time_s, value });
    (scenario.solver.duration_s, scenario.solver.pinion_revolutions) = (None, None);
    scenario.solver.settle_fraction = 0.0;
    of_constant_stiffness(&scenario, seconds)
}

/// The translations in the plane and the rotations, which torque and mesh move.
const MOVED: usize = 7;

/// Orders of convergence of displacement, velocity and acceleration of what moves, and the largest relative errors of each.
fn orders_of_convergence(rates_hz: [f64; 3], damping_ratio: f64) -> [(Vec<f64>, Vec<f64>); 3] {
    let swing = 0.6;
    let (errors, steps): (Vec<[DVector<f64>; 3]>, Vec<f64>) = rates_hz
        .into_iter()
        .map(|rate| {
            let stages = smoothly_forced(rate, 0.01, swing, damping_ratio);
            (errors(&stages, swing), stages.time.step_s())
        })
        .unzip();
    let names = ["displacement", "velocity", "acceleration"];
    [0, 1, 2].map(|d| {
        let of_coordinate = |n: usize| {
            let errors: Vec<f64> = errors.iter().map(|errors| errors[d][n]).collect();
            orders(&errors, &steps)
        };
        let all: Vec<f64> = (0..MOVED).flat_map(of_coordinate).collect();
        let largest: Vec<f64> = errors.iter().map(|errors| errors[d].rows(0, MOVED).max()).collect();
        let least = all.iter().copied().fold(f64::INFINITY, f64::min);
        let most = all.iter().copied().fold(0.0, f64::max);
        println!("{}: orders {least:.3} to {most:.3}, largest relative errors {largest:?}", names[d]);
        (all, largest)
    })
}

/// Without damping displacement and acceleration converge with the fourth power of the step. A velocity is that of the trapezoidal
/// rule, which converges with the square.
#[test]
fn every_coordinate_converges_with_the_fourth_power_of_the_step() {
    let [displacement, velocity, acceleration] = orders_of_convergence([6e4, 9e4, 1.2e5], 0.0);
    for (orders, expected) in [(&displacement, 4.0), (&velocity, 2.0), (&acceleration, 4.0)] {
        for order in &orders.0 {
            assert!((order - expected).abs() < 0.2, "{order} instead of {expected}");
        }
    }
}

/// Damping takes its force from the velocity.
#[test]
fn damped_motion_converges_with_the_square_of_the_step() {
    for (orders, largest) in orders_of_convergence([1e5, 2e5, 4e5], 0.05) {
        assert!(largest[0] < 0.02, "{largest:?}");
        for order in orders {
            assert!((order - 2.0).abs() < 0.2, "{order}");
        }
    }
}

/// A step of β = 1/12 is stable as long as `ω Δt < √6`, one of β = ¼ always: a machine whose modes a step cannot resolve stays bounded,
/// and deflects under a constant load as it should.
#[test]
fn what_a_step_cannot_resolve_is_stable() {
    for rate in [2e3, 5e3, 1e4, 2e4] {
        let stages = of_constant_stiffness(&pushed(rate, 0.05, 10.0), 2.0);
        let betas = Dense::of(&stages, 1).steps().beta.symmetric_eigenvalues();
        let [solved, _, _] = solve(&stages);
        let at_rest = &exact(&stages, 0.0)[0][0];
        let last = solved.last().unwrap();
        let error = (last[THETA_BRAKE] / at_rest[THETA_BRAKE] - 1.0).abs();
        println!(
            "{rate} S/s: β {:.3} to {:.3}, angle of the brake off by {error:.1e}",
            betas.min(),
            betas.max()
        );
        assert!(error < 1e-4, "{rate}: {error}");
    }
}

/// Newmark's methods with γ = ½ keep `½ vᵀ M v + ½ uᵀ K u + ½ Δt² aᵀ M (β − ¼) a`, with the mass and the accelerations of the steps.
#[test]
fn energy_is_kept_without_damping_and_forcing() {
    let mut scenario = pushed(1e5, 0.0, 0.0);
    scenario.meshes[0].damping_ratio = 0.0;
    let stages = of_constant_stiffness(&scenario, 1.0);
    let machine = machine_of(&stages).0;
    let stiffness = machine.turn_back(&machine.closed_stiffness(&[mesh(&stages).mean_stiffness_n_per_m]));
    let own_mass = machine.mass.diagonal();
    let steps = Dense::of(&stages, 1).steps();
    let n = machine.coordinates();
    let of_acceleration =
        &steps.mass * (&steps.beta - DMatrix::identity(n, n) * 0.25) * stages.time.step_s().powi(2);
    let to_stepped = steps.mass.clone().try_inverse().unwrap();
    let [displacement, velocity, acceleration] = solve(&stages);
    let energies = displacement.iter().zip(&velocity).zip(&acceleration).map(|((u, v), a)| {
        let a = &to_stepped * own_mass.component_mul(a);
        let quadratic = |matrix: &DMatrix<f64>, x: &DVector<f64>| 0.5 * x.dot(&(matrix * x));
        quadratic(&steps.mass, v) + quadratic(&stiffness, u) + quadratic(&of_acceleration, &a)
    });
    let energies: Vec<f64> = energies.collect();
    let drift = energies.iter().map(|energy| (energy / energies[0] - 1.0).abs()).fold(0.0, f64::max);
    println!("{} steps, largest relative drift {drift:.2e}", energies.len() - 1);
    assert!(energies.len() > 100_000);
    assert!(drift < 1e-9, "{drift:.2e}");
}
