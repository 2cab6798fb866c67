//! The orders of a shaft over the time of a run-up.

use meshtone::signal::OrderMap;

use crate::Figure;
use crate::drawing::{
    Area, Axes, Canvas, EDGE, Fill, NAME_LEFT, Pixel, Stroke, TextStyle, Ticks, axes, bands, colour,
    described,
};

const HEIGHT: u32 = 900;
const MAP: Area = Area::new(84.0, 118.0, 1140.0, 710.0);
const SPEED: Area = Area::new(1356.0, 118.0, 212.0, 710.0);
/// (px) Width of a column of the map.
const COLUMN: f64 = 2.0;
/// (px) So much rectangles overlap, lest lines show between them.
const OVERLAP: f64 = 0.3;
/// (px) Room for the quantity above the bar of the bands.
const QUANTITY_WIDTH: f64 = 100.0;
const CURVE: Stroke = Stroke::solid(colour::BLUE, 1.5);

/// Content of the figure.
#[derive(Debug, Clone, Copy)]
pub struct OrderMapFigure<'a> {
    /// Title: what was recorded, and which channel.
    pub title: &'a str,
    /// Facts in the line below it.
    pub facts: &'a [String],
    /// Unit of the amplitudes, where it is known.
    pub unit: Option<&'a str>,
    /// Name of the wheel on the shaft, such as `pinion`.
    pub wheel: &'a str,
    /// Its teeth.
    pub teeth: u32,
    /// (s) Time of the recording's first sample.
    pub start_s: f64,
    /// The map, whose last order bounds the figure.
    pub map: &'a OrderMap,
}

/// Draws the amplitudes over order and time, and the speed of the shaft beside them.
///
/// # Arguments
/// * `figure` - what it shows
///
/// ```
/// use meshtone::signal::{OrderMapSettings, ShaftPhase, order_map};
/// use meshtone_plot::order_map::{self, OrderMapFigure};
///
/// let phase = ShaftPhase::from_speed_profile(&[0.0, 4.0], &[5.0, 15.0], 4000.0, 16_001)?;
/// let signal: Vec<f64> = phase.revolutions.iter().map(|r| (std::f64::consts::TAU * 19.0 * r).cos()).collect();
/// let map = order_map(&signal, &phase, 4000.0, &OrderMapSettings::default())?;
/// let figure = OrderMapFigure { title: "run.csv: bearing", facts: &[], unit: Some("g"), wheel: "wheel", teeth: 19, start_s: 0.0, map: &map };
/// assert!(order_map::draw(&figure).svg().contains("Order of the wheel"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn draw(figure: &OrderMapFigure) -> Figure {
    let OrderMapFigure { title, facts, wheel, teeth, map, .. } = *figure;
    let unit = figure.unit.filter(|unit| !unit.is_empty());
    let quantity = unit.map_or_else(|| "Amplitude".to_owned(), |unit| format!("Amplitude ({unit})"));
    let quantity = TextStyle::TICK.fitted(&quantity, QUANTITY_WIDTH);
    let mut canvas = Canvas::page(HEIGHT, EDGE, title, facts);
    let times_s: Vec<f64> = map.times_s.iter().map(|time_s| figure.start_s + time_s).collect();
    let edges_s = edges(&times_s);
    let time = axes::time_range([edges_s[0], edges_s[times_s.len()]]);
    let lines = map.amplitudes.iter().map(Vec::len).min().unwrap_or(0);
    let highest = map.order(lines.saturating_sub(1)).max(1.0);
    let named = format!("Amplitude over order and time, in parts of {} revolutions", map.revolutions);
    let axes = Axes::titled(&mut canvas, MAP, [0.0, highest], time, &named);
    let ends = band_ends(map);
    for (band, end) in ends.iter().enumerate() {
        canvas.rectangles(&above(map, &axes, &edges_s, *end), Fill::solid(bands::COLOURS[band + 1]));
    }
    let ticks = Ticks::every(f64::from(teeth.max(1)), 0.0, highest);
    axes.x_numbers(&mut canvas, &ticks);
    axes.x_name(
        &mut canvas,
        &format!("Order of the {wheel}’s shaft (mesh orders {teeth}, {}, …)", 2 * teeth),
    );
    let seconds = Ticks::nice(time[0], time[1], 10);
    axes.y_axis(&mut canvas, &seconds, "Time (s)", NAME_LEFT);
    axes.frame(&mut canvas);
    let words: Vec<String> = ends.iter().map(|end| crate::drawing::number(*end)).collect();
    bands::bar(&mut canvas, MAP, &quantity, (&bands::COLOURS, &words));
    speed(&mut canvas, wheel, (time, &seconds), &times_s, &map.speeds_hz);
    let what = format!(
        "Amplitudes of a recording over the order of the {wheel}’s shaft and over time, and the shaft’s speed."
    );
    canvas.finish(title, &described(&what, facts))
}

