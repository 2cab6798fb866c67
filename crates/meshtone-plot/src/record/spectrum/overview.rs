//! All orders: the largest amplitude in each mesh spacing, so that nothing is off the chart.

use super::{LineKind, amplitude_axis, last_order, low_orders};
use crate::drawing::{Area, Axes, Canvas, Colour, Fill, Sample, Stroke, TextStyle, Ticks, colour, number};
use crate::record::WheelView;

/// Of the regular part.
const REGULAR: Stroke = Stroke::solid(colour::BLUE, 1.2);
const DIFFERENCE: Fill = Fill::solid(Colour(0xc4_c4_c4));
/// The orders that are shown below.
const BELOW: Fill = Fill::tint(colour::GREEN, 0.25);
/// (px) Least width of a bin.
const BIN_WIDTH: f64 = 2.5;

/// One mesh spacing, or several, around a mesh order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bin {
    /// (orders) Where it begins and ends.
    ends: [f64; 2],
    /// Largest amplitude of mesh orders, sidebands and low shaft orders.
    pub(super) regular: f64,
    /// Largest amplitude of the others.
    pub(super) difference: f64,
}

/// All orders but 0, in bins.
pub(super) fn bins(wheel: &WheelView, width_px: f64) -> Vec<Bin> {
    let (last, teeth) = (last_order(wheel), wheel.teeth.max(1) as usize);
    let spacings = (last as f64 / (width_px / BIN_WIDTH) / teeth as f64).ceil().max(1.0) as usize;
    let (width, half) = (spacings * teeth, teeth.div_ceil(2));
    let mut bins: Vec<Bin> = Vec::new();
    for (order, &amplitude) in wheel.record.order_spectrum.iter().enumerate().take(last + 1).skip(1) {
        let begin = (order + teeth - half) / width * width;
        // Half an order before the first one of the bin; the very first begins at 0.
        let from = (begin as f64 + half as f64 - teeth as f64 - 0.5).max(0.0);
        if bins.last().is_none_or(|bin| bin.ends[0] < from) {
            bins.push(Bin { ends: [from, from], regular: 0.0, difference: 0.0 });
        }
        if let Some(bin) = bins.last_mut() {
            bin.ends[1] = order as f64 + 0.5;
            let largest = match LineKind::of(order, wheel) {
                LineKind::Difference => &mut bin.difference,
                _ => &mut bin.regular,
            };
            *largest = largest.max(amplitude);
        }
    }
    bins
}

pub(super) fn draw(canvas: &mut Canvas, area: Area, y: [f64; 2], wheel: &WheelView, unit: &str) {
    let last = last_order(wheel);
    let title = format!("Order spectrum, all {last} orders");
    let axes = Axes::titled(canvas, area, [0.0, last as f64 + 0.5], y, &title);
    let shown = low_orders::last(wheel, area.width);
    axes.band(canvas, 0.0, shown as f64 + 0.5, BELOW);
    let orders = Ticks::nice(0.0, last as f64, 10);
    let one = 10f64.powf((last as f64).log10().floor());
    let name = format!(
        "Order of {}’s shaft, the largest in each mesh spacing (order {one} is {} Hz at mean speed)",
        wheel.called(),
        number(one * wheel.mean_speed_hz)
    );
    axes.x_axis(canvas, &orders, &TextStyle::AXIS.fitted(&name, area.width));
    amplitude_axis(canvas, &axes, 3, unit);
    let height = |amplitude: f64| amplitude.log10().clamp(y[0], y[1]);
    let bins = bins(wheel, area.width);
    let bar = |bin: &Bin| [axes.at(bin.ends[0], height(bin.difference)), axes.at(bin.ends[1], y[0])];
    canvas.rectangles(&bins.iter().map(bar).collect::<Vec<_>>(), DIFFERENCE);
    let steps = bins.iter().flat_map(|bin| bin.ends.map(|end| axes.at(end, height(bin.regular))));
    canvas.polyline(&steps.collect::<Vec<_>>(), REGULAR);
    let entries = [
        (Sample::Area(BELOW), &*format!("shown below, {} of the power", share(wheel, shown))),
        (Sample::Line(REGULAR), "regular part"),
        (Sample::Area(DIFFERENCE), "difference"),
    ];
    axes.legend(canvas, &entries);
    axes.frame(canvas);
}

/// The part of the average's mean square that the orders 1 to `last` hold.
fn share(wheel: &WheelView, last: usize) -> String {
    let power = |last: usize| {
        let amplitudes = wheel.record.order_spectrum.iter().take(last + 1).skip(1);
        amplitudes.map(|amplitude| amplitude * amplitude).sum::<f64>()
    };
    match 100.0 * power(last) / power(last_order(wheel)) {
        percent if percent.is_nan() => "none".to_owned(),
        percent if percent >= 99.95 || (9.95..99.0).contains(&percent) => format!("{percent:.0} %"),
        percent if percent >= 0.1 => format!("{percent:.1} %"),
        _ => "less than 0.1 %".to_owned(),
    }
}
