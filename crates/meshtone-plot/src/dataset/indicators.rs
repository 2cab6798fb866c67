//! Indicators by class.

use super::DatasetPreview;
use crate::drawing::{Area, Axes, Canvas, Fill, Stroke, TextStyle, Ticks, axes, colour};

const DOTS: Fill = Fill::tint(colour::BLUE, 0.35);
const DOT_RADIUS: f64 = 1.3;
const MEDIAN: Stroke = Stroke::solid(colour::VERMILLION, 2.0);
/// (px) Between two plots below each other: the title of the lower one.
const GAP: f64 = 34.0;
const NAME_LEFT: f64 = 40.0;
/// (px) For the classes' names below the last plot.
const NAMES_HEIGHT: f64 = 20.0;
const NAME_LINES: usize = 3;
const LINE: f64 = 15.0;
/// One of so many values at either end is left out.
const EXTREMES: usize = 300;
/// Dots of a class, at most.
const MOST_DOTS: usize = 400;

pub(super) fn draw(canvas: &mut Canvas, area: Area, preview: &DatasetPreview) {
    let plots = Area { height: area.height - NAMES_HEIGHT, ..area };
    let each = plots.grid([1, preview.indicators.len()], [0.0, GAP], f64::INFINITY);
    for (indicator, plot) in preview.indicators.iter().zip(each) {
        one(canvas, plot, &indicator.name, &indicator.values, preview);
    }
    if !preview.indicators.is_empty() {
        names(canvas, plots, preview);
    }
}

fn one(canvas: &mut Canvas, area: Area, name: &str, values: &[f64], preview: &DatasetPreview) {
    let logarithms: Vec<f64> = values.iter().map(|value| value.log10()).collect();
    let classes = preview.classes.len().max(1);
    let y = axes::range(without_extremes(&logarithms).into_iter(), 0.06);
    let axes = Axes::titled(canvas, area, [0.0, classes as f64], y, name);
    axes.y_axis(canvas, &Ticks::of_logarithms(y[0], y[1]).thinned(6), "", NAME_LEFT);
    for class in 0..classes {
        let mut of_class: Vec<f64> = logarithms
            .iter()
            .zip(&preview.class_of)
            .filter(|(value, of)| (y[0]..=y[1]).contains(*value) && **of == class)
            .map(|(value, _)| *value)
            .collect();
        let every = of_class.len().div_ceil(MOST_DOTS).max(1);
        // Spread over the class's width by the golden ratio, which leaves no pattern.
        let spread = |i: usize| (i as f64 * 0.618_033_988_749_895).fract();
        let dots = of_class.iter().enumerate().step_by(every);
        let dots: Vec<_> =
            dots.map(|(i, &value)| axes.at(class as f64 + 0.15 + 0.7 * spread(i), value)).collect();
        canvas.dots(&dots, DOT_RADIUS, DOTS);
        of_class.sort_by(f64::total_cmp);
        if let Some(&median) = of_class.get(of_class.len() / 2) {
            let x = class as f64 + 0.5;
            canvas.line(axes.at(x - 0.38, median), axes.at(x + 0.38, median), MEDIAN);
        }
    }
    axes.frame(canvas);
}

/// The values but for a few at the ends, which would leave little room for the others.
fn without_extremes(values: &[f64]) -> Vec<f64> {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|value| axes::drawable(*value)).collect();
    sorted.sort_by(f64::total_cmp);
    let few = sorted.len() / EXTREMES;
    sorted[few..sorted.len() - few].to_vec()
}

fn names(canvas: &mut Canvas, area: Area, preview: &DatasetPreview) {
    let slot = area.width / preview.classes.len().max(1) as f64;
    let style = TextStyle::TICK;
    for (class, name) in preview.classes.iter().enumerate() {
        let middle = area.left + (class as f64 + 0.5) * slot;
        let lines = style.wrapped(&name.replace(['-', '_'], " "), slot - 4.0, NAME_LINES);
        for (line, text) in lines.iter().enumerate() {
            canvas.text((middle, area.bottom() + axes::NUMBERS_BELOW + line as f64 * LINE), text, style);
        }
    }
}
