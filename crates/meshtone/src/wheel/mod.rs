//! The healthy tooth and the line along which two teeth touch.

mod contact;
mod flank;
mod flank_relief;
mod gears;
mod helix;
mod internal_rules;
mod lead;
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
pub use gears::{BodyRotation, FoundationCoefficients, Gears, ReliefShape};
pub use lead::{EndRelief, Hand};
pub use material::{Material, MaterialConstants};
pub use mounting::Mounting;
pub use name::WheelName;
pub(crate) use named_gears::{NamedGears, NamedWheel};
pub use path::PathOfContact;
pub(crate) use profile::first_minimum;
pub use profile::{Root, TipRelief, ToothProfile, tooth_profile};
pub use quality::{
    Deviations, ERROR_POINTS, ErrorTable, ProfileErrors, Quality, RunOut, Tolerances, WheelDeviations,
};
pub use radii::Wheel;
pub(crate) use rules::{HALF_THICKNESS, unused_slices};

use std::sync::Arc;

use crate::known::Known;

/// Profiles, by the section's wheel without what they do not depend on, the number of points and the uniform reduction: of all pairs of tooth
/// counts and modules of a data set, at 0.24 MB each.
pub(crate) type KnownProfiles = Known<(Wheel, usize, f64), ToothProfile, 48>;

/// Both wheels with their teeth, ready to mesh.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Teeth {
    /// The driving wheel.
    pub pinion: Wheel,
    /// The driven wheel.
    pub gear: Wheel,
    /// The spur wheel whose teeth are those of the pinion's normal section: the pinion itself where it is a spur wheel.
    pub pinion_section: Wheel,
    /// The same of the gear.
    pub gear_section: Wheel,
    /// Profile of a healthy pinion tooth, of helical wheels in the normal section.
    pub pinion_profile: Arc<ToothProfile>,
    /// Profile of a healthy gear tooth, likewise.
    pub gear_profile: Arc<ToothProfile>,
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

    /// The same teeth on wheels of another face width.
    ///
    /// # Arguments
    /// * `face_width_mm` - (mm) of both wheels
    pub(crate) fn with_face_width(&self, face_width_mm: f64) -> Self {
        let mut teeth = self.clone();
        for wheel in [&mut teeth.pinion, &mut teeth.gear, &mut teeth.pinion_section, &mut teeth.gear_section]
        {
            wheel.face_width_mm = face_width_mm;
        }
        teeth
    }

    /// The spur wheel whose teeth are those of a wheel's normal section.
    ///
    /// # Arguments
    /// * `wheel` - which
    pub fn section(&self, wheel: WheelName) -> &Wheel {
        wheel.choose(&self.pinion_section, &self.gear_section)
    }

    /// (mm) How much farther from the centre a point of the flank is in the normal section than in the transverse one.
    fn outwards_mm(&self, wheel: WheelName) -> f64 {
        self.section(wheel).pitch_radius_mm - self.wheel(wheel).pitch_radius_mm
    }

    /// (mm) Radius of curvature of a flank in the normal section, at the same height of the tooth as in the transverse one.
    ///
    /// # Arguments
    /// * `wheel` - whose flank
    /// * `curvature_mm` - (mm) radius of curvature in the transverse section; less than 0 where it lies beyond the base circle
    pub(crate) fn section_curvature_mm(&self, wheel: WheelName, curvature_mm: f64) -> f64 {
        let own = self.wheel(wheel);
        if own.helix_angle_rad == 0.0 {
            return curvature_mm;
        }
        let radius_mm = curvature_mm.max(0.0).hypot(own.base_radius_mm);
        self.section(wheel).curvature_mm(radius_mm + self.outwards_mm(wheel))
    }

    /// (mm) Radius of curvature of a flank in the transverse section, at the same height of the tooth as in the normal one.
    ///
    /// # Arguments
    /// * `wheel` - whose flank
    /// * `curvature_mm` - (mm) radius of curvature in the normal section
    pub(crate) fn transverse_curvature_mm(&self, wheel: WheelName, curvature_mm: f64) -> f64 {
        let own = self.wheel(wheel);
        if own.helix_angle_rad == 0.0 {
            return curvature_mm;
        }
        let radius_mm = curvature_mm.hypot(self.section(wheel).base_radius_mm);
        own.curvature_mm(radius_mm - self.outwards_mm(wheel))
    }

    /// (mm) A point of a tooth in the transverse section, from x along the tooth's centre line and y across it in the normal one.
    ///
    /// # Arguments
    /// * `wheel` - whose tooth
    /// * `point_mm` - (mm) x and y
    pub fn transverse_point_mm(&self, wheel: WheelName, [x_mm, y_mm]: [f64; 2]) -> [f64; 2] {
        [x_mm - self.outwards_mm(wheel), y_mm / self.wheel(wheel).helix_angle_rad.cos()]
    }

    /// (base pitches) Where on the path the flanks roll without sliding: the pitch point.
    pub fn pitch_point(&self) -> f64 {
        let on_flank_mm = self.gear.curvature_mm(self.gear.working_pitch_radius_mm);
        self.path.position(WheelName::Gear, on_flank_mm)
    }

    /// (pitches) The same as [`Gears::contact_span_pitches`].
    pub fn contact_span_pitches(&self) -> [f64; 2] {
        let overlap =
            self.gear.face_width_mm * self.gear.base_helix_angle_rad().tan() / self.path.base_pitch_mm;
        [-overlap / 2.0, self.contact.contact_ratio + overlap / 2.0]
    }

    /// (mm) The contact line on a tooth of helical wheels at an instant: z from the middle of the face, and x along the tooth's centre line
    /// in the normal section. Empty where no place of the face is on the path.
    ///
    /// # Arguments
    /// * `wheel` - on whose tooth
    /// * `overlap` - (base pitches) as [`FaceForm::overlap`](crate::mesh::FaceForm::overlap)
    /// * `position` - (base pitches) of the middle of the face since the start of the path
    pub fn contact_line_mm(&self, wheel: WheelName, overlap: f64, position: f64) -> Vec<[f64; 2]> {
        const POINTS: usize = 40;
        let width_mm = self.wheel(wheel).face_width_mm;
        // Where along the face the line enters and leaves the path.
        let place = |at: f64| (at - position) / overlap;
        let ends = [place(0.0), place(self.path.contact_ratio)];
        let [from, until] = [ends[0].min(ends[1]).max(-0.5), ends[0].max(ends[1]).min(0.5)];
        if from >= until {
            return Vec::new();
        }
        let flank = self.flank(wheel);
        let point = |n: usize| {
            let along = from + (until - from) * n as f64 / (POINTS - 1) as f64;
            let curvature_mm = self.path.curvature_mm(wheel, position + overlap * along);
            [along * width_mm, flank.at_curvature(self.section_curvature_mm(wheel, curvature_mm)).x_mm]
        };
        (0..POINTS).map(point).collect()
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
        Flank { wheel: self.section(wheel), profile: self.profile(wheel) }
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
    teeth_of_known(gears, bore_radii_mm, &KnownProfiles::default())
}

