//! Bending about both axes of the section.
//!
//! `U_b = ∫ (M_z² Iy − 2 M_z M_y Iyz + M_y² Iz)/(2E (Iy Iz − Iyz²)) dx` with
//! `M_z = F_s (x − x_i) + F_a (y_i − Yc)` and `M_y = F_a (Z̄_i − Zc)`, both the moment of the stress, `−∫ σ y dA` and
//! `−∫ σ z dA`. Everything that depends on the loaded point i is moved out of the integrals.

use super::energy::LoadedTooth;
use crate::published::damage::LateralBending;
use crate::stiffness::{Energy, bending_energy, bending_integrands, main_energy, main_integrands};

pub(super) fn energy(tooth: &LoadedTooth) -> Vec<Energy> {
    match &tooth.section.lateral {
        None => about_z(tooth),
        Some(lateral) => about_both(tooth, lateral),
    }
}

/// Integrals of `w (x², x, 1)` and of `w (x Yc, Yc, Yc²)`, `w = 1/(2 E Iz)`.
fn about_z(tooth: &LoadedTooth) -> Vec<Energy> {
    let flexibility = 1.0 / (2.0 * tooth.youngs_modulus_mpa);
    let weight = |i: usize| flexibility / tooth.section.iz_mm4[i];
    let y_mm = &tooth.profile.y_mm;
    match &tooth.section.yc_mm {
        None => tooth.integrate(
            |i| {
                let (w, x) = (weight(i), tooth.depth_mm(i));
                [w * x * x, w * x, w]
            },
            |i, &[xx, x, one]| main_energy([xx, x, one, 0.0, 0.0, 0.0], tooth.depth_mm(i), y_mm[i]),
        ),
        Some(yc) => tooth.integrate(
            |i| main_integrands(weight(i), tooth.depth_mm(i), yc[i]),
            |i, integrals| main_energy(*integrals, tooth.depth_mm(i), y_mm[i]),
        ),
    }
}

fn about_both(tooth: &LoadedTooth, lateral: &LateralBending) -> Vec<Energy> {
    let flexibility = 1.0 / (2.0 * tooth.youngs_modulus_mpa);
    let y_mm = &tooth.profile.y_mm;
    let centre_y = |i: usize| tooth.section.yc_mm.as_ref().map_or(0.0, |yc| yc[i]);
    tooth.integrate(
        |i| {
            // The published energy adds the coupling, as if M_y had the opposite sign: it is that of the section's mirror image.
            let moments = [lateral.iy_mm4[i], tooth.section.iz_mm4[i], -lateral.iyz_mm4[i]];
            bending_integrands(flexibility, tooth.depth_mm(i), [centre_y(i), lateral.zc_mm[i]], moments)
        },
        |i, integrals| bending_energy(integrals, [tooth.depth_mm(i), y_mm[i], lateral.load_z_mm[i]]),
    )
}
