//! Difference signals of the cases, original and enhanced.

use meshtone::scenario::WheelName;

use super::data::Data;
use super::symbols::{ENHANCED_CURVE, ORIGINAL_CURVE};
use crate::axes::{self, Area, Axes};
use crate::canvas::Canvas;
use crate::style::{Anchor, Stroke, TextStyle};
use crate::ticks::Ticks;

const TITLES: [&str; 2] = ["Original simulation", "Enhanced, one draw of the noise"];
const UNIT: &str = "(healthy rms)";
/// (px) Numbers left of each plot, and the gap right of it.
const NUMBERS: f64 = 33.0;
const GAP: f64 = 7.0;
const MARGIN: f64 = 1.08;
/// The case's number, where the columns are not those of the indicators.
const NUMBER: TextStyle = TextStyle::TICK.anchored(Anchor::Start).with_halo();

pub(super) fn heading(wheel: WheelName) -> String {
    format!("Difference signals over one {} revolution, each on its own scale", wheel.name())
}

fn angle(wheel: WheelName) -> &'static str {
    match wheel {
        WheelName::Pinion => "Pinion angle from the middle of the fault’s response (rev)",
        WheelName::Gear => "Gear angle from the middle of the fault’s response (rev)",
    }
}

/// Draws the original signals in the first area and enhanced in the second.
pub(super) fn draw(canvas: &mut Canvas, areas: [Area; 2], data: &Data) {
    let shown = data.shown_cases();
    let rows = [(&data.original_signals, ORIGINAL_CURVE), (&data.enhanced_signals, ENHANCED_CURVE)];
    for (row, (signals, stroke)) in rows.into_iter().enumerate() {
        let area = areas[row];
        canvas.text((area.left + NUMBERS, area.top - axes::TITLE_ABOVE), TITLES[row], TextStyle::AXES_TITLE);
        let unit_at = (area.left - super::NAME_LEFT + 19.0, area.top + area.height / 2.0);
        canvas.text(unit_at, UNIT, TextStyle::AXIS.upwards());
        let slot = area.width / shown.len() as f64;
        for (column, &case) in shown.iter().enumerate() {
            let left = area.left + column as f64 * slot;
            let plot = Area::new(left + NUMBERS, area.top, slot - NUMBERS - GAP, area.height);
            signal(canvas, plot, &signals[case], stroke, row == 1);
            if shown.len() < data.cases() {
                canvas.text((plot.left + 4.0, plot.top + 13.0), &format!("case {case}"), NUMBER);
            }
        }
    }
    let middle = areas[1].left + areas[1].width / 2.0;
    let angle = angle(data.experiment.chain.wheel);
    canvas.text((middle, areas[1].bottom() + axes::NAME_BELOW), angle, TextStyle::AXIS);
}

fn signal(canvas: &mut Canvas, area: Area, values: &[f64], stroke: Stroke, numbered: bool) {
    let size = values.iter().copied().filter(|value| axes::drawable(*value));
    let size = size.fold(0.0f64, |size, value| size.max(value.abs()));
    let half = if size > 0.0 { MARGIN * size } else { 1.0 };
    let axes = Axes::new(area, [-0.5, 0.5], [-half, half]);
    let angles = Ticks::every(0.4, -0.4, 0.4);
    axes.x_grid(canvas, &angles);
    if numbered {
        axes.x_numbers(canvas, &angles);
    }
    axes.y_axis(canvas, &Ticks::about_zero(half), "", super::NAME_LEFT);
    let count = values.len() as f64;
    let points = values.iter().enumerate().map(|(i, &value)| ((i as f64 + 0.5) / count - 0.5, value));
    axes.line(canvas, points, stroke);
    axes.frame(canvas);
}
