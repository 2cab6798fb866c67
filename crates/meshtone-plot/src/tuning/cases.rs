//! Indicators and errors against the cases.

use meshtone::tuning::{Case, TuningIndicator};

use super::data::{DRAWS, Data};
use super::symbols::{ENHANCED, LEFT_OUT, MEDIAN, ORIGINAL, RECORDS, Symbol};
use crate::drawing::{
    Anchor, Area, Axes, Canvas, DOT_RADIUS, Fill, Sample, Stroke, TextStyle, Ticks, axes, colour, legend,
};

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

/// What one of the simulations gives, by case.
struct Series {
    values: Vec<f64>,
    /// (cases) Where its markers stand beside the middle of a case.
    at: f64,
    symbol: Symbol,
}

/// A plot over the cases.
struct CasesPlot {
    axes: Axes,
    cases: usize,
}

impl CasesPlot {
    /// Draws title, vertical axis and a line between neighbouring cases.
    fn new(canvas: &mut Canvas, area: Area, cases: usize, y: [f64; 2], title: &str) -> Self {
        let axes = Axes::titled(canvas, area, range_of(cases), y, title);
        let numbers = (area.height / PER_NUMBER) as usize;
        let most = (area.height / LEAST_PER_NUMBER) as usize;
        let ticks = Ticks::nice(y[0], y[1], numbers.clamp(2, 6)).thinned(most);
        axes.y_axis(canvas, &ticks, "", super::NAME_LEFT);
        for case in 1..cases {
            axes.vertical(canvas, case as f64 - 0.5, NAMES);
        }
        Self { axes, cases }
    }

    /// A place beside the middle of a case, given in cases.
    fn beside(&self, case: usize, at: f64) -> f64 {
        case as f64 + at * (WIDEST * self.cases as f64 / self.axes.area.width).min(1.0)
    }

    /// The drawable values of a series and their places.
    fn places(&self, series: &Series) -> impl Iterator<Item = (f64, f64)> {
        let places = series.values.iter().enumerate();
        let places = places.map(|(case, &value)| (self.beside(case, series.at), value));
        places.filter(|&(_, y)| axes::drawable(y))
    }

    /// Lines from case to case, in the order in which the series are given.
    fn connected(&self, canvas: &mut Canvas, series: &[Series]) {
        series.iter().for_each(|series| self.axes.line(canvas, self.places(series), series.symbol.stroke));
    }

    fn markers(&self, canvas: &mut Canvas, series: &[Series]) {
        for series in series {
            self.places(series).for_each(|(x, y)| series.symbol.marker.draw(canvas, self.axes.at(x, y)));
        }
    }

    /// A short line, as wide as the records.
    fn level(&self, canvas: &mut Canvas, case: usize, at: f64, y: f64) {
        let ends = [-HALF_RECORDS, HALF_RECORDS];
        let [from, to] = ends.map(|half| self.axes.at(self.beside(case, at + half), y));
        canvas.line(from, to, MEDIAN);
    }

    fn whisker(&self, canvas: &mut Canvas, x: f64, ends: [f64; 2]) {
        let [low, high] = ends.map(|y| self.axes.at(x, y));
        canvas.line(low, high, ENHANCED.stroke);
        for (x, y) in [low, high] {
            canvas.line((x - 4.0, y), (x + 4.0, y), ENHANCED.stroke);
        }
    }

    /// Every record, spread over the width of the case in the order of measurement.
    fn dots(&self, canvas: &mut Canvas, case: usize, records: &[f64], every: usize) {
        let mut sorted: Vec<(usize, f64)> = records.iter().copied().enumerate().collect();
        sorted.sort_by(|a, b| a.1.total_cmp(&b.1));
        let pixel = |(record, value): (usize, f64)| {
            let place = (record as f64 * GOLDEN).fract() - 0.5;
            self.axes.at(self.beside(case, RECORDS_AT + 2.0 * 0.95 * HALF_RECORDS * place), value)
        };
        let pixels: Vec<_> = sorted.into_iter().step_by(every).map(pixel).collect();
        canvas.dots(&pixels, DOT_RADIUS, RECORDS);
    }
}

/// Range of the horizontal axis: each case is 1 wide.
fn range_of(cases: usize) -> [f64; 2] {
    [-0.5, cases as f64 - 0.5]
}

