//! Newmark's method, γ = ½ and β = ¼, on the reduced model.
//!
//! The modes' motion is computed on top of the rigid rotation at the nominal speed, in which the mesh does not
//! deflect: Newmark's method carries a uniform motion exactly, so nothing changes but the rounding, which would
//! otherwise grow with the angle turned.
//!
//! Source: N. M. Newmark, "A method of computation for structural dynamics", Journal of the Engineering
//! Mechanics Division 85 (1959); the iteration on the angle-dependent stiffness is the paper's (section 4, item 3).

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

use super::reduce::ReducedModel;
use super::{Recorder, StateView};
use crate::dynamics::{Excitation, MeshLoad, System};
use crate::sampling::{CycleGrid, TimeGrid};
use crate::scenario::Convention;

/// Most Newton–Raphson iterations of a step.
const MOST_ITERATIONS: usize = 11;
/// Energy norm at which the published iteration stops.
const PUBLISHED_TOLERANCE: f64 = 1e-5;

/// Integrates the equations of motion and hands every sample's state to `recorder`.
///
/// # Arguments
/// * `model` - the reduced model
/// * `system` - for the mesh stiffness over the cycle
/// * `time`, `cycle` - divisions of time and cycle
/// * `excitation` - one per sample, at least `time.samples`
/// * `convention` - damping and iteration: published or corrected
/// * `recorder` - takes the states
pub fn integrate(
    model: &ReducedModel,
    system: &System,
    time: &TimeGrid,
    cycle: &CycleGrid,
    excitation: impl Iterator<Item = Excitation>,
    convention: Convention,
    recorder: &mut impl Recorder,
) {
    // Fixed sizes keep the step free of allocation and let the compiler unroll it.
    match (model.modes(), model.directions.len()) {
        (0..=8, 0..=1) => run::<8, 1>(model, system, time, cycle, excitation, convention, recorder),
        (0..=8, 2) => run::<8, 2>(model, system, time, cycle, excitation, convention, recorder),
        (0..=8, 3) => run::<8, 3>(model, system, time, cycle, excitation, convention, recorder),
        _ => run::<16, 5>(model, system, time, cycle, excitation, convention, recorder),
    }
}

/// What the step needs at one coarse point of the cycle.
#[derive(Clone, Copy)]
struct CyclePoint<const R: usize> {
    /// (N/m) `S − S_mean`.
    deviation: [[f64; R]; R],
    /// (N/m) `S' (1 + G S')⁻¹` with `S' = S − S_mean`, `G = Bᵀ D⁻¹ B`: the Woodbury correction.
    correction: [[f64; R]; R],
    /// (N/m) `k · mean(g)`: mesh force per mesh deflection in each direction.
    load: [f64; R],
}

struct Stepper<'a, const N: usize, const R: usize> {
    load: &'a MeshLoad,
    directions: &'a [usize],
    stiffness: [f64; N],
    damping: [f64; N],
    /// `1/D`, `D = ω² + (γ/(β dt)) 2ζω + 1/(β dt²)`.
    inverse: [f64; N],
    mesh: [[f64; N]; R],
    motor: [f64; N],
    brake: [f64; N],
    rigid: [f64; N],
    rotation_rad_per_s: f64,
    /// The rigid rotation's part of a step's displacement and of its right-hand side, for the published energy norm.
    rigid_displacement: [f64; N],
    rigid_increment: [f64; N],
    pinion_angle: [f64; N],
    points: Vec<CyclePoint<R>>,
    coarse_points_per_rad: f64,
    step_s: f64,
}

fn padded<const N: usize>(values: &[f64]) -> [f64; N] {
    let mut array = [0.0; N];
    array[..values.len()].copy_from_slice(values);
    array
}

#[inline(always)]
fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    let mut sum = 0.0;
    for n in 0..N {
        sum += a[n] * b[n];
    }
    sum
}

