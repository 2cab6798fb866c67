//! The time integration on problems whose solution is known: constant mesh stiffness.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout)]

use meshtone::dynamics::coordinates::*;
use meshtone::scenario::{DampingRatio, Scenario};
use meshtone::solver::{Block, Output, Recorder};
use meshtone::{Stages, stages};

const PINION_SPEED_HZ: f64 = 1.0;

/// Stages of a pair whose mesh stiffness does not change, and which turns little, so that little is lost when the
/// rigid rotation is subtracted.
fn constant_stiffness(sampling_rate_hz: f64, damping_ratio: f64, torque_nm: f64, seconds: f64) -> Stages {
    let mut scenario = Scenario::new(3.0, 17, 38, 15.0, PINION_SPEED_HZ, torque_nm);
    scenario.gears.points_per_tooth = 1000;
    scenario.rig.damping_ratio = DampingRatio::Uniform(damping_ratio);
    scenario.solver.sampling_rate_hz = sampling_rate_hz;
    // From rest, and from the start on: nothing has settled.
    scenario.solver.initial_displacement = Some([0.0; 13]);
    scenario.solver.settle_tolerance = 0.0;
    let mut stages = stages(&scenario).unwrap();
    let mesh = &mut stages.system.mesh.stiffness_n_per_m;
    let mean = mesh.iter().sum::<f64>() / mesh.len() as f64;
    mesh.fill(mean);
    stages.time.samples = (seconds * stages.time.sampling_rate_hz).round() as usize + 1;
    stages
}

/// Displacement and velocity of all coordinates at every sample.
#[derive(Default)]
struct States {
    displacement: Vec<CoordinateVector>,
    velocity: Vec<CoordinateVector>,
}

impl Recorder for States {
    fn record(&mut self, block: &Block) {
        for k in 0..block.len() {
            self.displacement.push(CoordinateVector::from_fn(|n, _| block.output(n)[k]));
            self.velocity.push(CoordinateVector::from_fn(|n, _| block.output(COORDINATES + n)[k]));
        }
    }
}

fn solve(stages: &Stages) -> States {
    let each = |output: fn([f64; COORDINATES]) -> Output| {
        (0..COORDINATES).map(move |coordinate| {
            let mut weights = [0.0; COORDINATES];
            weights[coordinate] = 1.0;
            output(weights)
        })
    };
    let outputs: Vec<Output> = each(Output::Displacement).chain(each(Output::Velocity)).collect();
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

#[test]
fn error_falls_with_the_square_of_the_step() {
    let errors: Vec<f64> = [2e5, 4e5, 8e5]
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
            (square_sum / states.displacement.len() as f64).sqrt()
        })
        .collect();
    let orders: Vec<f64> = errors.windows(2).map(|pair| (pair[0] / pair[1]).log2()).collect();
    println!("rms errors {errors:?} rad, orders {orders:?}");
    for order in orders {
        assert!((order - 2.0).abs() < 0.05, "{order}");
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
