//! Indicators and errors against the cases.

use meshtone::tuning::{Case, TuningIndicator};

use super::data::{DRAWS, Data};
use super::symbols::{
    ENHANCED, ENHANCED_MARKER, LEFT_OUT, LEFT_OUT_MARKER, MEDIAN, ORIGINAL, ORIGINAL_MARKER, RECORDS,
};
use crate::axes::{self, Area, Axes};
use crate::canvas::Canvas;
use crate::font;
use crate::legend::{self, Entry, Sample};
use crate::marker::Marker;
use crate::style::{Anchor, DOT_RADIUS, Fill, Stroke, TextStyle, colour};
use crate::ticks::Ticks;

const MARGIN: f64 = 0.08;
/// (cases) Half of the width over which records are spread, and their middle.
const HALF_RECORDS: f64 = 0.2;
const RECORDS_AT: f64 = -0.15;
/// (px) Width of a case beyond which what belongs to it does not spread farther.
const WIDEST: f64 = 190.0;
/// (cases) Where the simulations' markers stand, beside the records.
const ORIGINAL_AT: f64 = 0.14;
const ENHANCED_AT: f64 = 0.24;
/// Dots in all; of more records, only every second, third, … of a case in order of size is drawn.
const MOST_DOTS: usize = 6000;
/// The golden ratio's multiples, modulo 1, fill an interval evenly.
const GOLDEN: f64 = 0.618_033_988_749_894_8;
const LABEL_LINES: usize = 3;
const LABEL_PITCH: f64 = 15.0;
const LABEL_GAP: f64 = 8.0;
/// (px) From the frame to the first line's baseline.
const FIRST_LABEL: f64 = 17.0;
const NAMES: Stroke = Stroke::solid(colour::GRID, 1.0);
/// (px) Height of a vertical axis per number.
const PER_NUMBER: f64 = 26.0;
const LEAST_PER_NUMBER: f64 = 17.0;

pub(super) fn draw(canvas: &mut Canvas, areas: &[Area], data: &Data) {
    let Some((errors, indicators)) = areas.split_last() else { return };
    for (j, (&area, &name)) in indicators.iter().zip(data.indicators()).enumerate() {
        indicator(canvas, area, data, j, name);
    }
    legend(canvas, super::HEADING_BASELINE, data);
    error(canvas, *errors, data);
    labels(canvas, *errors, data);
}

fn axes_of(area: Area, cases: usize, y: [f64; 2]) -> Axes {
    Axes::new(area, [-0.5, cases as f64 - 0.5], y)
}

/// A place beside the middle of a case, given in cases.
fn beside(axes: &Axes, case: usize, at: f64) -> f64 {
    let cases = axes.x[1] - axes.x[0];
    case as f64 + at * (WIDEST * cases / axes.area.width).min(1.0)
}

/// Title, vertical axis and a line between neighbouring cases.
fn ground(canvas: &mut Canvas, axes: &Axes, cases: usize, title: &str, unit: &str) {
    axes.title(canvas, title);
    let numbers = (axes.area.height / PER_NUMBER) as usize;
    let most = (axes.area.height / LEAST_PER_NUMBER) as usize;
    let ticks = Ticks::nice(axes.y[0], axes.y[1], numbers.clamp(2, 6)).thinned(most);
    axes.y_axis(canvas, &ticks, unit, super::NAME_LEFT);
    for case in 1..cases {
        let x = axes.px(case as f64 - 0.5);
        canvas.line((x, axes.area.top), (x, axes.area.bottom()), NAMES);
    }
}

