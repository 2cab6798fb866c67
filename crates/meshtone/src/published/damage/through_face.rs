//! A pit over the whole face width: while the mate passes it, it turns about the pit's two edges.

use super::face_circle::pit_on_gear;
use super::{Displacement, FaultGeometry, Pivot, ToothSection};
use crate::damage::{HealthyTooth, ThroughFace};
use crate::error::ScenarioError;
use crate::wheel::{Teeth, ToothProfile};

/// The half of a pit in which the mate turns about one of its edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Half {
    /// It turns about the pit's `start_index`.
    Start,
    /// It turns about the pit's `end_index`.
    End,
}

/// How the pressure angle changes while the mate turns about the pit's edges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RollingAngle {
    /// (rad) Nominal pressure angle.
    pub nominal_rad: f64,
    /// (mm) Base radius of the mate (the pinion).
    pub mate_base_radius_mm: f64,
    /// (mm) Radii of the mate at the points that match the pit's start, middle and end.
    pub mate_radii_mm: [f64; 3],
    /// (rev) Position at which the pit enters contact.
    pub start_rev: f64,
    /// (rev) Position at which it leaves contact.
    pub end_rev: f64,
    /// (mm) Largest displacement, `h`: how far the two flanks bulge over the chords between their edges.
    pub deviation_mm: f64,
}

impl RollingAngle {
    /// (rad) The pressure angle over a range of `points` points, from the pit's `start_index` to its
    /// `end_index`.
    ///
    /// In the first half the mate turns about the start edge, in the second about the end edge:
    /// `α + (√(R_edge² − Rb²) − √(R² − Rb²))/Rb`, R linear between edge and middle. Each half has
    /// ⌈points/2⌉ points and they share the middle one, which is the `middle` half's, so an even range gets one
    /// angle less than points.
    pub fn over_range_rad(&self, points: usize, middle: Half) -> Vec<f64> {
        if points == 0 {
            return Vec::new();
        }
        let half = points.div_ceil(2);
        let [start, mid, end] = self.mate_radii_mm;
        let arc = |radius: f64| (radius.powi(2) - self.mate_base_radius_mm.powi(2)).max(0.0).sqrt();
        let turned = |edge: f64, from: f64, to: f64| {
            (0..half).map(move |k| {
                let t = if half > 1 { k as f64 / (half - 1) as f64 } else { 0.0 };
                self.nominal_rad + (arc(edge) - arc(from + t * (to - from))) / self.mate_base_radius_mm
            })
        };
        let (first, second) = match middle {
            Half::Start => (half, half - 1),
            Half::End => (half - 1, half),
        };
        let mut angles: Vec<f64> = turned(start, start, mid).take(first).collect();
        angles.extend(turned(end, mid, end).skip(half - second));
        angles
    }

    /// (mm) Displacement at `position_rev` since the damaged tooth entered contact: `−h (1 − cos 2πξ)/2` over
    /// the pit, 0 elsewhere.
    pub fn displacement_mm(&self, position_rev: f64) -> f64 {
        if position_rev <= self.start_rev || position_rev >= self.end_rev {
            return 0.0;
        }
        let xi = (position_rev - self.start_rev) / (self.end_rev - self.start_rev);
        -self.deviation_mm * (1.0 - (2.0 * std::f64::consts::PI * xi).cos()) / 2.0
    }
}

pub(super) fn geometry(fault: &ThroughFace, teeth: &Teeth) -> Result<FaultGeometry, ScenarioError> {
    let (pit, flank_y_mm) = pit_on_gear(&fault.pit, teeth)?;
    let contact = &teeth.contact;
    let mate = [pit.start_index, pit.mid_index, pit.end_index].map(|i| contact.mate_index(i));
    let rolling = RollingAngle {
        nominal_rad: teeth.gear.pressure_angle_rad,
        mate_base_radius_mm: teeth.pinion.base_radius_mm,
        mate_radii_mm: mate.map(|i| teeth.pinion_profile.radius_mm(i)),
        start_rev: pit.start_rev,
        end_rev: pit.end_rev,
        deviation_mm: largest_deviation_mm(&teeth.gear_profile, pit.start_index, pit.end_index)
            + largest_deviation_mm(&teeth.pinion_profile, mate[2], mate[0]),
    };
    let inside = pit.end_index - pit.start_index + 1;
    let angles = rolling.over_range_rad(inside, Half::Start);

    let mut gear = ToothSection::cut_flank(teeth.gear.face_width_mm, &teeth.gear_profile, &flank_y_mm);
    let mut gear_angle = vec![rolling.nominal_rad; teeth.gear_profile.len()];
    gear_angle[pit.start_index..pit.start_index + angles.len()].copy_from_slice(&angles);
    let (gear_pivot, pinion_pivot) = Pivot::over_pit(&pit, contact, true);
    gear.pivot = Some(gear_pivot);

    let mut pinion_angle = vec![rolling.nominal_rad; teeth.pinion_profile.len()];
    for i in pit.start_index..=pit.end_index {
        pinion_angle[contact.mate_index(i)] = gear_angle[i];
    }
    gear.pressure_angle_rad = Some(gear_angle);
    let healthy = HealthyTooth::first_of_gear(teeth, 0);
    let description = pit.describe::<ThroughFace>(teeth.gear.face_width_mm, &flank_y_mm, &healthy);
    let mut fault = FaultGeometry::of_sound_pair(teeth, description);
    fault.pinion.pivot = Some(pinion_pivot);
    fault.pinion.pressure_angle_rad = Some(pinion_angle);
    Ok(FaultGeometry { gear, displacement: Displacement::Rolling(rolling), flank_y_mm, ..fault })
}

/// (mm) Largest distance, across the chord, of the flank from the chord between two of its points.
fn largest_deviation_mm(profile: &ToothProfile, start: usize, end: usize) -> f64 {
    let (x0, y0) = (profile.x_mm[start], profile.y_mm[start]);
    let (dx, dy) = (profile.x_mm[end] - x0, profile.y_mm[end] - y0);
    let chord = dx.hypot(dy);
    (start..=end)
        .map(|i| ((profile.y_mm[i] - y0) * dx - (profile.x_mm[i] - x0) * dy).abs() / chord)
        .fold(0.0, f64::max)
}
