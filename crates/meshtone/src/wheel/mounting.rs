//! Mounting of two wheels: profile shift, working pressure angle, centre distance, backlash.
//!
//! A rack that makes teeth can be set off from the wheel's pitch circle by `x m`: positive shifts make the tooth thicker at its
//! root and its tip narrower. Two such wheels touch without backlash at a distance of their own, where the line of action is
//! inclined by the working pressure angle: `inv α_w = inv α + 2 tan α (x₁ + x₂)/(z₁ + z₂)`, `a = a₀ cos α/cos α_w`. Put further
//! apart than that they have backlash, and the angle that goes with the distance.
//!
//! Source: ISO 21771:2007, sections 4.5 and 5; DIN 3960:1987; G. Niemann, H. Winter, *Maschinenelemente II*, chapter 21.

use super::radii::involute;
use super::{Gears, WheelName};

/// A pair of wheels on its two axes.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Mounting {
    /// (rad) Working pressure angle: the angle between the line of action and the tangent of the pitch circles in mesh.
    pub working_pressure_angle_rad: f64,
    /// (mm) Distance between the axes.
    pub centre_distance_mm: f64,
    /// (mm) Normal backlash that the distance opens between teeth of nominal thickness.
    pub opened_backlash_mm: f64,
}

/// (modules) By how much less than the distance without backlash a given one may be: shifts are rounded on drawings.
const ROUNDED: f64 = 1e-3;

impl Mounting {
    /// At the distance that is given, else at the one without backlash.
    ///
    /// # Arguments
    /// * `gears` - the pair
    ///
    /// ```
    /// use meshtone::wheel::{Gears, Mounting};
    ///
    /// let mut gears = Gears::new(3.0, 17, 38, 15.0);
    /// (gears.pinion_profile_shift, gears.gear_profile_shift) = (0.3, 0.2);
    /// let mounting = Mounting::new(&gears);
    /// assert!((mounting.working_pressure_angle_rad.to_degrees() - 22.50252).abs() < 1e-5);
    /// assert!((mounting.centre_distance_mm - 83.9136).abs() < 1e-4);
    /// ```
    pub fn new(gears: &Gears) -> Self {
        let tight = Self::without_backlash(gears);
        let Some(centre_distance_mm) = gears.centre_distance_mm else { return tight };
        // The base circles stay: a cos α_w is the same at any distance.
        let reference_mm = gears.reference_centre_distance_mm();
        let base_mm = reference_mm * gears.transverse_pressure_angle_rad().cos();
        let working_pressure_angle_rad = (base_mm / centre_distance_mm).min(1.0).acos();
        let turned = involute(working_pressure_angle_rad) - involute(tight.working_pressure_angle_rad);
        Self {
            working_pressure_angle_rad,
            centre_distance_mm,
            // Across the teeth, not across the axes. In a ring the teeth come apart where the axes come closer.
            opened_backlash_mm: (gears.sign(WheelName::Gear) * 2.0 * base_mm * turned).max(0.0)
                * gears.base_helix_angle_rad().cos(),
        }
    }

    /// At the distance where teeth of nominal thickness touch on both flanks.
    ///
    /// # Arguments
    /// * `gears` - the pair
    pub fn without_backlash(gears: &Gears) -> Self {
        let angle = gears.transverse_pressure_angle_rad();
        let working_pressure_angle_rad = working_pressure_angle_rad(gears);
        Self {
            working_pressure_angle_rad,
            centre_distance_mm: gears.reference_centre_distance_mm()
                * (angle.cos() / working_pressure_angle_rad.cos()),
            opened_backlash_mm: 0.0,
        }
    }

    /// (mm) Least distance that can be given.
    pub(super) fn least_centre_distance_mm(gears: &Gears) -> f64 {
        Self::without_backlash(gears).centre_distance_mm - ROUNDED * gears.module_mm
    }
}

impl Gears {
    /// (mm) Distance of the axes at which the pitch circles touch, `a₀ = m_t (z₁ + z₂)/2`, in a ring `m_t (z₂ − z₁)/2`.
    pub fn reference_centre_distance_mm(&self) -> f64 {
        self.transverse_module_mm() * self.of_both(|wheel| f64::from(self.teeth(wheel))).abs() / 2.0
    }

    /// A quantity of the pinion, and that of the gear added to it, or that of a ring taken from it.
    fn of_both(&self, of: impl Fn(WheelName) -> f64) -> f64 {
        of(WheelName::Pinion) + self.sign(WheelName::Gear) * of(WheelName::Gear)
    }

