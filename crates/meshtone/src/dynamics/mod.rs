//! Stage 6: the equations of motion, `M ü + C u̇ + K(θ_p) u = F`.
//!
//! `u` has 13 coordinates ([`coordinates`]). The mesh couples them along one line of action
//! ([`MeshDirections`]); everything else is constant.

mod body;
pub mod coordinates;
mod excitation;
mod forcing;
mod mesh_directions;
mod mesh_load;
mod modes;
mod motion;
mod system;

pub use body::WheelBody;
pub use excitation::{ErrorForce, Excitation};
pub(crate) use forcing::{Forcing, ForcingBlock};
pub(crate) use mesh_directions::DIRECTIONS;
pub use mesh_directions::MeshDirections;
pub use mesh_load::{LoadState, MeshLoad};
pub use modes::Modes;
pub use motion::{Motion, MotionSample};
pub use system::System;
