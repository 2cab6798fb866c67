//! The order spectrum on a logarithmic scale, and which part every order belongs to.

use super::{NAME_LEFT, WheelView};
use crate::axes::{self, Area, Axes};
use crate::canvas::Canvas;
use crate::legend::{self, Entry, Sample};
use crate::style::{Stroke, TextStyle, colour};
use crate::ticks::{Ticks, log_text};

const MESH: Stroke = Stroke::solid(colour::BLUE, 2.2);
const SIDEBAND: Stroke = Stroke::solid(colour::PURPLE, 1.8);
const SHAFT: Stroke = Stroke::solid(colour::GREEN, 1.8);
const REST: Stroke = Stroke::solid("#9a9a9a", 1.0);
/// (decades) What is shown below the largest amplitude, at least and at most.
const DECADES: [f64; 2] = [2.0, 4.0];
/// (px) Least distance of two orders.
const BETWEEN_ORDERS: f64 = 3.2;
/// Fewest mesh orders that are shown.
const FEWEST: f64 = 2.0;

/// (decades) Range of the amplitudes, for all wheels.
pub(super) fn range(wheels: &[WheelView], width_px: f64) -> [f64; 2] {
    let mut logs: Vec<f64> = wheels
        .iter()
        .flat_map(|wheel| wheel.record.order_spectrum.iter().skip(1).take(last_order(wheel, width_px)))
        .filter(|amplitude| **amplitude > 0.0 && axes::drawable(**amplitude))
        .map(|amplitude| amplitude.log10())
        .collect();
    logs.sort_by(f64::total_cmp);
    let Some(&largest) = logs.last() else { return [-1.0, 1.0] };
    let small = logs[logs.len() / 20];
    [small.clamp(largest - DECADES[1], largest - DECADES[0]) - 0.1, largest + 0.2]
}

pub(super) fn draw(canvas: &mut Canvas, area: Area, y: [f64; 2], wheel: &WheelView, unit: &str) {
    let most = last_order(wheel, area.width);
    let axes = Axes::new(area, [0.0, most as f64 + 0.5], y);
    axes.title(canvas, "Order spectrum");
    legend(canvas, &axes, wheel);
    let teeth = wheel.teeth.max(1);
    let orders = Ticks::every(f64::from(teeth), 0.0, most as f64);
    let nyquist = wheel.record.average.nyquist_order.floor() as usize;
    let shown = if most < nyquist { format!(", up to {most} of {nyquist}") } else { String::new() };
    let name = format!("Order of the {}’s shaft{shown} (mesh orders {teeth}, {}, …)", wheel.name, 2 * teeth);
    axes.x_axis(canvas, &orders, &name);
    let decades = Ticks::every(1.0, y[0], y[1]);
    axes.y_grid(canvas, &decades);
    for &decade in &decades.values {
        let style = TextStyle::TICK.anchored(crate::style::Anchor::End);
        canvas.text((area.left - 8.0, axes.py(decade) + 0.36 * style.size), &log_text(decade), style);
    }
    let middle = area.top + area.height / 2.0;
    canvas.text((area.left - NAME_LEFT, middle), &format!("Amplitude ({unit})"), TextStyle::AXIS.upwards());
    // The rest first, so that no marked order is hidden.
    let spectrum = &wheel.record.order_spectrum;
    for marked in [false, true] {
        for (order, &amplitude) in spectrum.iter().enumerate().take(most + 1).skip(1) {
            let stroke = part(order, wheel);
            let height = amplitude.log10().min(y[1]);
            if stroke.is_some() == marked && height > y[0] {
                let x = order as f64;
                canvas.line(axes.at(x, y[0]), axes.at(x, height), stroke.unwrap_or(REST));
            }
        }
    }
    axes.frame(canvas);
}

/// Orders that are shown: those that can be told apart, but always some mesh orders.
fn last_order(wheel: &WheelView, width_px: f64) -> usize {
    let room = width_px / BETWEEN_ORDERS;
    let nyquist = wheel.record.average.nyquist_order.floor() as usize;
    let teeth = f64::from(wheel.teeth);
    let shown = ((room / teeth - 0.5).floor().max(FEWEST) + 0.5) * teeth;
    (shown as usize).min(nyquist).min(wheel.record.order_spectrum.len().saturating_sub(1))
}

/// How an order of the regular part is drawn.
fn part(order: usize, wheel: &WheelView) -> Option<Stroke> {
    let teeth = wheel.teeth.max(1) as usize;
    let off = order.min(order % teeth).min(teeth - order % teeth);
    let beyond_first = order + wheel.sidebands >= teeth;
    match off {
        0 => Some(MESH),
        off if beyond_first && off <= wheel.sidebands => Some(SIDEBAND),
        _ if order <= wheel.low_orders => Some(SHAFT),
        _ => None,
    }
}

fn legend(canvas: &mut Canvas, axes: &Axes, wheel: &WheelView) {
    let sidebands = match wheel.sidebands {
        0 => None,
        1 => Some("±1 sideband".to_owned()),
        count => Some(format!("±{count} sidebands")),
    };
    let shaft = match wheel.low_orders {
        0 => None,
        1 => Some("shaft order 1".to_owned()),
        last => Some(format!("shaft orders 1–{last}")),
    };
    let texts = [
        (MESH, Some("mesh orders".to_owned())),
        (SIDEBAND, sidebands),
        (SHAFT, shaft),
        (REST, Some("difference".to_owned())),
    ];
    let entries: Vec<Entry> = texts
        .iter()
        .filter_map(|(stroke, text)| Some(Entry { sample: Sample::Line(*stroke), text: text.as_deref()? }))
        .collect();
    legend::row(canvas, (axes.area.right(), axes.area.top - axes::TITLE_ABOVE), &entries);
}