/// Does what [`teeth`] does, with profiles that are known already.
pub(crate) fn teeth_of_known(gears: &Gears, bore_radii_mm: [f64; 2], known: &KnownProfiles) -> Teeth {
    let pinion = Wheel::new(gears, WheelName::Pinion, bore_radii_mm[0]);
    let gear = Wheel::new(gears, WheelName::Gear, bore_radii_mm[1]);
    // A relief that thins the tip by half its thickness would leave nothing to touch: it is the published model's alone.
    let profile = |wheel: &Wheel, reduction_mm: f64| {
        let wheel = Wheel { face_width_mm: 0.0, bore_radius_mm: 0.0, ..*wheel };
        known.get((wheel, gears.points_per_tooth, reduction_mm), |key| {
            tooth_profile(&key.0, key.1, key.2, None, Root::Arc)
        })
    };
    Teeth::with_profiles(gears, [pinion, gear], profile)
}

impl Teeth {
    /// Two wheels with profiles of some kind.
    ///
    /// # Arguments
    /// * `gears` - geometry of the pair
    /// * `wheels` - the pinion and the gear
    /// * `profile` - makes the profile of a wheel's section, with the constant reduction of its flank, in mm
    pub(crate) fn with_profiles(
        gears: &Gears,
        [pinion, gear]: [Wheel; 2],
        profile: impl Fn(&Wheel, f64) -> Arc<ToothProfile>,
    ) -> Self {
        let section = |wheel: &Wheel| wheel.normal_section(gears.pressure_angle_deg.to_radians());
        let (pinion_section, gear_section) = (section(&pinion), section(&gear));
        let [pinion_mm, gear_mm] = gears.uniform_flank_reduction_mm;
        let (pinion_profile, gear_profile) =
            (profile(&pinion_section, pinion_mm), profile(&gear_section, gear_mm));
        let contact = contact_line(&pinion, &pinion_profile, &gear, &gear_profile);
        let path = PathOfContact::new(&pinion, &gear);
        Self { pinion, gear, pinion_section, gear_section, pinion_profile, gear_profile, contact, path }
    }
}
