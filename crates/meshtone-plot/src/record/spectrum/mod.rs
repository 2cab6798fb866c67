//! The order spectrum on a logarithmic scale: all orders, and below them the low ones, which can be distinguished.

mod low_orders;
mod overview;

use super::{NAME_LEFT, WheelView};
use crate::drawing::{Area, Axes, Canvas, Colour, Stroke, Ticks, axes};

/// Stroke of the difference.
const REST: Stroke = Stroke::solid(Colour(0x9a_9a_9a), 1.0);
/// (decades) What is shown below the largest amplitude, at least and at most.
const DECADES: [f64; 2] = [2.0, 4.0];
/// (px) Height of the axes with all orders.
const OVERVIEW_HEIGHT: f64 = 64.0;
/// (px) From these to those of the low orders.
const BETWEEN: f64 = 80.0;

/// (decades) Ranges of the amplitudes, for all wheels.
#[derive(Debug, Clone, Copy)]
pub(super) struct Amplitudes {
    low_orders: [f64; 2],
    overview: [f64; 2],
}

impl Amplitudes {
    pub(super) fn of(wheels: &[WheelView], width_px: f64) -> Self {
        let low_orders = wheels.iter().flat_map(|wheel| low_orders::amplitudes(wheel, width_px));
        let bins = wheels.iter().flat_map(|wheel| overview::bins(wheel, width_px));
        Self {
            low_orders: range(low_orders),
            overview: range(bins.flat_map(|bin| [bin.regular, bin.difference])),
        }
    }
}

/// Draws all orders above the low ones, or these alone where there are no others.
pub(super) fn draw(canvas: &mut Canvas, area: Area, amplitudes: &Amplitudes, wheel: &WheelView, unit: &str) {
    if low_orders::last(wheel, area.width) >= last_order(wheel) {
        low_orders::draw(canvas, area, amplitudes.low_orders, wheel, unit);
        return;
    }
    let above = Area { height: OVERVIEW_HEIGHT, ..area };
    let top = above.bottom() + BETWEEN;
    let below = Area { top, height: area.bottom() - top, ..area };
    overview::draw(canvas, above, amplitudes.overview, wheel, unit);
    low_orders::draw(canvas, below, amplitudes.low_orders, wheel, unit);
}

/// The last order that the recording holds.
fn last_order(wheel: &WheelView) -> usize {
    let nyquist = wheel.record.average.nyquist_order.floor() as usize;
    nyquist.min(wheel.record.order_spectrum.len().saturating_sub(1))
}

/// Kind of an order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum LineKind {
    Mesh,
    Sideband,
    /// Of another mesh, a sideband of it, or of another shaft.
    Other,
    Shaft,
    Difference,
}

impl LineKind {
    fn of(order: usize, wheel: &WheelView) -> Self {
        // How far from a mesh order, where that is near enough for a sideband.
        let beside = |teeth: usize| {
            let teeth = teeth.max(1);
            let off = order.min(order % teeth).min(teeth - order % teeth);
            let beyond_first = order + wheel.sidebands >= teeth;
            (off == 0 || beyond_first && off <= wheel.sidebands).then_some(off)
        };
        let is_other = |orders: &usize| order.is_multiple_of((*orders).max(1));
        match beside(wheel.teeth as usize) {
            Some(0) => Self::Mesh,
            Some(_) => Self::Sideband,
            None if wheel.other_teeth.iter().any(|teeth| beside(*teeth).is_some()) => Self::Other,
            None if wheel.other_orders.iter().any(is_other) => Self::Other,
            None if order <= wheel.low_orders => Self::Shaft,
            None => Self::Difference,
        }
    }
}

/// From a little above the largest down to where the smallest twentieth ends, within [`DECADES`].
fn range(amplitudes: impl Iterator<Item = f64>) -> [f64; 2] {
    let positive = amplitudes.filter(|amplitude| *amplitude > 0.0 && axes::drawable(*amplitude));
    let mut logs: Vec<f64> = positive.map(f64::log10).collect();
    logs.sort_by(f64::total_cmp);
    let Some(&largest) = logs.last() else { return [-1.0, 1.0] };
    let small = logs[logs.len() / 20];
    [small.clamp(largest - DECADES[1], largest - DECADES[0]) - 0.1, largest + 0.2]
}

/// The logarithmic axis of the amplitudes, with at most `most` numbers.
fn amplitude_axis(canvas: &mut Canvas, axes: &Axes, most: usize, unit: &str) {
    let decades = Ticks::decades(axes.y).thinned(most);
    axes.y_axis(canvas, &decades, &format!("Amplitude ({unit})"), NAME_LEFT);
}
