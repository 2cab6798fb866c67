//! A signal of each class.

use super::DatasetPreview;
use crate::axes::{self, Area, Axes};
use crate::canvas::Canvas;
use crate::font;
use crate::style::{Stroke, TextStyle, colour};
use crate::text::fitted;
use crate::ticks::Ticks;

const CURVE: Stroke = Stroke::solid(colour::BLUE, 1.0);
/// (px) Between two plots: the title of the lower one.
const GAP: f64 = 30.0;
const TALLEST: f64 = 220.0;
const NAME_LEFT: f64 = 48.0;
const MOST: usize = 9;
const MARGIN: f64 = 1.06;

pub(super) fn draw(canvas: &mut Canvas, area: Area, preview: &DatasetPreview) {
    let shown = preview.examples.len().min(MOST);
    let height = ((area.height + GAP) / shown.max(1) as f64 - GAP).min(TALLEST);
    for (place, example) in preview.examples.iter().take(MOST).enumerate() {
        let top = area.top + place as f64 * (height + GAP);
        let plot = Area::new(area.left, top, area.width, height);
        let size = example.signal.iter().copied().filter(|value| axes::drawable(*value));
        let half = size.fold(0.0f64, |size, value| size.max(value.abs()));
        let half = if half > 0.0 { MARGIN * half } else { 1.0 };
        let axes = Axes::new(plot, [0.0, 1.0], [-half, half]);
        let label = fitted(&example.label, TextStyle::AXES_TITLE, 0.45 * area.width);
        axes.title(canvas, &label);
        let after = font::text_width(&label, TextStyle::AXES_TITLE.size, true) + 12.0;
        let conditions = fitted(&example.conditions, TextStyle::NOTE, area.width - after);
        let at = (plot.left + after, plot.top - axes::TITLE_ABOVE);
        canvas.text(at, &conditions, TextStyle::NOTE.coloured(colour::MUTED));
        let ticks = Ticks::every(0.2, 0.0, 1.0);
        axes.x_grid(canvas, &ticks);
        if place + 1 == shown {
            axes.x_axis(
                canvas,
                &ticks,
                if preview.over_angle {
                    "Shaft angle from the mark (rev)"
                } else {
                    "Part of the record (–)"
                },
            );
        }
        axes.y_axis(canvas, &Ticks::about_zero(half), "", NAME_LEFT);
        let last = example.signal.len().max(1) as f64;
        let points = example.signal.iter().enumerate().map(|(i, &value)| (i as f64 / last, value));
        axes.line(canvas, points, CURVE);
        axes.frame(canvas);
    }
    if preview.examples.len() > MOST {
        let rest = format!("and {} more classes", preview.examples.len() - MOST);
        canvas.text((area.left, super::SECOND_LINE), &rest, TextStyle::NOTE);
    }
}