    /// (-) Tip alteration coefficient k: by how many modules both wheels' tips are set off, so that they clear their mates' roots
    /// by as much as without shift. 0 or less; 0 in a ring.
    ///
    /// `k = (a − a₀)/m − x₁ − x₂` with the distance a without backlash.
    pub fn tip_alteration(&self) -> f64 {
        if self.internal {
            return 0.0;
        }
        let distance_mm = Mounting::without_backlash(self).centre_distance_mm;
        (distance_mm - self.reference_centre_distance_mm()) / self.module_mm
            - (self.pinion_profile_shift + self.gear_profile_shift)
    }

    /// (mm) Normal backlash: the given one; by default the least of ISO/TR 10064-2:1996, table A.1,
    /// `⅔ (0.06 + 0.0005 a + 0.03 m)`, which the teeth are made thinner for, and what a given centre distance opens.
    pub fn normal_backlash_mm(&self) -> f64 {
        let Mounting { centre_distance_mm, opened_backlash_mm, .. } = Mounting::new(self);
        let least = 2.0 / 3.0 * (0.06 + 0.0005 * centre_distance_mm + 0.03 * self.module_mm);
        self.backlash_mm.unwrap_or(least + opened_backlash_mm)
    }

    /// (-) Profile shift coefficient x of a wheel.
    ///
    /// # Arguments
    /// * `wheel` - which of the two
    pub fn profile_shift(&self, wheel: WheelName) -> f64 {
        wheel.choose(self.pinion_profile_shift, self.gear_profile_shift)
    }

    /// (-) Addendum coefficient of a wheel's basic rack.
    ///
    /// # Arguments
    /// * `wheel` - which of the two
    pub fn addendum(&self, wheel: WheelName) -> f64 {
        wheel.choose(self.pinion_addendum, self.gear_addendum)
    }

    /// (-) Dedendum coefficient of a wheel's basic rack.
    ///
    /// # Arguments
    /// * `wheel` - which of the two
    pub fn dedendum(&self, wheel: WheelName) -> f64 {
        wheel.choose(self.pinion_dedendum, self.gear_dedendum)
    }
}

/// (rad) `inv α_wt = inv α_t + 2 tan α_n (x₁ + x₂)/(z₁ + z₂)`, in a ring `(x₂ − x₁)/(z₂ − z₁)`, by Newton's method from above, where the
/// involute function is convex; 0 where the right side is not positive, which the rules of the scenario refuse.
fn working_pressure_angle_rad(gears: &Gears) -> f64 {
    let reference_rad = gears.transverse_pressure_angle_rad();
    let shifts = gears.of_both(|wheel| gears.profile_shift(wheel));
    let teeth = gears.of_both(|wheel| f64::from(gears.teeth(wheel)));
    let normal_tan = gears.pressure_angle_deg.to_radians().tan();
    let target = involute(reference_rad) + 2.0 * normal_tan * shifts / teeth;
    if target <= 0.0 {
        return 0.0;
    }
    // inv α is more than α³/3. Without shift the start is the solution, to the last bit.
    let mut angle_rad = if shifts / teeth > 0.0 { (3.0 * target).cbrt() } else { reference_rad };
    for _ in 0..MAX_NEWTON_STEPS {
        let step = (involute(angle_rad) - target) / angle_rad.tan().powi(2);
        angle_rad -= step;
        if step.abs() < 1e-15 * angle_rad {
            break;
        }
    }
    angle_rad
}

