//! One record: signal, average, order spectrum and difference on one page.
//!
//! Above, the recording as it was read; below, for one wheel or in two columns for both wheels of a pair, the average over a
//! revolution and its difference, both over the teeth, and the order spectrum: all of it, and its low orders with what belongs
//! to which part.

mod difference;
mod heading;
mod signal;
mod spectrum;
mod teeth;

use meshtone::signal::Record;

use crate::axes::{self, Area, Axes};
use crate::canvas::Canvas;
use crate::legend;
use crate::style::{Stroke, colour};
use crate::{DamagedTooth, Figure, damaged_tooth};

/// (px) Size of the figure.
pub const WIDTH: u32 = 1600;
/// (px) Size of the figure.
pub const HEIGHT: u32 = 1200;

const LEFT: f64 = 84.0;
const RIGHT: f64 = 1576.0;
const COLUMN_GAP: f64 = 92.0;
/// (px) From the frame of a plot to the baseline of its vertical axis' name.
const NAME_LEFT: f64 = 56.0;
const SIGNAL_TOP: f64 = 100.0;
const SIGNAL_HEIGHT: f64 = 130.0;
const HEADING_BASELINE: f64 = 302.0;
const AVERAGE_TOP: f64 = 372.0;
const SPECTRUM_TOP: f64 = 604.0;
const SPECTRUM_HEIGHT: f64 = 308.0;
const DIFFERENCE_TOP: f64 = 990.0;
const HEIGHT_OF_AXES: f64 = 162.0;
const MARGIN: f64 = 0.06;
const CURVE: Stroke = Stroke::solid(colour::BLUE, 1.2);

/// What the figure shows.
#[derive(Debug, Clone, Copy)]
pub struct RecordFigure<'a> {
    /// Title: what was recorded, and which channel.
    pub title: &'a str,
    /// Facts in the line below it.
    pub facts: &'a [String],
    /// The recording.
    pub signal: SignalView<'a>,
    /// One wheel, or both of a pair; further ones are left out.
    pub wheels: &'a [WheelView<'a>],
}

/// A channel, as it was read.
#[derive(Debug, Clone, Copy)]
pub struct SignalView<'a> {
    /// What was measured, such as `vertical acceleration`.
    pub quantity: &'a str,
    /// Its unit, where it is known.
    pub unit: Option<&'a str>,
    /// (S/s) Its sampling rate.
    pub sampling_rate_hz: f64,
    /// (s) Time of the first sample.
    pub start_s: f64,
    /// (unit) The samples.
    pub samples: &'a [f64],
}

/// What is shown about one wheel.
#[derive(Debug, Clone, Copy)]
pub struct WheelView<'a> {
    /// Its name, such as `gear`.
    pub name: &'a str,
    /// Its teeth.
    pub teeth: u32,
    /// (Hz) Mean speed of its shaft.
    pub mean_speed_hz: f64,
    /// Sidebands on each side of a mesh order that belong to the regular part.
    pub sidebands: usize,
    /// The shaft orders 1 to this one belong to the regular part.
    pub low_orders: usize,
    /// What marks tooth 1, such as `tooth 1 is in mesh at the tachometer's pulse`.
    pub first_tooth: &'a str,
    /// The damaged teeth, where they are known; their turns are tinted.
    pub damaged_teeth: &'a [DamagedTooth],
    /// The record.
    pub record: &'a Record,
}

impl WheelView<'_> {
    /// What the tinted parts of its revolution are.
    fn damage_in_words(&self) -> Option<String> {
        damaged_tooth::in_words(&[(self.name, self.damaged_teeth)])
    }
}

