//! The mesh as the published code has it: one faulty pair, and a load state that is the whole mesh's.

mod error_force;
mod load;
mod pair;
mod stiffness;

pub use error_force::ErrorForce;
pub use load::{LoadState, MeshLoad};
pub use pair::{PairCurve, PairStiffness};
pub use stiffness::MeshStiffness;

use super::cycle::remainder;
use super::damage::{ContactWidth, FaultGeometry};
use crate::error::ScenarioError;
use crate::operation::CycleGrid;
use crate::wheel::{Gears, Teeth};

/// The published mesh over its cycle.
#[derive(Debug, Clone, PartialEq)]
pub struct PublishedMesh {
    /// Division of the cycle.
    pub grid: CycleGrid,
    /// The faulty pair; none for a healthy gear.
    pub fault: Option<FaultGeometry>,
    /// Stiffness of a tooth pair.
    pub pair: PairStiffness,
    /// Stiffness of the mesh.
    pub stiffness: MeshStiffness,
    /// Stiffness and load state of the mesh at every point of the cycle.
    pub load: MeshLoad,
    /// Tooth counts of pinion and gear.
    teeth: [u32; 2],
}

impl PublishedMesh {
    /// The mesh of two wheels.
    ///
    /// # Arguments
    /// * `gears` - material and foundation coefficients
    /// * `teeth` - both healthy teeth
    /// * `fault` - the faulty pair
    /// * `grid` - division of the cycle
    ///
    /// # Errors
    /// Foundation coefficients with which the healthy pair would not be stiff.
    pub fn new(
        gears: &Gears,
        teeth: &Teeth,
        fault: Option<FaultGeometry>,
        grid: CycleGrid,
    ) -> Result<Self, ScenarioError> {
        let pair = PairStiffness::new(gears, teeth, fault.as_ref())?;
        let stiffness = MeshStiffness::new(&pair, &grid);
        let load = MeshLoad::new(&stiffness, fault.as_ref(), &grid, teeth);
        Ok(Self { grid, fault, pair, stiffness, load, teeth: [gears.pinion_teeth, gears.gear_teeth] })
    }

    /// The coarse point of the cycle nearest to an angle of the pinion or the motor.
    ///
    /// # Arguments
    /// * `revolutions` - (rev) since the start
    pub(super) fn coarse_point(&self, revolutions: f64) -> usize {
        let nearest = (revolutions / self.grid.coarse_step_rev).round() as i64;
        nearest.rem_euclid(self.grid.points_per_gear_revolution as i64) as usize
    }

    /// (rev) Pinion revolutions since the gear's first tooth last entered contact. Where the cycle comes out longer, this knows nothing
    /// of it.
    ///
    /// # Arguments
    /// * `revolutions` - (rev) of the motor since the start
    pub(super) fn position_rev(&self, revolutions: f64) -> f64 {
        let [pinion_teeth, gear_teeth] = self.teeth.map(f64::from);
        remainder(revolutions, gear_teeth / pinion_teeth)
    }

    /// (mm) Part of the face width that carries nothing at an angle of the motor, where the deviations' force takes the width: at the
    /// angle itself, not at the coarse point nearest to it.
    ///
    /// # Arguments
    /// * `revolutions` - (rev) since the start
    pub(super) fn missing_width_mm(&self, revolutions: f64) -> f64 {
        match self.fault.as_ref().map(|fault| fault.contact_width) {
            None | Some(ContactWidth::Whole) => 0.0,
            Some(width) => width.missing_mm(self.position_rev(revolutions)),
        }
    }
}
