//! One record: signal, average, order spectrum and difference on one page.
//!
//! Above, the recording as it was read; below, for one wheel or in two columns for two or more, the average over a
//! revolution and its difference, both over the teeth, and the order spectrum: all of it, and its low orders with what belongs
//! to which part.

mod heading;
mod spectrum;
mod teeth;

use meshtone::signal::Record;

use crate::drawing::{
    Area, Axes, BETWEEN_FACTS, Canvas, EDGE, NAME_LEFT, Stroke, TextStyle, Ticks, WIDTH, axes, colour, number,
};
use crate::{DamagedTooth, Figure};

/// (px) Height of the figure of one or two wheels.
const HEIGHT: u32 = 1200;
/// (px) By how much each further row of two wheels makes it higher.
const ROW_HEIGHT: u32 = 952;

const LEFT: f64 = 84.0;
const RIGHT: f64 = 1576.0;
const COLUMN_GAP: f64 = 92.0;
const SIGNAL: Area = Area::new(LEFT, 100.0, RIGHT - LEFT, 130.0);
const HEADING_BASELINE: f64 = 302.0;
/// (px) Upper and lower edges of the plots of each wheel.
const AVERAGE: [f64; 2] = [372.0, 534.0];
const SPECTRUM: [f64; 2] = [604.0, 912.0];
const DIFFERENCE: [f64; 2] = [990.0, 1152.0];
/// Letters of a unit for which the axes have room.
const LONGEST_UNIT: usize = 12;
const MARGIN: f64 = 0.06;
const CURVE: Stroke = Stroke::solid(colour::BLUE, 1.2);
const ENVELOPE: Stroke = Stroke::solid(colour::INK, 1.2);

/// Content of the figure.
#[derive(Debug, Clone, Copy)]
pub struct RecordFigure<'a> {
    /// Title: what was recorded, and which channel.
    pub title: &'a str,
    /// Facts in the line below it.
    pub facts: &'a [String],
    /// The recording.
    pub signal: SignalView<'a>,
    /// The wheels, two in a row.
    pub wheels: &'a [WheelView<'a>],
}

/// A channel, as it was read.
#[derive(Debug, Clone, Copy)]
pub struct SignalView<'a> {
    /// Name of the measured quantity, such as `vertical acceleration`.
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

/// Results of one wheel.
#[derive(Debug, Clone, Copy)]
pub struct WheelView<'a> {
    /// Its name, such as `gear`.
    pub name: &'a str,
    /// Its teeth.
    pub teeth: u32,
    /// Name of its shaft, where that has one of its own.
    pub shaft: Option<&'a str>,
    /// Teeth of the other wheels on its shaft, whose mesh orders with their sidebands belong to the regular part too.
    pub other_teeth: &'a [usize],
    /// Orders of other shafts and meshes, whose multiples belong to it as well.
    pub other_orders: &'a [usize],
    /// (Hz) Mean speed of its shaft.
    pub mean_speed_hz: f64,
    /// Sidebands on each side of a mesh order that belong to the regular part.
    pub sidebands: usize,
    /// The shaft orders 1 to this one belong to the regular part.
    pub low_orders: usize,
    /// Mark of tooth 1, such as `tooth 1 is in mesh at the tachometer's pulse`.
    pub first_tooth: &'a str,
    /// The damaged teeth, where they are known; their turns are tinted.
    pub damaged_teeth: &'a [DamagedTooth],
    /// The record.
    pub record: &'a Record,
}

impl WheelView<'_> {
    /// Its name in a sentence: that of a pair's wheel is a word, as in `the gear`.
    fn called(&self) -> String {
        if self.shaft.is_some() { self.name.to_owned() } else { format!("the {}", self.name) }
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
///     shaft: None,
///     other_teeth: &[],
///     other_orders: &[],
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
    let wheels = figure.wheels;
    let rows = wheels.len().div_ceil(2).max(1) as u32;
    let mut canvas = Canvas::new(WIDTH, HEIGHT + (rows - 1) * ROW_HEIGHT);
    canvas.heading(EDGE, RIGHT - EDGE, (36.0, figure.title), (61.0, &figure.facts.join(BETWEEN_FACTS)));
    let unit = figure.signal.unit.filter(|unit| !unit.is_empty());
    let shortened = |unit: &str| unit.chars().take(LONGEST_UNIT).collect();
    let unit: String = unit.map_or_else(|| "unit not stated".to_owned(), shortened);
    signal(&mut canvas, &figure.signal, &unit);
    let columns = wheels.len().min(2);
    // All wheels have the same scales.
    let averages = wheels.iter().flat_map(|wheel| &wheel.record.average.values);
    let differences =
        wheels.iter().flat_map(|wheel| [&wheel.record.parts.difference, &wheel.record.envelope]);
    let y = axes::range(averages.copied(), MARGIN);
    let around = axes::range(differences.flatten().copied(), MARGIN);
    let amplitudes = spectrum::Amplitudes::of(wheels, column(0, columns, [0.0; 2]).width);
    for (place, wheel) in wheels.iter().enumerate() {
        let down = f64::from(ROW_HEIGHT) * (place / 2) as f64;
        let area = |vertical: [f64; 2]| column(place % 2, columns, vertical.map(|y| y + down));
        let Area { left, width, .. } = area(AVERAGE);
        heading::column(&mut canvas, (left, HEADING_BASELINE + down), width, wheel);
        let record = wheel.record;
        let title = format!("Average over a revolution of {}", wheel.called());
        let average = [(None, &record.average.values[..], CURVE)];
        teeth::draw(&mut canvas, area(AVERAGE), (y, &unit), &title, wheel, &average);
        spectrum::draw(&mut canvas, area(SPECTRUM), &amplitudes, wheel, &unit);
        let curves = [
            (Some("difference"), &record.parts.difference[..], CURVE),
            (Some("envelope"), &record.envelope[..], ENVELOPE),
        ];
        teeth::draw(&mut canvas, area(DIFFERENCE), (around, &unit), "Difference signal", wheel, &curves);
    }
    canvas.finish(figure.title, &heading::description(figure))
}

/// The recording over time.
fn signal(canvas: &mut Canvas, signal: &SignalView, unit: &str) {
    let SignalView { quantity, sampling_rate_hz, start_s, samples, .. } = *signal;
    let duration_s = samples.len() as f64 / sampling_rate_hz;
    let time = axes::time_range([start_s, start_s + duration_s]);
    let y = axes::range(samples.iter().copied(), MARGIN);
    let title = format!(
        "{}: {} s, {} samples at {} S/s",
        TextStyle::AXES_TITLE.fitted(quantity, 0.5 * SIGNAL.width),
        number(duration_s),
        samples.len(),
        number(sampling_rate_hz)
    );
    let axes = Axes::titled(canvas, SIGNAL, time, y, &title);
    axes.x_axis(canvas, &Ticks::nice(time[0], time[1], 12), "Time (s)");
    axes.y_axis(canvas, &Ticks::nice(y[0], y[1], 4), &format!("Signal ({unit})"), NAME_LEFT);
    axes.line(canvas, axes::over(time, samples), CURVE);
    axes.frame(canvas);
}

/// One of one or two columns, between two heights.
fn column(place: usize, columns: usize, [top, bottom]: [f64; 2]) -> Area {
    let gaps = columns.saturating_sub(1) as f64;
    let width = (RIGHT - LEFT - gaps * COLUMN_GAP) / (gaps + 1.0);
    Area::new(LEFT + place as f64 * (width + COLUMN_GAP), top, width, bottom - top)
}
