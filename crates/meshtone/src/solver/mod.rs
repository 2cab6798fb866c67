//! Stage 7: time integration by Newmark's method, in modal coordinates and with a low-rank correction.
//!
//! In the mass-normalised modes of the mean stiffness the mass matrix is the identity and the damping and the
//! mean stiffness are diagonal. What varies, `K(cycle) − K_mean = B S(cycle) Bᵀ`, has the rank of the mesh's
//! directions: a step costs a diagonal solve and a Woodbury correction of that size ([`reduce`]). Modes that
//! neither a force nor the mesh reaches stay at rest and are left out.

mod newmark;
mod reduce;

pub use newmark::integrate;
pub use reduce::ReducedModel;

use crate::dynamics::coordinates::{COORDINATES, CoordinateVector};

/// State of the system at one sample, as a [`Recorder`] sees it: a motion of the modes on top of the rigid
/// rotation at the nominal speed.
pub struct StateView<'a> {
    pub(crate) displacement: &'a [f64],
    pub(crate) velocity: &'a [f64],
    pub(crate) acceleration: &'a [f64],
    /// (rad) Angle of the rigid rotation.
    pub(crate) rotation_rad: f64,
    /// (rad/s) Its speed.
    pub(crate) rotation_rad_per_s: f64,
    /// (N) Force with which the mesh presses the flanks together; negative: the linear mesh pulls.
    pub mesh_force_n: f64,
}

/// Takes the states of the solution as they are computed.
pub trait Recorder {
    /// Called once per sample, in order.
    ///
    /// # Arguments
    /// * `sample` - number of the sample, 0 at the start of the simulation
    /// * `state` - the state there
    fn record(&mut self, sample: usize, state: &StateView);
}

/// A linear combination of the 13 coordinates, in modal coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct Projection {
    weights: Vec<f64>,
    rotation: f64,
}

impl Projection {
    /// The combination of the modes' own motions.
    ///
    /// # Arguments
    /// * `model` - the reduced model whose states are projected
    /// * `weights` - weight of each of the 13 coordinates
    pub fn new(model: &ReducedModel, weights: &[f64; COORDINATES]) -> Self {
        let row = CoordinateVector::from(*weights);
        Self {
            weights: model.shapes.iter().map(|shape| shape.dot(&row)).collect(),
            rotation: model.rigid_rotation.dot(&row),
        }
    }

    fn apply(&self, modal: &[f64]) -> f64 {
        self.weights.iter().zip(modal).map(|(w, q)| w * q).sum()
    }

    /// (m or rad) The combination of displacements.
    pub fn displacement(&self, state: &StateView) -> f64 {
        self.apply(state.displacement) + self.rotation * state.rotation_rad
    }

    /// (m/s or rad/s) The combination of velocities.
    pub fn velocity(&self, state: &StateView) -> f64 {
        self.apply(state.velocity) + self.rotation * state.rotation_rad_per_s
    }

    /// (m/s² or rad/s²) The combination of accelerations.
    pub fn acceleration(&self, state: &StateView) -> f64 {
        self.apply(state.acceleration)
    }
}
