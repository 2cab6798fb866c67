//! The modal, low-rank solver against a dense 13 × 13 one, written straight from the equations of motion.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout, clippy::panic)]

use meshtone::dynamics::Excitation;
use meshtone::dynamics::coordinates::{COORDINATES, CoordinateMatrix, CoordinateVector, THETA_PINION};
use meshtone::scenario::*;
use meshtone::solver::{Block, Output, Recorder};
use meshtone::{Stages, stages};

const MOST_ITERATIONS: usize = 11;

/// Newmark's method (γ = ½, β = ¼) in the 13 coordinates, with full matrices and their inverses.
///
/// The unknown is `u` less the rigid rotation at the nominal speed, whose forces are subtracted. The equations are the
/// same; in `u` itself rounding grows with the angle turned (to 1e-8 of the acceleration in 76 revolutions), which
/// would hide what is compared.
struct Dense<'a> {
    stages: &'a Stages,
    mass: CoordinateMatrix,
    damping: CoordinateMatrix,
    stiffness: Vec<Option<CoordinateMatrix>>,
    inverse: Vec<Option<CoordinateMatrix>>,
    dt: f64,
}

impl<'a> Dense<'a> {
    fn new(stages: &'a Stages) -> Self {
        let points = stages.cycle.points_per_gear_revolution;
        Self {
            stages,
            mass: CoordinateMatrix::from_diagonal(&CoordinateVector::from(stages.system.mass_diagonal)),
            damping: stages.system.damping_matrix(),
            stiffness: vec![None; points],
            inverse: vec![None; points],
            dt: stages.time.step_s(),
        }
    }

    fn stiffness(&mut self, point: usize) -> CoordinateMatrix {
        *self.stiffness[point].get_or_insert_with(|| self.stages.system.stiffness_matrix_at(point))
    }

    fn effective(&mut self, point: usize) -> CoordinateMatrix {
        self.stiffness(point) + self.damping * (2.0 / self.dt) + self.mass * (4.0 / (self.dt * self.dt))
    }

    fn inverse(&mut self, point: usize) -> CoordinateMatrix {
        let effective = self.effective(point);
        *self.inverse[point].get_or_insert_with(|| effective.try_inverse().unwrap())
    }

    fn point(&self, angle: f64) -> usize {
        let turns = angle / std::f64::consts::TAU / self.stages.cycle.coarse_step_rev;
        (turns.round() as i64).rem_euclid(self.stages.cycle.points_per_gear_revolution as i64) as usize
    }

    fn nominal_speed(&self) -> f64 {
        std::f64::consts::TAU * self.stages.scenario.operation.pinion_speed_hz
    }

    fn rotation(&self, sample: usize) -> f64 {
        self.nominal_speed() * (sample as f64 * self.dt)
    }

    fn force(&self, sample: usize, excitation: Excitation) -> CoordinateVector {
        let convention = self.stages.scenario.convention;
        let relative = Excitation {
            motor_angle_rad: excitation.motor_angle_rad - self.rotation(sample),
            motor_speed_rad_per_s: excitation.motor_speed_rad_per_s - self.nominal_speed(),
            ..excitation
        };
        let force = self.stages.system.force(&relative, convention);
        match convention {
            Convention::Corrected => force,
            Convention::Published => {
                force - self.damping * self.stages.system.rigid_rotation() * self.nominal_speed()
            }
        }
    }

    /// The published iteration, on the residual.
    fn published_step(
        &mut self,
        increment: &CoordinateVector,
        u: &CoordinateVector,
        angle: f64,
        point: &mut usize,
        whole: impl Fn(&CoordinateVector) -> f64,
    ) -> CoordinateVector {
        let start_stiffness = self.stiffness(*point);
        let mut p = CoordinateVector::zeros();
        let mut residual = *increment;
        for iteration in 0..MOST_ITERATIONS {
            let change = self.inverse(*point) * residual;
            p += change;
            let error = if iteration == 0 { 1.0 } else { (residual.dot(&change) / whole(&p)).abs() };
            *point = self.point(angle + p[THETA_PINION]);
            residual =
                increment - self.effective(*point) * p + (start_stiffness - self.stiffness(*point)) * u;
            if error <= 1e-5 {
                break;
            }
        }
        p
    }

    /// The corrected iteration: the step solved for one point of the cycle, until it leads to that point.
    fn corrected_step(
        &mut self,
        increment: &CoordinateVector,
        u: &CoordinateVector,
        angle: f64,
        guess: f64,
        point: &mut usize,
    ) -> CoordinateVector {
        let start_stiffness = self.stiffness(*point);
        *point = self.point(guess);
        let mut p = self.inverse(*point) * (increment + (start_stiffness - self.stiffness(*point)) * u);
        for _ in 0..MOST_ITERATIONS {
            let next = self.point(angle + p[THETA_PINION]);
            if next == *point {
                break;
            }
            *point = next;
            let residual = increment + (start_stiffness - self.stiffness(next)) * u;
            p = self.inverse(next) * residual;
        }
        p
    }

