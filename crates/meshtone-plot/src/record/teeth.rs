//! The teeth as a horizontal axis.

use super::WheelView;
use crate::axes::Axes;
use crate::canvas::Canvas;
use crate::damaged_tooth;
use crate::style::{Stroke, TextStyle, colour};
use crate::ticks::Ticks;

/// (px) Least distance of two numbers, and of two grid lines.
const BETWEEN_NUMBERS: f64 = 30.0;
const BETWEEN_LINES: f64 = 7.0;
const GRID: Stroke = Stroke::solid(colour::GRID, 1.0);

/// The values of a revolution over the teeth: tooth k is from k − 1 to k.
pub(super) fn over(values: &[f64], teeth: u32) -> impl Iterator<Item = (f64, f64)> + '_ {
    let per_value = f64::from(teeth) / values.len().max(1) as f64;
    values.iter().enumerate().map(move |(k, &value)| (k as f64 * per_value, value))
}

/// Numbers of the teeth in the middle of their pitches, lines between them; the turns of damaged ones are tinted.
pub(super) fn axis(canvas: &mut Canvas, axes: &Axes, wheel: &WheelView) {
    damaged_tooth::tint(canvas, axes, wheel.damaged_teeth, wheel.teeth, 1.0);
    let pitch = axes.area.width / f64::from(wheel.teeth.max(1));
    let step = |least: f64| {
        let steps = [1u32, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000];
        steps.into_iter().find(|&step| f64::from(step) * pitch >= least).unwrap_or(10_000)
    };
    let (numbers, lines) = (step(BETWEEN_NUMBERS), step(BETWEEN_LINES));
    let (top, bottom) = (axes.area.top, axes.area.bottom());
    for line in Ticks::every(f64::from(lines), 0.0, f64::from(wheel.teeth)).values {
        canvas.line((axes.px(line), top), (axes.px(line), bottom), GRID);
        canvas.line(
            (axes.px(line), bottom),
            (axes.px(line), bottom + 4.0),
            Stroke::solid(colour::FRAME, 1.0),
        );
    }
    let first = if numbers > 2 { numbers } else { 1 };
    let others = (first..=wheel.teeth).step_by(numbers as usize).filter(|&tooth| tooth != 1);
    for tooth in std::iter::once(1).chain(others) {
        let x = axes.px(f64::from(tooth) - 0.5);
        canvas.text((x, bottom + 17.0), &tooth.to_string(), TextStyle::TICK);
    }
    let middle = axes.area.left + axes.area.width / 2.0;
    let name = format!("Tooth of the {} ({})", wheel.name, wheel.first_tooth);
    canvas.text((middle, bottom + 36.0), &name, TextStyle::AXIS);
}
