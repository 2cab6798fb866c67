//! Stage 5: mesh stiffness by strain energy.
//!
//! One file per compliance. A compliance is the displacement along the line of action under a unit
//! force there, at each point of contact; a tooth's is their sum ([`ToothCompliance`]), a pair's
//! stiffness the inverse of both teeth's and the contact's ([`crate::mesh::Pairs`]), and the mesh's the sum of the pairs in
//! contact ([`crate::mesh::PairMesh`]).

mod axial;
mod bending;
mod energy;
mod foundation;
mod hertz;
mod loaded_flank;
mod shear;
mod tooth;

pub use hertz::hertz_compliance_mm_per_n;
pub use loaded_flank::{FlankLoad, LoadedFlank};
pub use tooth::ToothCompliance;
