//! The radius at which the involute of an undercut tooth begins.

use super::Wheel;
use super::mounting_rules::TOOL_ROUNDING;
use super::radii::involute;

/// Halvings of an interval that is no longer than the wheel's radius.
const BISECTIONS: usize = 60;

impl Wheel {
    /// (mm) Radius of curvature at which a tooth's involute begins where the rack that cuts it reaches below the base circle and
    /// takes the foot of the flank away again; 0 of a tooth that is not undercut.
    ///
    /// The end of the rack's straight flank lies `h` below the pitch line and moves by `r φ` while the wheel turns by φ. At the
    /// radius R it is `√(R² − (r − h)²)` beside the centre line; where it crosses the involute there, the involute begins.
    ///
    /// Source: F. L. Litvin, A. Fuentes, *Gear Geometry and Applied Theory*, 2nd edition (2004), chapter 10.
    ///
    /// ```
    /// use meshtone::wheel::{Gears, Wheel, WheelName};
    ///
    /// let begins_mm = |teeth| Wheel::new(&Gears::new(1.0, teeth, 38, 15.0), WheelName::Pinion, 1.0).undercut_curvature_mm();
    /// assert_eq!(begins_mm(18), 0.0);
    /// assert!((begins_mm(14) - 0.246).abs() < 1e-3);
    /// ```
    pub fn undercut_curvature_mm(&self) -> f64 {
        let (radius_mm, base_mm) = (self.pitch_radius_mm, self.base_radius_mm);
        let end_mm = self.root_radius_mm + TOOL_ROUNDING * self.normal_module_mm();
        let below_mm = radius_mm - end_mm;
        if end_mm >= base_mm {
            return 0.0;
        }
        // How far inside the tooth the rack's end is, as an angle, at the radius of a point of the involute.
        let cut_rad = |curvature_mm: f64| {
            let beside_mm = (base_mm * base_mm + curvature_mm * curvature_mm - end_mm * end_mm).sqrt();
            let turned_rad = (beside_mm + below_mm * self.pressure_angle_rad.tan()) / radius_mm;
            let of_involute = involute((curvature_mm / base_mm).atan()) - involute(self.pressure_angle_rad);
            beside_mm.atan2(end_mm) - turned_rad - of_involute
        };
        if cut_rad(0.0) <= 0.0 {
            return 0.0;
        }
        let (mut cut_mm, mut left_mm) = (0.0, radius_mm * self.pressure_angle_rad.sin());
        for _ in 0..BISECTIONS {
            let middle_mm = (cut_mm + left_mm) / 2.0;
            if cut_rad(middle_mm) > 0.0 { cut_mm = middle_mm } else { left_mm = middle_mm }
        }
        left_mm
    }
}

#[cfg(test)]
mod tests {
    use crate::wheel::{Gears, Wheel, WheelName};

    fn begins(teeth: u32, shift: f64) -> f64 {
        let mut gears = Gears::new(2.0, teeth, 38, 15.0);
        gears.pinion_profile_shift = shift;
        Wheel::new(&gears, WheelName::Pinion, 1.0).undercut_curvature_mm() / 2.0
    }

    // The rack's end, followed in steps of 7.5 µrad until it comes out of the tooth: another program.
    #[test]
    fn involutes_begin_where_the_stepped_rack_leaves_them() {
        let stepped =
            [(16, 0.0915), (15, 0.1701), (14, 0.2458), (13, 0.3167), (12, 0.3830), (10, 0.5001), (8, 0.5934)];
        for (teeth, curvature) in stepped {
            assert!((begins(teeth, 0.0) - curvature).abs() < 1e-3, "{teeth}: {}", begins(teeth, 0.0));
        }
    }

    // z = 2 (h − x)/sin²α: 17.1 teeth without a shift.
    #[test]
    fn undercut_ends_at_the_known_number_of_teeth() {
        for (shift, fewest) in [(0.0, 18), (0.3, 12), (0.5, 9), (-0.3, 23)] {
            assert!(begins(fewest, shift) == 0.0 && begins(fewest - 1, shift) > 0.0, "{shift}");
        }
    }
}
