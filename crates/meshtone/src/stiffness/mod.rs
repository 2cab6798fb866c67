//! Mesh stiffness by strain energy.
//!
//! A compliance is the displacement along the line of action under a unit force there; a tooth's is [`LoadedFlank`]'s, a pair's
//! stiffness the inverse of both teeth's and the contact's ([`crate::mesh::Pairs`]), and the mesh's the sum of the pairs in
//! contact ([`crate::mesh::Mesh`]).

mod energy;
mod foundation;
mod hertz;
mod loaded_flank;

pub(crate) use energy::{
    Energy, bending_energy, bending_integrands, cumulative, main_energy, main_integrands,
};
pub(crate) use foundation::{Foundation, LoadDirection};
pub use hertz::hertz_compliance_mm_per_n;
pub use loaded_flank::{FlankLoad, LoadedFlank};