impl<'a, const N: usize, const R: usize> Stepper<'a, N, R> {
    fn new(model: &'a ReducedModel, system: &'a System, time: &TimeGrid, cycle: &CycleGrid) -> Self {
        let dt = time.step_s();
        let (stiffness, damping) = (padded::<N>(&model.stiffness), padded::<N>(&model.damping));
        let mut inverse = [0.0; N];
        for n in 0..N {
            inverse[n] = 1.0 / (stiffness[n] + 2.0 / dt * damping[n] + 4.0 / (dt * dt));
        }
        let mut mesh = [[0.0; N]; R];
        for (column, source) in mesh.iter_mut().zip(&model.mesh) {
            *column = padded(source.as_slice());
        }
        let pinion_angle: Vec<f64> =
            (model.shapes.iter()).map(|shape| shape[crate::dynamics::coordinates::THETA_PINION]).collect();
        let motor: [f64; N] = padded(&model.motor);
        let rigid: [f64; N] = padded(&model.rigid_velocity);
        let rotation = model.rotation_rad_per_s;
        let mut rigid_displacement = [0.0; N];
        let mut rigid_increment = [0.0; N];
        for n in 0..N {
            rigid_displacement[n] = rigid[n] * rotation * dt;
            // K̂ r = k_p e_θp + (2/dt) C r + (4/dt²) M r, whatever the mesh stiffness.
            rigid_increment[n] =
                motor[n] * rotation * dt + (2.0 * damping[n] + 4.0 / dt) * rigid[n] * rotation;
        }
        Self {
            rotation_rad_per_s: rotation,
            rigid_displacement,
            rigid_increment,
            load: &system.mesh,
            directions: &model.directions,
            points: cycle_points(model, system, &inverse),
            stiffness,
            damping,
            inverse,
            mesh,
            motor,
            brake: padded(&model.brake),
            rigid,
            pinion_angle: padded(&pinion_angle),
            coarse_points_per_rad: 1.0 / (2.0 * PI * cycle.coarse_step_rev),
            step_s: dt,
        }
    }

    /// Coarse point of the cycle at which the pinion has turned by `angle_rad`.
    #[inline(always)]
    fn point(&self, angle_rad: f64) -> usize {
        let nearest = (angle_rad * self.coarse_points_per_rad).round() as i64;
        nearest.rem_euclid(self.points.len() as i64) as usize
    }

    /// Mesh deflection in each direction.
    #[inline(always)]
    fn deflection(&self, modal: &[f64; N]) -> [f64; R] {
        let mut deflection = [0.0; R];
        for r in 0..R {
            deflection[r] = dot(&self.mesh[r], modal);
        }
        deflection
    }

    #[inline(always)]
    fn add_mesh(&self, modal: &mut [f64; N], factor: f64, amplitude: &[f64; R]) {
        for r in 0..R {
            let a = factor * amplitude[r];
            for n in 0..N {
                modal[n] += a * self.mesh[r][n];
            }
        }
    }

    /// `K̂(point)⁻¹ residual`.
    #[inline(always)]
    fn solve(&self, point: &CyclePoint<R>, residual: &[f64; N]) -> [f64; N] {
        let mut solution = [0.0; N];
        for n in 0..N {
            solution[n] = self.inverse[n] * residual[n];
        }
        let amplitude = product(&point.correction, &self.deflection(&solution));
        let mut corrected = *residual;
        self.add_mesh(&mut corrected, -1.0, &amplitude);
        for n in 0..N {
            solution[n] = self.inverse[n] * corrected[n];
        }
        solution
    }

    /// (rad) Angle of the rigid rotation at a sample.
    fn rotation(&self, sample: usize) -> f64 {
        self.rotation_rad_per_s * (sample as f64 * self.step_s)
    }

    /// Modal force of an excitation at a sample, on top of what the rigid rotation needs.
    fn force(&self, sample: usize, excitation: &Excitation, convention: Convention) -> [f64; N] {
        let mut force = [0.0; N];
        // Convention: under `corrected` damping acts on the velocity relative to the motor's rigid rotation, under
        // `published` on the whole velocity.
        let undamped_speed = match convention {
            Convention::Published => 0.0,
            Convention::Corrected => excitation.motor_speed_rad_per_s,
        };
        let motor_lead = excitation.motor_angle_rad - self.rotation(sample);
        for n in 0..N {
            force[n] = self.motor[n] * motor_lead
                + self.brake[n] * excitation.brake_torque_nm
                + self.damping[n] * self.rigid[n] * (undamped_speed - self.rotation_rad_per_s);
        }
        if excitation.error_force_n != 0.0 {
            let direction =
                self.load.error_direction(excitation.position_rev, excitation.coarse_point, convention);
            let mut picked = [0.0; R];
            for (weight, &direction_index) in picked.iter_mut().zip(self.directions) {
                *weight = direction[direction_index];
            }
            self.add_mesh(&mut force, -excitation.error_force_n, &picked);
        }
        force
    }
}

