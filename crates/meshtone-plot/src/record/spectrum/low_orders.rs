//! The low orders, one line each, and what they are.

use super::{Kind, REST, amplitude_axis, last_order};
use crate::axes::{self, Area, Axes};
use crate::canvas::Canvas;
use crate::legend::{self, Entry, Sample};
use crate::record::WheelView;
use crate::style::{Stroke, colour};
use crate::ticks::Ticks;

const MESH: Stroke = Stroke::solid(colour::BLUE, 2.2);
const SIDEBAND: Stroke = Stroke::solid(colour::PURPLE, 1.8);
const SHAFT: Stroke = Stroke::solid(colour::GREEN, 1.8);
/// (px) Least distance of two orders.
const BETWEEN_ORDERS: f64 = 3.2;
/// Fewest mesh orders that are shown.
const FEWEST: f64 = 2.0;

/// The last one: as far as orders can be told apart, but always some mesh orders.
pub(super) fn last(wheel: &WheelView, width_px: f64) -> usize {
    let room = width_px / BETWEEN_ORDERS;
    let teeth = f64::from(wheel.teeth);
    let shown = ((room / teeth - 0.5).floor().max(FEWEST) + 0.5) * teeth;
    (shown as usize).min(last_order(wheel))
}

pub(super) fn amplitudes<'w>(wheel: &'w WheelView, width_px: f64) -> impl Iterator<Item = f64> + 'w {
    wheel.record.order_spectrum.iter().skip(1).take(last(wheel, width_px)).copied()
}

pub(super) fn draw(canvas: &mut Canvas, area: Area, y: [f64; 2], wheel: &WheelView, unit: &str) {
    let last = last(wheel, area.width);
    let axes = Axes::new(area, [0.0, last as f64 + 0.5], y);
    let title =
        if last < last_order(wheel) { format!("Orders 1 to {last}") } else { "Order spectrum".to_owned() };
    axes.title(canvas, &title);
    legend(canvas, &axes, wheel);
    let teeth = wheel.teeth.max(1);
    let mesh_orders = Ticks::every(f64::from(teeth), 0.0, last as f64);
    let name = format!("Order of the {}’s shaft (mesh orders {teeth}, {}, …)", wheel.name, 2 * teeth);
    axes.x_axis(canvas, &mesh_orders, &name);
    amplitude_axis(canvas, &axes, 6, unit);
    // The rest first, so that no marked order is hidden.
    let spectrum = &wheel.record.order_spectrum;
    for marked in [false, true] {
        for (order, &amplitude) in spectrum.iter().enumerate().take(last + 1).skip(1) {
            let kind = Kind::of(order, wheel);
            let height = amplitude.log10().min(y[1]);
            if (kind != Kind::Difference) == marked && height > y[0] {
                let x = order as f64;
                canvas.line(axes.at(x, y[0]), axes.at(x, height), stroke(kind));
            }
        }
    }
    axes.frame(canvas);
}

fn stroke(kind: Kind) -> Stroke {
    match kind {
        Kind::Mesh => MESH,
        Kind::Sideband => SIDEBAND,
        Kind::Shaft => SHAFT,
        Kind::Difference => REST,
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
        (Kind::Mesh, Some("mesh orders".to_owned())),
        (Kind::Sideband, sidebands),
        (Kind::Shaft, shaft),
        (Kind::Difference, Some("difference".to_owned())),
    ];
    let entries: Vec<Entry> = texts
        .iter()
        .filter_map(|(kind, text)| {
            Some(Entry { sample: Sample::Line(stroke(*kind)), text: text.as_deref()? })
        })
        .collect();
    legend::row(canvas, (axes.area.right(), axes.area.top - axes::TITLE_ABOVE), &entries);
}
