//! Forces that turn with a shaft: of an unbalance, and of a shaft that is not straight.

use nalgebra::DVector;

use crate::keys::{Range, keys};

/// (°) Any angle once around, either way.
const ANGLE: Range = Range::from_to(-360.0, 360.0);

/// An unbalance of a wheel or a shaft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unbalance {
    /// (g mm) Mass times its distance from the axis. Default 0.
    pub g_mm: f64,
    /// (°) Its direction at the start, from x towards y. Default 0.
    pub angle_deg: f64,
}

keys! {
    Unbalance = default Self { g_mm: 0.0, angle_deg: 0.0 };
    g_mm "g mm" "the mass times its distance from the axis"
        .range(Range::not_negative().implausible_above(1e7));
    angle_deg "°" "its direction at time 0, before settling, from x towards y" .range(ANGLE);
}

/// The bow of a shaft that is not straight: half a sine over its length, without a load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bow {
    /// (µm) Distance of the middle of the shaft from the line through its ends. Default 0.
    pub middle_um: f64,
    /// (°) Its direction at the start, from x towards y. Default 0.
    pub angle_deg: f64,
}

keys! {
    Bow = default Self { middle_um: 0.0, angle_deg: 0.0 };
    middle_um "µm" "the distance of its middle from the line through its ends, without a load"
        .range(Range::not_negative().implausible_above(1e4));
    angle_deg "°" "its direction at time 0, before settling, from x towards y" .range(ANGLE);
}

/// Forces on a machine that turn with a shaft.
#[derive(Debug, Clone, PartialEq)]
pub struct TurningForce {
    /// (-) Rotation of the shaft over that of the motor.
    pub speed_ratio: f64,
    /// Whether the forces grow with the square of the shaft's speed; otherwise they are constant.
    pub of_square_speed: bool,
    /// (N s²; or N, N m) Forces where the shaft stands as at the start, and a quarter of a revolution later, in turned coordinates.
    pub at: [DVector<f64>; 2],
}

impl TurningForce {
    /// Forces that point in a direction of the shaft.
    ///
    /// # Arguments
    /// * `speed_ratio`, `of_square_speed` - see the fields
    /// * `along` - the forces as they point along x and along y
    /// * `angle_deg` - (°) their direction at the start, from x towards y
    pub(super) fn new(
        speed_ratio: f64,
        of_square_speed: bool,
        [x, y]: [DVector<f64>; 2],
        angle_deg: f64,
    ) -> Self {
        let (sin, cos) = angle_deg.to_radians().sin_cos();
        Self { speed_ratio, of_square_speed, at: [&x * cos + &y * sin, y * cos - x * sin] }
    }

    /// Forces of an unbalance, `U ω²`.
    ///
    /// # Arguments
    /// * `unbalance` - U
    /// * `speed_ratio` - (-) rotation of its shaft over that of the motor
    /// * `motion` - motion of its place along x and along y, per unit of each coordinate
    pub(super) fn of_unbalance(unbalance: &Unbalance, speed_ratio: f64, motion: [DVector<f64>; 2]) -> Self {
        let kg_m = unbalance.g_mm * 1e-6;
        Self::new(speed_ratio, true, motion.map(|along| along * kg_m), unbalance.angle_deg)
    }
}
