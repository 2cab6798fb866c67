//! The machine around the meshes, `M ü + C u̇ + K u = F(t) − Σ g f(gᵀu, t)`.
//!
//! A [`Machine`] is a list of parts in any number of coordinates. The meshes are not among them: they act along its lines of action,
//! and the solver closes or opens them. Only `rig_machine` names the coordinates of a rig.

mod body;
mod gearbox;
mod gyroscopic;
mod modes;
mod parts;
mod rig;
mod rig_machine;
mod shaft_bending;
mod support;
mod turning_force;

pub use body::WheelBody;
pub(crate) use body::body_stiffness_nm_per_rad;
pub use gearbox::{
    Bearing, BearingKind, Coupled, Disc, Foot, GearboxMachine, GearboxParts, GearboxPlace, GearboxShaft,
    Housing, HousingModes, MeshLine, PlacedUnbalance, RimParts, RimShape, Seat, SeatedBearing,
    SetCoordinates, SetParts,
};
pub use gyroscopic::Spinning;
pub(crate) use modes::KnownModes;
pub(crate) use modes::connected_groups;
pub use modes::{ClosedMesh, DecayingMode, Modes};
#[cfg(feature = "internals")]
pub use parts::{AcrossLine, LineOfAction, Spring};
pub use parts::{Axis, Drive, Machine, Place};
pub(crate) use parts::{Leans, weights};
pub use rig::{DampingRatio, Rig, RigParts, Shaft, WheelInertia};
pub(crate) use rig_machine::turn_planes;
pub use rig_machine::{
    GEAR, GEAR_SUPPORT, PINION, PINION_SUPPORT, RigMachine, SUPPORTS, SupportMode, Supports, WHEELS,
    support_modes,
};
pub use support::{Support, SupportSprings};
pub use turning_force::{Bow, TurningForce, Unbalance};
