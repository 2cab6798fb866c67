//! Manufacturing quality.

use nalgebra::DMatrix;

/// Number of radii at which a tooth's profile error is given.
pub const ERROR_POINTS: usize = 100;

/// How well the teeth are made.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Quality {
    /// Grade of DIN 3962, 1 (best) to 12; 0 for ideal teeth. Default 0.
    pub din_grade: u8,
    /// Seed of the draw by `din_grade`: which wheels they are. Default: the scenario's seed.
    pub seed: Option<u64>,
    /// The errors themselves, instead of a draw by `din_grade`: several simulations that are
    /// given the same errors share one pair of wheels.
    pub profile_errors: Option<ProfileErrors>,
}

/// Deviation of every tooth's flank from the ideal profile.
///
/// Each matrix has [`ERROR_POINTS`] rows, uniform in radius, and one column per tooth. The
/// pinion's rows run from the initial contact radius to the tip, the gear's from the tip to the
/// initial contact radius: both in the order in which a tooth pair passes through contact.
#[derive(Debug, Clone, PartialEq)]
pub struct ProfileErrors {
    /// (mm) Pinion, 100 × pinion teeth.
    pub pinion_profile_errors_mm: DMatrix<f64>,
    /// (mm) Gear, 100 × gear teeth.
    pub gear_profile_errors_mm: DMatrix<f64>,
}
