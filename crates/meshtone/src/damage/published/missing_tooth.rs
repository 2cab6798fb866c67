//! A tooth that is gone: its pair has no stiffness.

use super::{ContactWidth, Displacement, FaultGeometry, ToothSection};
use crate::damage::DamageDescription;
use crate::wheel::Teeth;

pub(in crate::damage) fn geometry(teeth: &Teeth) -> FaultGeometry {
    FaultGeometry {
        gear: ToothSection::sound(&teeth.gear, &teeth.gear_profile),
        pinion: ToothSection::sound(&teeth.pinion, &teeth.pinion_profile),
        no_contact: 0..teeth.gear_profile.len(),
        contact_width: ContactWidth::Whole,
        displacement: Displacement::None,
        flank_y_mm: teeth.gear_profile.y_mm.clone(),
        description: DamageDescription::MissingTooth,
    }
}
