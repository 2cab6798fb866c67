//! What the published model makes of damage: one fault, on the gear's first tooth.
//!
//! One file per kind that it knows. Each turns the fault's parameters into a [`FaultGeometry`], all that the
//! later stages need to know: the cross-sections of the two teeth of the faulty pair, where they do
//! not touch, over which width, at which pressure angle and with which displacement.

mod face_circle;
mod partial_face;
mod section;
mod through_face;
mod tooth_breakage;
mod tooth_destruction;

use crate::damage::{Damage, DamageDescription, DamagedTooth, HealthyTooth, MissingTooth};
use crate::error::ScenarioError;
use crate::scenario::unknown_kind;
pub use section::{LateralBending, Pivot, ToothSection};
pub use through_face::{Half, RollingAngle};

use std::ops::Range;

use crate::wheel::{Teeth, WheelName};

/// The faulty tooth pair. The fault is on the gear's first tooth.
#[derive(Debug, Clone, PartialEq)]
pub struct FaultGeometry {
    /// Cross-sections of the damaged gear tooth.
    pub gear: ToothSection,
    /// Cross-sections of the pinion tooth that meets it.
    pub pinion: ToothSection,
    /// Indices of the gear's profile where the pair does not touch.
    pub no_contact: Range<usize>,
    /// Part of the face width that carries the load.
    pub contact_width: ContactWidth,
    /// Displacement that the damage imposes on the mesh.
    pub displacement: Displacement,
    /// (mm) The damaged flank over the gear's profile points.
    pub flank_y_mm: Vec<f64>,
    /// Numbers that describe the damage.
    pub description: DamageDescription,
}

impl FaultGeometry {
    /// A pair that touches at all points over the whole width.
    ///
    /// # Arguments
    /// * `teeth` - both healthy teeth
    /// * `description` - numbers that describe the damage
    fn of_sound_pair(teeth: &Teeth, description: DamageDescription) -> Self {
        Self {
            gear: ToothSection::sound(&teeth.gear, &teeth.gear_profile),
            pinion: ToothSection::sound(&teeth.pinion, &teeth.pinion_profile),
            no_contact: 0..0,
            contact_width: ContactWidth::Whole,
            displacement: Displacement::None,
            flank_y_mm: teeth.gear_profile.y_mm.clone(),
            description,
        }
    }

    /// What is left of the gear's first tooth.
    ///
    /// # Arguments
    /// * `teeth` - both healthy teeth
    pub(crate) fn damaged_tooth(&self, teeth: &Teeth) -> DamagedTooth {
        let mut tooth = DamagedTooth::sound(WheelName::Gear, vec![0], &teeth.gear_profile);
        tooth.corner_y_mm.clone_from(&self.flank_y_mm);
        let face_width_mm = teeth.gear.face_width_mm;
        let missing_mm = self.gear.contact_width_mm.iter().map(|width_mm| face_width_mm - width_mm).collect();
        match self.contact_width {
            ContactWidth::Whole => tooth.flank_y_mm.clone_from(&self.flank_y_mm),
            ContactWidth::Chip { .. } => tooth.missing_width_mm = missing_mm,
            ContactWidth::Pit { .. } => tooth.corner_width_mm = missing_mm,
        }
        if !self.no_contact.is_empty() {
            tooth.gone_from_index = self.no_contact.start;
        }
        tooth.descriptions.push(self.description.clone());
        tooth
    }
}

/// Part of the face width that carries the load while the damaged tooth is in contact.
/// Positions are fractions of a pinion revolution since that tooth entered contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ContactWidth {
    /// The whole face width.
    Whole,
    /// The chip's edge moves to the face's end: its width falls linearly to 0.
    Chip {
        /// (mm) Missing width at the start of contact.
        width_mm: f64,
        /// (rev) Position at which the whole width carries again.
        exit_rev: f64,
    },
    /// A constant width is missing from `start_rev` to `end_rev`.
    Pit {
        /// (mm) Missing width.
        width_mm: f64,
        /// (rev) Position at which the pit enters contact.
        start_rev: f64,
        /// (rev) Position at which it leaves contact.
        end_rev: f64,
    },
}

impl ContactWidth {
    /// (mm) Width that carries no load at `position_rev` since the damaged tooth entered contact: a chip's from there on, a pit's strictly
    /// between its positions.
    pub fn missing_mm(&self, position_rev: f64) -> f64 {
        match *self {
            Self::Chip { width_mm, exit_rev } if position_rev < exit_rev => {
                width_mm * (1.0 - position_rev / exit_rev)
            }
            Self::Pit { width_mm, start_rev, end_rev }
                if position_rev > start_rev && position_rev < end_rev =>
            {
                width_mm
            }
            _ => 0.0,
        }
    }
}

/// Displacement that the damage imposes along the line of action.
#[derive(Debug, Clone, PartialEq)]
pub enum Displacement {
    /// None.
    None,
    /// The faulty pair's flanks come together later: it acts on that pair's stiffness.
    Pair {
        /// (mm) At the contact points, in the order of contact.
        displacement_mm: Vec<f64>,
    },
    /// The mate turns about the pit's edges: `−h (1 − cos 2πξ)/2`, acting on the whole mesh.
    Rolling(RollingAngle),
}

/// The faulty pair that a damage of the gear's first tooth makes.
///
/// # Arguments
/// * `damage` - with its own sizes
/// * `teeth` - both healthy teeth
/// * `seed` - of a destruction's roughness
///
/// # Errors
/// A fault that does not fit the tooth: a pit that misses the flank or is deeper than the tooth, a chip larger than the tooth, a
/// line that leaves no tooth; a kind that the published model does not know.
pub fn geometry(damage: &Damage, teeth: &Teeth, seed: u64) -> Result<FaultGeometry, ScenarioError> {
    match damage {
        Damage::MissingTooth(_) => {
            let description = MissingTooth::describe(&HealthyTooth::first_of_gear(teeth, 0));
            let no_contact = 0..teeth.gear_profile.len();
            Ok(FaultGeometry { no_contact, ..FaultGeometry::of_sound_pair(teeth, description) })
        }
        Damage::ToothBreakage(breakage) => tooth_breakage::geometry(breakage, teeth),
        Damage::PartialFace(pit) => partial_face::geometry(pit, teeth),
        Damage::ThroughFace(pit) => through_face::geometry(pit, teeth),
        Damage::ToothDestruction(destruction) => tooth_destruction::geometry(destruction, teeth, seed),
        _ => Err(unknown_kind(damage)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Model;
    use crate::scenario::{Fault, GearPair, Scenario, damage_kinds};

    #[test]
    fn exactly_the_kinds_that_validation_lets_through_have_a_geometry() {
        for kind in damage_kinds() {
            let mut scenario = Scenario::new(GearPair::example());
            scenario.model = Model::Published;
            scenario.faults = vec![Fault::on_first_gear_tooth(kind.example.clone())];
            let teeth = crate::published::teeth(&scenario.gears(), [10.0; 2]);
            let (checked, made) = (scenario.validate(), geometry(&kind.example, &teeth, 0));
            assert_eq!(
                checked.err().map(|error| error.key),
                made.err().map(|error| error.key),
                "{}",
                kind.name
            );
        }
    }
}
