//! What is broken on the gear's first tooth.

/// Damage to the gear's first tooth.
#[derive(Debug, Clone, PartialEq)]
pub enum Fault {
    /// The tooth is gone.
    MissingTooth,
    /// A corner of the tooth has chipped off.
    ToothBreakage(ToothBreakage),
    /// A pit over a part of the face width.
    PartialFace(PartialFace),
    /// A pit over the whole face width.
    ThroughFace(ThroughFace),
    /// The working flank is ground down along a straight line.
    ToothDestruction(ToothDestruction),
}

impl Fault {
    /// The value of `kind` in the scenario file.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::MissingTooth => "missing-tooth",
            Self::ToothBreakage(_) => "tooth-breakage",
            Self::PartialFace(_) => "partial-face",
            Self::ThroughFace(_) => "through-face",
            Self::ToothDestruction(_) => "tooth-destruction",
        }
    }
}

/// A corner chipped off, and the tip lost over the whole width.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToothBreakage {
    /// (mm) Extent of the chip from the tip along the tooth's centre line.
    pub chip_height_mm: f64,
    /// (mm) Extent of the chip along the face width, at the tip.
    pub chip_width_mm: f64,
    /// (mm) Length of the tip that is lost over the whole width. Default 0.
    pub tip_loss_mm: f64,
}

/// A pit over a part of the face width, from one side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PartialFace {
    /// (mm) Width of the pit along the face.
    pub width_mm: f64,
    /// The circle that is cut into the flank.
    pub pit: PitCircle,
}

/// A pit over the whole face width.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThroughFace {
    /// The circle that is cut into the flank.
    pub pit: PitCircle,
}

/// A circle cut into the flank, in the tooth's own plane (x along its centre line from the
/// wheel's centre, y towards the working flank).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PitCircle {
    /// By the points where it meets the flank.
    Fractions {
        /// (-) First edge, as a fraction of the flank's contact part from its root side, in \[0, 1).
        start: f64,
        /// (-) Second edge, likewise, in (start, 1\].
        end: f64,
        /// (-) Depth of the pit over half its chord, in (0, 1].
        depth: f64,
    },
    /// By centre and radius.
    Circle {
        /// (mm) Centre, along the tooth's centre line.
        x_mm: f64,
        /// (mm) Centre, across the tooth.
        y_mm: f64,
        /// (mm) Radius.
        radius_mm: f64,
    },
}

/// A flank ground down along a straight line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToothDestruction {
    /// (-) Where the line starts, as a fraction of the flank's contact part from its root side,
    /// in (−1, 1); negative: below the contact part.
    pub start: f64,
    /// Where the line goes.
    pub line: DestructionLine,
    /// (mm) How far the line lies inside the flank, across the tooth. Default 0.
    pub offset_mm: f64,
    /// (mm) Half width of a uniform roughness of the ground flank. Default 0.
    pub noise_mm: f64,
}

/// Direction of a destruction's line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DestructionLine {
    /// (-) Towards the flank point of this fraction, in (start, 1].
    End(f64),
    /// (°) Falling towards the tip at this angle to the tooth's centre line.
    SlopeDeg(f64),
}
