//! The time integration on problems whose solution is known: constant mesh stiffness.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout, clippy::panic)]

use meshtone::machine::coordinates::*;
use meshtone::mesh::Mesh;
use meshtone::scenario::{DampingRatio, GearPair, MemoryLimit, Model, Profile, Scenario};
use meshtone::solver::{Block, Output, Recorder};
use meshtone::{Stages, stages, stages_within};

const PINION_SPEED_HZ: f64 = 1.0;

/// Makes the mesh's stiffness its mean at every point: each pair carries it for one pitch, and then nothing.
fn level_the_mesh(stages: &mut Stages) {
    let mean_n_per_m = stages.mesh.mean_stiffness_n_per_mm() * 1e3;
    let Mesh::Pairs(mesh) = &mut stages.mesh else { panic!("not of pairs") };
    let (carrying, after) = mesh.classes[0].stiffness_n_per_m.split_at_mut(mesh.points_per_pitch);
    carrying.fill(mean_n_per_m);
    after.fill(0.0);
}

/// Stages of a pair whose mesh stiffness does not change, and which turns little, so that little is lost when the
/// rigid rotation is subtracted.
fn constant_stiffness(sampling_rate_hz: f64, damping_ratio: f64, torque_nm: f64, seconds: f64) -> Stages {
    let mut scenario = Scenario::new(GearPair {
        pinion_speed_hz: PINION_SPEED_HZ,
        brake_torque_nm: torque_nm,
        ..GearPair::example()
    });
    scenario.model = Model::Linear;
    scenario.gears.points_per_tooth = 1000;
    scenario.rig.damping_ratio = DampingRatio::Uniform(damping_ratio);
    scenario.solver.sampling_rate_hz = sampling_rate_hz;
    // From rest, and from the start on: nothing has settled.
    scenario.solver.initial_displacement = Some([0.0; 13]);
    scenario.solver.settle_tolerance = 0.0;
    let mut stages = stages(&scenario).unwrap();
    level_the_mesh(&mut stages);
    stages.time.samples = (seconds * stages.time.sampling_rate_hz).round() as usize + 1;
    stages
}

/// Displacement, velocity and acceleration of all coordinates at every sample.
#[derive(Default)]
struct States {
    displacement: Vec<CoordinateVector>,
    velocity: Vec<CoordinateVector>,
    acceleration: Vec<CoordinateVector>,
}

impl Recorder for States {
    fn record(&mut self, block: &Block) {
        for k in 0..block.len() {
            self.displacement.push(CoordinateVector::from_fn(|n, _| block.output(n)[k]));
            self.velocity.push(CoordinateVector::from_fn(|n, _| block.output(COORDINATES + n)[k]));
            self.acceleration.push(CoordinateVector::from_fn(|n, _| block.output(2 * COORDINATES + n)[k]));
        }
    }
}

fn solve(stages: &Stages) -> States {
    let each = |output: fn(Vec<f64>) -> Output| {
        (0..COORDINATES).map(move |coordinate| {
            let mut weights = vec![0.0; COORDINATES];
            weights[coordinate] = 1.0;
            output(weights)
        })
    };
    let outputs: Vec<Output> =
        each(Output::Displacement).chain(each(Output::Velocity)).chain(each(Output::Acceleration)).collect();
    let mut states = States::default();
    stages.integrate(&stages.reduced_model(), &outputs, 0, &mut states).unwrap();
    states
}

/// Response of the brake's angle, relative to the rigid rotation, to its torque from rest: each mode is a damped
/// oscillator under a constant force.
fn exact_brake_angle(stages: &Stages, time_s: f64) -> f64 {
    let system = &stages.system;
    (0..COORDINATES)
        .map(|n| {
            let (omega, zeta) = (system.modes.angular_frequencies[n], system.damping_ratio[n]);
            let shape = system.modes.shapes[(THETA_BRAKE, n)];
            let damped = omega * (1.0 - zeta * zeta).sqrt();
            let decay = (-zeta * omega * time_s).exp();
            let (sin, cos) = (damped * time_s).sin_cos();
            let rise = 1.0 - decay * (cos + zeta * omega / damped * sin);
            shape * shape * stages.scenario.operation.brake_torque_nm / (omega * omega) * rise
        })
        .sum()
}

/// Orders of convergence of successive errors, by the steps that were made.
fn orders(errors: &[f64], steps_s: &[f64]) -> Vec<f64> {
    let pairs = errors.windows(2).zip(steps_s.windows(2));
    pairs.map(|(error, step)| (error[0] / error[1]).ln() / (step[0] / step[1]).ln()).collect()
}

