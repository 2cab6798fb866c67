//! Symbols at single values, distinguished by shape as well as by colour.

use super::canvas::{Canvas, Pixel};
use super::style::{Fill, Stroke};

/// Outlines: corners in parts of the radius.
pub(crate) const SQUARE: &[Pixel] = &[(-0.85, -0.85), (0.85, -0.85), (0.85, 0.85), (-0.85, 0.85)];
pub(crate) const DIAMOND: &[Pixel] = &[(0.0, -1.2), (1.0, 0.0), (0.0, 1.2), (-1.0, 0.0)];
pub(crate) const TRIANGLE: &[Pixel] = &[(0.0, -1.1), (1.05, 0.8), (-1.05, 0.8)];

/// A symbol.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Marker {
    /// Its outline.
    pub(crate) corners: &'static [Pixel],
    /// (px) Half of its size.
    pub(crate) radius: f64,
    pub(crate) stroke: Stroke,
    pub(crate) fill: Fill,
}

impl Marker {
    pub(crate) fn draw(&self, canvas: &mut Canvas, (x, y): Pixel) {
        let r = self.radius;
        let corners: Vec<Pixel> = self.corners.iter().map(|(dx, dy)| (x + r * dx, y + r * dy)).collect();
        canvas.outlined(&corners, self.stroke, self.fill);
    }
}
