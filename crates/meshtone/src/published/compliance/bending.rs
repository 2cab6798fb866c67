//! Bending about both axes of the section.
//!
//! `U_b = ∫ (M_z² Iy − 2 M_z M_y Iyz + M_y² Iz)/(2E (Iy Iz − Iyz²)) dx` with
//! `M_z = F_s (x − x_i) + F_a (y_i − Yc)` and `M_y = F_a (Z̄_i − Zc)`, both the moment of the stress, `−∫ σ y dA` and
//! `−∫ σ z dA`. Everything that depends on the loaded point i is moved out of the integrals.

use super::energy::{EnergyCoefficients, LoadedTooth};
use crate::published::damage::LateralBending;

pub(super) fn energy(tooth: &LoadedTooth) -> Vec<EnergyCoefficients> {
    match &tooth.section.lateral {
        None => about_z(tooth),
        Some(lateral) => about_both(tooth, lateral),
    }
}

/// Integrals of `w (x², x, 1)` and of `w (x Yc, Yc, Yc²)`, `w = 1/(2 E Iz)`.
fn about_z(tooth: &LoadedTooth) -> Vec<EnergyCoefficients> {
    let flexibility = 1.0 / (2.0 * tooth.youngs_modulus_mpa);
    let weight = |i: usize| flexibility / tooth.section.iz_mm4[i];
    let y_mm = &tooth.profile.y_mm;
    match &tooth.section.yc_mm {
        None => tooth.integrate(
            |i| {
                let (w, x) = (weight(i), tooth.depth_mm(i));
                [w * x * x, w * x, w]
            },
            |i, &[xx, x, one]| main_moment(tooth.depth_mm(i), y_mm[i], [xx, x, one, 0.0, 0.0, 0.0]),
        ),
        Some(yc) => tooth.integrate(
            |i| main_integrands(weight(i), tooth.depth_mm(i), yc[i]),
            |i, integrals| main_moment(tooth.depth_mm(i), y_mm[i], *integrals),
        ),
    }
}

fn main_integrands(w: f64, x: f64, yc: f64) -> [f64; 6] {
    [w * x * x, w * x, w, w * x * yc, w * yc, w * yc * yc]
}

/// `∫ w M_z² dx` of a load at (x_i, y_i).
fn main_moment(x_i: f64, y_i: f64, [xx, x, one, xyc, yc, ycyc]: [f64; 6]) -> EnergyCoefficients {
    EnergyCoefficients {
        ss: xx - 2.0 * x_i * x + x_i * x_i * one,
        sa: 2.0 * (y_i * (x - x_i * one) - (xyc - x_i * yc)),
        aa: y_i * y_i * one - 2.0 * y_i * yc + ycyc,
    }
}

fn about_both(tooth: &LoadedTooth, lateral: &LateralBending) -> Vec<EnergyCoefficients> {
    let flexibility = 1.0 / (2.0 * tooth.youngs_modulus_mpa);
    let y_mm = &tooth.profile.y_mm;
    // Model: the published energy adds the coupling, as if M_y had the opposite sign.
    let coupling = if lateral.published_coupling { 1.0 } else { -1.0 };
    let centre_y = |i: usize| tooth.section.yc_mm.as_ref().map_or(0.0, |yc| yc[i]);
    tooth.integrate(
        |i| {
            let (iz, iy, iyz) = (tooth.section.iz_mm4[i], lateral.iy_mm4[i], lateral.iyz_mm4[i]);
            let per_determinant = flexibility / (iy * iz - iyz * iyz);
            let (main, cross, side) =
                (iy * per_determinant, coupling * iyz * per_determinant, iz * per_determinant);
            let (x, yc, zc) = (tooth.depth_mm(i), centre_y(i), lateral.zc_mm[i]);
            let [m0, m1, m2, m3, m4, m5] = main_integrands(main, x, yc);
            [
                m0,
                m1,
                m2,
                m3,
                m4,
                m5,
                cross,
                cross * x,
                cross * yc,
                cross * zc,
                cross * x * zc,
                cross * yc * zc,
                side,
                side * zc,
                side * zc * zc,
            ]
        },
        |i, &[m0, m1, m2, m3, m4, m5, c, cx, cy, cz, cxz, cyz, s, sz, szz]| {
            let (x_i, y_i, z_i) = (tooth.depth_mm(i), y_mm[i], lateral.load_z_mm[i]);
            let mut energy = main_moment(x_i, y_i, [m0, m1, m2, m3, m4, m5]);
            energy.sa += 2.0 * (z_i * (cx - x_i * c) - (cxz - x_i * cz));
            energy.aa += 2.0 * (y_i * z_i * c - y_i * cz - z_i * cy + cyz);
            energy.aa += z_i * z_i * s - 2.0 * z_i * sz + szz;
            energy
        },
    )
}
