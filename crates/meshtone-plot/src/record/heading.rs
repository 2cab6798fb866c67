//! Title, facts and the columns' headings.

use super::{LEFT, NAME_LEFT, RIGHT, RecordFigure, WheelView};
use crate::canvas::{Canvas, Pixel};
use crate::style::{Stroke, TextStyle, colour};
use crate::text::fitted;
use crate::ticks::number;

/// (px) Where the names of the vertical axes begin.
const EDGE: f64 = LEFT - NAME_LEFT - 11.0;

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

pub(super) fn draw(canvas: &mut Canvas, figure: &RecordFigure) {
    let title = fitted(figure.title, TextStyle::TITLE, RIGHT - EDGE);
    canvas.text((EDGE, 36.0), &title, TextStyle::TITLE);
    let facts = fitted(&figure.facts.join("  ·  "), TextStyle::FACTS, RIGHT - EDGE);
    canvas.text((EDGE, 61.0), &facts, TextStyle::FACTS);
}

pub(super) fn column(canvas: &mut Canvas, (left, baseline): Pixel, width: f64, wheel: &WheelView) {
    let text = format!(
        "{}: average of {} revolutions at {} Hz",
        name(wheel),
        wheel.record.average.revolutions,
        number(wheel.mean_speed_hz)
    );
    canvas.text((left, baseline), &fitted(&text, TextStyle::HEADING, width), TextStyle::HEADING);
    canvas.line((left, baseline + 8.0), (left + width, baseline + 8.0), Stroke::solid(colour::INK, 1.2));
    let style = TextStyle::FACTS;
    canvas.text((left, baseline + 29.0), &fitted(&gear(wheel), style, width), style);
}

/// `Gear, 38 teeth`.
fn name(wheel: &WheelView) -> String {
    let mut letters = wheel.name.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    format!("{first}{}, {} teeth", letters.as_str(), wheel.teeth)
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
    let texts = values.map(|(name, value)| match value {
        Some(value) => format!("{name} {}", number(value)),
        None => format!("{name} –"),
    });
    texts.join("  ·  ")
}
