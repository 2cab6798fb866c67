//! The points at which two teeth touch.

use super::mounting_rules::touched_curvature_mm;
use super::profile::ToothProfile;
use super::radii::Wheel;

/// The part of both profiles that takes part in contact.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ContactLine {
    /// (-) Mean number of tooth pairs in contact, `ε`.
    pub contact_ratio: f64,
    /// Index of the gear's profile where contact starts at its root side, `i_c`.
    pub initial_contact_index: usize,
    /// Index of the pinion's profile where contact starts.
    pub pinion_initial_contact_index: usize,
    /// Number of contact points, `n_c = N − i_c`.
    pub points: usize,
    /// (mm) Radius of the pinion where contact starts.
    pub pinion_initial_radius_mm: f64,
    /// (mm) Radius of the gear where contact ends.
    pub gear_initial_radius_mm: f64,
    /// (rev) Part of a pinion revolution during which a pair touches, `ε/z_p`.
    pub span_rev: f64,
}

/// (-) Contact ratio of two standard wheels, without profile shift.
///
/// `ε = (√((z1+2)² − (z1 cos α)²) + √((z2+2)² − (z2 cos α)²) − (z1+z2) sin α)/(2π cos α)`.
///
/// # Arguments
/// * `teeth1`, `teeth2` - tooth counts
/// * `pressure_angle_rad` - (rad) pressure angle
///
/// ```
/// let ratio = meshtone::wheel::contact_ratio(62, 62, 20f64.to_radians());
/// assert!((ratio - 1.789_779_866_833_045_8).abs() < 1e-12);
/// ```
pub fn contact_ratio(teeth1: u32, teeth2: u32, pressure_angle_rad: f64) -> f64 {
    path_over_base_pitch([teeth1, teeth2].map(f64::from), [1.0; 2], pressure_angle_rad, pressure_angle_rad)
}

/// (-) Contact ratio of any two wheels.
pub(super) fn contact_ratio_of(pinion: &Wheel, gear: &Wheel) -> f64 {
    let Wheel { pressure_angle_rad, working_pressure_angle_rad, .. } = *pinion;
    let tip_heights = [pinion.tip_height, gear.tip_height];
    path_over_base_pitch(
        [pinion, gear].map(|wheel| wheel.sign() * f64::from(wheel.teeth)),
        tip_heights,
        pressure_angle_rad,
        working_pressure_angle_rad,
    )
}

/// (-) Length of the path in base pitches, all in halves of a module; a ring has a negative number of teeth.
fn path_over_base_pitch(
    [z1, z2]: [f64; 2],
    tip_heights: [f64; 2],
    pressure_angle_rad: f64,
    working_pressure_angle_rad: f64,
) -> f64 {
    let cos = pressure_angle_rad.cos();
    let (working_sin, working_cos) = working_pressure_angle_rad.sin_cos();
    let reach = |z: f64, tip: f64| {
        let squared = (z + 2.0 * tip).powi(2) - (z * cos).powi(2);
        squared.max(0.0).sqrt() * z.signum()
    };
    let line = (z1 + z2) * (cos / working_cos) * working_sin;
    (reach(z1, tip_heights[0]) + reach(z2, tip_heights[1]) - line) / (2.0 * std::f64::consts::PI * cos)
}

/// (mm) Radius of `wheel` that the tip of `mate` touches first.
pub(crate) fn initial_contact_radius_mm(wheel: &Wheel, mate: &Wheel) -> f64 {
    let curvature_mm = touched_curvature_mm(wheel, mate);
    (curvature_mm * curvature_mm + wheel.base_radius_mm.powi(2)).sqrt()
}

/// Finds the contact part of both profiles as they are.
///
/// # Arguments
/// * `pinion`, `gear` - the wheels
/// * `pinion_profile`, `gear_profile` - their profiles, in the normal section
pub fn contact_line(
    pinion: &Wheel,
    pinion_profile: &ToothProfile,
    gear: &Wheel,
    gear_profile: &ToothProfile,
) -> ContactLine {
    let pinion_radius = initial_contact_radius_mm(pinion, gear);
    let gear_radius = initial_contact_radius_mm(gear, pinion);
    // Heights are the same in both sections.
    let nearest = |profile: &ToothProfile, wheel: &Wheel, radius_mm: f64| {
        let outwards_mm = if wheel.helix_angle_rad == 0.0 {
            0.0
        } else {
            profile.involute_radius_mm[profile.len() - 1] - wheel.tip_radius_mm
        };
        profile.nearest_to_radius(radius_mm + outwards_mm)
    };
    let gear_index = nearest(gear_profile, gear, gear_radius);
    let ratio = contact_ratio_of(pinion, gear);
    ContactLine {
        contact_ratio: ratio,
        initial_contact_index: gear_index,
        pinion_initial_contact_index: nearest(pinion_profile, pinion, pinion_radius),
        points: gear_profile.len() - gear_index,
        pinion_initial_radius_mm: pinion_radius,
        gear_initial_radius_mm: gear_radius,
        span_rev: ratio / f64::from(pinion.teeth),
    }
}
