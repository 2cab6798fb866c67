//! The mesh as the published code has it: one faulty pair, and a load state that is the whole mesh's.

mod error_force;
mod forcing;
mod load;
mod pair;
mod stiffness;

pub(crate) use error_force::ErrorForce;
pub(crate) use forcing::PublishedForcing;
pub use load::MeshLoad;
pub use pair::{PairCurve, PairStiffness};
pub use stiffness::MeshStiffness;

use super::law::PublishedCycle;
use super::load_state::DirectionMatrix;
use crate::damage::published::FaultGeometry;
use crate::error::ScenarioError;
use crate::operation::CycleGrid;
use crate::wheel::{Gears, ProfileErrors, Teeth};

/// The published mesh over a revolution of the gear.
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
    /// * `grid` - division of the cycle, as published
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
        let (width, angle) = (gears.face_width_mm, teeth.gear.pressure_angle_rad);
        let load = MeshLoad::new(&stiffness, fault.as_ref(), &grid, width, angle);
        Ok(Self { grid, fault, pair, stiffness, load, teeth: [gears.pinion_teeth, gears.gear_teeth] })
    }

    /// Force of the flanks' deviations.
    pub(crate) fn error_force<'a>(&'a self, errors: Option<&'a ProfileErrors>) -> ErrorForce<'a> {
        ErrorForce::new(self.teeth, &self.pair, errors, self.fault.as_ref(), &self.load, self.grid)
    }

    /// (rev) Motor revolutions since the gear's first tooth last entered contact, and the coarse point nearest to them.
    pub(crate) fn position(&self, revolutions: f64) -> (f64, usize) {
        let nearest = (revolutions / self.grid.coarse_step_rev).round() as i64;
        let coarse_point = nearest.rem_euclid(self.grid.points_per_gear_revolution as i64) as usize;
        let [pinion_teeth, gear_teeth] = self.teeth.map(f64::from);
        let revolution = if self.grid.pitch_is_whole() {
            gear_teeth / pinion_teeth
        } else {
            gear_teeth * self.grid.fine_points_per_pitch as f64 * self.grid.fine_step_rev
        };
        (revolutions.rem_euclid(revolution), coarse_point)
    }

    /// How the entries of its table follow one another.
    pub(crate) fn cycle(&self) -> PublishedCycle {
        let cycle = self.load.stiffness_n_per_m.len();
        let (window, pitch) = (self.load.disturbed_points, self.load.points_per_pitch);
        // After the window, the pitch that starts at a tooth: any whole pitch beyond it.
        let fits = window.div_ceil(pitch) * pitch + pitch <= cycle;
        PublishedCycle { window: if fits { window } else { cycle }, pitch, cycle }
    }

    /// (N/m) `k · mean(g gᵀ)` of the table's entries, in the constant directions.
    pub(crate) fn tabulated_stiffness(&self) -> impl Iterator<Item = DirectionMatrix> {
        let PublishedCycle { window, pitch, cycle } = self.cycle();
        let healthy = if window < cycle { window.div_ceil(pitch) * pitch } else { 0 };
        (0..window).chain(healthy..healthy + pitch).map(|point| self.load.stiffness(point))
    }
}
