//! Stage 2: the healthy tooth and the line along which two teeth touch.

mod contact;
mod profile;
mod wheel;

pub use contact::{ContactLine, contact_line, contact_ratio};
pub(crate) use profile::first_minimum;
pub use profile::{ToothProfile, tooth_profile};
pub use wheel::Wheel;

use crate::scenario::{Convention, Gears, Rig};

/// Stage 2's result: both wheels with their teeth, ready to mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Teeth {
    /// The driving wheel.
    pub pinion: Wheel,
    /// The driven wheel.
    pub gear: Wheel,
    /// Profile of a healthy pinion tooth, resampled so that index `N − 1 + i_c − i` of the pinion
    /// meets index `i` of the gear.
    pub pinion_profile: ToothProfile,
    /// Profile of a healthy gear tooth.
    pub gear_profile: ToothProfile,
    /// Where along the profiles the teeth touch.
    pub contact: ContactLine,
}

/// Generates the healthy teeth of both wheels and their line of contact.
///
/// # Arguments
/// * `gears` - geometry of the pair
/// * `rig` - for the wheels' bores, which are the shafts' radii
/// * `convention` - published or corrected
///
/// Source: paper, stage 2.
pub fn teeth(gears: &Gears, rig: &Rig, convention: Convention) -> Teeth {
    let pinion = Wheel::new(gears, gears.pinion_teeth, rig.pinion_shaft.radius_mm);
    let gear = Wheel::new(gears, gears.gear_teeth, rig.gear_shaft.radius_mm);
    let profile =
        |wheel| tooth_profile(wheel, gears.points_per_tooth, gears.crowning_mm, gears.tip_relief, convention);
    let gear_profile = profile(&gear);
    let (contact, pinion_profile) = contact_line(&pinion, &profile(&pinion), &gear, &gear_profile);
    Teeth { pinion, gear, pinion_profile, gear_profile, contact }
}