/// The shaft's speed with the map's axis of time.
fn speed(
    canvas: &mut Canvas,
    wheel: &str,
    (time, seconds): ([f64; 2], &Ticks),
    times_s: &[f64],
    speeds_hz: &[f64],
) {
    let largest = axes::largest(speeds_hz);
    let axes =
        Axes::titled(canvas, SPEED, [0.0, if largest > 0.0 { 1.1 * largest } else { 1.0 }], time, "Speed");
    axes.x_axis(canvas, &Ticks::nice(0.0, axes.x[1], 4), &format!("Speed of the {wheel} (Hz)"));
    axes.y_grid(canvas, seconds);
    let points = speeds_hz.iter().copied().zip(times_s.iter().copied());
    canvas.polyline(&axes.along_y(points), CURVE);
    axes.frame(canvas);
}

/// (s) Times between the parts, and half a step before the first and after the last.
fn edges(times_s: &[f64]) -> Vec<f64> {
    let Some((first, last)) = times_s.first().zip(times_s.last()) else { return vec![0.0; 1] };
    let between: Vec<f64> = times_s.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
    let before = between.first().map_or(first - 0.5, |edge| 2.0 * first - edge);
    let after = between.last().map_or(last + 0.5, |edge| 2.0 * last - edge);
    [vec![before], between, vec![after]].concat()
}

/// The amplitudes between two bands each, rising by equal factors from above the noise floor, or from a thousandth of the largest.
fn band_ends(map: &OrderMap) -> Vec<f64> {
    const ABOVE_FLOOR: f64 = 1.5;
    let mut all: Vec<f64> =
        map.amplitudes.iter().flatten().copied().filter(|line| axes::drawable(*line)).collect();
    let largest = axes::largest(&all);
    if largest <= 0.0 {
        return Vec::new();
    }
    let middle = all.len() / 2;
    let median = *all.select_nth_unstable_by(middle, f64::total_cmp).1;
    let lowest = (ABOVE_FLOOR * median).clamp(1e-3 * largest, 0.5 * largest);
    let ends = bands::COLOURS.len() - 1;
    let end = |band: usize| two_digits(lowest * (largest / lowest).powf(band as f64 / ends as f64));
    (0..ends).map(end).collect()
}

fn two_digits(value: f64) -> f64 {
    let unit = 10f64.powf(value.log10().floor() - 1.0);
    (value / unit).round() * unit
}

/// Rectangles in which the largest amplitude of a column's orders is above a limit, part by part.
fn above(map: &OrderMap, axes: &Axes, edges_s: &[f64], limit: f64) -> Vec<[Pixel; 2]> {
    let area = axes.area;
    let columns = (area.width / COLUMN).round() as usize;
    let line_at = |column: usize| {
        let order = axes.x[1] * column as f64 / columns as f64;
        (order * map.revolutions as f64).round() as usize
    };
    let mut runs = Vec::new();
    for (part, amplitudes) in map.amplitudes.iter().enumerate() {
        let [bottom, top] = [edges_s[part], edges_s[part + 1]].map(|time_s| axes.py(time_s));
        let exceeds = |column: &usize| {
            let (from, until) = (line_at(*column), line_at(column + 1).max(line_at(*column) + 1));
            amplitudes
                .get(from..until.min(amplitudes.len()))
                .is_some_and(|lines| lines.iter().any(|line| *line > limit))
        };
        let mut column = 0;
        while let Some(first) = (column..columns).find(exceeds) {
            let end = (first..columns).find(|column| !exceeds(column)).unwrap_or(columns);
            let [left, right] = [first, end].map(|column| area.left + column as f64 * COLUMN);
            runs.push([(left, top), (right, (bottom + OVERLAP).min(area.bottom()))]);
            column = end;
        }
    }
    runs
}
