//! Axial compression: `U_a = F_a² ∫ dx/(2 E A)`.

use super::energy::{EnergyCoefficients, LoadedTooth};

pub(super) fn energy(tooth: &LoadedTooth) -> Vec<EnergyCoefficients> {
    let flexibility = 1.0 / (2.0 * tooth.youngs_modulus_mpa);
    tooth.integrate(
        |i| [flexibility / tooth.section.area_mm2[i]],
        |_, &[aa]| EnergyCoefficients { aa, ..Default::default() },
    )
}