fn indicator(canvas: &mut Canvas, area: Area, data: &Data, j: usize, indicator: TuningIndicator) {
    let (cases, measured) = (data.cases(), data.measured());
    let of_cases = |values: &[Vec<f64>]| values.iter().map(|of_case| of_case[j]).collect();
    let series = [
        Series { values: of_cases(&data.tuning.original), at: ORIGINAL_AT, symbol: ORIGINAL },
        Series { values: of_cases(&data.tuning.enhanced), at: ENHANCED_AT, symbol: ENHANCED },
    ];
    let simulated = series.iter().flat_map(|series| series.values.iter());
    let spread = data.spread.iter().flat_map(|of_case| &of_case[j]);
    let records = (0..cases).flat_map(|case| measured.records(case, j));
    let y = axes::range(simulated.chain(spread).chain(records).copied(), MARGIN);
    let plot = CasesPlot::new(canvas, area, cases, y, &format!("{} (–)", title(indicator)));
    for case in 0..cases {
        plot.dots(canvas, case, measured.records(case, j), every_nth(data));
    }
    plot.connected(canvas, &series);
    for case in 0..cases {
        plot.level(canvas, case, RECORDS_AT, measured.median(case, j));
        let [low, high] = data.spread[case][j];
        if axes::drawable(low) && axes::drawable(high) {
            plot.whisker(canvas, plot.beside(case, ENHANCED_AT), [low, high]);
        }
    }
    plot.markers(canvas, &series);
    plot.axes.frame(canvas);
}

fn error(canvas: &mut Canvas, area: Area, data: &Data) {
    let (cases, measured, tuning) = (data.cases(), data.measured(), data.tuning);
    let errors = |predicted: &[Vec<f64>]| {
        (0..cases).map(|case| measured.case_error(case, &predicted[case])).collect::<Vec<f64>>()
    };
    let series = [
        Series { values: errors(&tuning.original), at: 0.0, symbol: ORIGINAL },
        Series { values: tuning.left_out.iter().map(|case| case.error).collect(), at: 0.0, symbol: LEFT_OUT },
        Series { values: errors(&tuning.enhanced), at: 0.0, symbol: ENHANCED },
    ];
    let [_, high] = axes::range(series.iter().flat_map(|series| series.values.iter().copied()), MARGIN);
    let plot = CasesPlot::new(canvas, area, cases, [0.0, high], "Mean error of the case (σ)");
    plot.connected(canvas, &series);
    for case in 0..cases {
        plot.level(canvas, case, 0.0, measured.case_scatter(case));
    }
    plot.markers(canvas, &series);
    plot.axes.frame(canvas);
    let entries = [
        (Sample::Line(MEDIAN), "measurements’ own scatter"),
        (LEFT_OUT.sample(), "predicted by a fit to the other cases"),
    ];
    plot.axes.legend(canvas, &entries);
}

fn every_nth(data: &Data) -> usize {
    let records = |case| (0..data.indicators().len()).map(move |j| data.measured().records(case, j).len());
    (0..data.cases()).flat_map(records).sum::<usize>().div_ceil(MOST_DOTS).max(1)
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
        (ORIGINAL.sample(), "original simulation"),
        (ENHANCED.sample(), enhanced.as_str()),
    ];
    legend::row(canvas, (super::LEFT + super::CASES_WIDTH, baseline), &entries);
}

/// Names of the cases, below the lowest plot.
fn labels(canvas: &mut Canvas, area: Area, data: &Data) {
    let axes = Axes::new(area, range_of(data.cases()), [0.0, 1.0]);
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
    let numbered = data.shown_cases().len() < data.cases();
    let lines = |(number, case): (usize, &Case)| {
        let label = if numbered { format!("{number}: {}", case.label) } else { case.label.clone() };
        TextStyle::NOTE.wrapped(&label, of_case, LABEL_LINES)
    };
    data.experiment.cases.iter().enumerate().map(lines).collect()
}

/// (px) Height of the names below the lowest plot.
pub(super) fn labels_height(width: f64, data: &Data) -> f64 {
    let most = label_lines(width, data).iter().map(Vec::len).max().unwrap_or(1).max(1);
    FIRST_LABEL + LABEL_PITCH * (most as f64 - 1.0)
}

/// Name of the indicator, and of its logarithm where that is drawn.
fn title(indicator: TuningIndicator) -> String {
    let name = match indicator {
        TuningIndicator::Rms => "Rms over the healthy rms",
        TuningIndicator::Kurtosis => "Kurtosis",
        TuningIndicator::Skewness => "Skewness",
        TuningIndicator::EnvelopeRms => "Rms of the envelope over the healthy one",
        TuningIndicator::EnvelopeKurtosis => "Kurtosis of the envelope",
        TuningIndicator::EnvelopeSkewness => "Skewness of the envelope",
    };
    let logarithm = if indicator.is_logarithmic() { ", decadic logarithm" } else { "" };
    format!("{name}{logarithm}")
}
