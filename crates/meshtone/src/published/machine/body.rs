//! Mass and inertias of a wheel.

use crate::machine::{WheelBody, WheelInertia};
use crate::wheel::{Material, Wheel};

/// The disc of [`WheelBody::new`], of the pitch radius `R` as there is no profile shift, but for the transverse inertia
/// `I = m (3R² + W²)`, which the published code does not divide by 12. What the user gives replaces it.
///
/// # Arguments
/// * `wheel` - geometry
/// * `material` - for the density
/// * `given` - values of the user
pub(super) fn wheel_body(wheel: &Wheel, material: Material, given: &WheelInertia) -> WheelBody {
    let (radius, width) = (wheel.pitch_radius_mm * 1e-3, wheel.face_width_mm * 1e-3);
    let body = WheelBody::new(wheel, material, given);
    let undivided = body.mass_kg * (3.0 * radius * radius + width * width);
    WheelBody { transverse_kgm2: given.transverse_inertia_kgm2.unwrap_or(undivided), ..body }
}