#[inline(always)]
fn product<const R: usize>(matrix: &[[f64; R]; R], vector: &[f64; R]) -> [f64; R] {
    let mut result = [0.0; R];
    for r in 0..R {
        result[r] = dot(&matrix[r], vector);
    }
    result
}

fn cycle_points<const N: usize, const R: usize>(
    model: &ReducedModel,
    system: &System,
    inverse: &[f64; N],
) -> Vec<CyclePoint<R>> {
    let columns = model.directions.len();
    let load = &system.mesh;
    let nominal = load.nominal.pressure_angle_rad;
    let weight = DVector::from_fn(model.modes(), |n, _| inverse[n]);
    let compliance =
        DMatrix::from_fn(columns, columns, |r, c| model.mesh[r].component_mul(&weight).dot(&model.mesh[c]));
    let identity = DMatrix::<f64>::identity(columns, columns);
    (0..load.stiffness_n_per_m.len())
        .map(|point| {
            let k = load.stiffness_n_per_m[point];
            let state = load.state(point);
            let square = state.mean_square(nominal);
            let mean_direction = state.mean_direction(nominal);
            let deviation = DMatrix::from_fn(columns, columns, |r, c| {
                k * square[(model.directions[r], model.directions[c])]
            }) - &model.mean_mesh_stiffness;
            // K̂ is positive definite, so 1 + G S' is never singular.
            let inverted = (&identity + &compliance * &deviation).try_inverse();
            let correction = inverted.map_or_else(|| deviation.clone(), |inverted| &deviation * inverted);
            let mut entry =
                CyclePoint { deviation: [[0.0; R]; R], correction: [[0.0; R]; R], load: [0.0; R] };
            for r in 0..columns {
                for c in 0..columns {
                    entry.deviation[r][c] = deviation[(r, c)];
                    entry.correction[r][c] = correction[(r, c)];
                }
                entry.load[r] = k * mean_direction[model.directions[r]];
            }
            entry
        })
        .collect()
}

fn run<const N: usize, const R: usize>(
    model: &ReducedModel,
    system: &System,
    time: &TimeGrid,
    cycle: &CycleGrid,
    mut excitation: impl Iterator<Item = Excitation>,
    convention: Convention,
    recorder: &mut impl Recorder,
) {
    let stepper = Stepper::<N, R>::new(model, system, time, cycle);
    let Some(mut now) = excitation.next() else { return };
    let (two_per_dt, four_per_dt2) = (2.0 / stepper.step_s, 4.0 / (stepper.step_s * stepper.step_s));

    let mut u: [f64; N] = padded(&model.initial_displacement);
    let mut v: [f64; N] = padded(&model.initial_velocity);
    let mut force = stepper.force(0, &now, convention);
    let mut point = stepper.point(dot(&stepper.pinion_angle, &u));
    let mut a = [0.0; N];
    for n in 0..N {
        a[n] = force[n] - stepper.damping[n] * v[n] - stepper.stiffness[n] * u[n];
    }
    let amplitude = product(&stepper.points[point].deviation, &stepper.deflection(&u));
    stepper.add_mesh(&mut a, -1.0, &amplitude);

    for sample in 0..time.samples {
        let mesh_force_n = dot(&stepper.points[point].load, &stepper.deflection(&u)) + now.error_force_n;
        recorder.record(
            sample,
            &StateView {
                displacement: &u,
                velocity: &v,
                acceleration: &a,
                rotation_rad: stepper.rotation(sample),
                rotation_rad_per_s: stepper.rotation_rad_per_s,
                mesh_force_n,
            },
        );
        let Some(next) = excitation.next() else { return };
        let next_force = stepper.force(sample + 1, &next, convention);
        let mut increment = [0.0; N];
        for n in 0..N {
            increment[n] =
                next_force[n] - force[n] + (2.0 * two_per_dt + 2.0 * stepper.damping[n]) * v[n] + 2.0 * a[n];
        }
        let angle = dot(&stepper.pinion_angle, &u) + stepper.rotation(sample + 1);
        let deflection = stepper.deflection(&u);
        let (displacement, at) = match convention {
            Convention::Published => published_step(&stepper, &increment, angle, point, &deflection),
            Convention::Corrected => corrected_step(&stepper, &increment, angle, point, &deflection),
        };
        point = at;
        for n in 0..N {
            let velocity_change = two_per_dt * displacement[n] - 2.0 * v[n];
            let acceleration_change = four_per_dt2 * displacement[n] - 2.0 * two_per_dt * v[n] - 2.0 * a[n];
            u[n] += displacement[n];
            v[n] += velocity_change;
            a[n] += acceleration_change;
            // The force at the new state instead of the given one, so that errors do not accumulate.
            force[n] = a[n] + stepper.damping[n] * v[n] + stepper.stiffness[n] * u[n];
        }
        let amplitude = product(&stepper.points[point].deviation, &stepper.deflection(&u));
        stepper.add_mesh(&mut force, 1.0, &amplitude);
        now = next;
    }
}

