//! The error against the width ratio.

use std::sync::atomic::AtomicBool;

use meshtone::tuning::{Enhancement, EnhancementBounds, HybridError, fit};

use super::data::Data;
use super::surface::logarithms;
use super::symbols::{ENHANCED, MEDIAN};
use crate::drawing::{Area, Axes, Canvas, Fill, Sample, Stroke, TextStyle, Ticks, axes, colour, legend};

const PLACES: usize = 160;
/// Width ratios at which the other parameters are searched anew.
const FITS: usize = 33;
const MARGIN: f64 = 0.06;
const ADJUSTED: Stroke = Stroke::dashed(colour::BLUE, 1.6, &[7.0, 3.0]);
const FLOOR: Stroke = Stroke { width: 1.6, ..MEDIAN };
const INTERVAL: Fill = Fill::tint(colour::MUTED, 0.16);
/// (px) Above the frame: title, then two rows of the legend.
const LEGEND_ROW: f64 = 18.0;

pub(super) fn draw(canvas: &mut Canvas, area: Area, data: &Data) -> Result<(), HybridError> {
    let bounds = &data.experiment.bounds;
    let best = data.tuning.enhancement.width_ratio;
    let x = logarithms(best, bounds.width_ratio);
    let held =
        curve(x, PLACES, |width_ratio| data.error(&Enhancement { width_ratio, ..data.tuning.enhancement }))?;
    let never = AtomicBool::new(false);
    let adjusted = curve(x, FITS, |width_ratio| {
        let bounds = EnhancementBounds { width_ratio: [width_ratio; 2], ..*bounds };
        Ok(fit(data.result.simulated(), data.measured(), &bounds, None, &never)?.error)
    })?;
    let errors = held.iter().chain(&adjusted).map(|(_, error)| *error);
    let [_, most] = axes::range(errors.chain([data.tuning.scatter]), MARGIN);
    let axes = Axes::new(area, x, [0.0, most]);
    let [from, to] = data.tuning.intervals.width_ratio.map(f64::log10);
    axes.band(canvas, from, to, INTERVAL);
    axes.x_axis(canvas, &Ticks::of_logarithms(x[0], x[1]), "Width ratio w (–)");
    axes.y_axis(canvas, &Ticks::nice(0.0, most, 6), "Mean error (σ)", super::NAME_LEFT);
    axes.horizontal(canvas, data.tuning.scatter, FLOOR);
    axes.line(canvas, adjusted.iter().copied(), ADJUSTED);
    axes.line(canvas, held.iter().copied(), ENHANCED.stroke);
    let chosen = axes.at(best.log10().clamp(x[0], x[1]), data.tuning.enhanced_error);
    ENHANCED.marker.draw(canvas, chosen);
    axes.frame(canvas);
    key(canvas, area);
    Ok(())
}

/// Errors at equal distances of the width ratio's logarithm.
fn curve(
    x: [f64; 2],
    places: usize,
    error: impl Fn(f64) -> Result<f64, HybridError>,
) -> Result<Vec<(f64, f64)>, HybridError> {
    (0..places)
        .map(|k| {
            let place = x[0] + (x[1] - x[0]) * k as f64 / (places as f64 - 1.0);
            Ok((place, error(10f64.powf(place))?))
        })
        .collect()
}

fn key(canvas: &mut Canvas, area: Area) {
    let title = (area.left, area.top - axes::TITLE_ABOVE - 2.0 * LEGEND_ROW);
    canvas.text(title, "Mean error against the width ratio", TextStyle::AXES_TITLE);
    let curves = [(ENHANCED.sample(), "α and ν as chosen"), (Sample::Line(ADJUSTED), "α and ν adjusted")];
    let limits =
        [(Sample::Area(INTERVAL), "95 % interval"), (Sample::Line(FLOOR), "measurements’ own scatter")];
    for (row, entries) in [curves, limits].into_iter().enumerate() {
        let baseline = area.top - axes::TITLE_ABOVE - LEGEND_ROW * (1.0 - row as f64);
        legend::row(canvas, (area.right(), baseline), &entries);
    }
}
