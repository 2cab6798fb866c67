//! Strain energy of a tooth as a bar: what is integrated along it, and the energy that the integrals make.

use super::LoadDirection;

/// Energy of a unit load, split by its components: `F_s² ss + F_s F_a sa + F_a² aa`, with `F_s = cos α` across and `F_a = sin α` along
/// the tooth.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Energy {
    pub(crate) ss: f64,
    pub(crate) sa: f64,
    pub(crate) aa: f64,
}

impl Energy {
    /// (mm/N) Compliance `2U` of a unit force.
    pub(crate) fn compliance(&self, load: LoadDirection) -> f64 {
        let (fs, fa) = (load.cos, load.sin);
        2.0 * (fs * fs * self.ss + fs * fa * self.sa + fa * fa * self.aa)
    }
}

/// What is integrated of a section's bending about both axes, `(M_z² Iy − 2 M_z M_y Iyz + M_y² Iz)/(2E (Iy Iz − Iyz²))`: the moments of
/// the main bending, the cross terms and the bending about y.
///
/// # Arguments
/// * `flexibility` - (mm²/N) `1/(2E)`
/// * `x` - (mm) where the section is, from the root
/// * `centre` - (mm) y and z of its centre
/// * `moments` - (mm⁴) Iy, Iz and Iyz about that
pub(crate) fn bending_integrands(
    flexibility: f64,
    x: f64,
    [yc, zc]: [f64; 2],
    [iy, iz, iyz]: [f64; 3],
) -> [f64; 15] {
    let per_determinant = flexibility / (iy * iz - iyz * iyz);
    let (main, cross, side) = (iy * per_determinant, -iyz * per_determinant, iz * per_determinant);
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
}

/// What is integrated of a section's bending about z alone, times a weight.
pub(crate) fn main_integrands(w: f64, x: f64, yc: f64) -> [f64; 6] {
    [w * x * x, w * x, w, w * x * yc, w * yc, w * yc * yc]
}

/// Energy of a load at (x_i, y_i, z_i) by the integrals of [`bending_integrands`] from the root to x_i.
pub(crate) fn bending_energy(integrals: &[f64; 15], [x_i, y_i, z_i]: [f64; 3]) -> Energy {
    let &[m0, m1, m2, m3, m4, m5, c, cx, cy, cz, cxz, cyz, s, sz, szz] = integrals;
    let mut energy = main_energy([m0, m1, m2, m3, m4, m5], x_i, y_i);
    energy.sa += 2.0 * (z_i * (cx - x_i * c) - (cxz - x_i * cz));
    energy.aa += 2.0 * (y_i * z_i * c - y_i * cz - z_i * cy + cyz);
    energy.aa += z_i * z_i * s - 2.0 * z_i * sz + szz;
    energy
}

/// `∫ w M_z² dx` of a load at (x_i, y_i), by the integrals of [`main_integrands`].
pub(crate) fn main_energy([xx, x, one, xyc, yc, ycyc]: [f64; 6], x_i: f64, y_i: f64) -> Energy {
    Energy {
        ss: xx - 2.0 * x_i * x + x_i * x_i * one,
        sa: 2.0 * (y_i * (x - x_i * one) - (xyc - x_i * yc)),
        aa: y_i * y_i * one - 2.0 * y_i * yc + ycyc,
    }
}

/// Integrals up to each of some places, by cumulative trapezoids.
///
/// # Arguments
/// * `x` - the places, rising
/// * `integrand` - at a place of a number
pub(crate) fn cumulative<const N: usize>(x: &[f64], integrand: impl Fn(usize) -> [f64; N]) -> Vec<[f64; N]> {
    let mut integral = [0.0; N];
    let mut before = integrand(0);
    let mut all = Vec::with_capacity(x.len());
    all.push(integral);
    for i in 1..x.len() {
        let here = integrand(i);
        let half_step = 0.5 * (x[i] - x[i - 1]);
        for n in 0..N {
            integral[n] += half_step * (before[n] + here[n]);
        }
        before = here;
        all.push(integral);
    }
    all
}
