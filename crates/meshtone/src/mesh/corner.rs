//! A tooth that touches with its tip's corner, outside the path of contact.
//!
//! Inside the path the flanks touch along the line of action. Before its start and beyond its end the corner of one tooth's tip
//! runs towards, or away from, the flank of the other: flanks that errors or bent teeth bring close enough touch there too.

use crate::wheel::Wheel;

/// The corner of one tooth's tip and the flank of its mate.
///
/// With the line of action as x axis, the tangent point of the mate's base circle at 0 and that of the corner's own wheel at
/// `L`, the corner lies at `ρ₂ = L − ρ₁`, `ρ₁ = √(Ra₁² − Rb₁²)`, where it leaves the path.
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
            own_base_mm: own.base_radius_mm,
            mate_base_mm: mate.base_radius_mm,
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
        let tangent = (x * x + height * height - self.mate_base_mm * self.mate_base_mm).max(0.0).sqrt();
        // The tangent point lies ahead of the corner by the angle whose tangent is ρ_T/Rb₂.
        let turned = (tangent / self.mate_base_mm).atan() - x.atan2(height);
        tangent - self.mate_base_mm * turned - mate_curvature + outside_mm
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
}