#[test]
fn error_falls_with_the_square_of_the_step() {
    let (errors, steps): (Vec<f64>, Vec<f64>) = [2e5, 4e5, 8e5]
        .into_iter()
        .map(|rate| {
            let stages = constant_stiffness(rate, 0.05, 10.0, 0.02);
            let states = solve(&stages);
            let speed = -std::f64::consts::TAU * PINION_SPEED_HZ / stages.system.ratio;
            let dt = stages.time.step_s();
            let square_sum: f64 = (states.displacement.iter().enumerate())
                .map(|(i, u)| {
                    let time_s = i as f64 * dt;
                    (u[THETA_BRAKE] - speed * time_s - exact_brake_angle(&stages, time_s)).powi(2)
                })
                .sum();
            ((square_sum / states.displacement.len() as f64).sqrt(), dt)
        })
        .unzip();
    let orders = orders(&errors, &steps);
    println!("rms errors {errors:?} rad, orders {orders:?}");
    for order in orders {
        assert!((order - 2.0).abs() < 0.05, "{order}");
    }
}

/// (rad/s) Angular frequency of the brake's smooth torque, and the part of the nominal torque by which it swings.
const SWING_RAD_PER_S: f64 = std::f64::consts::TAU * 300.0;
const SWING: f64 = 0.6;

/// An initial displacement that reaches every mode, each with an amplitude of its own, and each about as far at the flank.
fn push() -> CoordinateVector {
    CoordinateVector::from_fn(|n, _| {
        let amplitude = 1e-6 * (1.0 + 0.5 * ((n * n) as f64 * 0.7).sin());
        if matches!(n, X_GEAR | Y_GEAR | X_PINION | Y_PINION | Z_GEAR | Z_PINION) {
            amplitude
        } else {
            amplitude / 0.03
        }
    })
}

/// Smoothly forced, all coordinates pushed, and no mode beyond what the coarsest step resolves.
fn smoothly_forced(sampling_rate_hz: f64, seconds: f64) -> Stages {
    let mut scenario = Scenario::new(GearPair { pinion_speed_hz: PINION_SPEED_HZ, ..GearPair::example() });
    scenario.model = Model::Linear;
    scenario.gears.points_per_tooth = 1000;
    // Tilting at some 5 kHz instead of 100 kHz and more, and every mode damped otherwise.
    scenario.rig.wheel_rotational_stiffness_nm_per_rad = 1e5;
    scenario.rig.damping_ratio = DampingRatio::PerMode(std::array::from_fn(|n| 0.02 + 0.005 * n as f64));
    scenario.solver.sampling_rate_hz = sampling_rate_hz;
    scenario.solver.initial_displacement = Some(push().into());
    scenario.solver.settle_tolerance = 0.0;
    // Some 11 GiB would be needed if all samples of the scenario were simulated; here are `seconds`.
    let limit = MemoryLimit::Given { bytes: 16 << 30 };
    let mut stages = stages_within(&scenario, limit).unwrap();
    level_the_mesh(&mut stages);
    let dt = stages.time.step_s();
    stages.time.samples = (seconds / dt).round() as usize + 1;
    // A point at every sample: the profile's straight lines are not seen.
    let time_s: Vec<f64> = (0..=stages.time.samples).map(|i| i as f64 * dt).collect();
    let value = time_s.iter().map(|t| 10.0 * (1.0 + SWING * (SWING_RAD_PER_S * t).cos())).collect();
    stages.scenario.operation.torque_profile_nm = Some(Profile { time_s, value });
    stages
}

/// The exact motion of [`smoothly_forced`], relative to the rigid rotation, mode by mode: displacement, velocity and
/// acceleration of all coordinates at `time_s`.
struct ExactMotion {
    /// Columns: modes in the 13 coordinates.
    shapes: CoordinateMatrix,
    modes: Vec<ExactMode>,
}

/// `q̈ + 2ζω q̇ + ω² q = f₀ + f₁ cos Ωt`.
struct ExactMode {
    zeta: f64,
    omega: f64,
    constant: f64,
    /// Of the steady oscillation, `a cos Ωt + b sin Ωt`.
    steady: [f64; 2],
    /// Of the free one, `e^(−ζωt) (a cos ω_d t + b sin ω_d t)`.
    free: [f64; 2],
}

impl ExactMode {
    fn new(omega: f64, zeta: f64, constant_force: f64, swinging_force: f64, displacement: f64) -> Self {
        let swing = SWING_RAD_PER_S;
        let (stiff, lossy) = (omega * omega - swing * swing, 2.0 * zeta * omega * swing);
        let share = swinging_force / (stiff * stiff + lossy * lossy);
        let steady = [share * stiff, share * lossy];
        let constant = constant_force / (omega * omega);
        // At rest, relative to the rigid rotation, at the start.
        let start = displacement - constant - steady[0];
        let damped = omega * (1.0 - zeta * zeta).sqrt();
        let free = [start, (zeta * omega * start - swing * steady[1]) / damped];
        Self { zeta, omega, constant, steady, free }
    }

