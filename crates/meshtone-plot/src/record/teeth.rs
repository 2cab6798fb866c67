//! Curves over a revolution of a wheel, with its teeth as the horizontal axis.

use super::{NAME_LEFT, WheelView};
use crate::damaged_tooth;
use crate::drawing::{Area, Axes, Canvas, Entry, Sample, Stroke, TextStyle, Ticks, axes, over};

/// (px) Least distance of two numbers, and of two grid lines.
const BETWEEN_NUMBERS: f64 = 30.0;
const BETWEEN_LINES: f64 = 7.0;

/// A curve over a revolution, and its name in the legend.
pub(super) type Curve<'a> = (Option<&'a str>, &'a [f64], Stroke);

/// Draws curves over a revolution: tooth k is from k − 1 to k.
///
/// # Arguments
/// * `canvas`, `area` - where
/// * `y` - range of the vertical axis, and its unit
/// * `title` - the title
/// * `wheel` - whose revolution
/// * `curves` - the curves
pub(super) fn draw(
    canvas: &mut Canvas,
    area: Area,
    (y, unit): ([f64; 2], &str),
    title: &str,
    wheel: &WheelView,
    curves: &[Curve],
) {
    let axes = Axes::titled(canvas, area, [0.0, f64::from(wheel.teeth)], y, title);
    let damaged =
        damaged_tooth::in_words(&[(wheel.name, damaged_tooth::marked(wheel.damaged_teeth, wheel.teeth))]);
    let named = curves.iter().filter_map(|(name, _, stroke)| Some((Sample::Line(*stroke), (*name)?)));
    let damaged = damaged.as_deref().map(|text| (Sample::Area(damaged_tooth::TINT), text));
    axes.legend(canvas, &damaged.into_iter().chain(named).collect::<Vec<Entry>>());
    teeth_axis(canvas, &axes, wheel);
    axes.y_axis(canvas, &Ticks::nice(y[0], y[1], 5), &format!("Signal ({unit})"), NAME_LEFT);
    for (_, values, stroke) in curves {
        axes.line(canvas, over(axes.x, values), *stroke);
    }
    axes.frame(canvas);
}

/// Numbers of the teeth in the middle of their pitches, lines between them; the turns of damaged ones are tinted.
fn teeth_axis(canvas: &mut Canvas, axes: &Axes, wheel: &WheelView) {
    let marked = damaged_tooth::marked(wheel.damaged_teeth, wheel.teeth);
    damaged_tooth::tint(canvas, axes, marked, wheel.teeth, 1.0);
    let pitch = axes.area.width / f64::from(wheel.teeth.max(1));
    let step = |least: f64| {
        let steps = [1u32, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000];
        steps.into_iter().find(|&step| f64::from(step) * pitch >= least).unwrap_or(10_000)
    };
    let numbers = step(BETWEEN_NUMBERS);
    axes.x_grid(canvas, &Ticks::every(f64::from(step(BETWEEN_LINES)), 0.0, axes.x[1]));
    let first = if numbers > 2 { numbers } else { 1 };
    let others = (first..=wheel.teeth).step_by(numbers as usize).filter(|&tooth| tooth != 1);
    for tooth in std::iter::once(1).chain(others) {
        let at = (axes.px(f64::from(tooth) - 0.5), axes.area.bottom() + axes::NUMBERS_BELOW);
        canvas.text(at, &tooth.to_string(), TextStyle::TICK);
    }
    axes.x_name(canvas, &format!("Tooth of {} ({})", wheel.called(), wheel.first_tooth));
}
