//! Flattening of the two flanks where they touch.

use std::f64::consts::PI;

use crate::wheel::Material;

/// (mm/N) Compliance of the contact of two flanks, `4 (1 − ν²)/(π E W)`.
///
/// Source: D. C. H. Yang, J. Y. Lin, "Hertzian damping, tooth friction and bending elasticity in gear
/// impact dynamics", Journal of Mechanisms, Transmissions, and Automation in Design 109 (1987).
///
/// # Arguments
/// * `materials` - of the two wheels
/// * `width_mm` - (mm) width over which they touch
///
/// ```
/// use meshtone::{scenario::Material, stiffness::hertz_compliance_mm_per_n};
/// let stiffness = 1.0 / hertz_compliance_mm_per_n([Material::Steel; 2], 20.0);
/// assert!((stiffness / 3.6249e6 - 1.0).abs() < 1e-4);
/// ```
pub fn hertz_compliance_mm_per_n(materials: [Material; 2], width_mm: f64) -> f64 {
    // Of both alike: each yields half of it.
    let alike = materials.map(|material| {
        let poisson = material.poisson_ratio();
        4.0 * (1.0 - poisson * poisson) / (PI * material.youngs_modulus_mpa() * width_mm)
    });
    alike.iter().sum::<f64>() / 2.0
}
