//! Where along the face and in which direction a pair of teeth carries its load.

use nalgebra::{SMatrix, SVector};

/// Number of constant directions that span every line of action of the mesh: along and across the nominal line of action,
/// rotation, and the two tilts that go with the first two ([`crate::machine::MeshDirections`]).
pub(crate) const DIRECTIONS: usize = 5;

/// The direction that has weight 1 in every line of action: its share of a force is the whole force.
pub(crate) const ROTATION: usize = 2;

/// A vector in the constant directions.
pub(crate) type DirectionVector = SVector<f64, DIRECTIONS>;

/// A matrix in the constant directions.
pub(crate) type DirectionMatrix = SMatrix<f64, DIRECTIONS, DIRECTIONS>;

/// Where and in which direction a pair carries its load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadState {
    /// (m) Mean of z over the contact width.
    pub mean_z_m: f64,
    /// (m²) Mean of z² over the contact width.
    pub mean_z2_m2: f64,
    /// (rad) Working pressure angle, at which the line of action lies.
    pub pressure_angle_rad: f64,
}

impl LoadState {
    /// Load spread evenly from `z_min_m` to `z_max_m`.
    pub(crate) fn spread(z_min_m: f64, z_max_m: f64, pressure_angle_rad: f64) -> Self {
        Self {
            mean_z_m: (z_min_m + z_max_m) / 2.0,
            mean_z2_m2: (z_min_m * z_min_m + z_min_m * z_max_m + z_max_m * z_max_m) / 3.0,
            pressure_angle_rad,
        }
    }

    /// Load spread evenly over some pieces of the face.
    ///
    /// # Arguments
    /// * `pieces_m` - (m) where each begins and ends; at least one that has a width
    /// * `pressure_angle_rad` - (rad) pressure angle
    pub(crate) fn over(pieces_m: &[[f64; 2]], pressure_angle_rad: f64) -> Self {
        let width: f64 = pieces_m.iter().map(|[from, to]| to - from).sum();
        let mean_power = |power: i32| {
            let of_piece =
                |[from, to]: &[f64; 2]| (to.powi(power + 1) - from.powi(power + 1)) / f64::from(power + 1);
            pieces_m.iter().map(of_piece).sum::<f64>() / width
        };
        Self { mean_z_m: mean_power(1), mean_z2_m2: mean_power(2), pressure_angle_rad }
    }

    /// Mean of the line of action over the contact width, in the five constant directions.
    pub(crate) fn mean_direction(&self, nominal_rad: f64) -> DirectionVector {
        let (sin, cos) = (self.pressure_angle_rad - nominal_rad).sin_cos();
        DirectionVector::from([cos, sin, 1.0, self.mean_z_m * cos, self.mean_z_m * sin])
    }

    /// Mean of `g gᵀ` over the contact width, in the five constant directions.
    pub(crate) fn mean_square(&self, nominal_rad: f64) -> DirectionMatrix {
        let (sin, cos) = (self.pressure_angle_rad - nominal_rad).sin_cos();
        let flat = DirectionVector::from([cos, sin, 1.0, 0.0, 0.0]);
        let tilt = DirectionVector::from([0.0, 0.0, 0.0, cos, sin]);
        let cross = flat * tilt.transpose();
        flat * flat.transpose()
            + (cross + cross.transpose()) * self.mean_z_m
            + tilt * tilt.transpose() * self.mean_z2_m2
    }
}
