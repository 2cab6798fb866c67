//! Where two teeth touch.

use super::profile::ToothProfile;
use super::radii::Wheel;
use crate::interpolation::Pchip;

/// The part of both profiles that takes part in contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactLine {
    /// (-) Mean number of tooth pairs in contact, `ε`.
    pub contact_ratio: f64,
    /// Index of the gear's profile where contact starts at its root side, `i_c`; under `published` of the pinion's too.
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

impl ContactLine {
    /// Number of points of either profile, `N`.
    pub fn profile_points(&self) -> usize {
        self.initial_contact_index + self.points
    }

    /// Index of the mate's profile that meets index `i` of a tooth's profile, `N − 1 + i_c − i`.
    pub fn mate_index(&self, index: usize) -> usize {
        self.profile_points() - 1 + self.initial_contact_index - index
    }
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
    path_over_base_pitch([teeth1, teeth2], [1.0; 2], pressure_angle_rad, pressure_angle_rad)
}

/// (-) Contact ratio of any two wheels.
pub(super) fn contact_ratio_of(pinion: &Wheel, gear: &Wheel) -> f64 {
    let Wheel { pressure_angle_rad, working_pressure_angle_rad, .. } = *pinion;
    let tip_heights = [pinion.tip_height, gear.tip_height];
    path_over_base_pitch(
        [pinion.teeth, gear.teeth],
        tip_heights,
        pressure_angle_rad,
        working_pressure_angle_rad,
    )
}

/// (-) Length of the path in base pitches, all in halves of a module.
fn path_over_base_pitch(
    teeth: [u32; 2],
    tip_heights: [f64; 2],
    pressure_angle_rad: f64,
    working_pressure_angle_rad: f64,
) -> f64 {
    let cos = pressure_angle_rad.cos();
    let (working_sin, working_cos) = working_pressure_angle_rad.sin_cos();
    let [z1, z2] = teeth.map(f64::from);
    let reach = |z: f64, tip: f64| ((z + 2.0 * tip).powi(2) - (z * cos).powi(2)).max(0.0).sqrt();
    let line = (z1 + z2) * (cos / working_cos) * working_sin;
    (reach(z1, tip_heights[0]) + reach(z2, tip_heights[1]) - line) / (2.0 * std::f64::consts::PI * cos)
}

/// (mm) Radius of `wheel` that the tip of `mate` touches first.
pub(crate) fn initial_contact_radius_mm(wheel: &Wheel, mate: &Wheel) -> f64 {
    let mate_reach = (mate.tip_radius_mm.powi(2) - mate.base_radius_mm.powi(2)).sqrt();
    let centre_distance = wheel.working_pitch_radius_mm + mate.working_pitch_radius_mm;
    let line = mate_reach - centre_distance * wheel.working_pressure_angle_rad.sin();
    (line * line + wheel.base_radius_mm.powi(2)).sqrt()
}

/// Finds the contact part of both profiles as they are.
///
/// # Arguments
/// * `pinion`, `gear` - the wheels
/// * `pinion_profile`, `gear_profile` - their profiles
pub fn contact_line(
    pinion: &Wheel,
    pinion_profile: &ToothProfile,
    gear: &Wheel,
    gear_profile: &ToothProfile,
) -> ContactLine {
    let pinion_radius = initial_contact_radius_mm(pinion, gear);
    let gear_radius = initial_contact_radius_mm(gear, pinion);
    let gear_index = gear_profile.nearest_to_radius(gear_radius);
    let ratio = contact_ratio_of(pinion, gear);
    ContactLine {
        contact_ratio: ratio,
        initial_contact_index: gear_index,
        pinion_initial_contact_index: pinion_profile.nearest_to_radius(pinion_radius),
        points: gear_profile.len() - gear_index,
        pinion_initial_radius_mm: pinion_radius,
        gear_initial_radius_mm: gear_radius,
        span_rev: ratio / f64::from(pinion.teeth),
    }
}

/// As [`contact_line`], as the published code pairs points: both flanks' contact parts are uniform in x, and the pinion's is
/// resampled so that the two match index by index. The pairs are not conjugate.
///
/// # Arguments
/// * `pinion`, `gear` - the wheels
/// * `pinion_profile`, `gear_profile` - their profiles, equally long
///
/// Returns the contact line and the resampled profile of the pinion: its parts before and after
/// its own contact start have the lengths of the gear's.
pub fn published_contact_line(
    pinion: &Wheel,
    pinion_profile: &ToothProfile,
    gear: &Wheel,
    gear_profile: &ToothProfile,
) -> (ContactLine, ToothProfile) {
    let contact = contact_line(pinion, pinion_profile, gear, gear_profile);
    let (pinion_index, gear_index) = (contact.pinion_initial_contact_index, contact.initial_contact_index);
    let resample = |values: &[f64], stretch: fn(&[f64], usize) -> Vec<f64>| {
        let mut resampled = stretch(&values[..pinion_index], gear_index);
        resampled.extend(stretch(&values[pinion_index..], contact.points));
        resampled
    };
    let resampled = ToothProfile {
        x_mm: resample(&pinion_profile.x_mm, stretch_line),
        y_mm: resample(&pinion_profile.y_mm, stretch),
        involute_radius_mm: resample(&pinion_profile.involute_radius_mm, stretch),
        tip_relief_index: pinion_profile.tip_relief_index,
    };
    let contact = ContactLine { pinion_initial_contact_index: gear_index, ..contact };
    (contact, resampled)
}

/// As [`stretch`], of values that are uniform: the curve is a line.
fn stretch_line(values: &[f64], count: usize) -> Vec<f64> {
    let (Some(&first), Some(&last)) = (values.first(), values.last()) else { return Vec::new() };
    let step = (last - first) / (count.max(2) - 1) as f64;
    (0..count).map(|i| if i + 1 == count { last } else { first + step * i as f64 }).collect()
}

/// The curve through `values` over a uniform parameter, at `count` uniform points.
fn stretch(values: &[f64], count: usize) -> Vec<f64> {
    if values.len() == count || values.len() < 2 {
        return values.iter().copied().cycle().take(if values.is_empty() { 0 } else { count }).collect();
    }
    let curve = Pchip::uniform(0.0, 1.0, values);
    let last = (count.max(2) - 1) as f64;
    let scale = (values.len() - 1) as f64;
    (0..count).map(|i| curve.at(i as f64 / last * scale)).collect()
}
