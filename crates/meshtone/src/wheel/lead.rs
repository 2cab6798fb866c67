//! What differs along the face: hand of the helix, lead crowning, end relief.

use crate::keys::{KeyRow, Keys, Range, by_name, field, row};

/// Hand of a helix.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Hand {
    /// The teeth lean to the right when the wheel stands with its axis upright, as the thread of a common screw.
    #[default]
    Right,
    /// They lean to the left.
    Left,
}

by_name!(Hand, ["right" => Hand::Right, "left" => Hand::Left]);

impl Hand {
    /// 1 of a right-hand helix, −1 of a left-hand one.
    pub fn sign(self) -> f64 {
        match self {
            Self::Right => 1.0,
            Self::Left => -1.0,
        }
    }

    /// That of a wheel that meshes with one of this hand.
    pub(crate) fn other(self) -> Self {
        match self {
            Self::Right => Self::Left,
            Self::Left => Self::Right,
        }
    }
}

/// Material removed from the flanks towards both ends of the face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndRelief {
    /// (mm) Length from each end of the face. Default 1.
    pub length_mm: f64,
    /// (µm) How much farther apart the flanks of both wheels are at the ends of the face. Default 0: no relief.
    pub amount_um: f64,
}

impl Default for EndRelief {
    fn default() -> Self {
        Self { length_mm: 1.0, amount_um: 0.0 }
    }
}

impl EndRelief {
    /// (mm²) Integral, from the end of the face to a distance from it, of how much farther apart the flanks are: a parabola that leaves
    /// the flank smoothly.
    ///
    /// # Arguments
    /// * `from_end_mm` - (mm) the distance
    pub(super) fn gap_until_mm2(&self, from_end_mm: f64) -> f64 {
        let left = (1.0 - from_end_mm / self.length_mm).clamp(0.0, 1.0);
        self.amount_um * 1e-3 * self.length_mm / 3.0 * (1.0 - left.powi(3))
    }
}

impl Keys for EndRelief {
    fn start() -> Self {
        Self::default()
    }

    fn rows() -> Vec<KeyRow<Self>> {
        vec![
            row("length_mm", "mm", "the length from each end of the face", field!(length_mm))
                .range(Range::positive())
                .rule("at most half the face width"),
            row(
                "amount_um",
                "µm",
                "how much farther apart the flanks of both wheels are at the ends of the face",
                field!(amount_um),
            )
            .range(Range::not_negative().implausible_above(1000.0)),
        ]
    }
}
