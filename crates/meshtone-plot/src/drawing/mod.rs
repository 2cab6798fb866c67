//! What all figures are drawn with: axes with their ticks, legends and curves, text that knows its own width, and the styles.

pub(crate) mod axes;
pub(crate) mod bands;
mod canvas;
pub(crate) mod curve;
pub(crate) mod legend;
mod marker;
mod style;
mod text;
mod ticks;

pub(crate) use axes::{Area, Axes, NAME_LEFT, over};
pub(crate) use canvas::{BETWEEN_FACTS, Canvas, EDGE, Pixel, WIDTH, described};
pub(crate) use legend::{Entry, Sample};
pub(crate) use marker::{DIAMOND, Marker, SQUARE, TRIANGLE};
pub(crate) use style::{
    Anchor, Colour, DOT_RADIUS, Fill, HALO_WIDTH, HATCH_ANGLE_DEG, HATCH_PITCH, HATCH_WIDTH, Stroke,
    TextStyle, colour,
};
pub(crate) use text::capitalised;
pub(crate) use ticks::{Ticks, number};
