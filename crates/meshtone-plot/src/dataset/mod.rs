//! A data set on one page.
//!
//! On the left an example of each class, in the middle how the varied keys are distributed, by split, on the right indicators by
//! class.

mod examples;
mod indicators;
mod keys;

use crate::Figure;
use crate::drawing::{Area, Canvas, Colour, Entry, Fill, Sample, Stroke, WIDTH, colour, legend};

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
const EXAMPLES: Area = Area::new(74.0, TOP, 436.0, BOTTOM - TOP);
const KEYS: Area = Area::new(582.0, TOP, 478.0, BOTTOM - TOP);
const INDICATORS: Area = Area::new(1140.0, TOP, 434.0, BOTTOM - TOP);

/// Content of the figure.
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
    pub keys: Vec<PreviewColumn>,
    /// Indicators.
    pub indicators: Vec<PreviewColumn>,
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

/// A varied key or an indicator.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PreviewColumn {
    /// Its name, with its unit: `pinion speed (Hz)`.
    pub name: String,
    /// Its value in each record; NaN where it has none.
    pub values: Vec<f64>,
}

/// Colours of the splits; of more, the order shows which is which.
const SPLIT_COLOURS: [Colour; 7] = [
    colour::BLUE,
    colour::INK,
    colour::GREEN,
    colour::VERMILLION,
    colour::PURPLE,
    colour::MUTED,
    colour::ORANGE,
];
/// Splits whose outlines can be distinguished when they are drawn over each other.
const MOST_OUTLINES: usize = 3;

fn split_colour(split: usize) -> Colour {
    SPLIT_COLOURS[split % SPLIT_COLOURS.len()]
}

/// Stroke of the distribution of a split after the training.
fn split_stroke(split: usize) -> Stroke {
    Stroke::solid(split_colour(split), 1.5)
}

const TRAIN: Fill = Fill::tint(colour::BLUE, 0.3);

/// Returns whether each split has a strip of its own, as there are too many for outlines.
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
    canvas.heading(TEXT_LEFT, width, (TITLE_BASELINE, &preview.title), (FACTS_BASELINE, &preview.facts));
    let distribution = match as_strips(preview) {
        true => "Varied keys, a strip each split: darker, more of its records",
        false => "Distribution of the varied keys, by split",
    };
    let examples = format!("One example of each class: {}", preview.signal_name);
    let columns = [(EXAMPLES, &*examples), (KEYS, distribution), (INDICATORS, "Indicators by class")];
    for (Area { left, width, .. }, text) in columns {
        canvas.section((left, HEADING_BASELINE), width, text, 6.0);
    }
    examples::draw(&mut canvas, EXAMPLES, preview);
    keys::draw(&mut canvas, KEYS, preview);
    indicators::draw(&mut canvas, INDICATORS, preview);
    splits_legend(&mut canvas, preview);
    let description = format!(
        "A data set of the classes {}: {}. Examples of each class, distributions of the varied keys, indicators by class.",
        preview.classes.join(", "),
        preview.facts
    );
    canvas.finish(&preview.title, &description)
}

/// Draws the legend of the distributions' fills and lines, at the page's right edge beside the title.
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
            (sample, name.as_str())
        })
        .collect();
    legend::row(canvas, (INDICATORS.right(), TITLE_BASELINE), &entries);
}
