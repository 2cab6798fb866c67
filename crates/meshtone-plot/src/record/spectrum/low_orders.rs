//! The low orders, one line each, and what they are.

use super::{LineKind, REST, amplitude_axis, last_order};
use crate::drawing::{Area, Axes, Canvas, Entry, Sample, Stroke, Ticks, colour};
use crate::record::WheelView;

/// (px) Least distance of two orders.
const BETWEEN_ORDERS: f64 = 3.2;
/// Fewest mesh orders that are shown.
const FEWEST: f64 = 2.0;

/// The last one: as far as orders can be distinguished, but always some mesh orders.
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
    let title =
        if last < last_order(wheel) { format!("Orders 1 to {last}") } else { "Order spectrum".to_owned() };
    let axes = Axes::titled(canvas, area, [0.0, last as f64 + 0.5], y, &title);
    legend(canvas, &axes, wheel);
    let teeth = wheel.teeth.max(1);
    let mesh_orders = Ticks::every(f64::from(teeth), 0.0, last as f64);
    let name = format!("Order of {}’s shaft (mesh orders {teeth}, {}, …)", wheel.called(), 2 * teeth);
    axes.x_axis(canvas, &mesh_orders, &name);
    amplitude_axis(canvas, &axes, 6, unit);
    // The rest first, so that no marked order is hidden.
    let spectrum = &wheel.record.order_spectrum;
    for marked in [false, true] {
        for (order, &amplitude) in spectrum.iter().enumerate().take(last + 1).skip(1) {
            let kind = LineKind::of(order, wheel);
            let height = amplitude.log10().min(y[1]);
            if (kind != LineKind::Difference) == marked && height > y[0] {
                let x = order as f64;
                canvas.line(axes.at(x, y[0]), axes.at(x, height), stroke(kind));
            }
        }
    }
    axes.frame(canvas);
}

fn stroke(kind: LineKind) -> Stroke {
    match kind {
        LineKind::Mesh => Stroke::solid(colour::BLUE, 2.2),
        LineKind::Sideband => Stroke::solid(colour::PURPLE, 1.8),
        LineKind::Other => Stroke::solid(colour::ORANGE, 2.0),
        LineKind::Shaft => Stroke::solid(colour::GREEN, 1.8),
        LineKind::Difference => REST,
    }
}

fn legend(canvas: &mut Canvas, axes: &Axes, wheel: &WheelView) {
    let sidebands = match wheel.sidebands {
        1 => "±1 sideband".to_owned(),
        count => format!("±{count} sidebands"),
    };
    let shaft = match wheel.low_orders {
        1 => "shaft order 1".to_owned(),
        last => format!("shaft orders 1–{last}"),
    };
    let entries = [
        (LineKind::Mesh, true, "mesh orders"),
        (LineKind::Sideband, wheel.sidebands > 0, &sidebands),
        (LineKind::Other, !(wheel.other_teeth.is_empty() && wheel.other_orders.is_empty()), "others"),
        (LineKind::Shaft, wheel.low_orders > 0, &shaft),
        (LineKind::Difference, true, "difference"),
    ];
    let shown = entries.into_iter().filter(|(_, is_there, _)| *is_there);
    let shown: Vec<Entry> = shown.map(|(kind, _, text)| (Sample::Line(stroke(kind)), text)).collect();
    axes.legend(canvas, &shown);
}
