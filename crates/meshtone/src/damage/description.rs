//! What a damage is, in numbers for pictures and traces.

use super::{Crack, FlankPit};

/// Numbers that describe a damage, one set per kind. Positions are counted in pinion revolutions since the damaged tooth
/// entered contact.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum DamageDescription {
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
    /// Pits that take a part of the face.
    Pits {
        /// The pits.
        pits: Vec<FlankPit>,
        /// (%) Part of the flank's contact part that they take together.
        area_percent: f64,
    },
    /// A worn flank.
    Wear {
        /// First worn profile index.
        start_index: usize,
        /// Last worn profile index.
        end_index: usize,
        /// (mm) Depth along the flank's normal, over the profile points.
        depth_mm: Vec<f64>,
    },
    /// A cracked root.
    RootCrack {
        /// Where the crack lies.
        crack: Crack,
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
