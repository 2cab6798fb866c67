//! The coordinates, in their order: 13 of the wheels and the brake, and 4 of supports that move.
//!
//! x and y lie in the plane of the wheels, z along the shafts; θ turns about z, φ and ψ tilt the wheel
//! about x and y. Displacements in m, rotations in rad.

use nalgebra::{DVector, SMatrix, SVector};

/// Number of coordinates.
pub const COORDINATES: usize = 13;

/// One number per coordinate.
pub type CoordinateVector = SVector<f64, COORDINATES>;
/// One number per pair of coordinates.
pub type CoordinateMatrix = SMatrix<f64, COORDINATES, COORDINATES>;

/// Gear, x.
pub const X_GEAR: usize = 0;
/// Gear, y.
pub const Y_GEAR: usize = 1;
/// Pinion, x.
pub const X_PINION: usize = 2;
/// Pinion, y.
pub const Y_PINION: usize = 3;
/// Rotation of the gear.
pub const THETA_GEAR: usize = 4;
/// Rotation of the pinion.
pub const THETA_PINION: usize = 5;
/// Rotation of the brake.
pub const THETA_BRAKE: usize = 6;
/// Gear, z.
pub const Z_GEAR: usize = 7;
/// Pinion, z.
pub const Z_PINION: usize = 8;
/// Tilt of the gear about x.
pub const PHI_GEAR: usize = 9;
/// Tilt of the pinion about x.
pub const PHI_PINION: usize = 10;
/// Tilt of the gear about y.
pub const PSI_GEAR: usize = 11;
/// Tilt of the pinion about y.
pub const PSI_PINION: usize = 12;

/// The coordinates' names, as in the paper.
pub const NAMES: [&str; COORDINATES] = [
    "x_g", "y_g", "x_p", "y_p", "theta_g", "theta_p", "theta_b", "z_g", "z_p", "phi_g", "phi_p", "psi_g",
    "psi_p",
];

/// Number of coordinates with those of the supports.
pub const COORDINATES_WITH_SUPPORTS: usize = 17;

/// Support of the gear's shaft, x.
pub const X_GEAR_SUPPORT: usize = 13;
/// Support of the gear's shaft, y.
pub const Y_GEAR_SUPPORT: usize = 14;
/// Support of the pinion's shaft, x.
pub const X_PINION_SUPPORT: usize = 15;
/// Support of the pinion's shaft, y.
pub const Y_PINION_SUPPORT: usize = 16;

/// Names of the supports' coordinates, which follow [`NAMES`].
pub const SUPPORT_NAMES: [&str; COORDINATES_WITH_SUPPORTS - COORDINATES] = ["x_gs", "y_gs", "x_ps", "y_ps"];

/// A vector of the wheels and the brake, with supports that have no part in it.
pub fn with_supports(wheels: &CoordinateVector) -> DVector<f64> {
    DVector::from_fn(COORDINATES_WITH_SUPPORTS, |n, _| wheels.get(n).copied().unwrap_or(0.0))
}
