//! The recording over time.

use super::{CURVE, MARGIN, NAME_LEFT, SignalView, unit};
use crate::axes::{self, Area, Axes};
use crate::canvas::Canvas;
use crate::style::TextStyle;
use crate::text::fitted;
use crate::ticks::{Ticks, number};

pub(super) fn draw(canvas: &mut Canvas, area: Area, signal: &SignalView) {
    let duration_s = signal.samples.len() as f64 / signal.sampling_rate_hz;
    let time = [signal.start_s, signal.start_s + duration_s];
    let time = if time[1] > time[0] && time.iter().all(|&t| axes::drawable(t)) { time } else { [0.0, 1.0] };
    let y = axes::range(signal.samples.iter().copied(), MARGIN);
    let axes = Axes::new(area, time, y);
    axes.title(
        canvas,
        &format!(
            "{}: {} s, {} samples at {} S/s",
            fitted(signal.quantity, TextStyle::AXES_TITLE, 0.5 * area.width),
            number(duration_s),
            signal.samples.len(),
            number(signal.sampling_rate_hz)
        ),
    );
    axes.x_axis(canvas, &Ticks::nice(time[0], time[1], 12), "Time (s)");
    axes.y_axis(canvas, &Ticks::nice(y[0], y[1], 4), &format!("Signal ({})", unit(signal.unit)), NAME_LEFT);
    let step_s = 1.0 / signal.sampling_rate_hz;
    let points = signal.samples.iter().enumerate();
    axes.line(canvas, points.map(|(k, &value)| (time[0] + k as f64 * step_s, value)), CURVE);
    axes.frame(canvas);
}