/// Residual's change by the difference of stiffness between two points: `(K(from) − K(to)) u`.
#[inline(always)]
fn stiffness_change<const N: usize, const R: usize>(
    stepper: &Stepper<N, R>,
    from: usize,
    to: usize,
    deflection: &[f64; R],
) -> [f64; R] {
    let before = product(&stepper.points[from].deviation, deflection);
    let after = product(&stepper.points[to].deviation, deflection);
    let mut change = [0.0; R];
    for r in 0..R {
        change[r] = before[r] - after[r];
    }
    change
}

/// The published iteration: full Newton steps from the residual until the energy norm is small.
#[inline(always)]
fn published_step<const N: usize, const R: usize>(
    stepper: &Stepper<N, R>,
    increment: &[f64; N],
    angle: f64,
    start: usize,
    deflection: &[f64; R],
) -> ([f64; N], usize) {
    let mut displacement = [0.0; N];
    let mut residual = *increment;
    let mut point = start;
    for iteration in 0..MOST_ITERATIONS {
        let change = stepper.solve(&stepper.points[point], &residual);
        for n in 0..N {
            displacement[n] += change[n];
        }
        let mut whole = 0.0;
        for n in 0..N {
            whole += (increment[n] + stepper.rigid_increment[n])
                * (displacement[n] + stepper.rigid_displacement[n]);
        }
        // The first change is the whole displacement, so its norm is 1.
        let error = if iteration == 0 { 1.0 } else { (dot(&residual, &change) / whole).abs() };
        point = stepper.point(angle + dot(&stepper.pinion_angle, &displacement));
        for n in 0..N {
            residual[n] = increment[n] - displacement[n] / stepper.inverse[n];
        }
        let here = product(&stepper.points[point].deviation, &stepper.deflection(&displacement));
        stepper.add_mesh(&mut residual, -1.0, &here);
        stepper.add_mesh(&mut residual, 1.0, &stiffness_change(stepper, start, point, deflection));
        let continues = error > PUBLISHED_TOLERANCE;
        if !continues {
            break;
        }
    }
    (displacement, point)
}

/// The same equation solved exactly for a given point of the cycle, until the point no longer changes.
#[inline(always)]
fn corrected_step<const N: usize, const R: usize>(
    stepper: &Stepper<N, R>,
    increment: &[f64; N],
    angle: f64,
    start: usize,
    deflection: &[f64; R],
) -> ([f64; N], usize) {
    let mut point = start;
    let mut displacement = stepper.solve(&stepper.points[point], increment);
    for _ in 0..MOST_ITERATIONS {
        let next = stepper.point(angle + dot(&stepper.pinion_angle, &displacement));
        if next == point {
            break;
        }
        point = next;
        let mut residual = *increment;
        stepper.add_mesh(&mut residual, 1.0, &stiffness_change(stepper, start, point, deflection));
        displacement = stepper.solve(&stepper.points[point], &residual);
    }
    (displacement, point)
}
