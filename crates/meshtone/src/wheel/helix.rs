//! Helical wheels: their transverse and normal sections, and the lines along which their teeth touch.
//!
//! In the transverse section, across the axes, helical wheels mesh as spur wheels of the module `m_t = m_n/cos β` and the pressure angle
//! `tan α_t = tan α_n/cos β`. Across the teeth, in the normal section, a tooth is nearly that of a spur wheel of
//! `z_n = z/(cos² β_b cos β)` teeth, module m_n and pressure angle α_n. The base helix angle is `sin β_b = sin β cos α_n`.
//!
//! Source: ISO 21771:2007, sections 4 and 5.

use std::f64::consts::PI;

use super::{Gears, Wheel};

impl Gears {
    /// (rad) Helix angle β at the pitch circle.
    fn helix_angle_rad(&self) -> f64 {
        self.helix_angle_deg.to_radians()
    }

    /// Whether the teeth are helical.
    pub fn is_helical(&self) -> bool {
        self.helix_angle_deg != 0.0
    }

    /// (mm) Transverse module, `m_t = m_n/cos β`.
    ///
    /// ```
    /// let mut gears = meshtone::wheel::Gears::new(3.0, 20, 60, 30.0);
    /// gears.helix_angle_deg = 20.0;
    /// assert!((gears.transverse_module_mm() - 3.192_533).abs() < 1e-6);
    /// assert!((gears.overlap_ratio() - 1.0887).abs() < 1e-4);
    /// ```
    pub fn transverse_module_mm(&self) -> f64 {
        self.module_mm / self.helix_angle_rad().cos()
    }

    /// (rad) Transverse pressure angle, `α_t = atan(tan α_n/cos β)`.
    pub fn transverse_pressure_angle_rad(&self) -> f64 {
        let normal_rad = self.pressure_angle_deg.to_radians();
        if self.is_helical() { (normal_rad.tan() / self.helix_angle_rad().cos()).atan() } else { normal_rad }
    }

    /// (rad) Base helix angle, `sin β_b = sin β cos α_n`.
    pub fn base_helix_angle_rad(&self) -> f64 {
        (self.helix_angle_rad().sin() * self.pressure_angle_deg.to_radians().cos()).asin()
    }

    /// (-) Force along the shafts per transverse force of the mesh, `h tan β_b`, h the sign of the pinion's hand.
    pub fn thrust(&self) -> f64 {
        self.hand.sign() * self.base_helix_angle_rad().tan()
    }

    /// (-) Overlap ratio, `ε_β = b sin β/(π m_n)`: how many pitches the ends of a tooth are apart on the path of contact.
    pub fn overlap_ratio(&self) -> f64 {
        self.face_width_mm * self.helix_angle_rad().sin() / (PI * self.module_mm)
    }

    /// (-) Total contact ratio, `ε_γ = ε_α + ε_β`: during how many pitches a pair of teeth touches.
    pub fn total_contact_ratio(&self) -> f64 {
        self.contact_ratio() + self.overlap_ratio()
    }

    /// (pitches) From where to where the wheels turn while a pair is in contact anywhere on its face, since its middle could enter contact.
    pub fn contact_span_pitches(&self) -> [f64; 2] {
        let ahead = self.overlap_ratio() / 2.0;
        [-ahead, self.contact_ratio() + ahead]
    }

    /// (mm) How much farther apart the flanks are over a part of the face than at its middle, on average: lead crowning `4 C_β ζ²` and end
    /// relief.
    ///
    /// # Arguments
    /// * `from`, `until` - (-) the part, ζ from −½ to ½
    pub(crate) fn mean_gap_mm(&self, [from, until]: [f64; 2]) -> f64 {
        let crowned = |place: f64| 4.0 * self.lead_crowning_um * 1e-3 * place.powi(3) / 3.0;
        let relieved = |place: f64| {
            let width_mm = self.face_width_mm;
            let [left, right] =
                [0.5 + place, 0.5 - place].map(|part| self.end_relief.gap_until_mm2(part * width_mm));
            (left - right) / width_mm
        };
        (crowned(until) - crowned(from) + relieved(until) - relieved(from)) / (until - from)
    }

