//! Time integration: Newmark's method (γ = ½, β = ¼) with Newton and Raphson's iteration on the angle-dependent stiffness.
//!
//! The unknown is `u` less the rigid rotation at the nominal speed, whose forces are subtracted: the equations are the same, and
//! rounding does not grow with the angle turned. Matrices are dense, over the `N` turned coordinates that anything sets in motion.
//!
//! Sources: N. M. Newmark, "A method of computation for structural dynamics", Journal of the Engineering Mechanics Division 85 (1959);
//! the paper's section 4, item 3.

use std::f64::consts::TAU;

use super::Published;
use super::machine::Forcing;
use super::machine::coordinates::*;
use super::mesh::{LoadState, PublishedMesh};
use crate::machine::{Axis, GEAR};
use crate::solver::{Block, Diverged, Output, Recorder};

/// Most iterations of a step.
const MOST_ITERATIONS: usize = 11;
/// Energy norm at which the iteration stops.
const TOLERANCE: f64 = 1e-5;
/// Samples that are handed out at a time.
const BLOCK: usize = 512;

type Vector<const N: usize> = [f64; N];
type Matrix<const N: usize> = [[f64; N]; N];

/// Integrates the equations of motion of a simulation from its start.
///
/// # Arguments
/// * `published` - the simulation
/// * `outputs` - what is read off the solution
/// * `first_sample` - first sample that is recorded
/// * `recorder` - takes the outputs
///
/// # Errors
/// A solution that grows without bound; nothing is recorded of the block in which that happens.
pub(crate) fn integrate(
    published: &Published,
    outputs: &[Output],
    first_sample: usize,
    recorder: &mut dyn Recorder,
) -> Result<(), Diverged> {
    match published.moving_coordinates().len() {
        0..=5 => Newmark::<5>::new(published, outputs).run(first_sample, recorder),
        6..=7 => Newmark::<7>::new(published, outputs).run(first_sample, recorder),
        _ => Newmark::<COORDINATES>::new(published, outputs).run(first_sample, recorder),
    }
}

/// What does not change from step to step.
struct Newmark<'a, const N: usize> {
    published: &'a Published,
    mesh: &'a PublishedMesh,
    /// Which of the turned coordinates the `N` are.
    coordinates: [usize; N],
    step_s: f64,
    mass: Vector<N>,
    damping: Matrix<N>,
    constant_stiffness: Matrix<N>,
    /// `K̂` without the mesh, `K + (2/dt) C + (4/dt²) M`, and its inverse.
    effective: Matrix<N>,
    inverse: Matrix<N>,
    /// The mesh's lines of action: those of the disturbed points of the cycle, and the nominal one last.
    lines: Vec<Line<N>>,
    /// Places of the pinion's and the brake's rotation among the `N`.
    pinion: usize,
    brake: usize,
    /// (rad/s) Nominal speed of the motor.
    speed_rad_per_s: f64,
    /// The rigid rotation in a step, and its part of the right-hand side.
    rigid_step: Vector<N>,
    rigid_increment: Vector<N>,
    /// Damping of the rigid rotation.
    drag: Vector<N>,
    /// The directions in which the deviations' force acts.
    nominal_line: [Vector<N>; 2],
    outputs: Vec<OutputRow<N>>,
}

/// The mesh's line of action: how a unit of mesh stiffness couples the coordinates.
struct Line<const N: usize> {
    /// The line in the middle of the face, and what is added to it per m along the face.
    directions: [Vector<N>; 2],
    /// Displacements under unit forces along both, of `K̂` without the mesh.
    moved: [Vector<N>; 2],
    /// Displacement along both under unit forces along both.
    compliance: [[f64; 2]; 2],
    /// (m, m²) Means of z and z² over the contact width.
    mean_z: f64,
    mean_z2: f64,
}

