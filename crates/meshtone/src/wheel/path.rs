//! The points at which two conjugate flanks touch.

use super::{Wheel, WheelName};

/// The path along which a pair of conjugate teeth touches: a stretch of the line of action, from the point where the
/// gear's tip meets the pinion's flank to the one where the pinion's tip leaves the gear's.
///
/// On the line of action a contact point's distances ρ from the two points where the line touches the base circles are the
/// flanks' radii of curvature there, `ρ = √(R² − Rb²)`. They add up to the line's length,
/// `ρ_p + ρ_g = L = a sin α_w`, and are linear in the wheels' angles. Positions are counted in base pitches
/// `p_b = π m cos α` from the start of the path; in a pitch either wheel turns by one tooth.
///
/// Source: any textbook of involute gears, for example F. L. Litvin, A. Fuentes, *Gear Geometry and Applied Theory*,
/// 2nd edition (2004), chapter 10.
///
/// In a ring both tangent points lie on the same side of the path. With the sign of [`Wheel::sign`] on the ring's radii, its own ρ and L are
/// less than 0, and nothing else changes: the planet's ρ is `ρ_r − a sin α_w`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct PathOfContact {
    /// (mm) Base pitch, `π m cos α`.
    pub base_pitch_mm: f64,
    /// (mm) Length of the line of action between the two base circles, `L`; `−a sin α_w` in a ring.
    pub line_mm: f64,
    /// (mm) Radius of curvature of the gear's flank at its tip, where the path starts; less than 0 of a ring.
    pub gear_tip_curvature_mm: f64,
    /// (mm) Radius of curvature of the pinion's flank at its tip, where the path ends.
    pub pinion_tip_curvature_mm: f64,
    /// (-) Length of the path in base pitches, `ε`: the mean number of tooth pairs in contact.
    pub contact_ratio: f64,
}

impl PathOfContact {
    /// The path of two wheels at their centre distance.
    ///
    /// # Arguments
    /// * `pinion`, `gear` - the wheels
    ///
    /// ```
    /// use meshtone::wheel::{Gears, PathOfContact, Wheel, WheelName};
    ///
    /// let gears = Gears::new(3.0, 17, 38, 15.0);
    /// let [pinion, gear] = WheelName::BOTH.map(|wheel| Wheel::new(&gears, wheel, 10.0));
    /// let path = PathOfContact::new(&pinion, &gear);
    /// assert!((path.contact_ratio - 1.609).abs() < 1e-3);
    /// // The pitch point, where both flanks touch on the pitch circles, is just beyond half of the path.
    /// let pitch_point = path.position(WheelName::Gear, gear.curvature_mm(gear.working_pitch_radius_mm));
    /// assert!((pitch_point / path.contact_ratio - 0.529).abs() < 1e-3);
    /// ```
    pub fn new(pinion: &Wheel, gear: &Wheel) -> Self {
        let base_pitch_mm = std::f64::consts::PI * gear.module_mm * gear.pressure_angle_rad.cos();
        let centre_distance_mm = pinion.working_pitch_radius_mm + gear.sign() * gear.working_pitch_radius_mm;
        let line_mm = centre_distance_mm * gear.working_pressure_angle_rad.sin();
        let [pinion_tip, gear_tip] = [pinion, gear].map(|wheel| wheel.curvature_mm(wheel.tip_radius_mm));
        Self {
            base_pitch_mm,
            line_mm,
            gear_tip_curvature_mm: gear_tip,
            pinion_tip_curvature_mm: pinion_tip,
            contact_ratio: (gear_tip + pinion_tip - line_mm) / base_pitch_mm,
        }
    }

    /// (base pitches) The position of a pair that goes through the path from its end.
    ///
    /// # Arguments
    /// * `position` - (base pitches) since the start of the path
    pub fn from_end(&self, position: f64) -> f64 {
        self.contact_ratio - position
    }

    /// (mm) Radius of curvature of a wheel's flank where the pair touches at `position`. Less than 0 of a ring; of another wheel
    /// where the path would reach beyond its base circle: the teeth then interfere.
    ///
    /// # Arguments
    /// * `wheel` - which of the two
    /// * `position` - (base pitches) since the start of the path
    pub fn curvature_mm(&self, wheel: WheelName, position: f64) -> f64 {
        let gear = self.gear_tip_curvature_mm - position * self.base_pitch_mm;
        wheel.choose(self.line_mm - gear, gear)
    }

    /// (base pitches) Position at which a flank touches its mate where its radius of curvature is `curvature_mm`.
    ///
    /// # Arguments
    /// * `wheel` - whose flank it is
    /// * `curvature_mm` - (mm) its radius of curvature there
    pub fn position(&self, wheel: WheelName, curvature_mm: f64) -> f64 {
        let gear = wheel.choose(self.line_mm - curvature_mm, curvature_mm);
        (self.gear_tip_curvature_mm - gear) / self.base_pitch_mm
    }
}
