//! Points of a working flank, by their radius of curvature.

use super::{ToothProfile, Wheel};

/// Point at which a flank is touched, and the direction of the contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlankPoint {
    /// Profile point before it.
    pub index: usize,
    /// (-) How far it lies from that point towards the next, in \[0, 1\].
    pub fraction: f64,
    /// (mm) Along the tooth's centre line, from the wheel's centre; less than 0 of a ring.
    pub x_mm: f64,
    /// (mm) Distance from the tooth's centre line.
    pub y_mm: f64,
    /// (-) Sine of the load's angle: the angle between the flank's normal and the normal of the centre line,
    /// `α₁ = tan a − (θ0 + inv α)` with `cos a = Rb/R`.
    pub load_sin: f64,
    /// (-) Its cosine.
    pub load_cos: f64,
}

impl FlankPoint {
    /// The value here of a quantity that is given at the profile's points.
    ///
    /// # Arguments
    /// * `values` - at the profile's points
    pub fn of(&self, values: &[f64]) -> f64 {
        let (before, after) = (values[self.index], values[self.index + 1]);
        before + self.fraction * (after - before)
    }

    /// Profile point nearest to it.
    pub fn nearest(&self) -> usize {
        if self.fraction < 0.5 { self.index } else { self.index + 1 }
    }
}

/// A wheel's working flank.
#[derive(Debug, Clone, Copy)]
pub struct Flank<'a> {
    /// The wheel.
    pub wheel: &'a Wheel,
    /// Its profile, as sampled for itself.
    pub profile: &'a ToothProfile,
}

impl Flank<'_> {
    /// The point whose radius of curvature is `curvature_mm`; at the ends of the flank where it has none such.
    ///
    /// The load's angle varies along the flank: the flank's normal is tangent to the base circle, and turns with the roll
    /// angle. (D. C. H. Yang, J. Y. Lin, Journal of Mechanisms, Transmissions, and Automation in Design 109 (1987), Eq. 8:
    /// `α₁`.)
    ///
    /// # Arguments
    /// * `curvature_mm` - (mm) radius of curvature of the involute, before relief
    pub fn at_curvature(&self, curvature_mm: f64) -> FlankPoint {
        let base = self.wheel.sign() * self.wheel.base_radius_mm;
        let roll = (curvature_mm / base).max(0.0);
        let (sin, cos) = (self.wheel.foot_angle_rad() - roll).sin_cos();
        let involute_x = base * (cos - roll * sin);
        let x = &self.profile.x_mm;
        let (root, last) = (x[0], x.len() - 1);
        let place = ((involute_x - root) / (x[last] - root)).clamp(0.0, 1.0) * last as f64;
        let index = (place as usize).min(last - 1);
        let point = FlankPoint {
            index,
            fraction: place - index as f64,
            x_mm: 0.0,
            y_mm: 0.0,
            load_sin: -sin,
            load_cos: cos,
        };
        FlankPoint { x_mm: point.of(x), y_mm: point.of(&self.profile.y_mm), ..point }
    }

    /// (mm) Radius of curvature of the involute at a profile point, before relief; 0 on the fillet.
    ///
    /// # Arguments
    /// * `index` - profile point
    pub fn curvature_mm(&self, index: usize) -> f64 {
        self.wheel.curvature_mm(self.profile.involute_radius_mm[index])
    }
}