    /// Whether its flanks are farther apart at the ends of the face than in the middle.
    pub(crate) fn is_crowned(&self) -> bool {
        self.lead_crowning_um > 0.0 || self.end_relief.amount_um > 0.0
    }

    /// (mm) Length of all contact lines together while the wheels are at a position.
    ///
    /// Pair n touches between `τ − n − ε_β/2` and `τ − n + ε_β/2` where that lies on the path, from 0 to ε_α.
    ///
    /// # Arguments
    /// * `position` - (base pitches) τ, since the start of the path of a pair at the middle of its face
    ///
    /// ```
    /// let mut gears = meshtone::wheel::Gears::new(3.0, 20, 60, 13.7781);
    /// gears.helix_angle_deg = 20.0;
    /// let lengths = (0..100).map(|point| gears.contact_line_length_mm(point as f64 / 100.0));
    /// assert!((lengths.fold(0.0, f64::max) - 29.1001).abs() < 1e-3);
    /// ```
    pub fn contact_line_length_mm(&self, position: f64) -> f64 {
        let (path, overlap) = (self.contact_ratio(), self.overlap_ratio());
        let reach = (path + overlap).ceil() as i32;
        let along = (-reach..=reach).map(|pair| {
            let middle = position.fract() - f64::from(pair);
            if overlap == 0.0 {
                return f64::from((0.0..path).contains(&middle));
            }
            ((middle + overlap / 2.0).min(path) - (middle - overlap / 2.0).max(0.0)).max(0.0) / overlap
        });
        along.sum::<f64>() * self.face_width_mm / self.base_helix_angle_rad().cos()
    }
}

impl Wheel {
    /// (rad) Base helix angle, `tan β_b = tan β cos α_t`.
    pub fn base_helix_angle_rad(&self) -> f64 {
        (self.helix_angle_rad.tan() * self.pressure_angle_rad.cos()).atan()
    }