/// Far more than any pair needs.
const MAX_NEWTON_STEPS: usize = 60;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::{GearPair, Scenario};
    use crate::wheel::Wheel;

    fn shifted(pinion: f64, gear: f64) -> Gears {
        let mut gears = Scenario::new(GearPair::example()).gears();
        (gears.pinion_profile_shift, gears.gear_profile_shift) = (pinion, gear);
        gears
    }

    fn wheels(gears: &Gears) -> [Wheel; 2] {
        WheelName::BOTH.map(|name| Wheel::new(gears, name, 10.0))
    }

    #[test]
    fn shifted_pairs_as_computed_elsewhere() {
        let gears = shifted(0.3, 0.2);
        let mounting = Mounting::new(&gears);
        let [pinion, gear] = wheels(&gears);
        let thickness = |wheel: &Wheel| 2.0 * wheel.pitch_radius_mm * wheel.half_thickness_angle_rad();
        for (value, expected) in [
            (mounting.working_pressure_angle_rad.to_degrees(), 22.50252),
            (mounting.centre_distance_mm, 83.9136),
            (2.0 * pinion.tip_radius_mm, 58.62719),
            (2.0 * gear.tip_radius_mm, 121.02719),
            (gears.contact_ratio(), 1.45981),
            (thickness(&pinion), 5.36754),
            (thickness(&gear), 5.14915),
        ] {
            // The centre distance is given to four digits.
            let tolerance = if expected == 83.9136 { 5e-5 } else { 1e-5 };
            assert!((value - expected).abs() < tolerance, "{value} {expected}");
        }
        assert_eq!(mounting.opened_backlash_mm, 0.0);

        let gears = shifted(0.3, -0.3);
        assert_eq!(Mounting::new(&gears).centre_distance_mm, 82.5);
        assert_eq!(gears.tip_alteration(), 0.0);
        assert!((gears.contact_ratio() - 1.55766).abs() < 1e-5);
        assert!((gears.normal_backlash_mm() - 0.1275).abs() < 1e-12);
    }

    #[test]
    fn without_shift_nothing_changes_to_the_last_bit() {
        for (module, pinion, gear, angle) in [(3.0, 17, 38, 20.0), (2.35, 25, 31, 22.5), (0.7, 7, 113, 14.5)]
        {
            let mut gears = Gears::new(module, pinion, gear, 15.0);
            gears.pressure_angle_deg = angle;
            let mounting = Mounting::new(&gears);
            assert_eq!(mounting.working_pressure_angle_rad, angle.to_radians());
            assert_eq!(mounting.centre_distance_mm, gears.reference_centre_distance_mm());
            assert_eq!(gears.tip_alteration(), 0.0);
            for wheel in wheels(&gears) {
                assert_eq!(wheel.working_pitch_radius_mm, wheel.pitch_radius_mm);
                assert_eq!(wheel.tip_radius_mm, wheel.pitch_radius_mm + module);
                assert_eq!(wheel.root_radius_mm, wheel.pitch_radius_mm - 1.25 * module);
            }
        }
    }

    // On the pitch circles in mesh both teeth fill the pitch at the distance without backlash; beyond it a gap is left, which
    // along the line of action is what a distance opens.
    #[test]
    fn thicknesses_on_the_working_circles_leave_the_backlash() {
        for (pinion, gear) in [(0.3, 0.2), (0.5, -0.4), (0.1, -0.5), (0.8, 0.9)] {
            for apart_mm in [0.0, 0.2, 1.0] {
                let mut gears = shifted(pinion, gear);
                let tight = Mounting::new(&gears);
                gears.centre_distance_mm = Some(tight.centre_distance_mm + apart_mm);
                let mounting = Mounting::new(&gears);
                let angle = mounting.working_pressure_angle_rad;
                let [thickness, radius] = wheels(&gears)
                    .map(|wheel| {
                        let half = wheel.foot_angle_rad() - involute(angle);
                        [2.0 * half * wheel.working_pitch_radius_mm, wheel.working_pitch_radius_mm]
                    })
                    .iter()
                    .fold([0.0; 2], |sum, wheel| [sum[0] + wheel[0], sum[1] + wheel[1]]);
                assert!((radius - mounting.centre_distance_mm).abs() < 1e-12);
                let pitch = std::f64::consts::PI * 3.0 * 20f64.to_radians().cos() / angle.cos();
                let gap = (pitch - thickness) * angle.cos();
                assert!((gap - mounting.opened_backlash_mm).abs() < 1e-12, "{gap} {mounting:?}");
                assert_eq!(gap > 1e-6, apart_mm > 0.0);
            }
        }
    }

    // A small change Δa opens 2 Δa sin α_w.
    #[test]
    fn a_larger_distance_is_backlash_by_default() {
        let mut gears = shifted(0.3, 0.2);
        let tight = Mounting::new(&gears);
        gears.centre_distance_mm = Some(tight.centre_distance_mm + 0.01);
        let opened = Mounting::new(&gears).opened_backlash_mm;
        let expected = 0.02 * tight.working_pressure_angle_rad.sin();
        assert!((opened / expected - 1.0).abs() < 1e-3, "{opened} {expected}");
        let least = 2.0 / 3.0 * (0.06 + 0.0005 * (tight.centre_distance_mm + 0.01) + 0.03 * 3.0);
        assert!((gears.normal_backlash_mm() - least - opened).abs() < 1e-15);
        gears.backlash_mm = Some(0.2);
        assert_eq!(gears.normal_backlash_mm(), 0.2);
    }

    // Newton's method, over all that the ranges of the keys allow.
    #[test]
    fn working_angle_solves_its_equation() {
        for angle in [10.0, 14.5, 20.0, 35.0] {
            for (pinion_teeth, gear_teeth) in [(6, 6), (17, 38), (60, 600)] {
                for shifts in [-1.0, -0.2, -1e-9, 1e-9, 0.4, 4.0] {
                    let mut gears = Gears::new(1.0, pinion_teeth, gear_teeth, 10.0);
                    gears.pressure_angle_deg = angle;
                    gears.gear_profile_shift = shifts;
                    let reference: f64 = angle.to_radians();
                    let target = involute(reference)
                        + 2.0 * reference.tan() * shifts / f64::from(pinion_teeth + gear_teeth);
                    let found = involute(working_pressure_angle_rad(&gears));
                    assert!((found - target.max(0.0)).abs() < 1e-14, "{angle} {shifts}: {found} {target}");
                }
            }
        }
    }
}
