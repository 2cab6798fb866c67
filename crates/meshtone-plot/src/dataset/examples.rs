//! A signal of each class.

use super::DatasetPreview;
use crate::drawing::{Area, Axes, Canvas, Stroke, TextStyle, Ticks, axes, colour};

const CURVE: Stroke = Stroke::solid(colour::BLUE, 1.0);
/// (px) Between two plots: the title of the lower one.
const GAP: f64 = 30.0;
const TALLEST: f64 = 220.0;
const NAME_LEFT: f64 = 48.0;
const MOST: usize = 9;
const MARGIN: f64 = 1.06;

pub(super) fn draw(canvas: &mut Canvas, area: Area, preview: &DatasetPreview) {
    let angle =
        if preview.over_angle { "Shaft angle from the mark (rev)" } else { "Part of the record (–)" };
    let shown = preview.examples.len().min(MOST);
    let plots = area.grid([1, shown], [0.0, GAP], TALLEST);
    for (place, (example, plot)) in preview.examples.iter().zip(plots).enumerate() {
        let largest = axes::largest(&example.signal);
        let half = if largest > 0.0 { MARGIN * largest } else { 1.0 };
        let label = TextStyle::AXES_TITLE.fitted(&example.label, 0.45 * area.width);
        let axes = Axes::titled(canvas, plot, [0.0, 1.0], [-half, half], &label);
        let after = TextStyle::AXES_TITLE.width(&label) + 12.0;
        let conditions = TextStyle::NOTE.fitted(&example.conditions, area.width - after);
        let at = (plot.left + after, plot.top - axes::TITLE_ABOVE);
        canvas.text(at, &conditions, TextStyle::NOTE.coloured(colour::MUTED));
        let ticks = Ticks::every(0.2, 0.0, 1.0);
        axes.x_grid(canvas, &ticks);
        if place + 1 == shown {
            axes.x_axis(canvas, &ticks, angle);
        }
        axes.y_axis(canvas, &Ticks::about_zero(half), "", NAME_LEFT);
        axes.line(canvas, axes::over(axes.x, &example.signal), CURVE);
        axes.frame(canvas);
    }
    if preview.examples.len() > MOST {
        let rest = format!("and {} more classes", preview.examples.len() - MOST);
        canvas.text((area.left, super::SECOND_LINE), &rest, TextStyle::NOTE);
    }
}
