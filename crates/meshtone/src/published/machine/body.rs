//! Mass and inertias of a wheel.

use std::f64::consts::PI;

use crate::machine::{WheelBody, WheelInertia};
use crate::wheel::{Material, Wheel};

/// A solid disc of pitch radius `R` and face width `W`: `m = ρ π R² W`, `J = m R²/2`, and `I = m (3R² + W²)`, which the published
/// code does not divide by 12. What the user gives replaces it.
///
/// # Arguments
/// * `wheel` - geometry
/// * `material` - for the density
/// * `given` - values of the user
pub(super) fn wheel_body(wheel: &Wheel, material: Material, given: &WheelInertia) -> WheelBody {
    let (radius, width) = (wheel.pitch_radius_mm * 1e-3, wheel.face_width_mm * 1e-3);
    let solid_kg = PI * radius * radius * width * material.density_kg_per_m3();
    let mass_kg = given.mass_kg.unwrap_or(solid_kg);
    WheelBody {
        mass_kg,
        polar_kgm2: given.polar_inertia_kgm2.unwrap_or(mass_kg * radius * radius / 2.0),
        transverse_kgm2: given
            .transverse_inertia_kgm2
            .unwrap_or(mass_kg * (3.0 * radius * radius + width * width)),
    }
}
