//! Mass and inertias of a wheel.

use std::f64::consts::PI;

use crate::machine::WheelInertia;
use crate::wheel::{BodyRotation, Gears, Material, Wheel, WheelName};

/// Mass and inertias of one wheel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WheelBody {
    /// (kg) Mass.
    pub mass_kg: f64,
    /// (kg m²) Moment of inertia about the shaft.
    pub polar_kgm2: f64,
    /// (kg m²) Moment of inertia about a diameter.
    pub transverse_kgm2: f64,
}

impl WheelBody {
    /// A solid disc of the V circle's radius `R`, without profile shift the pitch radius, and face width `W`: `m = ρ π R² W`, `J = m R²/2`,
    /// `I = m (3R² + W²)/12`; what the user gives replaces it.
    ///
    /// # Arguments
    /// * `wheel` - geometry
    /// * `material` - for the density
    /// * `given` - values of the user
    pub fn new(wheel: &Wheel, material: Material, given: &WheelInertia) -> Self {
        let radius = wheel.v_circle_radius_mm() * 1e-3;
        let width = wheel.face_width_mm * 1e-3;
        let solid_mass = PI * radius * radius * width * material.density_kg_per_m3();
        let mass_kg = given.mass_kg.unwrap_or(solid_mass);
        Self {
            mass_kg,
            polar_kgm2: given.polar_inertia_kgm2.unwrap_or(mass_kg * radius * radius / 2.0),
            transverse_kgm2: given
                .transverse_inertia_kgm2
                .unwrap_or(mass_kg * (3.0 * radius * radius + width * width) / 12.0),
        }
    }
}

impl WheelBody {
    /// A flat ring, `J = m (r² + R²)/2` and half of it about a diameter; what the user gives replaces it.
    ///
    /// # Arguments
    /// * `solid_kg` - (kg) its mass
    /// * `radii_m` - (m) r and R
    /// * `given` - values of the user
    pub(crate) fn of_annulus(solid_kg: f64, radii_m: [f64; 2], given: &WheelInertia) -> Self {
        let mass_kg = given.mass_kg.unwrap_or(solid_kg);
        let polar_kgm2 =
            given.polar_inertia_kgm2.unwrap_or(mass_kg * (radii_m[0].powi(2) + radii_m[1].powi(2)) / 2.0);
        Self {
            mass_kg,
            polar_kgm2,
            transverse_kgm2: given.transverse_inertia_kgm2.unwrap_or(polar_kgm2 / 2.0),
        }
    }
}

/// (N m/rad) Torsional stiffness of a wheel's body between bore and root circle, `4π G W/(1/r_i² − 1/r_f²)`: of a plane ring that is clamped
/// at its bore. None where the rotation is left in the teeth.
///
/// # Arguments
/// * `wheel` - geometry
/// * `side` - which of the two it is
/// * `gears` - for the shear modulus, and where the rotation is
pub(crate) fn body_stiffness_nm_per_rad(wheel: &Wheel, side: WheelName, gears: &Gears) -> Option<f64> {
    let of_radius = |radius_mm: f64| (radius_mm * 1e-3).powi(-2);
    let width_m = wheel.face_width_mm * 1e-3;
    let stiffness = 4.0 * PI * gears.material_of(side).shear_modulus_mpa() * 1e6 * width_m
        / (of_radius(wheel.bore_radius_mm) - of_radius(wheel.root_radius_mm));
    (gears.foundation.rotation == BodyRotation::Machine).then_some(stiffness)
}
