//! Bands of a quantity over two others, from pale to dark, and the bar that says what they are.

use super::axes::{self, Area, Axes};
use super::canvas::Canvas;
use super::style::{Anchor, Colour, Fill, TextStyle};

/// One hue, darker and darker, so that it reads in grey as well.
pub(crate) const COLOURS: [Colour; 10] = [
    Colour(0xff_ff_ff),
    Colour(0xea_f2_f8),
    Colour(0xd3_e4_f0),
    Colour(0xb9_d3_e7),
    Colour(0x9c_c0_db),
    Colour(0x7d_aa_cd),
    Colour(0x5f_92_bb),
    Colour(0x44_79_a6),
    Colour(0x2d_5f_8c),
    Colour(0x19_45_6e),
];
/// (px) From the axes to the bar, and its width.
const GAP: f64 = 16.0;
const WIDTH: f64 = 16.0;

/// The bands' colours on the right of the axes, with the values between them.
///
/// # Arguments
/// * `canvas`, `area` - where the axes are
/// * `title` - the quantity
/// * `bands` - the colours, and the values between two of them, from the bottom up
pub(crate) fn bar(canvas: &mut Canvas, area: Area, title: &str, (colours, ends): (&[Colour], &[String])) {
    let left = area.right() + GAP;
    let height = area.height / colours.len() as f64;
    let style = TextStyle::TICK.anchored(Anchor::Start);
    for (band, &colour) in colours.iter().enumerate() {
        let bottom = area.bottom() - band as f64 * height;
        canvas.rectangle((left, bottom), (left + WIDTH, bottom - height), Fill::solid(colour));
        if let Some(end) = ends.get(band) {
            canvas.text((left + WIDTH + 6.0, bottom - height + 4.5), end, style);
        }
    }
    Axes::new(Area::new(left, area.top, WIDTH, area.height), [0.0, 1.0], [0.0, 1.0]).frame(canvas);
    canvas.text((left, area.top - axes::TITLE_ABOVE), title, style);
}
