//! The error over the fault-to-harmonics ratio and the noise level.

use meshtone::tuning::{Enhancement, HybridError};

use super::data::Data;
use super::heading::short;
use super::symbols::ENHANCED;
use crate::drawing::{Area, Axes, Canvas, Fill, Pixel, Sample, Stroke, Ticks, axes, bands, colour, legend};

/// Ends of the bands, over the best error. Narrow at first: the valley is flat.
const BANDS: [f64; 9] = [1.02, 1.05, 1.1, 1.2, 1.35, 1.6, 2.0, 3.0, 5.0];
/// Errors below this count as this much for the bands.
const LEAST_BASE: f64 = 0.005;
/// The range around the best point, at least this factor on either side.
const AROUND: f64 = 4.0;
/// Ratio of the range to the interval.
const BEYOND: f64 = 1.25;
/// Places at which the error is computed, along each axis.
const NODES: usize = 72;
/// (px) Between them the error is interpolated for squares of this size.
const CELL: f64 = 1.0;
/// (px) So much squares overlap, lest lines show between them.
const OVERLAP: f64 = 0.3;
const HALO: Stroke = Stroke::solid(colour::WHITE, 3.6);
const INTERVAL: Stroke = Stroke::dashed(colour::INK, 1.4, &[6.0, 3.0]);
const UNIT_RATIO: Stroke = Stroke::dashed(colour::INK, 1.2, &[1.5, 3.0]);

pub(super) fn draw(canvas: &mut Canvas, area: Area, data: &Data) -> Result<(), HybridError> {
    let Enhancement { width_ratio, fault_to_harmonics_ratio, noise_level } = data.tuning.enhancement;
    let (bounds, intervals) = (&data.experiment.bounds, &data.tuning.intervals);
    let x =
        range(fault_to_harmonics_ratio, intervals.fault_to_harmonics_ratio, bounds.fault_to_harmonics_ratio);
    let y = range(noise_level, intervals.noise_level, bounds.noise_level);
    let title = format!("Mean error at the width ratio {}", short(width_ratio));
    let axes = Axes::titled(canvas, area, x, y, &title);
    axes.x_axis(canvas, &Ticks::of_logarithms(x[0], x[1]), "Fault-to-harmonics ratio α (–)");
    axes.y_axis(canvas, &Ticks::of_logarithms(y[0], y[1]), "Noise level ν (–)", super::NAME_LEFT);
    let grid = Grid::new(data, &axes)?;
    let base = data.tuning.enhanced_error.max(LEAST_BASE);
    // The good places are few: they are dark on a pale ground.
    let mut colours = bands::COLOURS;
    colours.reverse();
    canvas.rectangle((area.left, area.top), (area.right(), area.bottom()), Fill::solid(colours[0]));
    for (band, factor) in BANDS.iter().enumerate() {
        canvas.rectangles(&grid.above(area, factor * base), Fill::solid(colours[band + 1]));
    }
    marks(canvas, &axes, data);
    axes.frame(canvas);
    let ends: Vec<String> = BANDS.iter().map(|factor| short(factor * base)).collect();
    bands::bar(canvas, area, "Error (σ)", (&colours, &ends));
    let entries = [
        (Sample::Marker(None, ENHANCED.marker), "chosen"),
        (Sample::Line(INTERVAL), "95 % intervals"),
        (Sample::Line(UNIT_RATIO), "α = 1"),
    ];
    legend::row(canvas, (area.right(), area.bottom() + axes::NAME_BELOW + 24.0), &entries);
    Ok(())
}

/// Decadic logarithms of the range that is drawn.
fn range(best: f64, interval: [f64; 2], bounds: [f64; 2]) -> [f64; 2] {
    let low = (best / AROUND).min(interval[0] / BEYOND).max(bounds[0]);
    let high = (best * AROUND).max(interval[1] * BEYOND).min(bounds[1]);
    logarithms(best, [low, high])
}

