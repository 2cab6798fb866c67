//! Indicators over a series of records.

use crate::Figure;
use crate::axes::{self, Area, Axes};
use crate::canvas::{Canvas, Pixel};
use crate::legend::{self, Entry, Sample};
use crate::style::{Colour, Fill, Stroke, TextStyle, colour};
use crate::text::fitted;
use crate::ticks::Ticks;

/// (px) Size of the figure.
pub const WIDTH: u32 = 1600;
/// (px) Size of the figure.
pub const HEIGHT: u32 = 1000;

const COLUMNS: usize = 3;
const LEFT: f64 = 84.0;
const TOP: f64 = 118.0;
const PLOT: [f64; 2] = [430.0, 208.0];
const STEP: [f64; 2] = [531.0, 298.0];
const NAME_LEFT: f64 = 56.0;
const MARGIN: f64 = 0.08;
const EDGE: f64 = LEFT - NAME_LEFT - 11.0;
/// Beyond this many records every marker would touch the next.
const MARKED: usize = 60;
const STROKES: [Stroke; 2] = [Stroke::solid(colour::BLUE, 1.5), Stroke::solid(colour::PURPLE, 1.5)];

/// What the figure shows.
#[derive(Debug, Clone)]
pub struct TrendFigure<'a> {
    /// Title: what was recorded, and which channel.
    pub title: &'a str,
    /// Facts in the line below it.
    pub facts: &'a [String],
    /// What is counted along the horizontal axis, such as `Recording`.
    pub counted: &'a str,
    /// Names of the wheels: one, or both of a pair.
    pub wheels: &'a [String],
    /// Up to nine indicators.
    pub indicators: Vec<Trend>,
}

/// One indicator over the records.
#[derive(Debug, Clone, PartialEq)]
pub struct Trend {
    /// Its name.
    pub name: String,
    /// Its unit; empty for a plain number.
    pub unit: String,
    /// For each wheel its values, record by record; none where it is not defined.
    pub values: Vec<Vec<Option<f64>>>,
}

/// Draws indicators over the records of a series.
///
/// # Arguments
/// * `figure` - what it shows
///
/// ```
/// use meshtone_plot::trend::{self, Trend, TrendFigure};
///
/// let fm4 = Trend { name: "FM4".to_owned(), unit: String::new(), values: vec![vec![Some(3.0), None, Some(5.0)]] };
/// let figure = TrendFigure {
///     title: "bearing",
///     facts: &["3 recordings".to_owned()],
///     counted: "Recording",
///     wheels: &["wheel".to_owned()],
///     indicators: vec![fm4],
/// };
/// assert!(trend::draw(&figure).svg().contains("FM4"));
/// ```
pub fn draw(figure: &TrendFigure) -> Figure {
    let mut canvas = Canvas::new(WIDTH, HEIGHT);
    let width = f64::from(WIDTH) - 2.0 * EDGE;
    let title = fitted(figure.title, TextStyle::TITLE, width - 420.0);
    canvas.text((EDGE, 36.0), &title, TextStyle::TITLE);
    let facts = figure.facts.join("  ·  ");
    canvas.text((EDGE, 61.0), &fitted(&facts, TextStyle::FACTS, width), TextStyle::FACTS);
    let right = LEFT + STEP[0] * (COLUMNS as f64 - 1.0) + PLOT[0];
    let entries: Vec<Entry> = figure
        .wheels
        .iter()
        .zip(STROKES)
        .map(|(name, stroke)| Entry { sample: Sample::Line(stroke), text: name })
        .collect();
    legend::row(&mut canvas, (right, 34.0), &entries);
    for (place, trend) in figure.indicators.iter().take(COLUMNS * COLUMNS).enumerate() {
        let (row, column) = ((place / COLUMNS) as f64, (place % COLUMNS) as f64);
        let area = Area::new(LEFT + column * STEP[0], TOP + row * STEP[1], PLOT[0], PLOT[1]);
        indicator(&mut canvas, area, trend, figure.counted);
    }
    canvas.finish(figure.title, &format!("Indicators over a series of records. {}.", figure.facts.join(", ")))
}

fn indicator(canvas: &mut Canvas, area: Area, trend: &Trend, counted: &str) {
    let records = trend.values.iter().map(Vec::len).max().unwrap_or(0).max(1);
    let y = axes::range(trend.values.iter().flatten().filter_map(|value| *value), MARGIN);
    let axes = Axes::new(area, [0.5, records as f64 + 0.5], y);
    axes.title(canvas, &trend.name);
    axes.x_axis(canvas, &Ticks::whole(0.5, records as f64 + 0.5, 12), counted);
    let name = if trend.unit.is_empty() { "(–)".to_owned() } else { format!("({})", trend.unit) };
    axes.y_axis(canvas, &Ticks::nice(y[0], y[1], 5), &name, NAME_LEFT);
    if trend.values.iter().flatten().all(Option::is_none) {
        axes.note(canvas, "not defined for these records");
    }
    for (values, stroke) in trend.values.iter().zip(STROKES) {
        for run in values.iter().enumerate().collect::<Vec<_>>().split(|(_, value)| value.is_none()) {
            let points = run.iter().filter_map(|(k, value)| Some((*k as f64 + 1.0, (**value)?)));
            axes.line(canvas, points, stroke);
        }
        let defined = values.iter().enumerate().filter_map(|(k, value)| Some((k as f64 + 1.0, (*value)?)));
        for (x, value) in defined.filter(|_| records <= MARKED) {
            marker(canvas, axes.at(x, value), stroke.colour);
        }
    }
    axes.frame(canvas);
}

fn marker(canvas: &mut Canvas, (x, y): Pixel, colour: Colour) {
    const HALF: f64 = 3.0;
    canvas.rectangle((x - HALF, y - HALF), (x + HALF, y + HALF), Fill::solid(colour));
}