/// A motion at one sample.
#[derive(Clone, Copy)]
struct State<const N: usize> {
    displacement: Vector<N>,
    velocity: Vector<N>,
    acceleration: Vector<N>,
    /// Force that is in equilibrium with them: the published code replaces what is given by it, so that errors do not accumulate.
    force: Vector<N>,
    /// Coarse point of the cycle at the pinion's own angle.
    point: usize,
    /// Coarse point at which the step was solved: the mesh's force is the one there.
    solved_point: usize,
}

/// An output as a combination of the coordinates.
enum OutputRow<const N: usize> {
    /// Of displacements, or of that derivative of them.
    Motion {
        derivative: usize,
        weights: Vector<N>,
        /// The rigid rotation's part, per rad or rad/s of the motor.
        rigid: f64,
    },
    MeshForce,
}

impl<'a, const N: usize> Newmark<'a, N> {
    fn new(published: &'a Published, outputs: &[Output]) -> Self {
        let (machine, mesh) = (&published.machine, &published.mesh);
        let coordinates = picked(&published.moving_coordinates());
        let pick = |vector: &CoordinateVector| coordinates.map(|n| vector[n]);
        let pick_matrix =
            |matrix: &CoordinateMatrix| coordinates.map(|r| coordinates.map(|c| matrix[(r, c)]));
        let place = |coordinate| coordinates.iter().position(|&n| n == coordinate).unwrap_or(0);
        let step_s = published.time.step_s();
        let effective = machine.constant_stiffness
            + machine.damping * (2.0 / step_s)
            + CoordinateMatrix::from_diagonal(&(machine.mass * (4.0 / (step_s * step_s))));
        // Positive definite: mass and stiffness are positive.
        let inverse = effective.try_inverse().unwrap_or_else(CoordinateMatrix::zeros);
        let line = |load: &LoadState| {
            let directions = machine.turned_line(load.pressure_angle_rad);
            let moved = directions.map(|direction| inverse * direction);
            Line {
                compliance: directions.map(|along| moved.map(|moved| along.dot(&moved))),
                directions: directions.map(|direction| pick(&direction)),
                moved: moved.map(|moved| pick(&moved)),
                mean_z: load.mean_z_m,
                mean_z2: load.mean_z2_m2,
            }
        };
        let speed_rad_per_s = published.nominal_speed_rad_per_s();
        let rigid_step = machine.rigid_rotation() * (speed_rad_per_s * step_s);
        Self {
            published,
            mesh,
            coordinates,
            step_s,
            mass: pick(&machine.mass),
            damping: pick_matrix(&machine.damping),
            constant_stiffness: pick_matrix(&machine.constant_stiffness),
            effective: pick_matrix(&effective),
            inverse: pick_matrix(&inverse),
            lines: mesh.load.faulty.iter().chain([&mesh.load.nominal]).map(line).collect(),
            pinion: place(THETA_PINION),
            brake: place(THETA_BRAKE),
            speed_rad_per_s,
            // The mesh does not deflect in it.
            rigid_increment: pick(&(effective * rigid_step)),
            rigid_step: pick(&rigid_step),
            drag: pick(&(machine.damping * machine.rigid_rotation() * speed_rad_per_s)),
            nominal_line: machine.turned_line(machine.nominal_angle_rad).map(|direction| pick(&direction)),
            outputs: outputs.iter().map(|output| row(published, output, &coordinates)).collect(),
        }
    }

    /// The motion at the start: as given, and the acceleration by the equations of motion.
    fn first_state(&self, force: Vector<N>) -> State<N> {
        let machine = &self.published.machine;
        let pick = |vector: CoordinateVector| self.coordinates.map(|n| machine.turned(&vector)[n]);
        let displacement = pick(self.published.initial_displacement());
        let velocity = pick(self.published.initial_relative_velocity());
        let point = self.point(displacement[self.pinion]);
        let held = sum(&times(&self.damping, &velocity), &self.stiffness_times(point, &displacement));
        let acceleration = std::array::from_fn(|n| (force[n] - held[n]) / self.mass[n]);
        State { displacement, velocity, acceleration, force, point, solved_point: point }
    }

