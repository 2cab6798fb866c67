//! The indicators, for reading.

use std::fmt::Write;

use meshtone::signal::ShapeIndicators;
use meshtone_io::indicators::RecordEntry;

use super::process::Wheel;
use super::results::Series;
use crate::table::short;

/// The table of one record or of a series.
pub fn table(series: &Series) -> String {
    let mut text = String::new();
    let unit = series.results.unit.as_deref().unwrap_or("unit not stated");
    // Writing to a string cannot fail.
    let _ = writeln!(text, "  channel {}, {unit}", series.results.channel);
    for wheel in &series.wheels {
        let _ = if series.is_series() {
            of_series(&mut text, series, wheel)
        } else {
            of_record(&mut text, series, wheel)
        };
    }
    text
}

fn of_record(text: &mut String, series: &Series, wheel: &Wheel) -> std::fmt::Result {
    let Some(record) = series.of(wheel).next() else { return Ok(()) };
    writeln!(
        text,
        "\n  {}, {} teeth: average of {} revolutions at {} Hz",
        wheel.name,
        wheel.teeth,
        record.revolutions,
        short(record.mean_speed_hz)
    )?;
    let heads = ["rms", "peak to peak", "crest", "skewness", "kurtosis"];
    writeln!(text, "  {:<12}{}", "", heads.map(|head| format!("{head:>14}")).concat())?;
    let indicators = &record.indicators;
    for (name, part) in [
        ("average", &indicators.average),
        ("regular", &indicators.regular),
        ("residual", &indicators.residual),
        ("difference", &indicators.difference),
        ("envelope", &indicators.envelope),
    ] {
        writeln!(text, "  {name:<12}{}", shape(part).map(|value| format!("{value:>14}")).concat())?;
    }
    let names = ["FM0", "FM4", "M6A", "M8A", "NA4", "energy ratio", "sidebands"];
    writeln!(text, "  {:<12}{}", "", names.map(|name| format!("{name:>14}")).concat())?;
    writeln!(text, "  {:<12}{}", "gear metrics", gear(record).map(|value| format!("{value:>14}")).concat())
}

fn of_series(text: &mut String, series: &Series, wheel: &Wheel) -> std::fmt::Result {
    writeln!(text, "\n  {}, {} teeth", wheel.name, wheel.teeth)?;
    let labels: Vec<String> = series.of(wheel).map(|record| label(series, record)).collect();
    let width = labels.iter().map(|label| label.chars().count()).max().unwrap_or(0).max(6);
    let heads = [
        "revolutions",
        "average rms",
        "diff. rms",
        "FM0",
        "FM4",
        "M6A",
        "M8A",
        "NA4",
        "energy ratio",
        "sidebands",
    ];
    writeln!(text, "  {:<width$}{}", "record", heads.map(|head| format!("{head:>13}")).concat())?;
    for (label, record) in labels.iter().zip(series.of(wheel)) {
        let indicators = &record.indicators;
        let first =
            [record.revolutions.to_string(), short(indicators.average.rms), short(indicators.difference.rms)];
        let values: String =
            first.into_iter().chain(gear(record)).map(|value| format!("{value:>13}")).collect();
        writeln!(text, "  {label:<width$}{values}")?;
    }
    Ok(())
}

/// `run03.csv`, or `run03.csv 12` for a segment.
fn label(series: &Series, record: &RecordEntry) -> String {
    const LONGEST: usize = 32;
    let recording = record.recording.checked_sub(1).and_then(|index| series.results.recordings.get(index));
    let name = recording.map_or_else(String::new, |recording| super::figures::name(&recording.source));
    let letters: Vec<char> = name.chars().collect();
    let name: String = match letters.len().checked_sub(LONGEST) {
        None | Some(0) => name,
        Some(over) => std::iter::once('…').chain(letters[over + 1..].iter().copied()).collect(),
    };
    record.segment.map_or_else(|| name.clone(), |segment| format!("{name} {segment}"))
}

fn shape(shape: &ShapeIndicators) -> [String; 5] {
    let values =
        [Some(shape.rms), Some(shape.peak_to_peak), shape.crest_factor, shape.skewness, shape.kurtosis];
    values.map(or_dash)
}

fn gear(record: &RecordEntry) -> [String; 7] {
    let indicators = &record.indicators;
    let shown = [indicators.fm0, indicators.fm4, indicators.m6a, indicators.m8a, indicators.na4];
    let [a, b, c, d, e] = shown.map(or_dash);
    [a, b, c, d, e, or_dash(indicators.energy_ratio), or_dash(indicators.sideband_level_factor)]
}

fn or_dash(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_string(), short)
}
