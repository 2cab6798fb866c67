//! The equations of motion solved as they are written, with dense 13 × 13 matrices: what the modal, low-rank solver is
//! compared with, in its results and in its speed.
#![allow(clippy::unwrap_used, clippy::panic)]

use meshtone::Stages;
use meshtone::dynamics::Excitation;
use meshtone::dynamics::coordinates::{CoordinateMatrix, CoordinateVector, THETA_PINION};
use meshtone::scenario::Convention;

const MOST_ITERATIONS: usize = 11;

/// Newmark's method (γ = ½, β = ¼) in the 13 coordinates, with full matrices and their inverses.
///
/// The unknown is `u` less the rigid rotation at the nominal speed, whose forces are subtracted. The equations are the
/// same; in `u` itself rounding grows with the angle turned (to 1e-8 of the acceleration in 76 revolutions), which
/// would hide what is compared.
pub struct Dense<'a> {
    stages: &'a Stages,
    mass: CoordinateMatrix,
    damping: CoordinateMatrix,
    stiffness: Vec<Option<CoordinateMatrix>>,
    inverse: Vec<Option<CoordinateMatrix>>,
    dt: f64,
}

impl<'a> Dense<'a> {
    /// Nothing is computed yet.
    pub fn new(stages: &'a Stages) -> Self {
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
    pub fn accelerations(&mut self) -> Vec<CoordinateVector> {
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