/// Draws the figure of one record.
///
/// # Arguments
/// * `figure` - what it shows
///
/// ```
/// use meshtone::signal::{ChainSettings, ShaftPhase, process_channel};
/// use meshtone_plot::record::{self, RecordFigure, SignalView, WheelView};
///
/// let samples: Vec<f64> = (0..20_000).map(|i| (std::f64::consts::TAU * 380.0 * i as f64 / 1e4).cos()).collect();
/// let phase = ShaftPhase::constant(20.0, 1e4, samples.len())?;
/// let record = process_channel(&samples, &phase, 19, &ChainSettings::default())?;
/// let signal =
///     SignalView { quantity: "bearing", unit: Some("g"), sampling_rate_hz: 1e4, start_s: 0.0, samples: &samples };
/// let wheel = WheelView {
///     name: "wheel",
///     teeth: 19,
///     mean_speed_hz: 20.0,
///     sidebands: 2,
///     low_orders: 7,
///     first_tooth: "tooth 1 is in mesh at the first sample",
///     damaged_teeth: &[],
///     record: &record,
/// };
/// let figure = record::draw(&RecordFigure { title: "run.csv: bearing", facts: &[], signal, wheels: &[wheel] });
/// assert!(figure.svg().contains("Order spectrum"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn draw(figure: &RecordFigure) -> Figure {
    let mut canvas = Canvas::new(WIDTH, HEIGHT);
    heading::draw(&mut canvas, figure);
    signal::draw(&mut canvas, Area::new(LEFT, SIGNAL_TOP, RIGHT - LEFT, SIGNAL_HEIGHT), &figure.signal);
    let wheels = &figure.wheels[..figure.wheels.len().min(2)];
    let unit = unit(figure.signal.unit);
    let y = common(wheels.iter().flat_map(|wheel| wheel.record.average.values.iter().copied()));
    let around = common(wheels.iter().flat_map(|wheel| difference::extent(wheel)));
    let column = column_area(0, wheels.len(), 0.0, 0.0);
    let amplitudes = spectrum::Amplitudes::of(wheels, column.width);
    for (column, wheel) in wheels.iter().enumerate() {
        let area = |top: f64| column_area(column, wheels.len(), top, HEIGHT_OF_AXES);
        heading::column(&mut canvas, (area(0.0).left, HEADING_BASELINE), area(0.0).width, wheel);
        average(&mut canvas, Axes::new(area(AVERAGE_TOP), [0.0, f64::from(wheel.teeth)], y), wheel, &unit);
        let spectrum_area = column_area(column, wheels.len(), SPECTRUM_TOP, SPECTRUM_HEIGHT);
        spectrum::draw(&mut canvas, spectrum_area, &amplitudes, wheel, &unit);
        let axes = Axes::new(area(DIFFERENCE_TOP), [0.0, f64::from(wheel.teeth)], around);
        difference::draw(&mut canvas, axes, wheel, &unit);
    }
    canvas.finish(figure.title, &heading::description(figure))
}

fn average(canvas: &mut Canvas, axes: Axes, wheel: &WheelView, unit: &str) {
    axes.title(canvas, &format!("Average over a revolution of the {}", wheel.name));
    if let Some(text) = wheel.damage_in_words() {
        let end_of_title = (axes.area.right(), axes.area.top - axes::TITLE_ABOVE);
        legend::row(canvas, end_of_title, &[damaged_tooth::legend_entry(&text)]);
    }
    teeth::axis(canvas, &axes, wheel);
    value_axis(canvas, &axes, unit);
    axes.line(canvas, teeth::over(&wheel.record.average.values, wheel.teeth), CURVE);
    axes.frame(canvas);
}

fn value_axis(canvas: &mut Canvas, axes: &Axes, unit: &str) {
    axes.y_axis(
        canvas,
        &crate::ticks::Ticks::nice(axes.y[0], axes.y[1], 5),
        &format!("Amplitude ({unit})"),
        NAME_LEFT,
    );
}

/// The same scale for both wheels.
fn common(values: impl Iterator<Item = f64>) -> [f64; 2] {
    axes::range(values, MARGIN)
}

fn column_area(column: usize, columns: usize, top: f64, height: f64) -> Area {
    let width = match columns {
        0 | 1 => RIGHT - LEFT,
        _ => (RIGHT - LEFT - COLUMN_GAP) / 2.0,
    };
    Area::new(LEFT + column as f64 * (width + COLUMN_GAP), top, width, height)
}

/// The unit in an axis' name.
fn unit(unit: Option<&str>) -> String {
    unit.filter(|unit| !unit.is_empty()).map_or_else(|| "unit not stated".to_owned(), shortened_unit)
}

fn shortened_unit(unit: &str) -> String {
    unit.chars().take(12).collect()
}
