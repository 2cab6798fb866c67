//! A diagnosis on one page: the recording within what was simulated, probabilities, severity, and what explains it best.

use crate::Figure;
use crate::drawing::{
    Anchor, Area, Axes, Canvas, EDGE, Entry, Fill, NAME_LEFT, Sample, Stroke, TextStyle, Ticks, axes, colour,
    described, legend, over,
};

const HEIGHT: u32 = 1000;
const SIGNALS: Area = Area::new(84.0, 118.0, 900.0, 330.0);
const EXPLANATIONS: Area = Area::new(84.0, 532.0, 900.0, 418.0);
const EXPLANATIONS_GAP: f64 = 30.0;
const MOST_EXPLANATIONS: usize = 3;
const BARS: Area = Area::new(1200.0, 118.0, 330.0, 330.0);
const SEVERITY: Area = Area::new(1082.0, 532.0, 494.0, 418.0);
/// Kinds that are shown; the others are counted.
const MOST_KINDS: usize = 10;
const BINS: usize = 40;
const MARGIN: f64 = 0.08;
const RECORDED: Stroke = Stroke::solid(colour::INK, 1.2);
const EXPLAINED: Stroke = Stroke::solid(colour::BLUE, 1.4);
/// Note in place of numbers that do not count.
const OUTSIDE: &str = "nothing can be said";
/// The recording behind a simulation.
const BEHIND: Stroke = Stroke::solid(colour::FRAME, 0.9);
const BAND: Fill = Fill::tint(colour::BLUE, 0.22);
const DAMAGE: Fill = Fill::tint(colour::VERMILLION, 0.22);

/// Content of the figure.
#[derive(Debug, Clone, Copy)]
pub struct DiagnosisFigure<'a> {
    /// Title: what was recorded.
    pub title: &'a str,
    /// Facts in the line below it.
    pub facts: &'a [String],
    /// Name of the wheel whose signal is shown.
    pub wheel: &'a str,
    /// Teeth of that wheel.
    pub teeth: u32,
    /// The damaged tooth of that wheel from 1, if it is on it and it is known which.
    pub damaged_tooth: Option<u32>,
    /// (g) The recording's difference signal over a revolution of that wheel.
    pub difference_g: &'a [f64],
    /// (g) Between which values nine in ten of the simulations that resemble it are, angle by angle.
    pub band_g: [&'a [f64]; 2],
    /// Names of the kinds with their probabilities, the likeliest first; empty where they do not count, because the recordings are unlike
    /// what was simulated.
    pub kinds: &'a [(&'a str, f64)],
    /// Severity of the likeliest damage.
    pub severity: Option<SeverityView<'a>>,
    /// The best explanations of the recording: words, and its difference signal in g.
    pub explanations: &'a [(String, &'a [f64])],
}

/// Severity of a damage.
#[derive(Debug, Clone, Copy)]
pub struct SeverityView<'a> {
    /// The kind.
    pub kind: &'a str,
    /// (-) Draws of its severity.
    pub draws: &'a [f64],
    /// (-) As likely to be larger as to be smaller.
    pub median: f64,
    /// (-) It is within with a probability of 0.5.
    pub within_50: [f64; 2],
    /// (-) It is within with a probability of 0.9.
    pub within_90: [f64; 2],
}

/// Draws a diagnosis.
///
/// # Arguments
/// * `figure` - what it shows
///
/// ```
/// use meshtone_plot::diagnosis::{self, DiagnosisFigure};
///
/// let signal: Vec<f64> = (0..256).map(|i| (i as f64 / 9.0).sin()).collect();
/// let [low, high] = [-1.2, 1.2].map(|end| vec![end; signal.len()]);
/// let figure = DiagnosisFigure {
///     title: "worn.csv",
///     facts: &["damaged with a probability of 90 %".to_owned()],
///     wheel: "gear",
///     teeth: 38,
///     damaged_tooth: Some(7),
///     difference_g: &signal,
///     band_g: [&low, &high],
///     kinds: &[("missing-tooth", 0.9), ("healthy", 0.1)],
///     severity: None,
///     explanations: &[("missing-tooth".to_owned(), &signal)],
/// };
/// assert!(diagnosis::draw(&figure).svg().contains("missing-tooth"));
/// ```
pub fn draw(figure: &DiagnosisFigure) -> Figure {
    let mut canvas = Canvas::page(HEIGHT, EDGE, figure.title, figure.facts);
    recording(&mut canvas, figure);
    probabilities(&mut canvas, figure.kinds);
    severity(&mut canvas, figure);
    explanations(&mut canvas, figure);
    canvas.finish(figure.title, &described("What may be wrong with the gears.", figure.facts))
}

