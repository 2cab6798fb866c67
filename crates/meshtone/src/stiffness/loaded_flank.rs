//! Compliance of a tooth under a load anywhere on its flank, in any direction.
//!
//! A load `F` at (x_i, y_i, z_i), `F_s = F cos α₁` across and `F_a = F sin α₁` along the tooth, bends it about both axes of its
//! sections, shears and compresses it. With `M_z = F_s (x − x_i) + F_a (y_i − Yc)` and `M_y = F_a (z_i − Zc)`
//! `U = ∫ (M_z² Iy − 2 M_z M_y Iyz + M_y² Iz)/(2E (Iy Iz − Iyz²)) + F_s² s/G + F_a²/(2EA) dx` from the root to x_i. Everything
//! that depends on the load is moved out of the integrals (paper, Eq. 2 → 3): they are evaluated once for all loads.

use super::energy::{Energy, bending_energy, bending_integrands, cumulative};
use super::foundation::{Foundation, LoadDirection};
use crate::damage::{DamagedTooth, Section};
use crate::wheel::{Flank, FlankPoint, FoundationCoefficients, Material};

/// A load on a flank, of unit size.
#[derive(Debug, Clone, Copy)]
pub struct FlankLoad {
    /// Point at which it acts.
    pub point: FlankPoint,
    /// (-) Sine of its angle to the normal of the tooth's centre line.
    pub sin: f64,
    /// (-) Cosine of it.
    pub cos: f64,
    /// (mm) Where it acts along the face, from its middle.
    pub z_mm: f64,
    /// (mm) Width over which it is spread.
    pub width_mm: f64,
}

/// A tooth that can be loaded anywhere on its flank.
pub struct LoadedFlank<'a> {
    flank: Flank<'a>,
    integrals: Integrals,
    foundation: Foundation,
    youngs_modulus_mpa: f64,
}

/// Integrals from the root up to each profile point.
enum Integrals {
    /// Of a sound tooth, whose sections' centres lie on its centre line.
    Sound(Vec<[f64; SOUND]>),
    /// Of a damaged one: bending about both axes, then shear and compression.
    Damaged(Vec<[f64; 15]>, Vec<[f64; 2]>),
}

/// `w (x², x, 1)` with `w = 1/(2E Iz)`, `1/(2E Iy)`, shear and compression.
const SOUND: usize = 6;

impl<'a> LoadedFlank<'a> {
    /// The integrals of a tooth.
    ///
    /// They are summed once along the profile, so that each load afterwards takes two values of each and no loop. A sound tooth is
    /// symmetric: its integrands have no product of inertia and follow from one division a point, which is most of the time of a healthy
    /// wheel.
    ///
    /// # Arguments
    /// * `flank` - the sound tooth
    /// * `damage` - what is left of it, where it is damaged
    /// * `material` - of the wheel
    /// * `foundation` - coefficients of the fillet foundation
    pub fn new(
        flank: Flank<'a>,
        damage: Option<&DamagedTooth>,
        material: Material,
        foundation: &FoundationCoefficients,
    ) -> Self {
        let bending = 1.0 / (2.0 * material.youngs_modulus_mpa());
        let shear = 1.0 / material.shear_modulus_mpa();
        let (profile, width) = (flank.profile, flank.wheel.face_width_mm);
        let depth = |i: usize| profile.x_mm[i] - profile.x_mm[0];
        let integrals = match damage {
            None => {
                // The reciprocals of W (2Y)³/12, 2Y W³/12 and 2Y W, by one division.
                let [of_iz, of_iy, of_shear, of_area] = [
                    bending * 12.0 / (8.0 * width),
                    bending * 6.0 / width.powi(3),
                    shear * 0.6 / (2.0 * width),
                    bending / (2.0 * width),
                ];
                Integrals::Sound(cumulative(&profile.x_mm, |i| {
                    let (x, inverse) = (depth(i), 1.0 / profile.y_mm[i]);
                    let w = of_iz * inverse * inverse * inverse;
                    [w * x * x, w * x, w, of_iy * inverse, of_shear * inverse, of_area * inverse]
                }))
            }
            Some(damage) => {
                let section = |i: usize| Section::damaged(damage, profile, width, i);
                let sections: Vec<Section> = (0..profile.len()).map(section).collect();
                let bent = |i: usize| {
                    let Section { yc_mm, zc_mm, iy_mm4, iz_mm4, iyz_mm4, .. } = sections[i];
                    bending_integrands(bending, depth(i), [yc_mm, zc_mm], [iy_mm4, iz_mm4, iyz_mm4])
                };
                let others = |i: usize| [shear * sections[i].shear_per_mm2, bending / sections[i].area_mm2];
                Integrals::Damaged(cumulative(&profile.x_mm, bent), cumulative(&profile.x_mm, others))
            }
        };
        Self {
            foundation: Foundation::local(flank.wheel, profile, foundation, material.poisson_ratio()),
            youngs_modulus_mpa: material.youngs_modulus_mpa(),
            flank,
            integrals,
        }
    }

    /// (mm/N) Displacement along the load under a unit of it: bending, shear, compression and the wheel's body near the tooth. The
    /// rotation of the body as a whole is the machine's.
    ///
    /// # Arguments
    /// * `load` - where and how it acts
    pub fn compliance_mm_per_n(&self, load: &FlankLoad) -> f64 {
        let direction = LoadDirection { sin: load.sin, cos: load.cos, tan: load.sin / load.cos };
        let place = (load.point.x_mm, load.point.y_mm);
        self.energy(load).compliance(direction)
            + self.foundation.compliance(place, direction, load.width_mm, self.youngs_modulus_mpa)
    }

    fn energy(&self, load: &FlankLoad) -> Energy {
        let x_i = load.point.x_mm - self.flank.profile.x_mm[0];
        let (y_i, z_i) = (load.point.y_mm, load.z_mm);
        match &self.integrals {
            Integrals::Sound(integrals) => {
                let [xx, x, one, side, shear, axial] = at(integrals, &load.point);
                Energy {
                    ss: xx - 2.0 * x_i * x + x_i * x_i * one + shear,
                    sa: 2.0 * y_i * (x - x_i * one),
                    aa: y_i * y_i * one + z_i * z_i * side + axial,
                }
            }
            Integrals::Damaged(bent, others) => {
                let Energy { ss, sa, aa } = bending_energy(&at(bent, &load.point), [x_i, y_i, z_i]);
                let [shear, axial] = at(others, &load.point);
                Energy { ss: ss + shear, sa, aa: aa + axial }
            }
        }
    }
}

/// Values between two profile points.
fn at<const N: usize>(values: &[[f64; N]], point: &FlankPoint) -> [f64; N] {
    let (before, after) = (&values[point.index], &values[point.index + 1]);
    std::array::from_fn(|n| before[n] + point.fraction * (after[n] - before[n]))
}
