//! Radii of one wheel.

use std::f64::consts::PI;

use crate::wheel::{Gears, Mounting, WheelName};

/// A wheel in its transverse section, with what its mate and the distance between their axes make of it; or the spur wheel whose teeth
/// are those of its normal section.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Wheel {
    /// Whether it is a ring with internal teeth.
    pub is_internal: bool,
    /// Tooth count.
    pub teeth: u32,
    /// (-) Tooth count of the section: whole in the transverse one, `z/(cos² β_b cos β)` in the normal one.
    pub section_teeth: f64,
    /// (mm) Module of the section: the transverse one of a helical wheel.
    pub module_mm: f64,
    /// (rad) Helix angle at the pitch circle; 0 of a spur wheel and of a normal section.
    pub helix_angle_rad: f64,
    /// (mm) Face width.
    pub face_width_mm: f64,
    /// (rad) Pressure angle at the pitch circle, in the section.
    pub pressure_angle_rad: f64,
    /// (rad) Pressure angle of the pair at its centre distance: the direction of the line of action.
    pub working_pressure_angle_rad: f64,
    /// (-) Profile shift coefficient in modules of the section, `x`; of a ring that of the wheel that would fill its tooth spaces.
    pub profile_shift: f64,
    /// (modules) Height of the tip above the pitch circle, addendum coefficient + `x` + `k`, of a ring addendum coefficient − `x`
    /// inwards; 1 of a standard wheel.
    pub tip_height: f64,
    /// (mm) Pitch radius, `m z/2`: of the circle that rolls on the rack.
    pub pitch_radius_mm: f64,
    /// (mm) Radius of the circle that rolls on the mate's, base radius/cos α_w; the pitch radius at the standard distance.
    pub working_pitch_radius_mm: f64,
    /// (mm) Tip radius, pitch radius + `m` times the tip's height; − of a ring.
    pub tip_radius_mm: f64,
    /// (mm) Root radius, pitch radius − `m` (dedendum coefficient − `x`); of a ring + `m` (dedendum coefficient + `x`).
    pub root_radius_mm: f64,
    /// (mm) Base radius, pitch radius × cos α.
    pub base_radius_mm: f64,
    /// (mm) Radius of the bore.
    pub bore_radius_mm: f64,
}

impl Wheel {
    /// One of the two wheels of a pair.
    ///
    /// # Arguments
    /// * `gears` - the pair
    /// * `wheel` - which of the two
    /// * `bore_radius_mm` - (mm) radius of the shaft that the wheel sits on
    pub fn new(gears: &Gears, wheel: WheelName, bore_radius_mm: f64) -> Self {
        let (teeth, module_mm) = (gears.teeth(wheel), gears.transverse_module_mm());
        let helix_angle_rad = gears.helix_angle_deg.to_radians();
        let pressure_angle_rad = gears.transverse_pressure_angle_rad();
        let working_pressure_angle_rad = Mounting::new(gears).working_pressure_angle_rad;
        // (-) From modules of the normal section to transverse ones.
        let per_module = helix_angle_rad.cos();
        let sign = gears.sign(wheel);
        let outwards = sign * gears.profile_shift(wheel);
        let tip_height = (gears.addendum(wheel) + outwards + gears.tip_alteration()) * per_module;
        let root_depth = (gears.dedendum(wheel) - outwards) * per_module;
        let pitch_radius_mm = module_mm * f64::from(teeth) / 2.0;
        Self {
            is_internal: sign < 0.0,
            teeth,
            section_teeth: f64::from(teeth),
            module_mm,
            helix_angle_rad,
            face_width_mm: gears.face_width_mm,
            pressure_angle_rad,
            working_pressure_angle_rad,
            profile_shift: gears.profile_shift(wheel) * per_module,
            tip_height,
            pitch_radius_mm,
            working_pitch_radius_mm: pitch_radius_mm
                * (pressure_angle_rad.cos() / working_pressure_angle_rad.cos()),
            tip_radius_mm: pitch_radius_mm + sign * module_mm * tip_height,
            root_radius_mm: pitch_radius_mm - sign * module_mm * root_depth,
            base_radius_mm: pitch_radius_mm * pressure_angle_rad.cos(),
            bore_radius_mm,
        }
    }

    /// (-) The sign with which a ring's radii are those of an external wheel in all formulas: 1, and −1 of a ring. So counted they rise from
    /// root to tip, and its concave flank has a radius of curvature below 0.
    ///
    /// Source: DIN 3960:1987, where a ring has a negative number of teeth.
    pub fn sign(&self) -> f64 {
        if self.is_internal { -1.0 } else { 1.0 }
    }

    /// (mm) Module of the normal section.
    pub fn normal_module_mm(&self) -> f64 {
        self.module_mm * self.helix_angle_rad.cos()
    }

    /// (mm) Radius of the V circle, `m (z/2 + x)`: the wheel's pitch line on a rack that is set off by the profile shift, which
    /// parts the material of the teeth from the spaces between them.
    pub fn v_circle_radius_mm(&self) -> f64 {
        self.pitch_radius_mm + self.module_mm * self.profile_shift
    }

    /// (mm) Radius of curvature of the involute at `radius_mm` from the wheel's centre, `√(R² − Rb²)`, of a ring `−√(R² − Rb²)`; 0
    /// inside the base circle.
    ///
    /// # Arguments
    /// * `radius_mm` - (mm) distance from the wheel's centre
    pub fn curvature_mm(&self, radius_mm: f64) -> f64 {
        self.sign() * (radius_mm * radius_mm - self.base_radius_mm * self.base_radius_mm).max(0.0).sqrt()
    }

    /// (rad) Angle between a tooth's centre line and the foot of its flank on the base circle, `θ0 + inv α`; of a ring
    /// `−θ0 + inv α`, which is counted the other way as its radii are.
    pub fn foot_angle_rad(&self) -> f64 {
        self.sign() * self.half_thickness_angle_rad() + involute(self.pressure_angle_rad)
    }

    /// (rad) Half the angle that a tooth fills on the pitch circle, `θ0 = (π/2 + 2x tan α)/z`, of a ring `(π/2 − 2x tan α)/z`.
    pub fn half_thickness_angle_rad(&self) -> f64 {
        let (teeth, outwards) = (self.section_teeth, self.sign() * self.profile_shift);
        PI / (2.0 * teeth) + 2.0 * outwards * self.pressure_angle_rad.tan() / teeth
    }

    /// (rad) Half the angle from one tooth to the next, `π/z`.
    pub fn half_pitch_angle_rad(&self) -> f64 {
        PI / self.section_teeth
    }

    /// (rad) Half the angle that a tooth fills on the circle of a radius, `θ0 ± (inv α − inv a)` with `cos a = Rb/R`, − of a ring; the
    /// flank's foot inside the base circle.
    ///
    /// # Arguments
    /// * `radius_mm` - (mm) of the circle
    pub fn half_thickness_angle_at_rad(&self, radius_mm: f64) -> f64 {
        self.sign() * (self.foot_angle_rad() - involute((self.base_radius_mm / radius_mm).min(1.0).acos()))
    }
}

/// (rad) The involute function `inv a = tan a − a`.
pub(super) fn involute(angle_rad: f64) -> f64 {
    angle_rad.tan() - angle_rad
}