    /// The force at a sample, relative to that of the rigid rotation, which is damped as any other motion.
    fn force(&self, sample: usize, forcing: &Forcing) -> Vector<N> {
        let [line, tilt] = &self.nominal_line;
        let errors = forcing.error_force_n;
        let mut force: Vector<N> =
            std::array::from_fn(|n| -self.drag[n] - errors * (line[n] + forcing.error_mean_z_m * tilt[n]));
        let shaft = self.published.machine.shaft_stiffness_nm_per_rad[0];
        force[self.pinion] += shaft * (forcing.motor_angle_rad - self.rotation_rad(sample));
        force[self.brake] += forcing.brake_torque_nm;
        force
    }

    /// Solves all samples and hands them out in blocks.
    fn run(&self, first_sample: usize, recorder: &mut dyn Recorder) -> Result<(), Diverged> {
        let mut block: Vec<Vec<f64>> = vec![Vec::with_capacity(BLOCK); self.outputs.len()];
        let mut state = None;
        for (sample, forcing) in self.published.forcing().take(self.published.time.samples).enumerate() {
            let force = self.force(sample, &forcing);
            let now = match &state {
                None => self.first_state(force),
                Some(before) => self.step(before, &force, self.rotation_rad(sample)),
            };
            if sample >= first_sample {
                for (row, values) in self.outputs.iter().zip(&mut block) {
                    values.push(self.output(row, &now, sample, forcing.error_force_n));
                }
            }
            state = Some(now);
            let is_last = sample + 1 == self.published.time.samples;
            if is_last || (sample + 1).is_multiple_of(BLOCK) {
                if !now.displacement.iter().chain(&now.velocity).all(|value| value.is_finite()) {
                    return Err(Diverged { sample: sample + 1 });
                }
                if sample >= first_sample {
                    let recorded = block.first().map_or(0, Vec::len);
                    recorder.record(&Block::new(sample + 1 - recorded, &block));
                    block.iter_mut().for_each(Vec::clear);
                }
                if !recorder.goes_on() {
                    break;
                }
            }
        }
        Ok(())
    }

    /// One step: the iteration ends when the energy of its last change is small beside that of the step. Both hold the rigid
    /// rotation, which the published unknown has.
    fn step(&self, before: &State<N>, force: &Vector<N>, rotation_rad: f64) -> State<N> {
        let State { displacement, velocity, acceleration, .. } = before;
        let dt = self.step_s;
        let damped = times(&self.damping, velocity);
        let increment: Vector<N> = std::array::from_fn(|n| {
            force[n] - before.force[n]
                + 2.0 * damped[n]
                + self.mass[n] * (4.0 / dt * velocity[n] + 2.0 * acceleration[n])
        });
        let mut change = [0.0; N];
        let mut residual = increment;
        let (mut point, mut solved_point) = (before.point, before.point);
        for iteration in 0..MOST_ITERATIONS {
            let correction = self.solve(point, &residual);
            solved_point = point;
            change = sum(&change, &correction);
            let whole = dot(&sum(&increment, &self.rigid_increment), &sum(&change, &self.rigid_step));
            let error = if iteration == 0 { 1.0 } else { (dot(&residual, &correction) / whole).abs() };
            point = self.point(displacement[self.pinion] + change[self.pinion] + rotation_rad);
            residual = std::array::from_fn(|n| increment[n] - dot(&self.effective[n], &change));
            self.add_mesh(&mut residual, point, &change, -1.0);
            if point != before.point {
                self.add_mesh(&mut residual, before.point, displacement, 1.0);
                self.add_mesh(&mut residual, point, displacement, -1.0);
            }
            if error <= TOLERANCE {
                break;
            }
        }
        let displacement = sum(displacement, &change);
        let acceleration: Vector<N> =
            std::array::from_fn(|n| 4.0 / (dt * dt) * change[n] - 4.0 / dt * velocity[n] - acceleration[n]);
        let velocity: Vector<N> = std::array::from_fn(|n| 2.0 / dt * change[n] - velocity[n]);
        let held = sum(&times(&self.damping, &velocity), &self.stiffness_times(point, &displacement));
        let force = std::array::from_fn(|n| self.mass[n] * acceleration[n] + held[n]);
        State { displacement, velocity, acceleration, force, point, solved_point }
    }

