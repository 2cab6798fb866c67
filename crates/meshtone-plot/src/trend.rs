//! Indicators over a series of records.

use crate::Figure;
use crate::drawing::{
    Area, Axes, Canvas, EDGE, Entry, Fill, NAME_LEFT, Sample, Stroke, TextStyle, Ticks, WIDTH, axes, colour,
    described, legend,
};

const HEIGHT: u32 = 1000;
const PLOTS: Area = Area::new(84.0, 118.0, 1492.0, 804.0);
/// (px) Between columns and between rows of plots.
const GAP: [f64; 2] = [101.0, 90.0];
/// (px) For the legend beside the title.
const LEGEND_WIDTH: f64 = 420.0;
const MARGIN: f64 = 0.08;
/// Beyond this many records every marker would touch the next.
const MARKED: usize = 60;
/// (px) Half of a marker's size.
const HALF_MARKER: f64 = 3.0;
/// Of the wheels, one after the other; from the seventh on again the first.
const STROKES: [Stroke; 6] = [
    Stroke::solid(colour::BLUE, 1.5),
    Stroke::solid(colour::PURPLE, 1.5),
    Stroke::solid(colour::GREEN, 1.5),
    Stroke::solid(colour::ORANGE, 1.5),
    Stroke::solid(colour::VERMILLION, 1.5),
    Stroke::solid(colour::INK, 1.5),
];

/// Recordings with a line of the grid each; of more every second or third has one.
const MOST_TICKS: usize = 50;
/// (px) Dashes of a limit, and gaps between them.
const DASH: &[f64] = &[6.0, 4.0];

/// Content of the figure.
#[derive(Debug, Clone)]
pub struct TrendFigure<'a> {
    /// Title: what was recorded, and which channel.
    pub title: &'a str,
    /// Facts in the line below it.
    pub facts: &'a [String],
    /// Quantity of the horizontal axis.
    pub along: Along<'a>,
    /// Names of the wheels.
    pub wheels: &'a [String],
    /// For each wheel where its records lie along that axis, record by record.
    pub places: &'a [Vec<f64>],
    /// Up to nine indicators.
    pub indicators: Vec<Trend>,
}

/// Quantity along which records lie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Along<'a> {
    /// Recordings, at whole numbers from 1; what is cut from one lies within half a number of it.
    Recordings {
        /// Their names or dates.
        names: &'a [String],
    },
    /// The time of one recording.
    Time {
        /// (s) Its start.
        start_s: f64,
        /// (s) Its end.
        end_s: f64,
    },
}

impl Along<'_> {
    /// Range, ticks and name of the horizontal axis.
    fn axis(self) -> ([f64; 2], Ticks, &'static str) {
        match self {
            Self::Recordings { names } => {
                ([0.5, names.len().max(1) as f64 + 0.5], Ticks::named(names).thinned(MOST_TICKS), "Recording")
            }
            Self::Time { start_s, end_s } => ([start_s, end_s], Ticks::nice(start_s, end_s, 8), "Time (s)"),
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
    /// For each wheel the limit above which it is unusual, where there is one.
    pub limits: Vec<Option<f64>>,
}

/// Draws indicators over the records of a series.
///
/// # Arguments
/// * `figure` - what it shows
///
/// ```
/// use meshtone_plot::trend::{self, Along, Trend, TrendFigure};
///
/// let fm4 = Trend { name: "FM4".to_owned(), unit: String::new(), values: vec![vec![Some(3.0), None, Some(5.0)]], limits: Vec::new() };
/// let figure = TrendFigure {
///     title: "bearing",
///     facts: &["3 recordings".to_owned()],
///     along: Along::Recordings { names: &["may", "june", "july"].map(str::to_owned) },
///     wheels: &["wheel".to_owned()],
///     places: &[vec![1.0, 2.0, 3.0]],
///     indicators: vec![fm4],
/// };
/// assert!(trend::draw(&figure).svg().contains("FM4"));
/// ```
pub fn draw(figure: &TrendFigure) -> Figure {
    let title = TextStyle::TITLE.fitted(figure.title, f64::from(WIDTH) - 2.0 * EDGE - LEGEND_WIDTH);
    let mut canvas = Canvas::page(HEIGHT, EDGE, &title, figure.facts);
    let named = figure.wheels.iter().zip(STROKES.into_iter().cycle());
    let entries: Vec<Entry> = named.map(|(name, stroke)| (Sample::Line(stroke), name.as_str())).collect();
    legend::row(&mut canvas, (PLOTS.right(), 34.0), &entries);
    for (trend, area) in figure.indicators.iter().zip(PLOTS.grid([3, 3], GAP, f64::INFINITY)) {
        indicator(&mut canvas, area, trend, figure);
    }
    canvas.finish(figure.title, &described("Indicators over a series of records.", figure.facts))
}

fn indicator(canvas: &mut Canvas, area: Area, trend: &Trend, figure: &TrendFigure) {
    let limits = trend.limits.iter().copied().flatten();
    let y = axes::range(trend.values.iter().flatten().filter_map(|value| *value).chain(limits), MARGIN);
    let (x, ticks, along) = figure.along.axis();
    let unit = if trend.unit.is_empty() { "–" } else { &trend.unit };
    let axes = Axes::titled(canvas, area, x, y, &format!("{} ({unit})", trend.name));
    axes.x_axis(canvas, &ticks, along);
    axes.y_axis(canvas, &Ticks::nice(y[0], y[1], 5), "", NAME_LEFT);
    if trend.values.iter().flatten().all(Option::is_none) {
        axes.note(canvas, "not defined for these records");
    }
    for (limit, stroke) in trend.limits.iter().zip(STROKES.into_iter().cycle()) {
        limit
            .iter()
            .for_each(|limit| axes.horizontal(canvas, *limit, Stroke::dashed(stroke.colour, 1.0, DASH)));
    }
    let is_marked = trend.values.iter().all(|values| values.len() <= MARKED);
    for ((values, places), stroke) in trend.values.iter().zip(figure.places).zip(STROKES.into_iter().cycle())
    {
        let records: Vec<(f64, Option<f64>)> = places.iter().copied().zip(values.iter().copied()).collect();
        for run in records.split(|(_, value)| value.is_none()) {
            axes.line(canvas, run.iter().filter_map(|(x, value)| Some((*x, (*value)?))), stroke);
        }
        let defined = records.iter().filter_map(|(x, value)| Some((*x, (*value)?)));
        for (x, value) in defined.filter(|_| is_marked) {
            let (x, y) = axes.at(x, value);
            let corners = [(x - HALF_MARKER, y - HALF_MARKER), (x + HALF_MARKER, y + HALF_MARKER)];
            canvas.rectangle(corners[0], corners[1], Fill::solid(stroke.colour));
        }
    }
    axes.frame(canvas);
}
