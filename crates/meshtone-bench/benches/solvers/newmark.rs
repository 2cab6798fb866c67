//! A dense Newmark solver as a careful engineer would write it for a steady healthy or damaged pair: the yardstick for
//! what modes and low rank gain.
//!
//! Average acceleration (γ = ½, β = ¼) in the 13 coordinates, relative to the rigid rotation. At constant speed and load
//! the mesh's stiffness repeats with the points of its table, so the inverse of each effective matrix is made beforehand;
//! a step is two products of a 13 × 13 matrix and a vector, in arrays of fixed size, compiled for the vector
//! instructions that the processor has.

use meshtone::Stages;
use meshtone::machine::coordinates::*;
use pulp::{Arch, NullaryFnOnce};

/// Rows of a column, filled up with zeros to whole vectors.
const ROWS: usize = 16;
/// (m/s²) What the signals are divided by.
const STANDARD_GRAVITY: f64 = 9.81;

type Vector = [f64; ROWS];
/// Column after column.
type Matrix = [Vector; COORDINATES];

/// What a run needs of the stages.
pub struct Newmark<'a> {
    stages: &'a Stages,
    /// Inverse of the effective stiffness `K + 2/h C + 4/h² M` at each point of the mesh's table.
    inverses: Vec<Matrix>,
    mass: Vector,
    damping: Matrix,
    /// Force of the brake, and of one newton of deviation force in each direction of the mesh.
    brake: Vector,
    deviations: [Vector; 5],
    step_s: f64,
}

impl<'a> Newmark<'a> {
    /// Makes the inverses.
    pub fn new(stages: &'a Stages) -> Self {
        assert!(stages.is_steady(), "the mesh stiffness is a table only at constant speed and load");
        let (system, step_s) = (&stages.system, stages.time.step_s());
        let mass = CoordinateVector::from(system.mass_diagonal);
        let damping = system.damping_matrix();
        let constant =
            damping * (2.0 / step_s) + CoordinateMatrix::from_diagonal(&(mass * (4.0 / (step_s * step_s))));
        let points = stages.mesh.pairs().expect("tooth pairs").entries();
        let inverse = |point| {
            let effective = system.stiffness_matrix_at(&stages.mesh, point) + constant;
            columns(&effective.cholesky().expect("definite").inverse())
        };
        let mut brake = [0.0; ROWS];
        brake[THETA_BRAKE] = stages.scenario.operation.brake_torque_nm;
        Self {
            stages,
            inverses: (0..points).map(inverse).collect(),
            mass: padded(&mass),
            damping: columns(&damping),
            brake,
            deviations: system.directions.turned.map(|turned| padded(&-(system.directions.turn * turned))),
            step_s,
        }
    }

    /// (g) The kept samples of the horizontal, vertical and axial acceleration.
    pub fn signals(&self) -> [Vec<f64>; 3] {
        Arch::new().dispatch(self)
    }

    /// Static displacement under a force.
    fn equilibrium(&self, force: &Vector, point: usize) -> Vector {
        let stiffness = self.stages.system.stiffness_matrix_at(&self.stages.mesh, point);
        let force = CoordinateVector::from_fn(|i, _| force[i]);
        padded(&stiffness.cholesky().expect("definite").solve(&force))
    }
}

/// The time loop. Only loops: a closure would be compiled without the processor's vector instructions.
impl NullaryFnOnce for &Newmark<'_> {
    type Output = [Vec<f64>; 3];

    #[inline(always)]
    fn call(self) -> [Vec<f64>; 3] {
        let (h, time) = (self.step_s, &self.stages.time);
        let (a0, a1, a2) = (4.0 / (h * h), 2.0 / h, 4.0 / h);
        let pairs = self.stages.mesh.pairs().expect("tooth pairs");
        let mut signals = [(); 3].map(|()| Vec::with_capacity(time.kept_samples()));
        let (mut u, mut v, mut a) = ([0.0; ROWS], [0.0; ROWS], [0.0; ROWS]);
        for (sample, excitation) in self.stages.excitation().enumerate().take(time.samples) {
            let mut right = self.brake;
            for (one_newton, newtons) in self.deviations.iter().zip(excitation.deviation_force_n()) {
                add_scaled(&mut right, one_newton, newtons);
            }
            if sample == 0 {
                u = self.equilibrium(&right, pairs.entry(0));
            } else {
                // K̂ u⁺ = F⁺ + M (4/h² u + 4/h v + a) + C (2/h u + v).
                let mut damped = [0.0; ROWS];
                for i in 0..ROWS {
                    let inertial = a0.mul_add(u[i], a2.mul_add(v[i], a[i]));
                    right[i] = self.mass[i].mul_add(inertial, right[i]);
                    damped[i] = a1.mul_add(u[i], v[i]);
                }
                add_product(&mut right, &self.damping, &damped);
                let mut next = [0.0; ROWS];
                add_product(&mut next, &self.inverses[pairs.entry(sample)], &right);
                for i in 0..ROWS {
                    let moved = next[i] - u[i];
                    a[i] = a0.mul_add(moved, -a2.mul_add(v[i], a[i]));
                    v[i] = a1.mul_add(moved, -v[i]);
                }
                u = next;
            }
            if sample >= time.first_kept_sample {
                for (signal, [gear, pinion]) in
                    signals.iter_mut().zip([[X_GEAR, X_PINION], [Y_GEAR, Y_PINION], [Z_GEAR, Z_PINION]])
                {
                    signal.push((a[gear] + a[pinion]) / STANDARD_GRAVITY);
                }
            }
        }
        signals
    }
}

/// Adds `matrix · vector`.
#[inline(always)]
fn add_product(to: &mut Vector, matrix: &Matrix, vector: &Vector) {
    for (column, factor) in matrix.iter().zip(vector) {
        add_scaled(to, column, *factor);
    }
}

/// Adds `factor · vector`.
#[inline(always)]
fn add_scaled(to: &mut Vector, vector: &Vector, factor: f64) {
    for (to, entry) in to.iter_mut().zip(vector) {
        *to = entry.mul_add(factor, *to);
    }
}

fn padded(vector: &CoordinateVector) -> Vector {
    std::array::from_fn(|i| vector.get(i).copied().unwrap_or(0.0))
}

fn columns(matrix: &CoordinateMatrix) -> Matrix {
    std::array::from_fn(|column| padded(&matrix.column(column).into_owned()))
}
