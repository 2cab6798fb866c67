//! What is read off the solution.

use nalgebra::DVector;

use super::modal::ModalMachine;
use crate::machine::Axis;

/// A signal that is read off the solution.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Output {
    /// (m/s²) Acceleration of a named place along an axis, times a factor.
    Acceleration {
        /// The place's name.
        place: &'static str,
        /// The axis.
        axis: Axis,
        /// The factor.
        factor: f64,
    },
    /// (m/s, rad/s) Velocity of a named place along or about an axis, times a factor.
    Velocity {
        /// The place's name.
        place: &'static str,
        /// The axis.
        axis: Axis,
        /// The factor.
        factor: f64,
    },
    /// (m, rad; m/s, rad/s; m/s², rad/s²) A coordinate of the machine, or one of its derivatives.
    Coordinate {
        /// Its number.
        number: usize,
        /// Which derivative with respect to time: 0, 1 or 2.
        derivative: usize,
    },
    /// (N) Force with which a mesh presses its flanks together; negative: back flanks touch, or a linear mesh pulls.
    MeshForce {
        /// The mesh's number.
        mesh: usize,
    },
}

/// A linear combination of the step's own variables: `constant + sample·per_sample + u·displacement + s·velocity +
/// w·force + x·external`. An empty list stands for zeros.
#[derive(Debug, Clone, Default)]
pub(super) struct OutputWeights {
    pub(super) displacement: Vec<f64>,
    pub(super) scaled_velocity: Vec<f64>,
    /// Of the force in each column of each mesh's line of action, mesh by mesh.
    pub(super) force: Vec<f64>,
    pub(super) external: [f64; EXTERNALS],
    pub(super) constant: f64,
    pub(super) per_sample: f64,
}

/// Motor lead, brake torque deviation, motor speed deviation.
pub(super) const EXTERNALS: usize = 3;

/// Modal force of each external: the motor's lead twists its shaft, the brake's torque acts, and damping follows the motor's speed.
pub(super) fn external_forces(model: &ModalMachine) -> [Vec<f64>; EXTERNALS] {
    let followed_speed = model.damping.iter().zip(&model.rigid_velocity).map(|(d, rigid)| d * rigid);
    [model.motor.clone(), model.brake.clone(), followed_speed.collect()]
}

impl Output {
    /// The output in the variables of a step of `2 half_step_s`.
    pub(super) fn weights(&self, model: &ModalMachine, half_step_s: f64) -> OutputWeights {
        match *self {
            Self::Acceleration { place, axis, factor } => {
                let (weights, _) = model.of_coordinates(&(model.machine.weights(place, axis) * factor));
                acceleration(&weights, model, half_step_s)
            }
            Self::Velocity { place, axis, factor } => {
                let (weights, rigid) = model.of_coordinates(&(model.machine.weights(place, axis) * factor));
                velocity(&weights, rigid, model, half_step_s)
            }
            Self::Coordinate { number, derivative } => {
                let unit = DVector::from_fn(model.machine.coordinates(), |n, _| f64::from(n == number));
                let (weights, rigid) = model.of_coordinates(&unit);
                match derivative {
                    0 => displacement(weights, rigid, model, half_step_s),
                    1 => velocity(&weights, rigid, model, half_step_s),
                    _ => acceleration(&weights, model, half_step_s),
                }
            }
            Self::MeshForce { mesh } => {
                let columns = model.lines.iter().enumerate().flat_map(|(number, line)| {
                    // The force at the middle of the face is the whole force.
                    (0..line.columns.len())
                        .map(move |column| if (number, column) == (mesh, 0) { -1.0 } else { 0.0 })
                });
                OutputWeights {
                    force: columns.collect(),
                    constant: model.lines.get(mesh).map_or(0.0, |line| line.static_force_n),
                    ..OutputWeights::default()
                }
            }
        }
    }
}

fn displacement(weights: Vec<f64>, rigid: f64, model: &ModalMachine, half_step_s: f64) -> OutputWeights {
    OutputWeights {
        constant: dot(&weights, &model.static_displacement),
        per_sample: rigid * model.rotation_rad_per_s * 2.0 * half_step_s,
        displacement: weights,
        ..OutputWeights::default()
    }
}

fn velocity(weights: &[f64], rigid: f64, model: &ModalMachine, half_step_s: f64) -> OutputWeights {
    OutputWeights {
        scaled_velocity: weights.iter().map(|weight| weight / half_step_s).collect(),
        constant: rigid * model.rotation_rad_per_s,
        ..OutputWeights::default()
    }
}

/// By the equation of motion: `q̈ = B w + external − 2ζω q̇ − ω² q`, relative to the constant loads.
fn acceleration(weights: &[f64], model: &ModalMachine, half_step_s: f64) -> OutputWeights {
    let columns = model.lines.iter().flat_map(|line| &line.columns);
    OutputWeights {
        displacement: weights.iter().zip(&model.stiffness).map(|(weight, k)| -weight * k).collect(),
        scaled_velocity: (weights.iter().zip(&model.damping))
            .map(|(weight, damping)| -weight * damping / half_step_s)
            .collect(),
        force: columns.map(|column| dot(weights, column)).collect(),
        external: external_forces(model).map(|force| dot(weights, &force)),
        ..OutputWeights::default()
    }
}

/// `Σ a_n b_n`.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
