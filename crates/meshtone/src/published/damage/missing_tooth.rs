//! A tooth that is gone: its pair has no stiffness.

use super::{ContactWidth, Displacement, FaultGeometry, ToothSection};
use crate::damage::{HealthyTooth, MissingTooth};
use crate::wheel::Teeth;

pub(super) fn geometry(teeth: &Teeth) -> FaultGeometry {
    FaultGeometry {
        gear: ToothSection::sound(&teeth.gear, &teeth.gear_profile),
        pinion: ToothSection::sound(&teeth.pinion, &teeth.pinion_profile),
        no_contact: 0..teeth.gear_profile.len(),
        contact_width: ContactWidth::Whole,
        displacement: Displacement::None,
        flank_y_mm: teeth.gear_profile.y_mm.clone(),
        description: MissingTooth::describe(&HealthyTooth::first_of_gear(teeth, 0)),
    }
}
