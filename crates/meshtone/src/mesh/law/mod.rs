//! Mesh laws: the mesh's force from its deflection, one file a law. They are the only place where models differ in the time loop.
//!
//! A step of the integration is implicit through the mesh's force alone. The solver offers a [`Trial`], the step as it would be
//! without that force; a law finds the force at its end.

mod contact;
mod linear;
mod published;
mod table;

pub(crate) use contact::{ContactConstants, ContactLaw, ContactSample, deflection_at_rest, force_on};
pub(crate) use linear::LinearLaw;
pub(crate) use published::{PublishedCycle, PublishedLaw};
pub(crate) use table::{MeshTable, Reduction, TabulatedSample};

use crate::simd::{Instructions, Lanes};

/// A step of `L` simulations side by side before the new force of the mesh is known.
///
/// A force of the mesh has a component in each of `R` directions.
pub(crate) trait Trial<I: Instructions, const L: usize, const R: usize> {
    /// The right-hand side in the modes.
    type RightHandSide;

    /// (m) Deflection in the mesh's directions at the step's end, without the new force; with its damping's lead
    /// where [`MeshLaw::LEADS`].
    fn deflection(&self) -> &[Lanes<L>; R];

    /// (m) Deflection in the mesh's directions at the step's start.
    fn deflection_before(&self, simd: I) -> [Lanes<L>; R];

    /// (m/N) Deflection in each direction at the step's end per new force in each.
    fn compliance(&self) -> &[[Lanes<L>; R]; R];

    /// Angle of the pinion at the step's end under a new force, in points of the cycle plus a half.
    fn angle(&self, simd: I, force: &[Lanes<L>; R]) -> Lanes<L>;

    /// The step's right-hand side, where `held` is the mesh's force on the state before.
    fn right_hand_side(&self, simd: I, held: &[Lanes<L>; R]) -> Self::RightHandSide;

    /// Product of the right-hand side and the displacement in the step under a new force.
    fn work(&self, simd: I, right_hand_side: &Self::RightHandSide, force: &[Lanes<L>; R]) -> Lanes<L>;
}

/// The mesh of `L` simulations side by side.
pub(crate) trait MeshLaw<const L: usize, const R: usize> {
    /// What the law takes of the forcing at one sample.
    type Sample;

    /// Whether its force depends on the deflection's speed.
    const LEADS: bool = false;

    /// (N) The mesh's force at the end of a step, with respect to what the modes have already, in its directions.
    ///
    /// # Arguments
    /// * `trial` - the step without it
    /// * `sample` - pairs and deviations at the step's end
    /// * `entries` - entries of the tables at the step's start; set to those at its end
    fn force<I: Instructions, T: Trial<I, L, R>>(
        &self,
        simd: I,
        trial: &T,
        sample: &Self::Sample,
        entries: &mut [usize; L],
    ) -> [Lanes<L>; R];
}