    /// Displacement and velocity at the start, relative to the rigid rotation.
    fn start(&self) -> (CoordinateVector, CoordinateVector) {
        let (solver, operation) = (&self.stages.scenario.solver, &self.stages.scenario.operation);
        let rigid = self.stages.system.rigid_rotation();
        let u = solver.initial_displacement.map_or_else(CoordinateVector::zeros, Into::into);
        let speed_hz =
            operation.speed_profile_hz.as_ref().map_or(operation.pinion_speed_hz, |profile| profile.value[0]);
        let v = solver
            .initial_velocity
            .map_or_else(|| rigid * (std::f64::consts::TAU * speed_hz), CoordinateVector::from);
        (u, v - rigid * self.nominal_speed())
    }

    fn starts_in_equilibrium(&self) -> bool {
        let scenario = &self.stages.scenario;
        scenario.convention == Convention::Corrected && scenario.solver.initial_displacement.is_none()
    }

    /// `K(θ_p) u = F − C u̇`, at the point that the solution itself leads to.
    fn equilibrium(&mut self, force: &CoordinateVector) -> (CoordinateVector, usize) {
        let mut point = self.point(0.0);
        for _ in 0..MOST_ITERATIONS {
            let u = self.stiffness(point).lu().solve(force).unwrap();
            let next = self.point(u[THETA_PINION]);
            if next == point {
                return (u, point);
            }
            point = next;
        }
        panic!("no equilibrium");
    }

    /// Accelerations of all samples.
    fn accelerations(&mut self) -> Vec<CoordinateVector> {
        let convention = self.stages.scenario.convention;
        let rigid = self.stages.system.rigid_rotation();
        let rigid_step = rigid * self.nominal_speed() * self.dt;
        let rigid_increment = self.effective(0) * rigid_step;
        let (mut u, mut v) = self.start();
        let mut excitation = self.stages.excitation();
        let mut force = self.force(0, excitation.next().unwrap());
        let mut point = self.point(u[THETA_PINION]);
        if self.starts_in_equilibrium() {
            (u, point) = self.equilibrium(&(force - self.damping * v));
        }
        let mut before = [u[THETA_PINION]; 2];
        let mass_inverse = self.mass.try_inverse().unwrap();
        let mut a = mass_inverse * (force - self.damping * v - self.stiffness(point) * u);
        let mut accelerations = vec![a];
        for sample in 1..self.stages.time.samples {
            let next_force = self.force(sample, excitation.next().unwrap());
            let increment = next_force - force
                + (self.mass * (4.0 / self.dt) + self.damping * 2.0) * v
                + self.mass * a * 2.0;
            let angle = u[THETA_PINION] + self.rotation(sample);
            let p = match convention {
                Convention::Published => {
                    let whole = |p: &CoordinateVector| (increment + rigid_increment).dot(&(p + rigid_step));
                    self.published_step(&increment, &u, angle, &mut point, whole)
                }
                Convention::Corrected => {
                    // Where the angles before the last lead, continued along a line.
                    let guess = self.rotation(sample) + before[0] + 2.0 * (before[0] - before[1]);
                    self.corrected_step(&increment, &u, angle, guess, &mut point)
                }
            };
            before = [u[THETA_PINION], before[0]];
            let velocity_change = p * (2.0 / self.dt) - v * 2.0;
            a += p * (4.0 / (self.dt * self.dt)) - v * (4.0 / self.dt) - a * 2.0;
            v += velocity_change;
            u += p;
            force = self.mass * a + self.damping * v + self.stiffness(point) * u;
            accelerations.push(a);
        }
        accelerations
    }
}

struct Accelerations(Vec<CoordinateVector>);

impl Recorder for Accelerations {
    fn record(&mut self, block: &Block) {
        let rows = (0..block.len()).map(|k| CoordinateVector::from_fn(|n, _| block.output(n)[k]));
        self.0.extend(rows);
    }
}

fn modal(stages: &Stages) -> Vec<CoordinateVector> {
    let outputs: Vec<Output> = (0..COORDINATES)
        .map(|coordinate| {
            let mut weights = [0.0; COORDINATES];
            weights[coordinate] = 1.0;
            Output::Acceleration(weights)
        })
        .collect();
    let mut recorder = Accelerations(Vec::new());
    stages.integrate(&stages.reduced_model(), &outputs, 0, &mut recorder).unwrap();
    recorder.0
}

/// Rms of the difference over rms, the largest over all coordinates that move.
fn difference(a: &[CoordinateVector], b: &[CoordinateVector]) -> f64 {
    let rms = |of: &dyn Fn(usize) -> f64| (0..b.len()).map(|i| of(i).powi(2)).sum::<f64>().sqrt();
    let scale: Vec<f64> = (0..COORDINATES).map(|n| rms(&|i| b[i][n])).collect();
    let largest = scale.iter().copied().fold(0.0, f64::max);
    (0..COORDINATES)
        .map(|n| {
            let difference = rms(&|i| a[i][n] - b[i][n]);
            // What only rounding moves is compared with what moves.
            difference / if scale[n] > 1e-9 * largest { scale[n] } else { largest }
        })
        .fold(0.0, f64::max)
}