/// Range and ticks of a revolution of the wheel: tooth k is from k − 1 to k.
fn revolution(figure: &DiagnosisFigure) -> ([f64; 2], Ticks) {
    let teeth = f64::from(figure.teeth);
    ([0.0, teeth], Ticks::whole(0.0, teeth, 20))
}

fn tooth(canvas: &mut Canvas, axes: &Axes, figure: &DiagnosisFigure) {
    if let Some(tooth) = figure.damaged_tooth {
        axes.band(canvas, f64::from(tooth) - 1.0, f64::from(tooth), DAMAGE);
    }
}

fn recording(canvas: &mut Canvas, figure: &DiagnosisFigure) {
    let values = figure.difference_g.iter().chain(figure.band_g[0]).chain(figure.band_g[1]).copied();
    let (x, teeth) = revolution(figure);
    let y = axes::range(values, MARGIN);
    let title = format!("Difference signal of the recording, {}", figure.wheel);
    let axes = Axes::titled(canvas, SIGNALS, x, y, &title);
    let tooth_in_words = figure.damaged_tooth.map(|tooth| format!("tooth {tooth}"));
    let marked = tooth_in_words.as_deref().map(|text| (Sample::Area(DAMAGE), text));
    let others = [
        (Sample::Area(BAND), "nine in ten of the simulations that resemble it"),
        (Sample::Line(RECORDED), "recording"),
    ];
    let entries: Vec<Entry> = marked.into_iter().chain(others).collect();
    axes.legend(canvas, &entries);
    let turned = format!("Pitches that the {} has turned", figure.wheel);
    axes.x_axis(canvas, &teeth, &format!("{turned} (tooth k: from k – 1 to k)"));
    axes.y_axis(canvas, &Ticks::nice(axes.y[0], axes.y[1], 6), "Difference signal (g)", NAME_LEFT);
    tooth(canvas, &axes, figure);
    let [low, high] = figure.band_g.map(|end| axes.along_x(over(axes.x, end)));
    let around: Vec<_> = low.into_iter().chain(high.into_iter().rev()).collect();
    canvas.polygon(&around, BAND);
    axes.line(canvas, over(axes.x, figure.difference_g), RECORDED);
    axes.frame(canvas);
}

fn probabilities(canvas: &mut Canvas, kinds: &[(&str, f64)]) {
    let shown = &kinds[..kinds.len().min(MOST_KINDS)];
    let rest: f64 = kinds[shown.len()..].iter().map(|(_, probability)| probability).sum();
    let others = format!("{} others", kinds.len() - shown.len());
    let more = (kinds.len() > shown.len()).then_some((others.as_str(), rest));
    let bars: Vec<(&str, f64)> = shown.iter().copied().chain(more).collect();
    let y = [bars.len().max(1) as f64, 0.0];
    let axes = Axes::titled(canvas, BARS, [0.0, 100.0], y, "Probability, given the scenario");
    let name = "Probability (%); before: healthy 50, kinds of damage alike";
    axes.x_axis(canvas, &Ticks::every(20.0, 0.0, 100.0), name);
    if kinds.is_empty() {
        axes.note(canvas, OUTSIDE);
        return axes.frame(canvas);
    }
    for (place, (label, probability)) in bars.iter().enumerate() {
        let place = place as f64;
        let fill = if *label == "healthy" { colour::BLUE } else { colour::VERMILLION };
        let [from, to] = [axes.at(0.0, place + 0.2), axes.at(100.0 * probability, place + 0.8)];
        canvas.rectangle(from, to, Fill::solid(fill));
        let style = TextStyle::NOTE;
        let baseline = axes.py(place + 0.5) + 0.36 * style.size;
        canvas.text((axes.area.left - 8.0, baseline), label, style.anchored(Anchor::End));
        let percent =
            if *probability < 0.001 { "< 0.1 %".to_owned() } else { format!("{:.1} %", 100.0 * probability) };
        // Inside a bar that leaves no room beside it.
        let (x, style) = if *probability > 0.8 {
            (axes.px(100.0 * probability) - 6.0, style.coloured(colour::WHITE).anchored(Anchor::End))
        } else {
            (axes.px(100.0 * probability) + 6.0, style)
        };
        canvas.text((x, baseline), &percent, style);
    }
    axes.frame(canvas);
}

