//! Elements of a figure, before it is SVG or pixels.
//!
//! One description for both, so that they show the same: the same numbers, rounded here and nowhere else, in the
//! same order.

use crate::drawing::{Fill, Stroke, TextStyle};

/// A point in pixels, y downwards.
pub(crate) type Pixel = (f64, f64);

/// A point in hundredths of pixels: finer than eyes, and short in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ScenePoint {
    pub(crate) x: Hundredths,
    pub(crate) y: Hundredths,
}

impl From<Pixel> for ScenePoint {
    fn from((x, y): Pixel) -> Self {
        Self { x: x.into(), y: y.into() }
    }
}

/// A length in hundredths of pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Hundredths(pub(crate) i32);

impl From<f64> for Hundredths {
    fn from(px: f64) -> Self {
        Self((px * 100.0).round() as i32)
    }
}

impl Hundredths {
    /// (px)
    pub(crate) fn px(self) -> f32 {
        self.0 as f32 / 100.0
    }
}

/// A figure's size and its elements, the later ones over the earlier ones on white ground.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Scene {
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) elements: Vec<Element>,
}

/// Something drawn.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Element {
    /// Straight lines from point to point, filled and then stroked.
    Path { points: Vec<ScenePoint>, closed: bool, stroke: Option<Stroke>, fill: Option<Fill> },
    /// Rectangles with the corners `[upper left, lower right]`, filled as one shape.
    Rectangles { corners: Vec<[ScenePoint; 2]>, fill: Fill },
    /// Discs; where they overlap the fill adds up.
    Dots { centres: Vec<ScenePoint>, radius: f64, fill: Fill },
    /// Text whose baseline starts, has its middle or ends at a point.
    Text { at: ScenePoint, text: String, style: TextStyle },
}