    /// `K̂⁻¹ r` at a point of the cycle: the mesh changes `K̂` by a matrix of rank 2 (Sherman, Morrison, Woodbury).
    fn solve(&self, point: usize, right_hand_side: &Vector<N>) -> Vector<N> {
        let alone = times(&self.inverse, right_hand_side);
        let line = self.line(point);
        let stiffness = self.mesh.load.stiffness_n_per_m[point];
        let [s0, s1] = line.force(stiffness, &alone);
        let [c0, c1] = line.compliance;
        let coupled = |c: [f64; 2]| [c[0] + line.mean_z * c[1], line.mean_z * c[0] + line.mean_z2 * c[1]];
        // Columns of 1 + S Γ; Γ is symmetric.
        let ([m00, m10], [m01, m11]) = (coupled(c0), coupled(c1));
        let (m00, m11) = (1.0 + stiffness * m00, 1.0 + stiffness * m11);
        let (m01, m10) = (stiffness * m01, stiffness * m10);
        let determinant = m00 * m11 - m01 * m10;
        let forces = [(s0 * m11 - m01 * s1) / determinant, (m00 * s1 - m10 * s0) / determinant];
        std::array::from_fn(|n| alone[n] - line.moved[0][n] * forces[0] - line.moved[1][n] * forces[1])
    }

    /// `K u` at a point of the cycle.
    fn stiffness_times(&self, point: usize, displacement: &Vector<N>) -> Vector<N> {
        let mut force = times(&self.constant_stiffness, displacement);
        self.add_mesh(&mut force, point, displacement, 1.0);
        force
    }

    /// Adds the mesh's part of `K u` at a point of the cycle, times a factor.
    fn add_mesh(&self, sum: &mut Vector<N>, point: usize, displacement: &Vector<N>, factor: f64) {
        let line = self.line(point);
        let [whole, tilting] = line.force(factor * self.mesh.load.stiffness_n_per_m[point], displacement);
        let [along, tilt] = &line.directions;
        for n in 0..N {
            sum[n] += along[n] * whole + tilt[n] * tilting;
        }
    }

    fn line(&self, point: usize) -> &Line<N> {
        &self.lines[point.min(self.lines.len() - 1)]
    }

    /// The coarse point of the cycle nearest to an angle of the pinion.
    fn point(&self, angle_rad: f64) -> usize {
        self.mesh.coarse_point(angle_rad / TAU)
    }

    /// (rad) Angle of the rigid rotation.
    fn rotation_rad(&self, sample: usize) -> f64 {
        self.speed_rad_per_s * (sample as f64 * self.step_s)
    }

    fn output(&self, row: &OutputRow<N>, state: &State<N>, sample: usize, error_force_n: f64) -> f64 {
        match row {
            OutputRow::Motion { derivative: 0, weights, rigid } => {
                dot(weights, &state.displacement) + rigid * self.rotation_rad(sample)
            }
            OutputRow::Motion { derivative: 1, weights, rigid } => {
                dot(weights, &state.velocity) + rigid * self.speed_rad_per_s
            }
            OutputRow::Motion { weights, .. } => dot(weights, &state.acceleration),
            OutputRow::MeshForce => {
                let stiffness = self.mesh.load.stiffness_n_per_m[state.solved_point];
                self.line(state.solved_point).force(stiffness, &state.displacement)[0] + error_force_n
            }
        }
    }
}

