//! A dense Newmark solver as a careful engineer would write it for a linear mesh at constant speed and load: the yardstick for what modes
//! and low rank gain.
//!
//! Average acceleration (γ = ½, β = ¼) in the machine's coordinates, relative to the rigid rotation. The mesh's stiffness repeats with
//! the points of its tables, so the inverse of each effective matrix is made beforehand; a step is two products of a 13 × 13 matrix and a
//! vector, in arrays of fixed size, compiled for the vector instructions that the processor has.

use std::ops::Index;

use meshtone::Stages;
use meshtone::machine::{Axis, Drive, Machine, PINION_SUPPORT};
use meshtone::mesh::{Forcing, ForcingBlock, Mesh, PairDeviations};
use pulp::{Arch, NullaryFnOnce};

/// Coordinates of the machine whose supports are held.
const COORDINATES: usize = 13;
/// Rows of a column, filled up with zeros to whole vectors.
const ROWS: usize = 16;
/// (m/s²) What the signals are divided by.
const STANDARD_GRAVITY: f64 = 9.81;

type Vector = [f64; ROWS];
/// Column after column.
type Matrix = [Vector; COORDINATES];

/// The mesh at one sample.
#[derive(Clone, Copy, Default)]
struct Sample {
    /// Number of the pairs' stiffness: which matrices hold.
    state: usize,
    /// (N) Force of the deviations, `Σ k (o + τ ȯ)`.
    deviation_n: f64,
}

/// The matrices that hold while the pairs are equally stiff.
struct State {
    /// (N/m) Sum of the stiffnesses.
    stiffness_n_per_m: f64,
    line: Vector,
    damping: Matrix,
    /// Inverse of the effective stiffness `K + 2/h C + 4/h² M`.
    inverse: Matrix,
}

/// What a run needs of the stages.
pub struct Newmark<'a> {
    stages: &'a Stages,
    machine: &'a Machine,
    samples: Vec<Sample>,
    states: Vec<State>,
    mass: Vector,
    brake: Vector,
    sensors: [Vector; 3],
    /// Displacement at the first sample: at rest.
    at_rest: Vector,
}

impl<'a> Newmark<'a> {
    /// Makes the inverses.
    pub fn new(stages: &'a Stages) -> Self {
        assert!(stages.is_steady(), "the mesh stiffness is a table only at constant speed and load");
        let (Some((machine, modes)), [mesh]) = (stages.machine_and_modes(), &stages.meshes[..]) else {
            panic!("one linear mesh");
        };
        let step_s = stages.time.step_s();
        let (stiffness, damping) = (machine.turn_back(&machine.stiffness()), modes.damping_matrix(machine));
        let mut at_rest = None;
        let brake = brake(stages, machine);
        let new_state = |stiffness_n_per_m: f64, deviation_n: f64| {
            let line = &machine.turn * &machine.lines[0].at_middle;
            let of_mesh = &line * line.transpose() * stiffness_n_per_m;
            let (stiffness, damping) = (&stiffness + &of_mesh, &damping + of_mesh * mesh.damping_time_s);
            at_rest.get_or_insert_with(|| {
                let inverse = stiffness.clone().try_inverse().expect("a linear mesh holds both shafts");
                let mut force = brake;
                add_scaled(&mut force, &padded(&line), -deviation_n);
                let mut at_rest = [0.0; ROWS];
                add_product(&mut at_rest, &columns(&inverse), &force);
                at_rest
            });
            let mut effective = stiffness + &damping * (2.0 / step_s);
            for (n, mass) in machine.mass.diagonal().iter().enumerate() {
                effective[(n, n)] += mass * 4.0 / (step_s * step_s);
            }
            let inverse = columns(&effective.try_inverse().expect("definite"));
            State { stiffness_n_per_m, line: padded(&line), damping: columns(&damping), inverse }
        };
        let (samples, states) = mesh_samples(stages, mesh, new_state);
        Self {
            stages,
            machine,
            samples,
            states,
            mass: std::array::from_fn(|n| machine.mass.get((n, n)).copied().unwrap_or(0.0)),
            brake,
            sensors: [Axis::X, Axis::Y, Axis::Z].map(|axis| padded(&machine.weights(PINION_SUPPORT, axis))),
            at_rest: at_rest.expect("a sample"),
        }
    }

    /// (g) The kept samples of the horizontal, vertical and axial acceleration.
    pub fn signals(&self) -> [Vec<f64>; 3] {
        assert_eq!(self.machine.coordinates(), COORDINATES);
        Arch::new().dispatch(self)
    }
}

