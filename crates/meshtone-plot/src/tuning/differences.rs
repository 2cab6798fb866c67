//! Difference signals of the cases: original, enhanced, and measured where such were given.

use super::data::Data;
use super::symbols::{ENHANCED_CURVE, MEASURED_CURVE, ORIGINAL_CURVE};
use crate::drawing::{Anchor, Area, Axes, Canvas, Stroke, TextStyle, Ticks, axes};

const ORIGINAL_TITLE: &str = "Original simulation (over the healthy rms)";
const ENHANCED_TITLE: &str = "Enhanced, one draw of the noise (over the healthy rms)";
const MEASURED_TITLE: &str =
    "Measured, of each case the record that is the nearest to the medians (over the healthy rms)";
/// (px) Numbers left of each plot, and the gap right of it.
const NUMBERS: f64 = 33.0;
const GAP: f64 = 7.0;
const MARGIN: f64 = 1.08;
/// The case's number, where the columns are not those of the indicators.
const NUMBER: TextStyle = TextStyle::TICK.anchored(Anchor::Start).with_halo();

pub(super) fn heading(data: &Data) -> String {
    let scales = match data.measured_signals {
        None => "each on its own scale",
        Some(_) => "enhanced and measured ones of a case on the same scale",
    };
    format!("Difference signals over one revolution of {}, {scales}", averaged(data))
}

/// The wheel over whose revolutions is averaged, in words.
fn averaged(data: &Data) -> String {
    data.experiment.base.wheel_in_words(&data.experiment.chain.wheel)
}

/// Number of rows of signals.
pub(super) fn rows(data: &Data) -> usize {
    if data.measured_signals.is_some() { 3 } else { 2 }
}

/// One row: a signal of each case.
struct SignalRow<'a> {
    title: &'static str,
    stroke: Stroke,
    /// By case.
    signals: Vec<&'a [f64]>,
    /// (healthy rms) Largest value that the vertical axis of a case is made for.
    sizes: Vec<f64>,
}

impl<'a> SignalRow<'a> {
    fn new(title: &'static str, stroke: Stroke, signals: Vec<&'a [f64]>) -> Self {
        let sizes = signals.iter().map(|values| axes::largest(*values)).collect();
        Self { title, stroke, signals, sizes }
    }
}

fn rows_of<'a>(data: &'a Data) -> Vec<SignalRow<'a>> {
    let all = |signals: &'a [Vec<f64>]| signals.iter().map(Vec::as_slice).collect();
    let mut enhanced = SignalRow::new(ENHANCED_TITLE, ENHANCED_CURVE, all(&data.enhanced_signals));
    let measured = data.measured_signals.clone().map(|signals| {
        let mut row = SignalRow::new(MEASURED_TITLE, MEASURED_CURVE, signals);
        // Compared by eye, so on the same scale.
        for (one, other) in row.sizes.iter_mut().zip(&mut enhanced.sizes) {
            *one = one.max(*other);
            *other = *one;
        }
        row
    });
    let original = SignalRow::new(ORIGINAL_TITLE, ORIGINAL_CURVE, all(&data.original_signals));
    [Some(original), Some(enhanced), measured].into_iter().flatten().collect()
}

/// Draws the rows of signals, one in each area.
pub(super) fn draw(canvas: &mut Canvas, areas: &[Area], data: &Data) {
    let shown = data.shown_cases();
    let Some(&lowest) = areas.last() else { return };
    for (number, (row, &area)) in rows_of(data).iter().zip(areas).enumerate() {
        canvas.text((area.left + NUMBERS, area.top - axes::TITLE_ABOVE), row.title, TextStyle::AXES_TITLE);
        let slot = area.width / shown.len() as f64;
        for (column, &case) in shown.iter().enumerate() {
            let left = area.left + column as f64 * slot;
            let plot = Area::new(left + NUMBERS, area.top, slot - NUMBERS - GAP, area.height);
            signal(canvas, plot, row, case, number + 1 == areas.len());
            if shown.len() < data.cases() {
                canvas.text((plot.left + 4.0, plot.top + 13.0), &format!("case {case}"), NUMBER);
            }
        }
    }
    let angle = format!("Angle of {} from the middle of the fault’s response (rev)", averaged(data));
    Axes::new(lowest, [0.0; 2], [0.0; 2]).x_name(canvas, &angle);
}

fn signal(canvas: &mut Canvas, area: Area, row: &SignalRow, case: usize, numbered: bool) {
    let values = row.signals[case];
    let half = if row.sizes[case] > 0.0 { MARGIN * row.sizes[case] } else { 1.0 };
    let axes = Axes::new(area, [-0.5, 0.5], [-half, half]);
    let angles = Ticks::every(0.4, -0.4, 0.4);
    axes.x_grid(canvas, &angles);
    if numbered {
        axes.x_numbers(canvas, &angles);
    }
    axes.y_axis(canvas, &Ticks::about_zero(half), "", super::NAME_LEFT);
    let count = values.len() as f64;
    let points = values.iter().enumerate().map(|(i, &value)| ((i as f64 + 0.5) / count - 0.5, value));
    axes.line(canvas, points, row.stroke);
    axes.frame(canvas);
}
