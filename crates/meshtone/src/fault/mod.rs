//! Stage 4: the damaged tooth.
//!
//! One file per fault. Each turns the fault's parameters into a [`FaultGeometry`], all that the
//! later stages need to know: the cross-sections of the two teeth of the faulty pair, where they do
//! not touch, over which width, at which pressure angle and with which displacement.

mod face_circle;
mod missing_tooth;
mod partial_face;
mod section;
mod through_face;
mod tooth_breakage;
mod tooth_destruction;

pub use section::{LateralBending, Pivot, ToothSection};
pub use through_face::{Half, RollingAngle};

use std::ops::Range;

use crate::scenario::{Convention, Fault, ScenarioError};
use crate::tooth::Teeth;

/// Stage 4's result: the faulty tooth pair. The fault is on the gear's first tooth.
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
    pub description: FaultDescription,
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

/// Numbers that describe the damage, one set per kind.
#[derive(Debug, Clone, PartialEq)]
pub enum FaultDescription {
    /// The tooth is gone.
    MissingTooth,
    /// A chipped corner.
    ToothBreakage {
        /// (rev) Position at which contact with the chip ends.
        exit_rev: f64,
        /// Last profile index below the chip.
        chip_start_index: usize,
        /// (mm) Lost tip.
        tip_loss_mm: f64,
        /// (mm) Missing width over the profile points.
        missing_width_mm: Vec<f64>,
    },
    /// A pit, over a part or the whole of the face width.
    FaceFault {
        /// Where the pit lies on the flank.
        pit: Pit,
        /// (mm) Width along the face.
        width_mm: f64,
    },
    /// A ground flank.
    ToothDestruction {
        /// First and last damaged profile index.
        start_index: usize,
        /// Last damaged profile index.
        end_index: usize,
        /// (rad) Angle of the line to the tooth's centre line.
        slope_rad: f64,
    },
}

/// A pit's place on the flank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pit {
    /// First profile index inside the pit.
    pub start_index: usize,
    /// Middle of the pit.
    pub mid_index: usize,
    /// Last profile index inside the pit.
    pub end_index: usize,
    /// (mm) Chord between the pit's edges.
    pub length_mm: f64,
    /// (-) `length_mm` over the chord of the flank's contact part.
    pub length_fraction: f64,
    /// (rev) Position at which the pit enters contact (its `end_index`).
    pub start_rev: f64,
    /// (rev) Position at which it leaves contact (its `start_index`).
    pub end_rev: f64,
}

/// Generates the geometry of the faulty pair.
///
/// # Arguments
/// * `fault` - the damage
/// * `teeth` - both healthy teeth
/// * `convention` - published or corrected
/// * `seed` - seed of a destruction's roughness
///
/// # Errors
/// A fault that does not fit the tooth: a pit that misses the flank or is deeper than the tooth, a
/// chip larger than the tooth, a line that leaves no tooth.
pub fn fault_geometry(
    fault: &Fault,
    teeth: &Teeth,
    convention: Convention,
    seed: u64,
) -> Result<FaultGeometry, ScenarioError> {
    match fault {
        Fault::MissingTooth => Ok(missing_tooth::geometry(teeth)),
        Fault::ToothBreakage(fault) => tooth_breakage::geometry(fault, teeth),
        Fault::PartialFace(fault) => partial_face::geometry(fault, teeth, convention),
        Fault::ThroughFace(fault) => through_face::geometry(fault, teeth, convention),
        Fault::ToothDestruction(fault) => tooth_destruction::geometry(fault, teeth, convention, seed),
    }
}