impl<const N: usize> Line<N> {
    /// Force of the mesh along both directions.
    fn force(&self, stiffness_n_per_m: f64, displacement: &Vector<N>) -> [f64; 2] {
        let [whole, tilting] =
            [&self.directions[0], &self.directions[1]].map(|along| dot(along, displacement));
        [
            stiffness_n_per_m * (whole + self.mean_z * tilting),
            stiffness_n_per_m * (self.mean_z * whole + self.mean_z2 * tilting),
        ]
    }
}

/// An output in the picked coordinates. There are no supports that move: every sensor shows the sum of both wheels' accelerations.
fn row<const N: usize>(published: &Published, output: &Output, coordinates: &[usize; N]) -> OutputRow<N> {
    let machine = &published.machine;
    let motion = |derivative: usize, terms: &[(usize, f64)]| {
        let mut weights = CoordinateVector::zeros();
        terms.iter().for_each(|&(coordinate, weight)| weights[coordinate] = weight);
        let mut turned = machine.turned(&weights);
        if published.wheels_move_in_opposition() {
            // Their sum is no signal but rounding.
            for (gear, pinion) in [(X_GEAR, X_PINION), (Y_GEAR, Y_PINION)] {
                if turned[gear] == turned[pinion] {
                    (turned[gear], turned[pinion]) = (0.0, 0.0);
                }
            }
        }
        let rigid = machine.rigid_rotation().dot(&weights);
        OutputRow::Motion { derivative, weights: coordinates.map(|n| turned[n]), rigid }
    };
    let of_both = |derivative: usize, axis: Axis, factor: f64| {
        let wheels = match axis {
            Axis::X => [X_GEAR, X_PINION],
            Axis::Y => [Y_GEAR, Y_PINION],
            Axis::Z => [Z_GEAR, Z_PINION],
            Axis::Rotation => [THETA_GEAR, THETA_PINION],
        };
        motion(derivative, &wheels.map(|wheel| (wheel, factor)))
    };
    match output {
        &Output::Acceleration { axis, factor, .. } => of_both(2, axis, factor),
        &Output::Displacement { axis, factor, .. } => of_both(0, axis, factor),
        // The gear turns backwards.
        Output::Velocity { place, factor, .. } if place == GEAR => motion(1, &[(THETA_GEAR, -factor)]),
        Output::Velocity { factor, .. } => motion(1, &[(THETA_PINION, *factor)]),
        &Output::Coordinate { number, derivative } => motion(derivative, &[(number, 1.0)]),
        Output::MeshForce { .. } => OutputRow::MeshForce,
        // Its flanks do not rub, and it has no ring.
        Output::FrictionLoss { .. } | Output::OnRing(_) => motion(0, &[]),
    }
}

/// `N` coordinates: those in motion, and others beside them that stay at rest.
fn picked<const N: usize>(moving: &[usize]) -> [usize; N] {
    let still = (0..COORDINATES).filter(|n| !moving.contains(n));
    let mut all = moving.iter().copied().chain(still);
    std::array::from_fn(|_| all.next().unwrap_or(0))
}

fn dot<const N: usize>(a: &Vector<N>, b: &Vector<N>) -> f64 {
    let mut sum = 0.0;
    for n in 0..N {
        sum += a[n] * b[n];
    }
    sum
}

fn sum<const N: usize>(a: &Vector<N>, b: &Vector<N>) -> Vector<N> {
    std::array::from_fn(|n| a[n] + b[n])
}

fn times<const N: usize>(matrix: &Matrix<N>, vector: &Vector<N>) -> Vector<N> {
    // Column by column: all entries of the result at once.
    let mut product = [0.0; N];
    for c in 0..N {
        for r in 0..N {
            // Symmetric.
            product[r] += matrix[c][r] * vector[c];
        }
    }
    product
}