fn indicator(canvas: &mut Canvas, area: Area, data: &Data, j: usize, indicator: TuningIndicator) {
    let cases = data.cases();
    let original = |case: usize| data.tuning.original[case][j];
    let enhanced = |case: usize| data.tuning.enhanced[case][j];
    let simulated = (0..cases).flat_map(|case| {
        let [low, high] = data.spread[case][j];
        [original(case), enhanced(case), low, high]
    });
    let records = (0..cases).flat_map(|case| data.measured().records(case, j).iter().copied());
    let axes = axes_of(area, cases, axes::range(simulated.chain(records), MARGIN));
    ground(canvas, &axes, cases, &title(indicator), "(–)");
    for case in 0..cases {
        dots(canvas, &axes, case, data.measured().records(case, j), every_nth(data));
    }
    connected(canvas, &axes, cases, ORIGINAL_AT, &original, ORIGINAL);
    connected(canvas, &axes, cases, ENHANCED_AT, &enhanced, ENHANCED);
    for case in 0..cases {
        level(canvas, &axes, case, RECORDS_AT, data.measured().median(case, j));
        let [low, high] = data.spread[case][j];
        if axes::drawable(low) && axes::drawable(high) {
            whisker(canvas, &axes, beside(&axes, case, ENHANCED_AT), [low, high]);
        }
    }
    markers(canvas, &axes, cases, ORIGINAL_AT, &original, ORIGINAL_MARKER);
    markers(canvas, &axes, cases, ENHANCED_AT, &enhanced, ENHANCED_MARKER);
    axes.frame(canvas);
}

/// A short line, as wide as the records.
fn level(canvas: &mut Canvas, axes: &Axes, case: usize, at: f64, y: f64) {
    let [from, to] = [-HALF_RECORDS, HALF_RECORDS].map(|half| axes.at(beside(axes, case, at + half), y));
    canvas.line(from, to, MEDIAN);
}

fn whisker(canvas: &mut Canvas, axes: &Axes, x: f64, ends: [f64; 2]) {
    let [low, high] = ends.map(|y| axes.at(x, y));
    canvas.line(low, high, ENHANCED);
    for (x, y) in [low, high] {
        canvas.line((x - 4.0, y), (x + 4.0, y), ENHANCED);
    }
}

fn error(canvas: &mut Canvas, area: Area, data: &Data) {
    let cases = data.cases();
    let measured = data.measured();
    let original = |case: usize| measured.case_error(case, &data.tuning.original[case]);
    let enhanced = |case: usize| measured.case_error(case, &data.tuning.enhanced[case]);
    let left_out = |case: usize| data.tuning.leave_one_out_error[case];
    let all = (0..cases).flat_map(|case| [original(case), enhanced(case), left_out(case)]);
    let [_, high] = axes::range(all, MARGIN);
    let axes = axes_of(area, cases, [0.0, high]);
    ground(canvas, &axes, cases, "Mean error of the case", "(σ)");
    connected(canvas, &axes, cases, 0.0, &original, ORIGINAL);
    connected(canvas, &axes, cases, 0.0, &left_out, LEFT_OUT);
    connected(canvas, &axes, cases, 0.0, &enhanced, ENHANCED);
    for case in 0..cases {
        level(canvas, &axes, case, 0.0, measured.case_scatter(case));
    }
    markers(canvas, &axes, cases, 0.0, &original, ORIGINAL_MARKER);
    markers(canvas, &axes, cases, 0.0, &left_out, LEFT_OUT_MARKER);
    markers(canvas, &axes, cases, 0.0, &enhanced, ENHANCED_MARKER);
    axes.frame(canvas);
    let entries = [
        (Sample::Line(MEDIAN), "measurements’ own scatter"),
        (Sample::Marked(LEFT_OUT, LEFT_OUT_MARKER), "predicted by a fit to the other cases"),
    ]
    .map(|(sample, text)| Entry { sample, text });
    legend::row(canvas, (area.right(), area.top - axes::TITLE_ABOVE), &entries);
}

/// Every record, spread over the width of the case in the order of measurement.
fn dots(canvas: &mut Canvas, axes: &Axes, case: usize, records: &[f64], every: usize) {
    let mut sorted: Vec<(usize, f64)> = records.iter().copied().enumerate().collect();
    sorted.sort_by(|a, b| a.1.total_cmp(&b.1));
    let pixels: Vec<_> = sorted
        .into_iter()
        .step_by(every)
        .map(|(record, value)| {
            let place = (record as f64 * GOLDEN).fract() - 0.5;
            axes.at(beside(axes, case, RECORDS_AT + 2.0 * 0.95 * HALF_RECORDS * place), value)
        })
        .collect();
    canvas.dots(&pixels, DOT_RADIUS, RECORDS);
}

