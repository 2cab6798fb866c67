//! Tolerances of a wheel by formula, for any module and diameter.

use crate::wheel::Wheel;

/// Tolerances of one wheel.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Tolerances {
    /// (µm) Single pitch deviation, f_p.
    pub single_pitch_um: f64,
    /// (µm) Total cumulative pitch deviation, F_p.
    pub cumulative_pitch_um: f64,
    /// (µm) Profile slope deviation, f_Hα.
    pub profile_slope_um: f64,
    /// (µm) Profile form deviation, f_fα.
    pub profile_form_um: f64,
    /// (µm) Helix slope deviation, f_Hβ.
    pub helix_slope_um: f64,
    /// (µm) Helix form deviation, f_fβ.
    pub helix_form_um: f64,
    /// (µm) Run-out, F_r.
    pub run_out_um: f64,
}

impl Tolerances {
    /// By ISO 1328-1:2013, class 1 (best) to 11: those of class 5, times `√2` a class.
    ///
    /// # Arguments
    /// * `wheel` - module, pitch diameter, face width
    /// * `class` - of the tolerances
    ///
    /// Source: ISO 1328-1:2013, section 5.3.
    ///
    /// ```
    /// use meshtone::wheel::{Gears, Tolerances, Wheel, WheelName};
    ///
    /// let wheel = Wheel::new(&Gears::new(3.0, 17, 38, 15.0), WheelName::Pinion, 10.0);
    /// let class_6 = Tolerances::iso_1328(&wheel, 6);
    /// assert!((class_6.single_pitch_um - 8.840).abs() < 1e-3);
    /// assert!((class_6.cumulative_pitch_um - 25.639).abs() < 1e-3);
    /// ```
    pub fn iso_1328(wheel: &Wheel, class: u8) -> Self {
        let (module, diameter, width) =
            (wheel.normal_module_mm(), 2.0 * wheel.pitch_radius_mm, wheel.face_width_mm);
        let step = std::f64::consts::SQRT_2.powi(i32::from(class) - 5);
        let cumulative = 0.002 * diameter + 0.55 * diameter.sqrt() + 0.7 * module + 12.0;
        Self {
            single_pitch_um: step * (0.001 * diameter + 0.4 * module + 5.0),
            cumulative_pitch_um: step * cumulative,
            profile_slope_um: step * (0.4 * module + 0.001 * diameter + 4.0),
            profile_form_um: step * (0.55 * module + 5.0),
            helix_slope_um: step * (0.05 * diameter.sqrt() + 0.35 * width.sqrt() + 4.0),
            helix_form_um: step * (0.07 * diameter.sqrt() + 0.45 * width.sqrt() + 4.0),
            run_out_um: step * 0.9 * cumulative,
        }
    }

    /// By DIN 3961, grade 1 (best) to 12: those of grade 5, in steps of 1.4 up to grade 9 and of 1.6 above. The helix's, which it
    /// tabulates by face width, are those of the ISO class of the same number.
    ///
    /// # Arguments
    /// * `wheel` - module, pitch diameter, teeth
    /// * `grade` - of the tolerances
    ///
    /// Source: DIN 3961:1978.
    pub fn din_3961(wheel: &Wheel, grade: u8) -> Self {
        let (module, diameter) = (wheel.normal_module_mm(), 2.0 * wheel.pitch_radius_mm);
        let above_nine = i32::from(grade.saturating_sub(9));
        let step = 1.4f64.powi(i32::from(grade.min(9)) - 5) * 1.6f64.powi(above_nine);
        let root = module.sqrt();
        let helix = Self::iso_1328(wheel, grade);
        Self {
            single_pitch_um: step * (4.0 + 0.315 * (module + 0.25 * diameter.sqrt())),
            cumulative_pitch_um: step * 7.25 * diameter.cbrt() / f64::from(wheel.teeth).powf(1.0 / 7.0),
            profile_slope_um: step * (2.5 + 0.25 * (module + 3.0 * root)),
            profile_form_um: step * (1.5 + 0.25 * (module + 9.0 * root)),
            run_out_um: step * (1.68 + 2.18 * root + (2.3 + 1.2 * module.log10()) * diameter.powf(0.25)),
            ..helix
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::{GearPair, Scenario};
    use crate::wheel::WheelName;

    #[test]
    fn iso_classes_as_computed_elsewhere() {
        let wheel = |name| Wheel::new(&Scenario::new(GearPair::example()).gears(), name, 10.0);
        for (name, class, expected) in [
            (WheelName::Pinion, 6, [8.840, 25.639, 7.426, 9.405, 8.079, 8.829]),
            (WheelName::Gear, 7, [12.628, 40.401, 10.628, 13.300, 11.779, 12.980]),
        ] {
            let found = Tolerances::iso_1328(&wheel(name), class);
            let values = [
                found.single_pitch_um,
                found.cumulative_pitch_um,
                found.profile_slope_um,
                found.profile_form_um,
                found.helix_slope_um,
                found.helix_form_um,
            ];
            for (value, expected) in values.into_iter().zip(expected) {
                assert!((value - expected).abs() < 1e-3, "{value} {expected}");
            }
            assert_eq!(found.run_out_um, 0.9 * found.cumulative_pitch_um);
        }
    }

    #[test]
    fn din_grades_step_by_1_4_and_1_6() {
        let wheel = Wheel::new(&Scenario::new(GearPair::example()).gears(), WheelName::Pinion, 10.0);
        let of = |grade| Tolerances::din_3961(&wheel, grade);
        for (finer, coarser, step) in [(4, 5, 1.4), (8, 9, 1.4), (9, 10, 1.6), (11, 12, 1.6)] {
            assert!((of(coarser).run_out_um / of(finer).run_out_um - step).abs() < 1e-12);
        }
        assert!((of(5).profile_slope_um - (2.5 + 0.25 * (3.0 + 3.0 * 3f64.sqrt()))).abs() < 1e-12);
    }
}