    fn at(&self, time_s: f64) -> [f64; 3] {
        let Self { zeta, omega, constant, steady: [a, b], free: [c, d] } = *self;
        let swing = SWING_RAD_PER_S;
        let (sin, cos) = (swing * time_s).sin_cos();
        let steady = a * cos + b * sin;
        let (decay, damped) = (zeta * omega, omega * (1.0 - zeta * zeta).sqrt());
        let envelope = (-decay * time_s).exp();
        let (free_sin, free_cos) = (damped * time_s).sin_cos();
        let free = envelope * (c * free_cos + d * free_sin);
        let turned = envelope * damped * (d * free_cos - c * free_sin);
        let velocity = turned - decay * free;
        [
            constant + steady + free,
            swing * (b * cos - a * sin) + velocity,
            -swing * swing * steady - 2.0 * decay * velocity - omega * omega * free,
        ]
    }
}

impl ExactMotion {
    fn new(stages: &Stages) -> Self {
        let system = &stages.system;
        let shapes = system.directions.turn * system.modes.shapes;
        let mass = CoordinateVector::from(system.mass_diagonal);
        let start = shapes.transpose() * mass.component_mul(&push());
        let torque = stages.scenario.operation.brake_torque_nm;
        let modes = (0..COORDINATES)
            .map(|n| {
                let force = shapes[(THETA_BRAKE, n)] * torque;
                let omega = system.modes.angular_frequencies[n];
                ExactMode::new(omega, system.damping_ratio[n], force, SWING * force, start[n])
            })
            .collect();
        Self { shapes, modes }
    }

    fn at(&self, time_s: f64) -> [CoordinateVector; 3] {
        let modes: Vec<[f64; 3]> = self.modes.iter().map(|mode| mode.at(time_s)).collect();
        [0, 1, 2].map(|d| self.shapes * CoordinateVector::from_fn(|n, _| modes[n][d]))
    }
}

/// Rms over time of every coordinate's error in displacement, velocity and acceleration, over the rms of what is exact.
fn errors_of_all_coordinates(stages: &Stages) -> [CoordinateVector; 3] {
    let states = solve(stages);
    let exact = ExactMotion::new(stages);
    let speed = stages.system.rigid_rotation() * (std::f64::consts::TAU * PINION_SPEED_HZ);
    let dt = stages.time.step_s();
    let mut errors = [CoordinateVector::zeros(); 3];
    let mut scales = [CoordinateVector::zeros(); 3];
    for i in 0..states.displacement.len() {
        let time_s = i as f64 * dt;
        let [u, v, a] = exact.at(time_s);
        let solved =
            [states.displacement[i] - speed * time_s, states.velocity[i] - speed, states.acceleration[i]];
        for (d, exact) in [u, v, a].into_iter().enumerate() {
            errors[d] += (solved[d] - exact).map(|x| x * x);
            scales[d] += exact.map(|x| x * x);
        }
    }
    [0, 1, 2].map(|d| errors[d].component_div(&scales[d]).map(f64::sqrt))
}

#[test]
fn every_coordinate_converges_with_the_square_of_the_step() {
    let (errors, steps): (Vec<[CoordinateVector; 3]>, Vec<f64>) = [8e5, 1.6e6, 3.2e6]
        .into_iter()
        .map(|rate| {
            let stages = smoothly_forced(rate, 0.01);
            (errors_of_all_coordinates(&stages), stages.time.step_s())
        })
        .unzip();
    for (d, quantity) in ["displacement", "velocity", "acceleration"].into_iter().enumerate() {
        let mut all: Vec<f64> = Vec::new();
        for n in 0..COORDINATES {
            let errors: Vec<f64> = errors.iter().map(|errors| errors[d][n]).collect();
            assert!(errors[0] < 0.05, "{} {quantity}: {errors:?}", NAMES[n]);
            for order in orders(&errors, &steps) {
                assert!((order - 2.0).abs() < 0.05, "{} {quantity}: {order}, {errors:?}", NAMES[n]);
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
    let mut stages = constant_stiffness(1e5, 0.0, 0.0, 1.0);
    stages.scenario.solver.initial_displacement =
        Some(std::array::from_fn(|n| 1e-4 * ((n * n) as f64 * 0.7).sin()));
    let states = solve(&stages);
    let stiffness = stages.system.mean_stiffness_matrix();
    let mass = CoordinateVector::from(stages.system.mass_diagonal);
    let rigid = stages.system.rigid_rotation() * (std::f64::consts::TAU * PINION_SPEED_HZ);
    let dt = stages.time.step_s();
    let energy = |i: usize| {
        let u = states.displacement[i] - rigid * (i as f64 * dt);
        let v = states.velocity[i] - rigid;
        0.5 * v.dot(&mass.component_mul(&v)) + 0.5 * u.dot(&(stiffness * u))
    };
    let start = energy(0);
    let drift = (0..states.displacement.len()).map(|i| (energy(i) / start - 1.0).abs()).fold(0.0, f64::max);
    println!("{} steps, largest relative drift {drift:.2e}", states.displacement.len() - 1);
    assert!(states.displacement.len() > 100_000);
    assert!(drift < 1e-9, "{drift:.2e}");
}