/// Draws the distribution of a damage's severity with its median and intervals.
///
/// The axes are drawn in any case, so that the figure keeps its layout; a note stands in them where no damage, or only one severity, is
/// known. Bands lie below the bars, and the legend on the side with more room.
fn severity(canvas: &mut Canvas, figure: &DiagnosisFigure) {
    let severity = figure.severity.as_ref();
    let mut counts = [0.0f64; BINS];
    let draws = severity.map_or(&[][..], |severity| severity.draws);
    for draw in draws {
        let bin = (draw.clamp(0.0, 1.0) * BINS as f64) as usize;
        counts[bin.min(BINS - 1)] += 100.0 / draws.len() as f64;
    }
    let highest = counts.iter().copied().fold(1.0, f64::max);
    let title = severity.map_or_else(
        || "Severity".to_owned(),
        |severity| format!("Severity of {}, if it is that", severity.kind),
    );
    let axes = Axes::titled(canvas, SEVERITY, [0.0, 1.0], [0.0, 1.12 * highest], &title);
    axes.x_axis(canvas, &Ticks::nice(0.0, 1.0, 6), "Severity (–)");
    axes.y_axis(canvas, &Ticks::nice(0.0, axes.y[1], 5), "Part of the draws (%)", 48.0);
    let severity = match severity {
        None => {
            axes.note(
                canvas,
                if figure.kinds.is_empty() { OUTSIDE } else { "no damage is known to the scenario's model" },
            );
            return axes.frame(canvas);
        }
        Some(severity) if severity.within_90[0] == severity.within_90[1] => {
            axes.note(canvas, "damage of this kind has one severity alone");
            return axes.frame(canvas);
        }
        Some(severity) => severity,
    };
    let damage = |opacity: f64| Fill::tint(colour::VERMILLION, opacity);
    for ([from, to], opacity) in [(severity.within_90, 0.14), (severity.within_50, 0.2)] {
        axes.band(canvas, from, to, damage(opacity));
    }
    let bar = |(bin, &count): (usize, &f64)| {
        let [from, to] = [bin, bin + 1].map(|edge| edge as f64 / BINS as f64);
        [axes.at(from, count), axes.at(to, 0.0)]
    };
    let filled = counts.iter().enumerate().filter(|(_, count)| **count > 0.0);
    canvas.rectangles(&filled.map(bar).collect::<Vec<_>>(), damage(0.75));
    let median = Stroke::solid(colour::INK, 1.6);
    canvas.line(axes.at(severity.median, 0.0), axes.at(severity.median, axes.y[1]), median);
    let text = format!("median {:.2}", severity.median);
    let entries = [
        (Sample::Area(damage(0.14)), "90 %"),
        (Sample::Area(damage(0.34)), "50 %"),
        (Sample::Line(median), &text),
    ];
    // Where there is more room.
    let x = if severity.median > 0.5 { axes.px(0.0) + 12.0 } else { axes.px(1.0) - 132.0 };
    legend::column(canvas, (x, axes.area.top + 22.0), &entries);
    axes.frame(canvas);
}

fn explanations(canvas: &mut Canvas, figure: &DiagnosisFigure) {
    let shown = &figure.explanations[..figure.explanations.len().min(MOST_EXPLANATIONS)];
    let values = shown.iter().flat_map(|(_, signal)| signal.iter()).chain(figure.difference_g).copied();
    let y = axes::range(values, MARGIN);
    let (x, teeth) = revolution(figure);
    let areas = EXPLANATIONS.grid([1, shown.len()], [0.0, EXPLANATIONS_GAP], f64::INFINITY);
    for (row, ((words, signal), area)) in shown.iter().zip(areas).enumerate() {
        let what = if figure.kinds.is_empty() { "for comparison" } else { "that resembles it" };
        let title = format!("Simulation {what}: {words}");
        let title = TextStyle::AXES_TITLE.fitted(&title, 0.75 * area.width);
        let axes = Axes::titled(canvas, area, x, y, &title);
        if row + 1 == shown.len() {
            axes.x_axis(canvas, &teeth, &format!("Pitches that the {} has turned", figure.wheel));
        } else {
            axes.x_grid(canvas, &teeth);
        }
        axes.y_axis(canvas, &Ticks::nice(y[0], y[1], 3), "Signal (g)", NAME_LEFT);
        tooth(canvas, &axes, figure);
        axes.line(canvas, over(axes.x, figure.difference_g), BEHIND);
        axes.line(canvas, over(axes.x, signal), EXPLAINED);
        if row == 0 {
            let entries = [(Sample::Line(EXPLAINED), "simulation"), (Sample::Line(BEHIND), "recording")];
            axes.legend(canvas, &entries);
        }
        axes.frame(canvas);
    }
}
