//! The difference signal with its envelope.

use super::{CURVE, WheelView, teeth, value_axis};
use crate::axes::{self, Axes};
use crate::canvas::Canvas;
use crate::damaged_tooth;
use crate::legend::{self, Entry, Sample};
use crate::style::{Stroke, colour};

const ENVELOPE: Stroke = Stroke::solid(colour::INK, 1.2);

/// All values that are drawn.
pub(super) fn extent<'a>(wheel: &'a WheelView) -> impl Iterator<Item = f64> + 'a {
    let record = wheel.record;
    record.parts.difference.iter().chain(&record.envelope).copied()
}

pub(super) fn draw(canvas: &mut Canvas, axes: Axes, wheel: &WheelView, unit: &str) {
    axes.title(canvas, "Difference signal");
    let curves = [("difference", CURVE), ("envelope", ENVELOPE)]
        .map(|(text, line)| Entry { sample: Sample::Line(line), text });
    let damaged = wheel.damage_in_words();
    let damaged = damaged.as_deref().map(damaged_tooth::legend_entry);
    let entries: Vec<Entry> = damaged.into_iter().chain(curves).collect();
    legend::row(canvas, (axes.area.right(), axes.area.top - axes::TITLE_ABOVE), &entries);
    teeth::axis(canvas, &axes, wheel);
    value_axis(canvas, &axes, unit);
    axes.line(canvas, teeth::over(&wheel.record.parts.difference, wheel.teeth), CURVE);
    axes.line(canvas, teeth::over(&wheel.record.envelope, wheel.teeth), ENVELOPE);
    axes.frame(canvas);
}
