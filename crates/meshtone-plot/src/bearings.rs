//! Bearings in a recording: the kurtogram with the chosen band, and the squared envelope spectrum of each bearing with its defect lines.

use meshtone::signal::{
    BearingRecords, DefectKind, DefectLine, FrequencyBand, Kurtogram, SquaredEnvelopeSpectrum,
};

use crate::Figure;
use crate::drawing::{
    Anchor, Area, Axes, Canvas, Colour, DOT_RADIUS, EDGE, Fill, NAME_LEFT, Sample, Stroke, TextStyle, Ticks,
    axes, bands, colour, described, number,
};

const KURTOGRAM: Area = Area::new(84.0, 118.0, 1400.0, 290.0);
/// (px) The first spectrum, and how far the next ones are below it.
const SPECTRUM: Area = Area::new(84.0, 492.0, 1492.0, 250.0);
const SPECTRUM_STEP: f64 = 340.0;
/// (px) From one row of names at the lines to the next: each kind of defect has its own.
const NAME_ROW: f64 = 15.0;
/// Orders that are shown, over the highest defect line.
const BEYOND: f64 = 1.08;
/// The lines at 0 hold what is left of the mean.
const FIRST_LINE: usize = 3;
const CURVE: Stroke = Stroke::solid(colour::INK, 1.0);
const CHOSEN: Stroke = Stroke::dashed(colour::VERMILLION, 1.5, &[6.0, 4.0]);

/// Content of the figure.
#[derive(Debug, Clone, Copy)]
pub struct BearingsFigure<'a> {
    /// Title: what was recorded, and which channel.
    pub title: &'a str,
    /// Facts in the line below it.
    pub facts: &'a [String],
    /// Unit of the amplitudes, such as `g²`, where it is known.
    pub amplitude_unit: Option<&'a str>,
    /// Each bearing's designation and its shaft's name, in the order of the records.
    pub bearings: &'a [(&'a str, &'a str)],
    /// What the recording shows about them.
    pub records: &'a BearingRecords,
}

/// Draws the kurtogram, and for each bearing the squared envelope spectrum with its defect lines by name.
///
/// # Arguments
/// * `figure` - what it shows
///
/// ```
/// use meshtone::bearing::NamedBearing;
/// use meshtone::signal::{BearingSettings, GearTrain, ShaftPhase, StatedTurning, TrainBearing, TrainRecording, TrainTurning};
/// use meshtone_plot::bearings::{self, BearingsFigure};
///
/// let geometry = NamedBearing::find("6205").ok_or("no such bearing")?.geometry;
/// let phase = ShaftPhase::constant(30.0, 10_000.0, 20_000)?;
/// let signal: Vec<f64> = phase.revolutions.iter().map(|angle| (-9.0 * (3.585 * angle).fract()).exp()).collect();
/// let turning = TrainTurning::Shaft { shaft: 0, phase, stated: StatedTurning::Other };
/// let train = GearTrain::of_shaft("shaft");
/// let recording = TrainRecording { signal: &signal, sampling_rate_hz: 10_000.0, train: &train, turning: &turning };
/// let records = recording.bearings(&[TrainBearing { geometry, shaft: 0 }], &BearingSettings::default())?;
/// let figure = BearingsFigure {
///     title: "run.csv: bearing", facts: &[], amplitude_unit: Some("g²"), bearings: &[("6205", "shaft")], records: &records,
/// };
/// assert!(bearings::draw(&figure).svg().contains("2 BPFO"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn draw(figure: &BearingsFigure) -> Figure {
    let BearingsFigure { title, facts, bearings, records, .. } = *figure;
    let below = SPECTRUM_STEP * bearings.len().max(1) as f64;
    let mut canvas = Canvas::page((SPECTRUM.top - 32.0 + below) as u32, EDGE, title, facts);
    kurtogram(&mut canvas, &records.kurtogram, records.band, records.kurtosis);
    let amplitude = match figure.amplitude_unit.filter(|unit| !unit.is_empty()) {
        Some(unit) => format!("Amplitude ({unit})"),
        None => "Amplitude".to_owned(),
    };
    let amplitude = TextStyle::AXIS.fitted(&amplitude, SPECTRUM.height);
    for (number, ((name, shaft), (spectrum, lines))) in bearings.iter().zip(&records.bearings).enumerate() {
        let area = Area { top: SPECTRUM.top + number as f64 * SPECTRUM_STEP, ..SPECTRUM };
        self::spectrum(&mut canvas, area, (name, shaft), (spectrum, lines), &amplitude);
    }
    let what =
        "Kurtogram of a recording, and the squared envelope spectrum of each bearing with its defect lines.";
    canvas.finish(title, &described(what, facts))
}

