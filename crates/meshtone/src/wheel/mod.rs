//! Stage 2: the healthy tooth and the line along which two teeth touch.

mod contact;
mod flank;
mod flank_relief;
mod gears;
mod material;
mod mounting;
mod mounting_rules;
mod name;
mod named_gears;
mod path;
mod profile;
pub mod quality;
mod radii;
pub(crate) mod rows;
mod rules;
mod undercut;

pub use contact::{ContactLine, contact_line, contact_ratio};
pub use flank::{Flank, FlankPoint};
pub use flank_relief::FlankRelief;
pub use gears::{FoundationCoefficients, Gears, ReliefShape};
pub use material::{Material, MaterialConstants};
pub use mounting::Mounting;
pub use name::WheelName;
pub(crate) use named_gears::NamedGears;
pub use path::PathOfContact;
pub(crate) use profile::first_minimum;
pub use profile::{Root, TipRelief, ToothProfile, tooth_profile};
pub use quality::{
    Deviations, ERROR_POINTS, ErrorTable, ProfileErrors, Quality, RunOut, Tolerances, WheelDeviations,
};
pub use radii::Wheel;
pub(crate) use rules::HALF_THICKNESS;

/// Stage 2's result: both wheels with their teeth, ready to mesh.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Teeth {
    /// The driving wheel.
    pub pinion: Wheel,
    /// The driven wheel.
    pub gear: Wheel,
    /// Profile of a healthy pinion tooth.
    pub pinion_profile: ToothProfile,
    /// Profile of a healthy gear tooth.
    pub gear_profile: ToothProfile,
    /// Points along the profiles at which the teeth touch.
    pub contact: ContactLine,
    /// The path along which conjugate flanks touch.
    pub path: PathOfContact,
}

impl Teeth {
    /// One of the two wheels.
    ///
    /// # Arguments
    /// * `wheel` - which
    pub fn wheel(&self, wheel: WheelName) -> &Wheel {
        wheel.choose(&self.pinion, &self.gear)
    }

    /// Profile of a healthy tooth of one of the two wheels.
    ///
    /// # Arguments
    /// * `wheel` - which
    pub fn profile(&self, wheel: WheelName) -> &ToothProfile {
        wheel.choose(&self.pinion_profile, &self.gear_profile)
    }

    /// Working flank of a healthy tooth of one of the two wheels.
    ///
    /// # Arguments
    /// * `wheel` - which
    pub fn flank(&self, wheel: WheelName) -> Flank<'_> {
        Flank { wheel: self.wheel(wheel), profile: self.profile(wheel) }
    }

    /// Index of the profile where contact starts at its root side.
    ///
    /// # Arguments
    /// * `wheel` - which of the two
    pub fn initial_contact_index(&self, wheel: WheelName) -> usize {
        wheel.choose(self.contact.pinion_initial_contact_index, self.contact.initial_contact_index)
    }

    /// (mm) Radius of a wheel where contact starts at its root side.
    pub(crate) fn initial_contact_radius_mm(&self, wheel: WheelName) -> f64 {
        wheel.choose(self.contact.pinion_initial_radius_mm, self.contact.gear_initial_radius_mm)
    }
}

/// Generates the healthy teeth of both wheels and their line of contact.
///
/// # Arguments
/// * `gears` - geometry of the pair
/// * `bore_radii_mm` - (mm) radii of the pinion's and of the gear's bore
///
/// Source: paper, stage 2.
pub fn teeth(gears: &Gears, bore_radii_mm: [f64; 2]) -> Teeth {
    let pinion = Wheel::new(gears, WheelName::Pinion, bore_radii_mm[0]);
    let gear = Wheel::new(gears, WheelName::Gear, bore_radii_mm[1]);
    // A relief that thins the tip by half its thickness would leave nothing to touch: it is the published model's alone.
    let profile = |wheel| {
        tooth_profile(wheel, gears.points_per_tooth, gears.uniform_flank_reduction_mm, None, Root::Arc)
    };
    let (pinion_profile, gear_profile) = (profile(&pinion), profile(&gear));
    let contact = contact_line(&pinion, &pinion_profile, &gear, &gear_profile);
    let path = PathOfContact::new(&pinion, &gear);
    Teeth { pinion, gear, pinion_profile, gear_profile, contact, path }
}
