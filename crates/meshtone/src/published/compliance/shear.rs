//! Shear: `U_s = F_s² ∫ s/G dx`, with s = 0.6/A for a rectangular section.

use super::energy::{EnergyCoefficients, LoadedTooth};

pub(super) fn energy(tooth: &LoadedTooth) -> Vec<EnergyCoefficients> {
    let flexibility = 1.0 / tooth.shear_modulus_mpa;
    tooth.integrate(
        |i| [flexibility * tooth.section.shear_per_mm2[i]],
        |_, &[ss]| EnergyCoefficients { ss, ..Default::default() },
    )
}
