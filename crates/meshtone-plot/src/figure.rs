//! A finished figure.

use crate::{PlotError, raster};

/// A finished figure.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    svg: String,
    width: u32,
    height: u32,
    labels: Vec<Label>,
}

/// A text of a figure and the box that it fills when set in the bundled font.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    /// The text.
    pub text: String,
    /// (px) Left edge, from the figure's left.
    pub left: f64,
    /// (px) Upper edge, from the figure's top.
    pub top: f64,
    /// (px) Right edge.
    pub right: f64,
    /// (px) Lower edge.
    pub bottom: f64,
}

impl Label {
    /// Whether the boxes of two texts share more than an edge.
    pub fn overlaps(&self, other: &Self) -> bool {
        self.left < other.right
            && other.left < self.right
            && self.top < other.bottom
            && other.top < self.bottom
    }
}

impl Figure {
    pub(crate) fn new(svg: String, width: u32, height: u32, labels: Vec<Label>) -> Self {
        Self { svg, width, height, labels }
    }

    /// The figure as an SVG document.
    pub fn svg(&self) -> &str {
        &self.svg
    }

    /// The figure as a PNG file of [`Self::size_px`], rasterised from [`Self::svg`].
    ///
    /// # Errors
    /// A figure that cannot be rasterised, which no input should bring about.
    pub fn png(&self) -> Result<Vec<u8>, PlotError> {
        raster::png(&self.svg, self.width, self.height)
    }

    /// (px) Width and height.
    pub fn size_px(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Every text of the figure and where it is.
    pub fn labels(&self) -> &[Label] {
        &self.labels
    }
}
