//! Symbols of measured, simulated and enhanced results.

use crate::drawing::{DIAMOND, Fill, Marker, SQUARE, Sample, Stroke, TRIANGLE, colour};

/// A line from case to case, and the marker on it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Symbol {
    pub(super) stroke: Stroke,
    pub(super) marker: Marker,
}

impl Symbol {
    /// Both, for the legend.
    pub(super) fn sample(self) -> Sample {
        Sample::Marker(self.stroke, self.marker)
    }
}

pub(super) const RECORDS: Fill = Fill::tint(colour::MUTED, 0.35);
pub(super) const MEDIAN: Stroke = Stroke::solid(colour::INK, 2.6);
pub(super) const ORIGINAL: Symbol = Symbol {
    stroke: Stroke::dashed(colour::BLUE, 1.6, &[5.0, 3.0]),
    marker: Marker {
        corners: SQUARE,
        radius: 5.2,
        stroke: Stroke::solid(colour::BLUE, 1.8),
        fill: Fill::solid(colour::WHITE),
    },
};
pub(super) const ENHANCED: Symbol = Symbol {
    stroke: Stroke::solid(colour::GREEN, 1.8),
    marker: Marker {
        corners: DIAMOND,
        radius: 6.0,
        stroke: Stroke::solid(colour::WHITE, 1.2),
        fill: Fill::solid(colour::GREEN),
    },
};
pub(super) const LEFT_OUT: Symbol = Symbol {
    stroke: Stroke::dashed(colour::PURPLE, 1.4, &[2.0, 2.5]),
    marker: Marker {
        corners: TRIANGLE,
        radius: 5.0,
        stroke: Stroke::solid(colour::WHITE, 1.0),
        fill: Fill::solid(colour::PURPLE),
    },
};
pub(super) const ORIGINAL_CURVE: Stroke = Stroke::solid(colour::BLUE, 1.0);
pub(super) const ENHANCED_CURVE: Stroke = Stroke::solid(colour::GREEN, 1.0);
pub(super) const MEASURED_CURVE: Stroke = Stroke::solid(colour::MUTED, 1.0);