/// The kurtosis in each band, the widest above, and the ends of the chosen one.
fn kurtogram(canvas: &mut Canvas, of: &Kurtogram, band: FrequencyBand, kurtosis: Option<f64>) {
    let half_hz = 0.5 * of.sampling_rate_hz;
    let rows = of.levels.len() as f64;
    let chosen = kurtosis.map_or_else(String::new, |value| format!(", kurtosis {}", number(value)));
    let [from, to] = [band.from_hz, band.to_hz].map(number);
    let title = format!("Kurtogram; band of the squared envelope {from} to {to} Hz{chosen}");
    let axes = Axes::titled(canvas, KURTOGRAM, [0.0, half_hz], [rows, 0.0], &title);
    let all = of.levels.iter().flatten();
    let largest = all.copied().filter(|value| axes::drawable(*value)).fold(0.0, f64::max);
    let largest = if largest > 0.0 { largest } else { 1.0 };
    let shades = bands::COLOURS.len();
    let mut shaded: Vec<Vec<_>> = vec![Vec::new(); shades];
    for (row, level) in of.levels.iter().enumerate() {
        let (top, width_hz) = (row as f64, half_hz / level.len() as f64);
        for (band, value) in level.iter().enumerate() {
            let shade = (value.max(0.0) / largest * shades as f64) as usize;
            let corners =
                [axes.at(band as f64 * width_hz, top), axes.at((band + 1) as f64 * width_hz, top + 1.0)];
            shaded[shade.min(shades - 1)].push(corners);
        }
        let style = TextStyle::TICK.anchored(Anchor::End);
        let (left, middle) = axes.at(0.0, top + 0.5);
        canvas.text((left - 8.0, middle + 4.5), &level.len().to_string(), style);
    }
    for (rectangles, colour) in shaded.iter().zip(bands::COLOURS) {
        canvas.rectangles(rectangles, Fill::solid(colour));
    }
    for hz in [band.from_hz, band.to_hz] {
        canvas.line(axes.at(hz, 0.0), axes.at(hz, rows), CHOSEN);
    }
    let name = (KURTOGRAM.left - NAME_LEFT, KURTOGRAM.middle().1);
    canvas.text(name, "Number of bands", TextStyle::AXIS.upwards());
    axes.x_numbers(canvas, &Ticks::nice(0.0, half_hz, 12));
    axes.x_name(canvas, "Frequency (Hz)");
    axes.frame(canvas);
    let ends: Vec<String> =
        (1..shades).map(|shade| number(two_decimals(largest * shade as f64 / shades as f64))).collect();
    bands::bar(canvas, KURTOGRAM, "Kurtosis (–)", (&bands::COLOURS, &ends));
}

/// A squared envelope spectrum on a linear scale, behind it an upright line at each defect order.
fn spectrum(
    canvas: &mut Canvas,
    area: Area,
    (name, shaft): (&str, &str),
    (spectrum, lines): (&SquaredEnvelopeSpectrum, &[DefectLine]),
    amplitude: &str,
) {
    let highest = lines.iter().map(|line| line.order).fold(0.0, f64::max);
    let highest = if highest > 0.0 { BEYOND * highest } else { 1.0 };
    let points = spectrum.amplitudes.iter().enumerate().skip(FIRST_LINE);
    let points = points.map(|(line, amplitude)| (line as f64 * spectrum.step, *amplitude));
    let shown: Vec<(f64, f64)> = points.take_while(|(order, _)| *order <= highest).collect();
    let largest = axes::largest(shown.iter().map(|(_, amplitude)| amplitude));
    // Above the curve is room for the names of all kinds.
    let y = [0.0, if largest > 0.0 { 1.35 * largest } else { 1.0 }];
    let title = format!("{name} on {shaft}, squared envelope spectrum");
    let axes = Axes::titled(
        canvas,
        area,
        [0.0, highest],
        y,
        &TextStyle::AXES_TITLE.fitted(&title, 0.4 * area.width),
    );
    axes.x_axis(canvas, &Ticks::nice(0.0, highest, 18), &format!("Order of {shaft}"));
    axes.y_axis(canvas, &Ticks::nice(y[0], y[1], 5), amplitude, NAME_LEFT);
    for line in lines {
        axes.vertical(canvas, line.order, stroke(line.kind));
    }
    axes.line(canvas, shown.into_iter(), CURVE);
    for (row, kind) in DefectKind::ALL.into_iter().enumerate() {
        let of_kind = || lines.iter().filter(|line| line.kind == kind);
        let found = of_kind().filter(|line| axes::drawable(line.amplitude) && line.amplitude <= y[1]);
        let dots: Vec<_> = found.map(|line| axes.at(line.found_order, line.amplitude)).collect();
        canvas.dots(&dots, 2.0 * DOT_RADIUS, Fill::solid(colour_of(kind)));
        for line in of_kind() {
            let style = TextStyle::NOTE.coloured(colour_of(kind)).with_halo();
            let baseline = area.top + NAME_ROW * (row + 1) as f64;
            canvas.text((axes.px(line.order) + 4.0, baseline), &line.name(), style);
        }
    }
    let first = |kind| lines.iter().find(move |line| line.kind == kind);
    let texts: Vec<(DefectKind, String)> = DefectKind::ALL
        .into_iter()
        .filter_map(|kind| {
            let line = first(kind)?;
            Some((
                kind,
                format!("{} {:.4}: {} ×", line.name(), line.order, number(two_decimals(line.over_median))),
            ))
        })
        .collect();
    let entries: Vec<_> =
        texts.iter().map(|(kind, text)| (Sample::Line(stroke(*kind)), text.as_str())).collect();
    axes.legend(canvas, &entries);
    axes.frame(canvas);
}

fn two_decimals(value: f64) -> f64 {
    (1e2 * value).round() / 1e2
}

fn colour_of(kind: DefectKind) -> Colour {
    match kind {
        DefectKind::Cage => colour::PURPLE,
        DefectKind::OuterRace => colour::BLUE,
        DefectKind::InnerRace => colour::VERMILLION,
        DefectKind::Element => colour::GREEN,
    }
}

fn stroke(kind: DefectKind) -> Stroke {
    Stroke::dashed(colour_of(kind), 1.2, &[4.0, 3.0])
}
