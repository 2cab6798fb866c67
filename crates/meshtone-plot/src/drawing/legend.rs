//! The legend of a plot.

use super::canvas::{Canvas, Pixel};
use super::marker::Marker;
use super::style::{DOT_RADIUS, Fill, Stroke, TextStyle, colour};

/// A sample of what the entry explains.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Sample {
    Line(Stroke),
    Area(Fill),
    Dots(Fill),
    /// A marker on a line.
    Marker(Stroke, Marker),
}

/// A sample and what it stands for.
pub(crate) type Entry<'a> = (Sample, &'a str);

const SAMPLE_WIDTH: f64 = 24.0;
const SAMPLE_GAP: f64 = 6.0;
const ENTRY_GAP: f64 = 20.0;
const ROW: f64 = 17.0;

/// Entries in one line that ends at `end`.
pub(crate) fn row(canvas: &mut Canvas, end: Pixel, entries: &[Entry]) {
    let mut left = end.0 - entries.iter().map(width).sum::<f64>() - ENTRY_GAP * (entries.len() as f64 - 1.0);
    for entry in entries {
        draw(canvas, (left, end.1), entry);
        left += width(entry) + ENTRY_GAP;
    }
}

/// Entries below each other, the first baseline at `start`.
pub(crate) fn column(canvas: &mut Canvas, start: Pixel, entries: &[Entry]) {
    let widest = entries.iter().map(width).fold(0.0, f64::max);
    let bottom = start.1 + ROW * (entries.len() as f64 - 1.0) + 5.0;
    let [from, to] = [(start.0 - 3.0, start.1 - 14.0), (start.0 + widest + 3.0, bottom)];
    canvas.rectangle(from, to, Fill::tint(colour::WHITE, 0.85));
    for (number, entry) in entries.iter().enumerate() {
        draw(canvas, (start.0, start.1 + ROW * number as f64), entry);
    }
}

fn width((_, text): &Entry) -> f64 {
    SAMPLE_WIDTH + SAMPLE_GAP + TextStyle::NOTE.width(text)
}

fn draw(canvas: &mut Canvas, (x, y): Pixel, (sample, text): &Entry) {
    let middle = y - 4.5;
    match *sample {
        Sample::Line(stroke) => canvas.line((x, middle), (x + SAMPLE_WIDTH, middle), stroke),
        Sample::Dots(fill) => {
            let dots = [4.0, 8.0, 12.0, 15.0, 20.0].map(|dx| (x + dx, middle + 3.0 * (dx * 2.1).sin()));
            canvas.dots(&dots, DOT_RADIUS, fill);
        }
        Sample::Marker(stroke, marker) => {
            canvas.line((x, middle), (x + SAMPLE_WIDTH, middle), stroke);
            marker.draw(canvas, (x + SAMPLE_WIDTH / 2.0, middle));
        }
        Sample::Area(fill) => canvas.rectangle((x, middle - 5.0), (x + SAMPLE_WIDTH, middle + 5.0), fill),
    }
    canvas.text((x + SAMPLE_WIDTH + SAMPLE_GAP, y), text, TextStyle::NOTE);
}
