//! What is read off the solution.

use std::borrow::Cow;

use nalgebra::DVector;

use super::modal::{AtRest, ModalMachine};
use super::mode_step::StepOfMode;
use crate::machine::Axis;

/// A signal that is read off the solution.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Output {
    /// (m/s²) Acceleration of a named place along an axis, times a factor.
    Acceleration {
        /// The place's name.
        place: Cow<'static, str>,
        /// The axis.
        axis: Axis,
        /// The factor.
        factor: f64,
    },
    /// (m/s, rad/s) Velocity of a named place along or about an axis, times a factor.
    Velocity {
        /// The place's name.
        place: Cow<'static, str>,
        /// The axis.
        axis: Axis,
        /// The factor.
        factor: f64,
    },
    /// (m, rad) Displacement of a named place along or about an axis, times a factor.
    Displacement {
        /// The place's name.
        place: Cow<'static, str>,
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
    /// (N) Force with which a mesh presses its flanks together; negative: coast flanks touch, or a linear mesh pulls.
    MeshForce {
        /// The mesh's number.
        mesh: usize,
    },
    /// (m/s²) Acceleration of a place on the ring of a planetary set, times a factor. It depends on where the carrier stands, and so is made of
    /// coordinates after the solution.
    OnRing(OnRing),
    /// (W) Power that the friction of a mesh's flanks takes, at the nominal speed; only of a mesh with friction.
    FrictionLoss {
        /// The mesh's number.
        mesh: usize,
    },
}

/// A place on the ring of a planetary set, and the direction that is measured there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OnRing {
    /// Number of the set.
    pub set: usize,
    /// (rad) Where it is, from x towards y.
    pub angle_rad: f64,
    /// (rad) The direction, from x towards y.
    pub direction_rad: f64,
    /// Whether it is far from the rim, and so feels the ring's mean motion alone: shapes of no wave and of one.
    pub is_far: bool,
    /// The factor of the acceleration in m/s².
    pub factor: f64,
}

/// A linear combination of what a step has of a sample ([`State`](super::step::State)): `constant + sample·per_sample + Σ weights`. An
/// empty list stands for zeros.
#[derive(Debug, Clone, Default)]
pub(super) struct OutputWeights {
    /// Of the predicted displacements.
    pub(super) displacement: Vec<f64>,
    /// Of the predicted velocities times Δt.
    pub(super) velocity: Vec<f64>,
    /// Of the accelerations times Δt².
    pub(super) acceleration: Vec<f64>,
    /// Of the force in each of [`ModalMachine::columns`], and of what acts across the lines.
    pub(super) force: Vec<f64>,
    /// Of the externals, by way of the modes that are not stepped.
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
    /// The output in what a step has of a sample.
    ///
    /// # Arguments
    /// * `model` - the machine
    /// * `steps` - how each of its modes is stepped
    /// * `step_s` - (s) Δt
    pub(super) fn weights(&self, model: &ModalMachine, steps: &[StepOfMode], step_s: f64) -> OutputWeights {
        let of_place = |place: &str, axis, factor: f64| model.weights(place, axis) * factor;
        let (weights, derivative) = match self {
            Self::Acceleration { place, axis, factor } => (of_place(place, *axis, *factor), 2),
            Self::Velocity { place, axis, factor } => (of_place(place, *axis, *factor), 1),
            Self::Displacement { place, axis, factor } => (of_place(place, *axis, *factor), 0),
            &Self::Coordinate { number, derivative } => {
                let unit = |n: usize, _| f64::from(n == number);
                (DVector::from_fn(model.rigid_rotation.len(), unit), derivative)
            }
            Self::OnRing(_) => return OutputWeights::default(),
            Self::MeshForce { mesh } => return mesh_force(model, *mesh),
            Self::FrictionLoss { mesh } => return friction_loss(model, *mesh),
        };
        let AtRest { constant, of_force, of_drives: [of_motor, of_brake] } =
            model.residual.of_coordinates(&weights);
        let (weights, rigid) = model.of_coordinates(&weights);
        let scaled = |of: &dyn Fn(&StepOfMode) -> f64| -> Vec<f64> {
            weights.iter().zip(steps).map(|(weight, step)| weight * of(step)).collect()
        };
        match derivative {
            0 => OutputWeights {
                constant: constant + dot(&weights, &model.static_displacement),
                force: of_force,
                external: [of_motor, of_brake, 0.0],
                per_sample: rigid * model.rotation_rad_per_s * step_s,
                acceleration: scaled(&|step| step.beta),
                displacement: weights,
                ..OutputWeights::default()
            },
            1 => OutputWeights {
                constant: rigid * model.rotation_rad_per_s,
                // How fast the forces of the meshes change is not known.
                external: [0.0, 0.0, of_motor],
                velocity: scaled(&|_| 1.0 / step_s),
                acceleration: scaled(&|_| 0.5 / step_s),
                ..OutputWeights::default()
            },
            // What is stepped is the force's part of it; the factor stands for the mode's inertia.
            _ => OutputWeights {
                acceleration: scaled(&|step| 1.0 / (step.force_factor * step_s * step_s)),
                ..OutputWeights::default()
            },
        }
    }
}

/// The whole force of a mesh: that in the column at the middle of its face.
fn mesh_force(model: &ModalMachine, mesh: usize) -> OutputWeights {
    OutputWeights {
        force: (0..model.lines.len()).map(|number| if number == mesh { -1.0 } else { 0.0 }).collect(),
        constant: model.lines.get(mesh).map_or(0.0, |line| line.static_force_n),
        ..OutputWeights::default()
    }
}

/// The moment of a mesh's friction, which both wheels turn against, times the sum of their speeds.
fn friction_loss(model: &ModalMachine, mesh: usize) -> OutputWeights {
    let first_across = model.columns().count();
    let mut force = vec![0.0; first_across + 2 * model.lines.len()];
    let sliding_rad_per_s = model.lines[mesh].sliding_speed_ratio * model.rotation_rad_per_s.abs();
    force[first_across + 2 * mesh + 1] = sliding_rad_per_s;
    OutputWeights { force, ..OutputWeights::default() }
}

/// `Σ a_n b_n`.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
