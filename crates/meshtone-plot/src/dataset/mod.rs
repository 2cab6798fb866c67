//! A data set on one page.
//!
//! On the left an example of each class, in the middle how the varied keys are distributed, by split, on the right indicators by
//! class.

mod examples;
mod indicators;
mod keys;

use crate::axes::Area;
use crate::canvas::Canvas;
use crate::legend::{self, Entry, Sample};
use crate::style::{Colour, Fill, Stroke, TextStyle, colour};
use crate::text::fitted;
use crate::{Figure, font};

const WIDTH: u32 = 1600;
const HEIGHT: u32 = 1000;
/// (px) Left edge of title and facts.
const TEXT_LEFT: f64 = 15.0;
const TITLE_BASELINE: f64 = 34.0;
const FACTS_BASELINE: f64 = 57.0;
const HEADING_BASELINE: f64 = 96.0;
const TOP: f64 = 136.0;
const BOTTOM: f64 = 944.0;
/// (px) Baseline of what was left out, below the lowest axis' name.
const SECOND_LINE: f64 = 996.0;
/// (px) Left edges and widths of the three columns' plots.
const EXAMPLES: [f64; 2] = [74.0, 436.0];
const KEYS: [f64; 2] = [582.0, 478.0];
const INDICATORS: [f64; 2] = [1140.0, 434.0];

/// What the figure shows.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DatasetPreview {
    /// Title.
    pub title: String,
    /// Facts in the line below it.
    pub facts: String,
    /// Names of the classes.
    pub classes: Vec<String>,
    /// Names of the splits, the first of them the training.
    pub splits: Vec<String>,
    /// Name of the signal that the examples show, its unit at the end.
    pub signal_name: String,
    /// Whether that signal is over a revolution of the gear; otherwise over time.
    pub over_angle: bool,
    /// At most one for each class.
    pub examples: Vec<Example>,
    /// Number of each record's class.
    pub class_of: Vec<usize>,
    /// Number of each record's split.
    pub split_of: Vec<usize>,
    /// Varied keys.
    pub keys: Vec<Key>,
    /// Indicators.
    pub indicators: Vec<Indicator>,
}

/// A record of one class.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Example {
    /// The class.
    pub label: String,
    /// Its conditions, in words.
    pub conditions: String,
    /// Its signal.
    pub signal: Vec<f64>,
}

/// A varied key.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Key {
    /// What it is called, with its unit: `pinion speed (Hz)`.
    pub name: String,
    /// Its value in each record; NaN where it has none.
    pub values: Vec<f64>,
}

/// An indicator.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Indicator {
    /// What it is called, with its unit: `pinion speed (Hz)`.
    pub name: String,
    /// Its value in each record; NaN where it has none.
    pub values: Vec<f64>,
}

/// Colours of the splits; of more, the order tells which is which.
const SPLIT_COLOURS: [Colour; 7] = [
    colour::BLUE,
    colour::INK,
    colour::GREEN,
    colour::VERMILLION,
    colour::PURPLE,
    colour::MUTED,
    colour::ORANGE,
];
/// Splits whose outlines can be told apart when they are drawn over each other.
const MOST_OUTLINES: usize = 3;

fn split_colour(split: usize) -> Colour {
    SPLIT_COLOURS[split % SPLIT_COLOURS.len()]
}

/// How the distribution of a split after the training is drawn over that.
fn split_stroke(split: usize) -> Stroke {
    Stroke::solid(split_colour(split), 1.5)
}

const TRAIN: Fill = Fill::tint(colour::BLUE, 0.3);

/// Whether each split has a strip of its own, as there are too many for outlines.
fn as_strips(preview: &DatasetPreview) -> bool {
    preview.splits.len() > MOST_OUTLINES
}

/// Draws a preview of a data set.
///
/// # Arguments
/// * `preview` - what it shows
///
/// ```
/// use meshtone_plot::dataset::{DatasetPreview, dataset_figure};
///
/// let preview = DatasetPreview { title: "Six faults".to_owned(), ..DatasetPreview::default() };
/// assert!(dataset_figure(&preview).svg().contains("Six faults"));
/// ```
pub fn dataset_figure(preview: &DatasetPreview) -> Figure {
    let mut canvas = Canvas::new(WIDTH, HEIGHT);
    let width = f64::from(WIDTH) - 2.0 * TEXT_LEFT;
    canvas.text(
        (TEXT_LEFT, TITLE_BASELINE),
        &fitted(&preview.title, TextStyle::TITLE, width),
        TextStyle::TITLE,
    );
    canvas.text(
        (TEXT_LEFT, FACTS_BASELINE),
        &fitted(&preview.facts, TextStyle::FACTS, width),
        TextStyle::FACTS,
    );
    section(&mut canvas, EXAMPLES, &format!("One example of each class: {}", preview.signal_name));
    let distribution = match as_strips(preview) {
        true => "Varied keys, a strip each split: darker, more of its records",
        false => "Distribution of the varied keys, by split",
    };
    section(&mut canvas, KEYS, distribution);
    section(&mut canvas, INDICATORS, "Indicators by class");
    examples::draw(&mut canvas, column(EXAMPLES), preview);
    keys::draw(&mut canvas, column(KEYS), preview);
    indicators::draw(&mut canvas, column(INDICATORS), preview);
    splits_legend(&mut canvas, preview);
    let description = format!(
        "A data set of the classes {}: {}. Examples of each class, distributions of the varied keys, indicators by class.",
        preview.classes.join(", "),
        preview.facts
    );
    canvas.finish(&preview.title, &description)
}

fn column([left, width]: [f64; 2]) -> Area {
    Area::new(left, TOP, width, BOTTOM - TOP)
}

fn section(canvas: &mut Canvas, [left, width]: [f64; 2], text: &str) {
    let style = TextStyle::HEADING;
    let lines = font::wrapped(text, width, 1, style.size, style.bold);
    canvas.text((left, HEADING_BASELINE), lines.first().map_or("", String::as_str), style);
    let below = HEADING_BASELINE + 6.0;
    canvas.line((left, below), (left + width, below), Stroke::solid(colour::INK, 1.2));
}

/// What the fills and lines of the distributions mean, at the page's right edge beside the title.
fn splits_legend(canvas: &mut Canvas, preview: &DatasetPreview) {
    let there = |split: usize| preview.split_of.contains(&split);
    let entries: Vec<Entry> = preview
        .splits
        .iter()
        .enumerate()
        .filter(|(split, _)| there(*split))
        .map(|(split, name)| {
            let sample = match split {
                _ if as_strips(preview) => Sample::Area(Fill::solid(split_colour(split))),
                0 => Sample::Area(TRAIN),
                _ => Sample::Line(split_stroke(split)),
            };
            Entry { sample, text: name }
        })
        .collect();
    legend::row(canvas, (INDICATORS[0] + INDICATORS[1], TITLE_BASELINE), &entries);
}