/// Every mode and every direction of the mesh moves.
fn started_with_a_push(scenario: &mut Scenario, random: &mut impl FnMut(f64, f64) -> f64) {
    scenario.solver.initial_displacement = Some(std::array::from_fn(|_| random(-1e-5, 1e-5)));
}

fn driven_unsteadily(scenario: &mut Scenario, random: &mut impl FnMut(f64, f64) -> f64) {
    let operation = &mut scenario.operation;
    let (speed, torque) = (operation.pinion_speed_hz, operation.brake_torque_nm);
    let seconds = 2.0 * f64::from(scenario.gears.gear_teeth) / speed;
    let profile = |nominal: f64, factors: [f64; 3]| {
        Some(Profile {
            time_s: vec![0.0, 0.6 * seconds, 1.1 * seconds],
            value: factors.map(|factor| factor * nominal).to_vec(),
        })
    };
    // The farther the shafts turn from the rigid rotation at the nominal speed, the more of the mesh's deflection is lost to
    // rounding, in both solutions: 5e-9 of the acceleration at ±10 %, 1.5e-9 at ±1 % and a light load.
    operation.speed_profile_hz = profile(speed, [0.997, 1.003, 1.0]);
    operation.torque_profile_nm = profile(torque, [1.0, 1.3, 0.8]);
    operation.speed_fluctuation_hz = random(0.0, 0.003) * speed;
    operation.torque_fluctuation_nm = random(0.0, 0.1) * torque;
    scenario.rig.eccentricity_mm = random(0.0, 0.02);
}

fn fault(kind: usize, module: f64, width: f64, random: &mut impl FnMut(f64, f64) -> f64) -> Option<Fault> {
    let start = random(0.05, 0.35);
    let pit = PitCircle::Fractions { start, end: random(0.55, 0.95), depth: random(0.1, 0.6) };
    Some(match kind {
        0 => return None,
        1 => Fault::MissingTooth,
        2 => Fault::ToothBreakage(ToothBreakage {
            chip_height_mm: random(0.5, 1.6) * module,
            chip_width_mm: random(0.2, 0.9) * width,
            tip_loss_mm: random(0.0, 0.9) * module,
        }),
        3 => Fault::PartialFace(PartialFace { width_mm: random(0.1, 0.7) * width, pit }),
        4 => Fault::ThroughFace(ThroughFace { pit }),
        _ => Fault::ToothDestruction(ToothDestruction {
            start,
            line: DestructionLine::End(random(0.7, 1.0)),
            offset_mm: random(0.0, 0.1) * module,
            noise_mm: 0.001,
        }),
    })
}

/// Scenarios over every fault and both conventions; short, because the oracle is slow.
#[test]
fn modal_and_dense_solutions_agree() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let mut random = |low: f64, high: f64| {
        use proptest::strategy::{Strategy, ValueTree};
        (low..high).new_tree(&mut runner).unwrap().current()
    };
    let mut worst: f64 = 0.0;
    for round in 0..3 {
        for kind in 0..6 {
            for convention in [Convention::Published, Convention::Corrected] {
                let (module, width) = (random(2.0, 6.0), random(10.0, 60.0));
                let teeth = [(14, 21), (18, 24), (15, 20), (16, 24), (20, 30), (40, 60), (28, 21)];
                let (pinion, gear) = teeth[random(0.0, teeth.len() as f64) as usize];
                let mut scenario =
                    Scenario::new(module, pinion, gear, width, random(15.0, 60.0), random(2.0, 80.0));
                scenario.convention = convention;
                scenario.seed = round;
                scenario.gears.points_per_tooth = 2000;
                scenario.quality.din_grade = random(0.0, 10.0) as u8;
                scenario.rig.damping_ratio = DampingRatio::Uniform(random(0.01, 0.1));
                scenario.solver.sampling_rate_hz = 1e3;
                // From the start on, where nothing has settled.
                scenario.solver.settle_tolerance = 0.0;
                scenario.gears.pressure_angle_deg = [20.0, 22.5, 18.0][round as usize];
                if round == 1 {
                    started_with_a_push(&mut scenario, &mut random);
                }
                if round == 2 && convention == Convention::Corrected {
                    driven_unsteadily(&mut scenario, &mut random);
                }
                scenario.fault = fault(kind, module, width, &mut random);
                let stages = stages(&scenario).unwrap();
                let difference = difference(&modal(&stages), &Dense::new(&stages).accelerations());
                println!("{kind} {convention:?} {pinion}/{gear}: {difference:.2e}");
                worst = worst.max(difference);
                assert!(difference < 1e-9, "{difference:.2e} for\n{}", scenario.to_toml());
            }
        }
    }
    println!("largest: {worst:.2e}");
}
