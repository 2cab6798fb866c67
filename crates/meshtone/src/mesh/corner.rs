//! A tooth that touches with its tip's corner, outside the path of contact.
//!
//! Inside the path the flanks touch along the line of action. Before its start and beyond its end the corner of one tooth's tip
//! runs towards, or away from, the flank of the other: flanks that errors or bent teeth bring close enough touch there too.

use std::array::from_fn;
use std::f64::consts::PI;

use nalgebra::{SMatrix, SVector};

use crate::wheel::Wheel;

/// The corner of one tooth's tip and the flank of its mate.
///
/// With the line of action as x axis, the tangent point of the mate's base circle at 0 and that of the corner's own wheel at
/// `L`, the corner lies at `ρ₂ = L − ρ₁`, `ρ₁ = √(Ra₁² − Rb₁²)`, where it leaves the path. Radii and curvature of a ring are less than 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Corner {
    own_base_mm: f64,
    mate_base_mm: f64,
    line_mm: f64,
    /// (mm) ρ₁.
    own_curvature_mm: f64,
}

impl Corner {
    /// The corner of a tooth.
    ///
    /// # Arguments
    /// * `own` - the wheel whose tooth has the corner
    /// * `mate` - the wheel whose flank it touches
    /// * `line_mm` - (mm) length of the line of action between the base circles
    /// * `tip_radius_mm` - (mm) radius of the corner, at least the base radius
    pub(crate) fn new(own: &Wheel, mate: &Wheel, line_mm: f64, tip_radius_mm: f64) -> Self {
        Self {
            own_base_mm: own.sign() * own.base_radius_mm,
            mate_base_mm: mate.sign() * mate.base_radius_mm,
            line_mm,
            own_curvature_mm: own.curvature_mm(tip_radius_mm),
        }
    }

    /// (mm) Distance, along the mate's base tangent, of the corner from the mate's flank.
    ///
    /// The corner is turned back by `ψ = s/Rb₁` about its wheel's centre at `(L, Rb₁)`; with `ρ_T` its distance from the mate's
    /// base circle along the tangent and `τ_T` the polar angle of the tangent point, the mate's flank having turned back too,
    /// `S = ρ_T − Rb₂ (τ_T − π/2) − ρ₂ + s`.
    ///
    /// # Arguments
    /// * `outside_mm` - (mm) s, how far along the line of action the pair is outside its path
    pub(crate) fn separation_mm(&self, outside_mm: f64) -> f64 {
        if outside_mm <= 0.0 {
            return 0.0;
        }
        let mate_curvature = self.line_mm - self.own_curvature_mm;
        let (sin, cos) = (outside_mm / self.own_base_mm).sin_cos();
        // From the wheel's centre to the corner on the path: (−ρ₁, −Rb₁).
        let x = self.line_mm - self.own_curvature_mm * cos - self.own_base_mm * sin;
        let y = self.own_base_mm + self.own_curvature_mm * sin - self.own_base_mm * cos;
        // From the mate's centre at (0, −Rb₂).
        let height = y + self.mate_base_mm;
        // Turned back from the line of action the corner moves away from the mate's base circle.
        let squared = (x * x + height * height - self.mate_base_mm * self.mate_base_mm).max(0.0);
        let tangent = squared.sqrt().copysign(self.mate_base_mm);
        // The tangent point lies ahead of the corner by the angle whose tangent is ρ_T/Rb₂.
        let side = self.mate_base_mm.signum();
        let turned = (tangent / self.mate_base_mm).atan() - (side * x).atan2(side * height);
        tangent - self.mate_base_mm * turned - mate_curvature + outside_mm
    }
}

/// Terms of a corner's series.
pub(crate) const TERMS: usize = 6;

/// (mm) Penetration up to which a corner's series holds: farther apart than this no flanks meet, even where teeth are missing.
const DEEPEST_MM: f64 = 0.4;

/// (base pitches) How far outside its path a corner is looked at, at most.
pub(super) const REACH: f64 = 0.6;

/// How far beyond its path a corner touches at a penetration D: `s*(D) = Σ a_j v^j` in base pitches, with `v = √D` in √m, the inverse of the
/// separation S(s).
///
/// S begins as s², so that s* is smooth in v, and its integral over D is the same sum with other factors: the force on what a contact line
/// has outside its path takes one square root. What is said of a place on the path as a multiple s of the base pitch is
/// said here by the v at which the corner reaches it: so all that follows from the sum is continuous, however well it fits.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct CornerReach {
    /// (base pitches per m^(j/2)) a_j, from j = 1.
    pub coefficients: [f64; TERMS],
    /// (√m) The largest v for which the sum stands.
    pub most: f64,
}

