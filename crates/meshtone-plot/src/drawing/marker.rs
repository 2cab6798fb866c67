//! Symbols at single values, told apart by shape as well as by colour.

use super::canvas::{Canvas, Pixel};
use super::style::{Fill, Stroke};

/// Its outline.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Shape {
    Square,
    Diamond,
    Triangle,
}

/// A symbol.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Marker {
    pub(crate) shape: Shape,
    /// (px) Half of its size.
    pub(crate) radius: f64,
    pub(crate) stroke: Stroke,
    pub(crate) fill: Fill,
}

impl Marker {
    pub(crate) fn draw(&self, canvas: &mut Canvas, (x, y): Pixel) {
        let r = self.radius;
        let corners: &[Pixel] = match self.shape {
            Shape::Square => &[(-0.85, -0.85), (0.85, -0.85), (0.85, 0.85), (-0.85, 0.85)],
            Shape::Diamond => &[(0.0, -1.2), (1.0, 0.0), (0.0, 1.2), (-1.0, 0.0)],
            Shape::Triangle => &[(0.0, -1.1), (1.05, 0.8), (-1.05, 0.8)],
        };
        let corners: Vec<Pixel> = corners.iter().map(|(dx, dy)| (x + r * dx, y + r * dy)).collect();
        canvas.outlined(&corners, self.stroke, self.fill);
    }
}