/// Decadic logarithms of a parameter's range; around the best one where it is held and has no range.
pub(super) fn logarithms(best: f64, [low, high]: [f64; 2]) -> [f64; 2] {
    if low < high { [low, high] } else { [best / 2.0, best * 2.0] }.map(f64::log10)
}

/// Errors at equal distances of both logarithms.
struct Grid {
    errors: Vec<f64>,
}

impl Grid {
    fn new(data: &Data, axes: &Axes) -> Result<Self, HybridError> {
        let at = |[low, high]: [f64; 2], k: usize| {
            10f64.powf(low + (high - low) * k as f64 / (NODES as f64 - 1.0))
        };
        let mut errors = Vec::with_capacity(NODES * NODES);
        for row in 0..NODES {
            for column in 0..NODES {
                errors.push(data.error(&Enhancement {
                    fault_to_harmonics_ratio: at(axes.x, column),
                    noise_level: at(axes.y, row),
                    ..data.tuning.enhancement
                })?);
            }
        }
        Ok(Self { errors })
    }

    /// Between the nodes.
    ///
    /// # Arguments
    /// * `x`, `y` - places from 0 to 1
    fn at(&self, x: f64, y: f64) -> f64 {
        let last = NODES - 2;
        let split = |place: f64| {
            let scaled = place * (NODES as f64 - 1.0);
            let below = (scaled as usize).min(last);
            (below, scaled - below as f64)
        };
        let ((column, dx), (row, dy)) = (split(x), split(y));
        let node = |row: usize, column: usize| self.errors[row * NODES + column];
        let along = |row: usize| node(row, column) * (1.0 - dx) + node(row, column + 1) * dx;
        along(row) * (1.0 - dy) + along(row + 1) * dy
    }

    /// Rectangles in which the error exceeds a limit, row by row.
    fn above(&self, area: Area, limit: f64) -> Vec<[Pixel; 2]> {
        let [columns, rows] = [area.width, area.height].map(|size| (size / CELL).round() as usize);
        let mut runs = Vec::new();
        for row in 0..rows {
            let y = 1.0 - (row as f64 + 0.5) / rows as f64;
            // An error that is not a number is no good error.
            let exceeds = |column: &usize| {
                let error = self.at((*column as f64 + 0.5) / columns as f64, y);
                error > limit || error.is_nan()
            };
            let top = area.top + row as f64 * CELL;
            let bottom = (top + CELL + OVERLAP).min(area.bottom());
            let mut column = 0;
            while let Some(first) = (column..columns).find(exceeds) {
                let end = (first..columns).find(|column| !exceeds(column)).unwrap_or(columns);
                let [left, right] = [first, end].map(|column| area.left + column as f64 * CELL);
                runs.push([(left, top), (right, bottom)]);
                column = end;
            }
        }
        runs
    }
}

fn marks(canvas: &mut Canvas, axes: &Axes, data: &Data) {
    let clamped = |value: f64, [low, high]: [f64; 2]| value.log10().clamp(low, high);
    if axes.x[0] < 0.0 && axes.x[1] > 0.0 {
        let [from, to] = axes.y.map(|y| axes.at(0.0, y));
        canvas.line(from, to, HALO);
        canvas.line(from, to, UNIT_RATIO);
    }
    let intervals = &data.tuning.intervals;
    let [left, right] = intervals.fault_to_harmonics_ratio.map(|value| clamped(value, axes.x));
    let [low, high] = intervals.noise_level.map(|value| clamped(value, axes.y));
    let corners = [(left, low), (right, low), (right, high), (left, high), (left, low)];
    let corners = corners.map(|(x, y)| axes.at(x, y));
    canvas.polyline(&corners, HALO);
    canvas.polyline(&corners, INTERVAL);
    let Enhancement { fault_to_harmonics_ratio, noise_level, .. } = data.tuning.enhancement;
    let best = axes.at(clamped(fault_to_harmonics_ratio, axes.x), clamped(noise_level, axes.y));
    ENHANCED.marker.draw(canvas, best);
}
