//! The line of action of the mesh in the 13 coordinates.

use super::coordinates::*;
use crate::mesh::DIRECTIONS;
use crate::wheel::Wheel;

/// Constant directions that span every line of action of the mesh.
///
/// At axial position z and working pressure angle α the line of action is `g = g0 + z g1`,
/// `g0 = [sin α, cos α, −sin α, −cos α, Rb_g, Rb_p, 0, 0, 0, 0, 0, 0, 0]`,
/// `g1 = [0×9, −cos α, cos α, sin α, −sin α]`. With `δ = α − α0`, `g` is
/// `cos δ · along + sin δ · across + rotation + z (cos δ · tilt + sin δ · tilt_across)`.
///
/// The bearings are as stiff in every direction, so the plane of the wheels and the plane of their
/// tilts can be turned until one axis lies along the nominal line of action. In these *turned*
/// coordinates most entries are exactly zero, and what the mesh does not reach stays out of the solution.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshDirections {
    /// Columns: the turned coordinates' unit vectors in the 13 coordinates.
    pub turn: CoordinateMatrix,
    /// The five directions in turned coordinates: along, across, rotation, tilt, tilt across.
    pub turned: [CoordinateVector; DIRECTIONS],
}

impl MeshDirections {
    /// The directions of a pair.
    ///
    /// # Arguments
    /// * `pinion`, `gear` - for the base radii and the working pressure angle
    pub fn new(pinion: &Wheel, gear: &Wheel) -> Self {
        let (sin, cos) = gear.working_pressure_angle_rad.sin_cos();
        let mut turn = CoordinateMatrix::identity();
        // Turned (x, y): along and across the line of action.
        for (x, y) in [(X_GEAR, Y_GEAR), (X_PINION, Y_PINION)] {
            turn[(x, x)] = sin;
            turn[(y, x)] = cos;
            turn[(x, y)] = cos;
            turn[(y, y)] = -sin;
        }
        // Turned (φ, ψ): the tilt that moves the flank along the line of action, and the other.
        for (phi, psi) in [(PHI_GEAR, PSI_GEAR), (PHI_PINION, PSI_PINION)] {
            turn[(phi, phi)] = -cos;
            turn[(psi, phi)] = sin;
            turn[(phi, psi)] = sin;
            turn[(psi, psi)] = cos;
        }
        let between = |gear: usize, pinion: usize| {
            let mut direction = CoordinateVector::zeros();
            direction[gear] = 1.0;
            direction[pinion] = -1.0;
            direction
        };
        let mut rotation = CoordinateVector::zeros();
        rotation[THETA_GEAR] = gear.base_radius_mm * 1e-3;
        rotation[THETA_PINION] = pinion.base_radius_mm * 1e-3;
        Self {
            turn,
            turned: [
                between(X_GEAR, X_PINION),
                between(Y_GEAR, Y_PINION),
                rotation,
                between(PHI_GEAR, PHI_PINION),
                between(PSI_GEAR, PSI_PINION),
            ],
        }
    }
}
