//! Stage 7: time integration by Newmark's method, in modal coordinates and with a low-rank correction.
//!
//! In the mass-normalised modes of the mean stiffness the mass matrix is the identity and the damping and the
//! mean stiffness are diagonal. What varies, `K(cycle) − K_mean = B S(cycle) Bᵀ`, has the rank of the mesh's
//! directions: a step costs a diagonal update and the solution of a system of that size. Modes that neither a
//! force nor the mesh reaches stay at rest and are left out ([`ReducedModel`]).

mod coefficients;
mod handout;
mod history;
mod integrate;
mod outputs;
mod prepare;
mod reduce;
mod shared_forcing;
mod size;
mod steady_sine;
mod step;
mod step_factors;
mod stretch;

pub use integrate::{Block, Recorder};
pub(crate) use integrate::{Diverged, LANES, Problem, integrate, integrate_side_by_side};
pub use outputs::{Axis, Output};
pub use reduce::ReducedModel;
pub(crate) use size::Size;
pub(crate) use steady_sine::MeanMachine;
