//! The compliances of one tooth: displacement along the line of action under a unit force there, at each point of
//! contact.

mod bending;
mod energy;

use energy::LoadedTooth;

use super::damage::ToothSection;
use crate::stiffness::{Energy, Foundation, LoadDirection};
use crate::wheel::{FoundationCoefficients, Material};
use crate::wheel::{ToothProfile, Wheel};

/// Displacement of a tooth along the line of action under a unit force there, at the contact points
/// from the root side to the tip.
#[derive(Debug, Clone, PartialEq)]
pub struct ToothCompliance {
    /// (mm/N) By axial compression.
    pub axial_mm_per_n: Vec<f64>,
    /// (mm/N) By shear.
    pub shear_mm_per_n: Vec<f64>,
    /// (mm/N) By bending.
    pub bending_mm_per_n: Vec<f64>,
    /// (mm/N) By deflection of the wheel's body.
    pub foundation_mm_per_n: Vec<f64>,
}

impl ToothCompliance {
    /// Compliances of a tooth.
    ///
    /// # Arguments
    /// * `wheel`, `profile`, `section` - the tooth
    /// * `material` - of the wheel
    /// * `foundation` - coefficients of the fillet foundation
    /// * `first_contact` - profile index where contact starts
    pub fn new(
        wheel: &Wheel,
        profile: &ToothProfile,
        section: &ToothSection,
        material: Material,
        foundation: &FoundationCoefficients,
        first_contact: usize,
    ) -> Self {
        let tooth = LoadedTooth {
            profile,
            section,
            youngs_modulus_mpa: material.youngs_modulus_mpa(),
            shear_modulus_mpa: material.shear_modulus_mpa(),
            first_contact,
        };
        let nominal = LoadDirection::new(wheel.pressure_angle_rad);
        let direction = |i: usize| match &section.pressure_angle_rad {
            Some(angles) if angles[i] != wheel.pressure_angle_rad => LoadDirection::new(angles[i]),
            _ => nominal,
        };
        let energy_point = |i: usize| match section.pivot {
            Some(pivot) if pivot.energies => pivot.loaded_point(i),
            _ => i,
        };
        let foundation_point = |i: usize| section.pivot.map_or(i, |pivot| pivot.loaded_point(i));
        let compliance = |energies: Vec<Energy>| {
            (first_contact..profile.len())
                .map(|i| energies[energy_point(i) - first_contact].compliance(direction(i)))
                .collect()
        };
        let body = Foundation::new(wheel, profile, foundation);
        // Axial compression: `U_a = F_a² ∫ dx/(2 E A)`.
        let per_area = 1.0 / (2.0 * tooth.youngs_modulus_mpa);
        let axial = tooth
            .integrate(|i| [per_area / section.area_mm2[i]], |_, &[aa]| Energy { aa, ..Default::default() });
        // Shear: `U_s = F_s² ∫ s/G dx`, with s = 0.6/A for a rectangular section.
        let per_shear = 1.0 / tooth.shear_modulus_mpa;
        let shear = tooth.integrate(
            |i| [per_shear * section.shear_per_mm2[i]],
            |_, &[ss]| Energy { ss, ..Default::default() },
        );
        Self {
            axial_mm_per_n: compliance(axial),
            shear_mm_per_n: compliance(shear),
            bending_mm_per_n: compliance(bending::energy(&tooth)),
            foundation_mm_per_n: (first_contact..profile.len())
                .map(|i| {
                    let point = foundation_point(i);
                    let load = (profile.x_mm[point], profile.y_mm[point]);
                    body.compliance(
                        load,
                        direction(i),
                        section.foundation_width_mm[i],
                        tooth.youngs_modulus_mpa,
                    )
                })
                .collect(),
        }
    }

    /// (mm/N) Sum of the four at contact point `index`.
    pub fn total_mm_per_n(&self, index: usize) -> f64 {
        self.axial_mm_per_n[index]
            + self.shear_mm_per_n[index]
            + self.bending_mm_per_n[index]
            + self.foundation_mm_per_n[index]
    }
}
