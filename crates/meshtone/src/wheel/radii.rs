//! Radii of one wheel.

use crate::wheel::Gears;

/// Standard spur wheel without profile shift.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wheel {
    /// Tooth count.
    pub teeth: u32,
    /// (mm) Module.
    pub module_mm: f64,
    /// (mm) Face width.
    pub face_width_mm: f64,
    /// (rad) Pressure angle at the pitch circle.
    pub pressure_angle_rad: f64,
    /// (mm) Pitch radius, `m z/2`.
    pub pitch_radius_mm: f64,
    /// (mm) Tip radius, pitch radius + `m`.
    pub tip_radius_mm: f64,
    /// (mm) Root radius, pitch radius − 1.25 `m`.
    pub root_radius_mm: f64,
    /// (mm) Base radius, pitch radius × cos α.
    pub base_radius_mm: f64,
    /// (mm) Radius of the bore.
    pub bore_radius_mm: f64,
}

impl Wheel {
    /// The wheel with `teeth` teeth.
    ///
    /// # Arguments
    /// * `gears` - module, face width and pressure angle
    /// * `teeth` - tooth count
    /// * `bore_radius_mm` - (mm) radius of the shaft that the wheel sits on
    pub fn new(gears: &Gears, teeth: u32, bore_radius_mm: f64) -> Self {
        let module_mm = gears.module_mm;
        let pressure_angle_rad = gears.pressure_angle_deg.to_radians();
        let pitch_radius_mm = module_mm * f64::from(teeth) / 2.0;
        Self {
            teeth,
            module_mm,
            face_width_mm: gears.face_width_mm,
            pressure_angle_rad,
            pitch_radius_mm,
            tip_radius_mm: pitch_radius_mm + module_mm,
            root_radius_mm: pitch_radius_mm - 1.25 * module_mm,
            base_radius_mm: pitch_radius_mm * pressure_angle_rad.cos(),
            bore_radius_mm,
        }
    }

    /// (mm) Radius of curvature of the involute at `radius_mm` from the wheel's centre, `√(R² − Rb²)`; 0 inside the base
    /// circle.
    ///
    /// # Arguments
    /// * `radius_mm` - (mm) distance from the wheel's centre
    pub fn curvature_mm(&self, radius_mm: f64) -> f64 {
        (radius_mm * radius_mm - self.base_radius_mm * self.base_radius_mm).max(0.0).sqrt()
    }

    /// (rad) Angle between a tooth's centre line and the foot of its flank on the base circle, `θ0 + inv α`.
    pub fn foot_angle_rad(&self) -> f64 {
        self.half_thickness_angle_rad() + involute(self.pressure_angle_rad)
    }

    /// (rad) Half the angle that a tooth fills on the pitch circle, `π/(2z)`.
    pub fn half_thickness_angle_rad(&self) -> f64 {
        std::f64::consts::PI / (2.0 * f64::from(self.teeth))
    }
}

/// (rad) The involute function `inv a = tan a − a`.
pub(super) fn involute(angle_rad: f64) -> f64 {
    angle_rad.tan() - angle_rad
}
