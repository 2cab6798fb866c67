//! What the published model makes of damage: one fault, on the gear's first tooth.
//!
//! One file per kind that it knows. Each turns the fault's parameters into a [`FaultGeometry`], all that the
//! later stages need to know: the cross-sections of the two teeth of the faulty pair, where they do
//! not touch, over which width, at which pressure angle and with which displacement.

mod face_circle;
pub(super) mod missing_tooth;
pub(super) mod partial_face;
mod section;
pub(super) mod through_face;
pub(super) mod tooth_breakage;
pub(super) mod tooth_destruction;

use super::{Damage, DamageDescription, DamagedTooth};
use crate::error::ScenarioError;
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
    /// What is left of the gear's first tooth.
    ///
    /// # Arguments
    /// * `teeth` - both healthy teeth
    pub(crate) fn damaged_tooth(&self, teeth: &Teeth) -> DamagedTooth {
        let mut tooth = DamagedTooth::sound(WheelName::Gear, vec![0], &teeth.gear_profile);
        tooth.corner_y_mm.clone_from(&self.flank_y_mm);
        match &self.description {
            DamageDescription::FaceFault { width_mm, pit } => {
                tooth.corner_width_mm[pit.start_index..=pit.end_index].fill(*width_mm);
            }
            DamageDescription::ToothBreakage { missing_width_mm, .. } => {
                tooth.missing_width_mm.clone_from(missing_width_mm);
            }
            DamageDescription::ToothDestruction { .. } => tooth.flank_y_mm.clone_from(&self.flank_y_mm),
            // Neither a crack nor wear nor pits are known to the published model.
            DamageDescription::MissingTooth
            | DamageDescription::RootCrack { .. }
            | DamageDescription::Pits { .. }
            | DamageDescription::Wear { .. } => {}
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
    /// (mm) Width that carries no load at `position_rev` since the damaged tooth entered contact.
    pub fn missing_mm(&self, position_rev: f64) -> f64 {
        match *self {
            Self::Chip { width_mm, exit_rev } if position_rev < exit_rev => {
                width_mm * (1.0 - position_rev / exit_rev)
            }
            Self::Pit { width_mm, start_rev, end_rev } if (start_rev..=end_rev).contains(&position_rev) => {
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

/// Whether the published model knows a kind of damage.
pub(crate) fn knows(damage: &Damage) -> bool {
    matches!(
        damage,
        Damage::MissingTooth(_)
            | Damage::ToothBreakage(_)
            | Damage::PartialFace(_)
            | Damage::ThroughFace(_)
            | Damage::ToothDestruction(_)
    )
}

/// A kind that the published model does not know, by its name in the scenario file.
pub(crate) fn unknown_kind(name: &str) -> ScenarioError {
    ScenarioError::new("fault.kind", format!("\"{name}\""), "is not known to the published model")
        .with_help("write model = \"linear\" or model = \"contact\"")
}