/// The mesh at every sample, and its states.
fn mesh_samples(
    stages: &Stages,
    mesh: &Mesh,
    mut new_state: impl FnMut(f64, f64) -> State,
) -> (Vec<Sample>, Vec<State>) {
    let (time, operation) = (&stages.time, &stages.scenario.operation);
    let deviations = PairDeviations {
        teeth: &stages.pairs[0].teeth,
        errors: stages.pairs[0].profile_errors.as_ref(),
        eccentricity_m: stages.pairs[0].eccentricity_mm.map(|of_wheel_mm| of_wheel_mm * 1e-3),
        run_out: stages.pairs[0].run_out,
    };
    let nominal = [operation.pinion_speed_hz, operation.brake_torque_nm];
    let mut forcing = Forcing::new(stages.motion(), time, nominal, 0, [(mesh, deviations)]);
    let mut block = ForcingBlock::default();
    let (mut samples, mut states) = (Vec::with_capacity(time.samples), Vec::<State>::new());
    // The numbers of the states at each point of a pitch.
    let mut at_point = vec![Vec::<usize>::new(); mesh.points_per_pitch];
    while samples.len() < time.samples {
        forcing.next_block(1024.min(time.samples - samples.len()), &mut block);
        let pairs = &block.meshes[0];
        for k in 0..pairs.stiffness[0].len() {
            let (mut stiffness_n_per_m, mut deviation_n) = (0.0, 0.0);
            for (stiffness, offset) in pairs.stiffness.iter().zip(&pairs.offset) {
                stiffness_n_per_m += stiffness[k];
                deviation_n += stiffness[k] * offset[k];
            }
            let known = &mut at_point[samples.len() % mesh.points_per_pitch];
            let is_this = |&&state: &&usize| states[state].stiffness_n_per_m == stiffness_n_per_m;
            let state = known.iter().find(is_this).copied().unwrap_or_else(|| {
                states.push(new_state(stiffness_n_per_m, deviation_n));
                known.push(states.len() - 1);
                states.len() - 1
            });
            samples.push(Sample { state, deviation_n });
        }
    }
    (samples, states)
}

/// (N m) The brake's torque.
fn brake(stages: &Stages, machine: &Machine) -> Vector {
    let mut brake = [0.0; ROWS];
    for drive in &machine.drives {
        if let Drive::Brake { coordinate, torque_share } = *drive {
            brake[coordinate] += torque_share * stages.scenario.operation.brake_torque_nm;
        }
    }
    brake
}

/// The time loop. Only loops: a closure would be compiled without the processor's vector instructions.
impl NullaryFnOnce for &Newmark<'_> {
    type Output = [Vec<f64>; 3];

    #[inline(always)]
    fn call(self) -> [Vec<f64>; 3] {
        let (h, time) = (self.stages.time.step_s(), &self.stages.time);
        let (a0, a1, a2) = (4.0 / (h * h), 2.0 / h, 4.0 / h);
        let mut signals = [(); 3].map(|()| Vec::with_capacity(time.kept_samples()));
        let (mut u, mut v, mut a) = (self.at_rest, [0.0; ROWS], [0.0; ROWS]);
        for (number, sample) in self.samples.iter().enumerate() {
            let state = &self.states[sample.state];
            if number > 0 {
                // K̂ u⁺ = F⁺ + M (4/h² u + 4/h v + a) + C (2/h u + v).
                let mut right = self.brake;
                add_scaled(&mut right, &state.line, -sample.deviation_n);
                let mut damped = [0.0; ROWS];
                for i in 0..ROWS {
                    let inertial = a0.mul_add(u[i], a2.mul_add(v[i], a[i]));
                    right[i] = self.mass[i].mul_add(inertial, right[i]);
                    damped[i] = a1.mul_add(u[i], v[i]);
                }
                add_product(&mut right, &state.damping, &damped);
                let mut next = [0.0; ROWS];
                add_product(&mut next, &state.inverse, &right);
                for i in 0..ROWS {
                    let moved = next[i] - u[i];
                    a[i] = a0.mul_add(moved, -a2.mul_add(v[i], a[i]));
                    v[i] = a1.mul_add(moved, -v[i]);
                }
                u = next;
            }
            if number >= time.first_kept_sample {
                for (signal, weights) in signals.iter_mut().zip(&self.sensors) {
                    let mut shown = 0.0;
                    for i in 0..ROWS {
                        shown = weights[i].mul_add(a[i], shown);
                    }
                    signal.push(shown / STANDARD_GRAVITY);
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

fn padded(vector: &impl Index<usize, Output = f64>) -> Vector {
    std::array::from_fn(|i| if i < COORDINATES { vector[i] } else { 0.0 })
}

fn columns(matrix: &impl Index<(usize, usize), Output = f64>) -> Matrix {
    std::array::from_fn(|c| std::array::from_fn(|r| if r < COORDINATES { matrix[(r, c)] } else { 0.0 }))
}
