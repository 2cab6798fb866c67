//! Time integration by methods of Newmark's family, in the modes of the machine without its meshes.
//!
//! In these mass-normalised modes the machine is a row of decoupled oscillators, and only the deflections of its meshes are unknown: one
//! number for each. A step costs a diagonal update and the solution of as many scalar equations, which are piecewise linear
//! ([`MeshLaw`](crate::mesh::MeshLaw)). Modes that neither a force nor a mesh reaches stay at rest and are left out ([`ModalMachine`]).
//!
//! [`integrate()`] takes simulations of one mesh, one or several side by side (`step`); several meshes on one machine are
//! stepped by `coupled`.

mod coupled;
mod gyroscopic;
mod history;
mod integrate;
mod lane_outputs;
mod lateral_response;
mod modal;
mod mode_step;
mod outputs;
mod prepare;
mod repetition;
mod steady_sine;
mod step;

pub(crate) use coupled::{MOST_MESHES, MOST_ROLLING_BEARINGS};
pub use integrate::{Block, Diverged, MotionState, Problem, Recorder, StepCounts, SteppedAlone, integrate};
pub(crate) use integrate::{LANES, integrate_side_by_side, resume};
pub(crate) use lateral_response::LateralResponse;
#[cfg(feature = "internals")]
pub use modal::ModalLine;
#[cfg(feature = "internals")]
pub use modal::Residual;
pub use modal::{InitialMotion, ModalMachine};
pub use outputs::{OnRing, Output};
pub(crate) use steady_sine::MeanMachine;
