//! Symbols of measured, simulated and enhanced results.

use crate::drawing::{Fill, Marker, Shape, Stroke, colour};

pub(super) const RECORDS: Fill = Fill::tint(colour::MUTED, 0.35);
pub(super) const MEDIAN: Stroke = Stroke::solid(colour::INK, 2.6);
pub(super) const ORIGINAL: Stroke = Stroke::dashed(colour::BLUE, 1.6, &[5.0, 3.0]);
pub(super) const ENHANCED: Stroke = Stroke::solid(colour::GREEN, 1.8);
pub(super) const LEFT_OUT: Stroke = Stroke::dashed(colour::PURPLE, 1.4, &[2.0, 2.5]);
pub(super) const ORIGINAL_CURVE: Stroke = Stroke::solid(colour::BLUE, 1.0);
pub(super) const ENHANCED_CURVE: Stroke = Stroke::solid(colour::GREEN, 1.0);
pub(super) const MEASURED_CURVE: Stroke = Stroke::solid(colour::MUTED, 1.0);

pub(super) const ORIGINAL_MARKER: Marker = Marker {
    shape: Shape::Square,
    radius: 5.2,
    stroke: Stroke::solid(colour::BLUE, 1.8),
    fill: Fill::solid(colour::WHITE),
};
pub(super) const ENHANCED_MARKER: Marker = Marker {
    shape: Shape::Diamond,
    radius: 6.0,
    stroke: Stroke::solid(colour::WHITE, 1.2),
    fill: Fill::solid(colour::GREEN),
};
pub(super) const LEFT_OUT_MARKER: Marker = Marker {
    shape: Shape::Triangle,
    radius: 5.0,
    stroke: Stroke::solid(colour::WHITE, 1.0),
    fill: Fill::solid(colour::PURPLE),
};