    /// The spur wheel whose teeth are those of this wheel's normal section, of `z/(cos² β_b cos β)` teeth; the wheel itself where it is a
    /// spur wheel. Its bore is as large a part of its pitch circle.
    ///
    /// # Arguments
    /// * `pressure_angle_rad` - (rad) of the normal section
    pub(super) fn normal_section(&self, pressure_angle_rad: f64) -> Self {
        if self.helix_angle_rad == 0.0 {
            return *self;
        }
        let (cos, base_cos) = (self.helix_angle_rad.cos(), self.base_helix_angle_rad().cos());
        let module_mm = self.normal_module_mm();
        let section_teeth = f64::from(self.teeth) / (base_cos * base_cos * cos);
        let pitch_radius_mm = module_mm * section_teeth / 2.0;
        let outwards_mm = pitch_radius_mm - self.pitch_radius_mm;
        Self {
            module_mm,
            section_teeth,
            helix_angle_rad: 0.0,
            pressure_angle_rad,
            pitch_radius_mm,
            profile_shift: self.profile_shift / cos,
            tip_height: self.tip_height / cos,
            tip_radius_mm: self.tip_radius_mm + outwards_mm,
            root_radius_mm: self.root_radius_mm + outwards_mm,
            working_pitch_radius_mm: self.working_pitch_radius_mm + outwards_mm,
            base_radius_mm: pitch_radius_mm * pressure_angle_rad.cos(),
            bore_radius_mm: self.bore_radius_mm * (pitch_radius_mm / self.pitch_radius_mm),
            ..*self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wheel::{Mounting, PathOfContact, WheelName};

    /// The third stage of a published gearbox of a wind turbine, 24/95 teeth of module 14 (A. R. Nejad, Y. Guo, Z. Gao, T. Moan,
    /// "Development of a 5 MW reference gearbox for offshore wind turbines", Wind Energy 19 (2016)).
    #[test]
    fn geometry_is_that_of_a_published_pair() {
        let mut gears = Gears::new(14.0, 24, 95, 360.0);
        gears.helix_angle_deg = 10.0;
        (gears.pinion_profile_shift, gears.gear_profile_shift) = (0.480, 0.669_1);
        gears.centre_distance_mm = Some(861.0);
        let mounting = Mounting::new(&gears);
        let [pinion, gear] = WheelName::BOTH.map(|wheel| Wheel::new(&gears, wheel, 100.0));
        let path = PathOfContact::new(&pinion, &gear);
        for (found, expected, tolerance) in [
            (gears.transverse_pressure_angle_rad().to_degrees(), 20.284, 5e-4),
            (mounting.working_pressure_angle_rad.to_degrees(), 22.856, 5e-4),
            (gears.base_helix_angle_rad().to_degrees(), 9.391, 5e-4),
            (pinion.base_helix_angle_rad().to_degrees(), 9.391, 5e-4),
            (path.base_pitch_mm, 41.891, 5e-4),
            (2.0 * pinion.pitch_radius_mm, 341.183, 5e-4),
            (2.0 * gear.pitch_radius_mm, 1350.517, 5e-4),
            (2.0 * pinion.base_radius_mm, 320.026, 5e-4),
            (2.0 * gear.base_radius_mm, 1266.770, 5e-4),
            (gears.tip_alteration() * 14.0, -0.938, 2e-3),
            (2.0 * pinion.tip_radius_mm, 380.747, 5e-3),
            (2.0 * gear.tip_radius_mm, 1395.376, 5e-3),
            (path.contact_ratio, 1.463, 5e-4),
            (gears.contact_ratio(), 1.463, 5e-4),
            (gears.overlap_ratio(), 1.421, 5e-4),
        ] {
            assert!((found - expected).abs() < tolerance, "{found} {expected}");
        }
    }

    /// (mm) Least and largest length: straight between the positions at which an end of the face enters or leaves the path.
    fn extremes(gears: &Gears) -> [f64; 2] {
        let ahead = gears.overlap_ratio() / 2.0;
        let bends = [-ahead, ahead, gears.contact_ratio() - ahead, gears.contact_ratio() + ahead];
        let lengths = bends.map(|position| gears.contact_line_length_mm(position.rem_euclid(1.0)));
        [f64::min, f64::max].map(|of| lengths.into_iter().reduce(of).unwrap())
    }

    /// In closed form, with the fractional parts n_α and n_β: `L cos β_b ε_β/b = ε_α ε_β − n_α n_β + o`, o between
    /// `max(0, n_α + n_β − 1)` and `min(n_α, n_β)`.
    #[test]
    fn contact_lines_are_as_long_as_in_closed_form() {
        for face_width_mm in [5.0, 13.7781, 27.5562, 30.0, 47.0] {
            let mut gears = Gears::new(3.0, 20, 60, face_width_mm);
            gears.helix_angle_deg = 20.0;
            let (path, overlap) = (gears.contact_ratio(), gears.overlap_ratio());
            let (n_a, n_b) = (path.fract(), overlap.fract());
            let whole = face_width_mm / (overlap * gears.base_helix_angle_rad().cos());
            let at = |o: f64| whole * (path * overlap - n_a * n_b + o);
            let [least, most] = extremes(&gears);
            assert!((least / at((n_a + n_b - 1.0).max(0.0)) - 1.0).abs() < 1e-9, "{face_width_mm}");
            assert!((most / at(n_a.min(n_b)) - 1.0).abs() < 1e-9, "{face_width_mm}");
            let lengths: Vec<f64> =
                (0..40_000).map(|point| gears.contact_line_length_mm(f64::from(point) / 4e4)).collect();
            let mean = lengths.iter().sum::<f64>() / lengths.len() as f64;
            let expected = path * face_width_mm / gears.base_helix_angle_rad().cos();
            assert!((mean / expected - 1.0).abs() < 1e-6, "{mean} {expected}");
        }
        // Numbers from an independent program.
        let mut gears = Gears::new(3.0, 20, 60, 13.7781);
        gears.helix_angle_deg = 20.0;
        let [least, most] = extremes(&gears);
        assert!(
            (least / 15.494_772 - 1.0).abs() < 1e-6 && (most / 29.100_095 - 1.0).abs() < 1e-6,
            "{least} {most}"
        );
    }
}