impl CornerReach {
    /// Fits the series to a corner's separation: exactly at [`TERMS`] distances, which lie as Chebyshev's points do, so that s*/v is met
    /// between them within 1e-4 (2e-3 of a corner that runs out of its mate's involute).
    ///
    /// # Arguments
    /// * `corner` - the corner
    /// * `base_pitch_mm` - (mm) the base pitch
    pub(super) fn new(corner: &Corner, base_pitch_mm: f64) -> Self {
        let root = |reach: f64| (corner.separation_mm(reach * base_pitch_mm) * 1e-3).sqrt();
        let (mut low, mut high) = (0.0, REACH);
        while root(REACH) > (DEEPEST_MM * 1e-3).sqrt() && high - low > 1e-6 {
            let middle = (low + high) / 2.0;
            if root(middle) < (DEEPEST_MM * 1e-3).sqrt() { low = middle } else { high = middle }
        }
        let most = root(high);
        let node = |n: usize| 0.5 * high * (1.0 - ((n as f64 + 0.5) * PI / TERMS as f64).cos());
        let part = SVector::<f64, TERMS>::from_fn(|n, _| node(n) / root(node(n)) * most);
        let powers = SMatrix::<f64, TERMS, TERMS>::from_fn(|n, j| (root(node(n)) / most).powi(j as i32));
        let scaled = powers.lu().solve(&part).unwrap_or_default();
        Self { coefficients: from_fn(|j| scaled[j] / most.powi(j as i32 + 1)), most }
    }

    /// (base pitches) s* at a v.
    fn reach(&self, v: f64) -> f64 {
        self.coefficients.iter().rev().fold(0.0, |sum, coefficient| (sum + coefficient) * v)
    }

    /// (√m) The v at which the corner reaches a place, at most the largest one of the series.
    ///
    /// # Arguments
    /// * `outside` - (base pitches) how far outside the path the place is
    pub(super) fn root_at(&self, outside: f64) -> f64 {
        if outside <= 0.0 {
            return 0.0;
        }
        let (mut low, mut high) = (0.0, self.most);
        let mut v = (outside / self.coefficients[0]).min(high);
        // Newton's steps, and halves of the interval where one would leave it.
        for _ in 0..60 {
            let beyond = self.reach(v) - outside;
            if beyond > 0.0 {
                high = v
            } else {
                low = v
            }
            let slope = (1..=TERMS).rev().fold(0.0, |sum, j| sum * v + j as f64 * self.coefficients[j - 1]);
            let next = v - beyond / slope;
            let next = if next > low && next < high { next } else { (low + high) / 2.0 };
            if (next - v).abs() <= 1e-15 * self.most {
                break;
            }
            v = next;
        }
        v
    }

    /// (√m) The same of a place on either side of the corner's, with the side's sign.
    pub(super) fn signed_root_at(&self, outside: f64) -> f64 {
        self.root_at(outside.abs()).copysign(outside)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wheel::{Gears, PathOfContact, WheelName};

    fn corner(module_mm: f64, pinion_teeth: u32, gear_teeth: u32) -> (Corner, f64) {
        let gears = Gears::new(module_mm, pinion_teeth, gear_teeth, 15.0);
        let [pinion, gear] = WheelName::BOTH.map(|wheel| Wheel::new(&gears, wheel, 10.0));
        let path = PathOfContact::new(&pinion, &gear);
        (Corner::new(&gear, &pinion, path.line_mm, gear.tip_radius_mm), path.base_pitch_mm)
    }

    #[test]
    fn separates_as_computed_elsewhere() {
        for (module, pinion, gear, expected_um) in [
            (2.0, 25, 30, [0.683, 4.293, 17.34, 70.80]),
            (3.0, 62, 62, [0.219, 1.377, 5.582, 22.92]),
            (3.0, 17, 38, [2.901, 15.90, 57.04, 206.4]),
        ] {
            let (corner, pitch) = corner(module, pinion, gear);
            for (outside, expected) in [0.02, 0.05, 0.1, 0.2].into_iter().zip(expected_um) {
                let separation = corner.separation_mm(outside * pitch) * 1e3;
                // Three to four digits are given.
                assert!(
                    (separation / expected - 1.0).abs() < 2.5e-3,
                    "{pinion}/{gear} {outside}: {separation}"
                );
            }
        }
    }

    #[test]
    fn touches_on_the_path_and_leaves_it_smoothly() {
        let (corner, pitch) = corner(3.0, 17, 38);
        assert_eq!(corner.separation_mm(0.0), 0.0);
        assert_eq!(corner.separation_mm(-1.0), 0.0);
        assert!(corner.separation_mm(1e-4 * pitch) < 1e-6 * pitch);
        let far: Vec<f64> =
            (0..60).map(|step| corner.separation_mm(f64::from(step) * 0.01 * pitch)).collect();
        assert!(far.windows(2).all(|pair| pair[1] > pair[0]), "{far:?}");
    }

    #[test]
    fn series_is_the_inverse_of_the_separation() {
        for (module, pinion, gear, tolerance) in
            [(2.0, 25, 30, 2e-5), (3.0, 62, 62, 1e-7), (3.0, 17, 38, 3e-3)]
        {
            let (corner, pitch) = corner(module, pinion, gear);
            let series = CornerReach::new(&corner, pitch);
            for outside in [0.005, 0.02, 0.05, 0.1, 0.2] {
                let v = (corner.separation_mm(outside * pitch) * 1e-3).sqrt();
                let found = series.reach(v) / outside - 1.0;
                assert!(found.abs() < tolerance, "{pinion}/{gear} {outside}: {found:e}");
                assert!((series.reach(series.root_at(outside)) / outside - 1.0).abs() < 1e-13);
            }
        }
    }
}
