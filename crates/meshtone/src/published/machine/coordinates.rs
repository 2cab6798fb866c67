//! The 13 coordinates of the wheels and the brake, in their order.
//!
//! x and y lie in the plane of the wheels, z along the shafts; θ turns about z, φ and ψ tilt the wheel
//! about x and y. Displacements in m, rotations in rad.

use nalgebra::{SMatrix, SVector};

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