fn every_nth(data: &Data) -> usize {
    let records = |case| (0..data.indicators().len()).map(move |j| data.measured().records(case, j).len());
    (0..data.cases()).flat_map(records).sum::<usize>().div_ceil(MOST_DOTS).max(1)
}

fn places(axes: &Axes, cases: usize, at: f64, value: &dyn Fn(usize) -> f64) -> Vec<(f64, f64)> {
    let place = |case| (beside(axes, case, at), value(case));
    (0..cases).map(place).filter(|&(_, y)| axes::drawable(y)).collect()
}

fn connected(
    canvas: &mut Canvas,
    axes: &Axes,
    cases: usize,
    at: f64,
    value: &dyn Fn(usize) -> f64,
    stroke: Stroke,
) {
    axes.line(canvas, places(axes, cases, at, value).into_iter(), stroke);
}

fn markers(
    canvas: &mut Canvas,
    axes: &Axes,
    cases: usize,
    at: f64,
    value: &dyn Fn(usize) -> f64,
    marker: Marker,
) {
    for (x, y) in places(axes, cases, at, value) {
        marker.draw(canvas, axes.at(x, y));
    }
}

/// At the end of the heading.
fn legend(canvas: &mut Canvas, baseline: f64, data: &Data) {
    let records = match every_nth(data) {
        1 => "measured records".to_owned(),
        every => format!("measured records (1 of {every})"),
    };
    let enhanced = format!("enhanced; bar: {DRAWS} draws of the noise");
    let entries = [
        (Sample::Dots(Fill { opacity: 0.6, ..RECORDS }), records.as_str()),
        (Sample::Line(MEDIAN), "their median"),
        (Sample::Marked(ORIGINAL, ORIGINAL_MARKER), "original simulation"),
        (Sample::Marked(ENHANCED, ENHANCED_MARKER), enhanced.as_str()),
    ]
    .map(|(sample, text)| Entry { sample, text });
    legend::row(canvas, (super::LEFT + super::CASES_WIDTH, baseline), &entries);
}

/// Names of the cases, below the lowest plot.
fn labels(canvas: &mut Canvas, area: Area, data: &Data) {
    let axes = axes_of(area, data.cases(), [0.0, 1.0]);
    let style = TextStyle::NOTE.anchored(Anchor::Middle);
    for (case, lines) in label_lines(area.width, data).iter().enumerate() {
        for (number, line) in lines.iter().enumerate() {
            let at = (axes.px(case as f64), area.bottom() + FIRST_LABEL + LABEL_PITCH * number as f64);
            canvas.text(at, line, style);
        }
    }
}

fn label_lines(width: f64, data: &Data) -> Vec<Vec<String>> {
    let of_case = width / data.cases() as f64 - LABEL_GAP;
    let style = TextStyle::NOTE;
    let numbered = data.shown_cases().len() < data.cases();
    let lines = |(number, case): (usize, &Case)| {
        let label = if numbered { format!("{number}: {}", case.label) } else { case.label.clone() };
        font::wrapped(&label, of_case, LABEL_LINES, style.size, style.bold)
    };
    data.experiment.cases.iter().enumerate().map(lines).collect()
}

/// (px) Height of the names below the lowest plot.
pub(super) fn labels_height(width: f64, data: &Data) -> f64 {
    let most = label_lines(width, data).iter().map(Vec::len).max().unwrap_or(1).max(1);
    FIRST_LABEL + LABEL_PITCH * (most as f64 - 1.0)
}

/// What the indicator is and whether its logarithm is drawn.
fn title(indicator: TuningIndicator) -> String {
    let name = name(indicator);
    if indicator.is_logarithmic() { format!("{name}, decadic logarithm") } else { name.to_owned() }
}

fn name(indicator: TuningIndicator) -> &'static str {
    match indicator {
        TuningIndicator::Rms => "Rms over the healthy rms",
        TuningIndicator::Kurtosis => "Kurtosis",
        TuningIndicator::Skewness => "Skewness",
        TuningIndicator::EnvelopeRms => "Rms of the envelope over the healthy one",
        TuningIndicator::EnvelopeKurtosis => "Kurtosis of the envelope",
        TuningIndicator::EnvelopeSkewness => "Skewness of the envelope",
    }
}
