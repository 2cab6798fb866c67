//! The columns' headings, and the figure in a sentence.

use super::{RecordFigure, WheelView};
use crate::drawing::{BETWEEN_FACTS, Canvas, Pixel, TextStyle, capitalised, number};

/// The figure in a sentence, for readers who cannot see it.
pub(super) fn description(figure: &RecordFigure) -> String {
    let wheels: Vec<String> =
        figure.wheels.iter().map(|wheel| format!("{}: {}", name(wheel), gear(wheel))).collect();
    format!(
        "A recording, its average over a revolution, order spectrum and difference signal. {}. {}.",
        figure.facts.join(", "),
        wheels.join(". ")
    )
}

pub(super) fn column(canvas: &mut Canvas, (left, baseline): Pixel, width: f64, wheel: &WheelView) {
    let (revolutions, speed) = (wheel.record.average.revolutions, number(wheel.mean_speed_hz));
    let text = format!("{}: average of {revolutions} revolutions at {speed} Hz", name(wheel));
    canvas.section((left, baseline), width, &text, 8.0);
    let style = TextStyle::FACTS;
    canvas.text((left, baseline + 29.0), &style.fitted(&gear(wheel), width), style);
}

/// `Gear, 38 teeth`, or `z2, 96 teeth, on shaft middle`.
fn name(wheel: &WheelView) -> String {
    match wheel.shaft {
        None => format!("{}, {} teeth", capitalised(wheel.name), wheel.teeth),
        Some(shaft) => format!("{}, {} teeth, on shaft {shaft}", wheel.name, wheel.teeth),
    }
}

/// The gear's indicators.
fn gear(wheel: &WheelView) -> String {
    let indicators = &wheel.record.indicators;
    let values = [
        ("FM0", indicators.fm0),
        ("FM4", indicators.fm4),
        ("NA4", indicators.na4),
        ("energy ratio", indicators.energy_ratio),
        ("sideband level factor", indicators.sideband_level_factor),
    ];
    let texts =
        values.map(|(name, value)| format!("{name} {}", value.map_or_else(|| "–".to_owned(), number)));
    texts.join(BETWEEN_FACTS)
}
