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
    /// What the horizontal axis is.
    pub along: Along,
    /// Names of the wheels: one, or both of a pair.
    pub wheels: &'a [String],
    /// For each wheel where its records lie along that axis, record by record.
    pub places: &'a [Vec<f64>],
    /// Up to nine indicators.
    pub indicators: Vec<Trend>,
}

/// What records lie along.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Along {
    /// Recordings by their numbers from 1; what is cut from one lies within half a number of it.
    Recordings {
        /// How many.
        count: usize,
    },
    /// The time of one recording.
    Time {
        /// (s) Its start.
        start_s: f64,
        /// (s) Its end.
        end_s: f64,
    },
}

impl Along {
    fn range(self) -> [f64; 2] {
        match self {
            Self::Recordings { count } => [0.5, count.max(1) as f64 + 0.5],
            Self::Time { start_s, end_s } => [start_s, end_s],
        }
    }

    fn ticks(self) -> Ticks {
        let [from, to] = self.range();
        match self {
            Self::Recordings { .. } => Ticks::whole(from, to, 12),
            Self::Time { .. } => Ticks::nice(from, to, 8),
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Recordings { .. } => "Recording",
            Self::Time { .. } => "Time (s)",
        }
    }
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
/// use meshtone_plot::trend::{self, Along, Trend, TrendFigure};
///
/// let fm4 = Trend { name: "FM4".to_owned(), unit: String::new(), values: vec![vec![Some(3.0), None, Some(5.0)]] };
/// let figure = TrendFigure {
///     title: "bearing",
///     facts: &["3 recordings".to_owned()],
///     along: Along::Recordings { count: 3 },
///     wheels: &["wheel".to_owned()],
///     places: &[vec![1.0, 2.0, 3.0]],
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
        indicator(&mut canvas, area, trend, figure);
    }
    canvas.finish(figure.title, &format!("Indicators over a series of records. {}.", figure.facts.join(", ")))
}

fn indicator(canvas: &mut Canvas, area: Area, trend: &Trend, figure: &TrendFigure) {
    let y = axes::range(trend.values.iter().flatten().filter_map(|value| *value), MARGIN);
    let axes = Axes::new(area, figure.along.range(), y);
    axes.title(canvas, &trend.name);
    axes.x_axis(canvas, &figure.along.ticks(), figure.along.name());
    let name = if trend.unit.is_empty() { "(–)".to_owned() } else { format!("({})", trend.unit) };
    axes.y_axis(canvas, &Ticks::nice(y[0], y[1], 5), &name, NAME_LEFT);
    if trend.values.iter().flatten().all(Option::is_none) {
        axes.note(canvas, "not defined for these records");
    }
    let is_marked = trend.values.iter().all(|values| values.len() <= MARKED);
    for ((values, places), stroke) in trend.values.iter().zip(figure.places).zip(STROKES) {
        let records: Vec<(f64, Option<f64>)> = places.iter().copied().zip(values.iter().copied()).collect();
        for run in records.split(|(_, value)| value.is_none()) {
            axes.line(canvas, run.iter().filter_map(|(x, value)| Some((*x, (*value)?))), stroke);
        }
        let defined = records.iter().filter_map(|(x, value)| Some((*x, (*value)?)));
        for (x, value) in defined.filter(|_| is_marked) {
            marker(canvas, axes.at(x, value), stroke.colour);
        }
    }
    axes.frame(canvas);
}

fn marker(canvas: &mut Canvas, (x, y): Pixel, colour: Colour) {
    const HALF: f64 = 3.0;
    canvas.rectangle((x - HALF, y - HALF), (x + HALF, y + HALF), Fill::solid(colour));
}
