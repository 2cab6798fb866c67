//! A working flank that has been ground down along a straight line.

use super::{Displacement, FaultGeometry, ToothSection};
use crate::damage::{HealthyTooth, ToothDestruction};
use crate::error::ScenarioError;
use crate::random::{Draws, Purpose};
use crate::wheel::Teeth;

pub(super) fn geometry(
    fault: &ToothDestruction,
    teeth: &Teeth,
    seed: u64,
) -> Result<FaultGeometry, ScenarioError> {
    let profile = &teeth.gear_profile;
    let first_contact = teeth.contact.initial_contact_index;
    let roughness = Draws::new(seed, Purpose::DestructionNoise, 0);
    // Where line or roughness lie outside the flank, the published code adds metal.
    let ground = fault.grind(profile, first_contact, roughness, |ground, _| ground)?;
    // In the order of contact: the gear's tooth enters at its tip.
    let displacement_mm = ground.deviation_mm[first_contact..].iter().rev().copied().collect();
    let description = ground.describe(&HealthyTooth::first_of_gear(teeth, seed));
    Ok(FaultGeometry {
        gear: ToothSection::cut_flank(teeth.gear.face_width_mm, profile, &ground.flank_y_mm),
        displacement: Displacement::Pair { displacement_mm },
        flank_y_mm: ground.flank_y_mm,
        ..FaultGeometry::of_sound_pair(teeth, description)
    })
}
