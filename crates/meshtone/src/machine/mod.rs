//! Stage 6: the equations of motion, `M ü + C u̇ + K(θ_p) u = F`.
//!
//! `u` has 13 coordinates ([`coordinates`]). The mesh couples them along one line of action
//! ([`MeshDirections`]); everything else is constant.

mod body;
pub mod coordinates;
mod mesh_directions;
mod modes;
mod rig;
mod shaft_bending;
mod structure;
mod system;

pub use body::WheelBody;
pub use mesh_directions::MeshDirections;
pub use modes::Modes;
pub use rig::{DampingRatio, Rig, Shaft, Support, WheelInertia};
pub(crate) use structure::DecayingMode;
pub use structure::{ClosedMesh, Structure};
pub use system::{Excitation, System};
