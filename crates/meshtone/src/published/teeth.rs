//! Teeth as the published code has them.

use std::sync::Arc;

use crate::interpolation::{NaturalSpline, Pchip};
use crate::wheel::{
    ContactLine, Gears, Root, Teeth, TipRelief, ToothProfile, Wheel, WheelName, tooth_profile,
};

/// The healthy teeth of both wheels, with the relief of the published code.
///
/// # Arguments
/// They are those of [`relieved_teeth`].
pub fn teeth(gears: &Gears, bore_radii_mm: [f64; 2]) -> Teeth {
    relieved_teeth(gears, bore_radii_mm, Some(TipRelief::PUBLISHED))
}

/// The healthy teeth of both wheels. The published code samples both flanks' contact parts uniformly in x and resamples the
/// pinion's, so that index `N − 1 + i_c − i` meets index `i` of the gear. The pairs are not conjugate.
///
/// # Arguments
/// * `gears` - geometry of the pair
/// * `bore_radii_mm` - (mm) radii of the pinion's and of the gear's bore
/// * `relief` - of all teeth, if any
pub fn relieved_teeth(gears: &Gears, bore_radii_mm: [f64; 2], relief: Option<TipRelief>) -> Teeth {
    let pinion = Wheel::new(gears, WheelName::Pinion, bore_radii_mm[0]);
    let gear = Wheel::new(gears, WheelName::Gear, bore_radii_mm[1]);
    let profile = |wheel: &Wheel, reduction_mm: f64| {
        let root = Root::Published(joint(wheel));
        Arc::new(tooth_profile(wheel, gears.points_per_tooth, reduction_mm, relief, root))
    };
    let own = Teeth::with_profiles(gears, [pinion, gear], profile);
    let contact =
        ContactLine { pinion_initial_contact_index: own.contact.initial_contact_index, ..own.contact };
    Teeth { pinion_profile: Arc::new(resampled(&own.pinion_profile, &own.contact)), contact, ..own }
}

impl ContactLine {
    /// Number of points of either profile, `N`.
    pub(super) fn profile_points(&self) -> usize {
        self.initial_contact_index + self.points
    }

    /// Index of the mate's profile that meets index `i` of a tooth's profile, `N − 1 + i_c − i`.
    pub(super) fn mate_index(&self, index: usize) -> usize {
        self.profile_points() - 1 + self.initial_contact_index - index
    }
}

/// Number of points on the fillet of the published code, and of steps from base to tip circle on its involute near the base circle.
/// Inferred from the published profiles, which they reproduce to 1e-10 mm.
const FILLET_SAMPLES: usize = 5_001;
const INVOLUTE_STEPS: f64 = 14_800.0;
/// Number of points on either side of the joint between fillet and involute that a spline through it still feels: the effect of a
/// point shrinks by 0.27 from one to the next.
const JOINT_KNOTS: usize = 60;

/// The curve round the joint of fillet and involute; none without a fillet.
///
/// The published code takes the fillet's nearer intersection with each ray. Where the involute's foot lies on the arc's farther side
/// (small tooth counts) that leaves a gap, which its resampling bridges by a cubic spline through both curves' points. The fillet's
/// very last point is left to the involute.
fn joint(wheel: &Wheel) -> Option<NaturalSpline> {
    let (base, root) = (wheel.base_radius_mm, wheel.root_radius_mm);
    let (foot_angle, centre_angle) = (wheel.foot_angle_rad(), wheel.half_pitch_angle_rad());
    let psi = centre_angle - foot_angle;
    let room = 2.0 * base * psi.cos() - 2.0 * root;
    if root >= base || room <= 0.0 || psi <= 0.0 {
        return None;
    }
    let radius = (root * root + base * base - 2.0 * root * base * psi.cos()) / room;
    let distance = root + radius;
    let last = FILLET_SAMPLES - 1;
    let on_fillet = (last - JOINT_KNOTS..last).map(|k| {
        let gamma = psi * k as f64 / last as f64;
        let to_arc = (radius.powi(2) - (distance * gamma.sin()).powi(2)).max(0.0).sqrt();
        let (r, theta) = (distance * gamma.cos() - to_arc, centre_angle - gamma);
        (r * theta.cos(), r * theta.sin())
    });
    let tip_angle = (base / wheel.tip_radius_mm).acos();
    let on_involute = (0..JOINT_KNOTS).map(|k| {
        let roll = (tip_angle * k as f64 / INVOLUTE_STEPS).tan();
        let (sin, cos) = (foot_angle - roll).sin_cos();
        (base * (cos - roll * sin), base * (sin + roll * cos))
    });
    let (x, y) = on_fillet.chain(on_involute).unzip();
    Some(NaturalSpline::new(x, y))
}

/// The pinion's profile with its parts before and after its own start of contact stretched to the lengths of the gear's.
fn resampled(pinion_profile: &ToothProfile, contact: &ContactLine) -> ToothProfile {
    let (pinion_index, gear_index) = (contact.pinion_initial_contact_index, contact.initial_contact_index);
    let resample = |values: &[f64], stretch: fn(&[f64], usize) -> Vec<f64>| {
        let mut resampled = stretch(&values[..pinion_index], gear_index);
        resampled.extend(stretch(&values[pinion_index..], contact.points));
        resampled
    };
    ToothProfile {
        x_mm: resample(&pinion_profile.x_mm, stretch_line),
        y_mm: resample(&pinion_profile.y_mm, stretch),
        involute_radius_mm: resample(&pinion_profile.involute_radius_mm, stretch),
        tip_relief_index: pinion_profile.tip_relief_index,
    }
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
