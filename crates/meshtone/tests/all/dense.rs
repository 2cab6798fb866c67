//! The equations of motion solved as they are written, with dense 13 × 13 matrices: what the modal, low-rank solver is
//! compared with, in its results and in its speed.
#![allow(clippy::unwrap_used, clippy::panic)]

use meshtone::Stages;
use meshtone::machine::Excitation;
use meshtone::machine::coordinates::{CoordinateMatrix, CoordinateVector, THETA_PINION};
use meshtone::scenario::Model;

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
        // What differs of the mesh: entries of the pairs' table, or all coarse points of a gear revolution.
        let points =
            stages.mesh.pairs().map_or(stages.cycle.points_per_gear_revolution, |pairs| pairs.entries());
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
        *self.stiffness[point]
            .get_or_insert_with(|| self.stages.system.stiffness_matrix_at(&self.stages.mesh, point))
    }

    fn effective(&mut self, point: usize) -> CoordinateMatrix {
        self.stiffness(point) + self.damping * (2.0 / self.dt) + self.mass * (4.0 / (self.dt * self.dt))
    }

    fn inverse(&mut self, point: usize) -> CoordinateMatrix {
        let effective = self.effective(point);
        *self.inverse[point].get_or_insert_with(|| effective.try_inverse().unwrap())
    }

    /// Published: the coarse point of the cycle nearest to the pinion's own angle.
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
        let model = self.stages.scenario.model;
        let mut relative = excitation;
        relative.motor_angle_rad -= self.rotation(sample);
        relative.motor_speed_rad_per_s -= self.nominal_speed();
        let force = self.stages.system.force(&relative);
        match model {
            Model::Linear => force,
            Model::Published => {
                force - self.damping * self.stages.system.rigid_rotation() * self.nominal_speed()
            }
            _ => panic!("a model that this oracle does not know"),
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

    /// Linear: the mesh's point nearest to the motor's angle, at every sample. Nothing of the solution decides it.
    fn known_points(&self) -> Vec<usize> {
        let Some(pairs) = self.stages.mesh.pairs() else { return Vec::new() };
        let points_per_revolution = (pairs.points_per_pitch * self.stages.teeth.pinion.teeth as usize) as f64;
        self.stages
            .scenario
            .motion(&self.stages.time)
            .take(self.stages.time.samples)
            .map(|motion| pairs.entry((motion.revolutions * points_per_revolution).round() as usize))
            .collect()
    }

    /// The linear step: no iteration, since the point at its end is known.
    fn linear_step(
        &mut self,
        increment: &CoordinateVector,
        u: &CoordinateVector,
        point: &mut usize,
        next: usize,
    ) -> CoordinateVector {
        let start_stiffness = self.stiffness(*point);
        *point = next;
        self.inverse(next) * (increment + (start_stiffness - self.stiffness(next)) * u)
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
        scenario.model == Model::Linear && scenario.solver.initial_displacement.is_none()
    }

    /// Accelerations of all samples.
    pub fn accelerations(&mut self) -> Vec<CoordinateVector> {
        let model = self.stages.scenario.model;
        let rigid = self.stages.system.rigid_rotation();
        let rigid_step = rigid * self.nominal_speed() * self.dt;
        let rigid_increment = self.effective(0) * rigid_step;
        let (mut u, mut v) = self.start();
        let mut excitation = self.stages.excitation();
        let mut force = self.force(0, excitation.next().unwrap());
        let known = self.known_points();
        let mut point = known.first().copied().unwrap_or_else(|| self.point(u[THETA_PINION]));
        if self.starts_in_equilibrium() {
            // K u = F − C u̇.
            u = self.stiffness(point).lu().solve(&(force - self.damping * v)).unwrap();
        }
        let mass_inverse = self.mass.try_inverse().unwrap();
        let mut a = mass_inverse * (force - self.damping * v - self.stiffness(point) * u);
        let mut accelerations = vec![a];
        for sample in 1..self.stages.time.samples {
            let next_force = self.force(sample, excitation.next().unwrap());
            let increment = next_force - force
                + (self.mass * (4.0 / self.dt) + self.damping * 2.0) * v
                + self.mass * a * 2.0;
            let angle = u[THETA_PINION] + self.rotation(sample);
            let p = match model {
                Model::Published => {
                    let whole = |p: &CoordinateVector| (increment + rigid_increment).dot(&(p + rigid_step));
                    self.published_step(&increment, &u, angle, &mut point, whole)
                }
                Model::Linear => self.linear_step(&increment, &u, &mut point, known[sample]),
                _ => panic!("a model that this oracle does not know"),
            };
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
