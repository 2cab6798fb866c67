//! The indicators, for reading.

use std::fmt::Display;

use meshtone::signal::ShapeIndicators;
use meshtone_io::indicators::RecordEntry;

use super::process::Wheel;
use super::results::Series;
use crate::table::short;

const OF_GEARS: [&str; 7] = ["FM0", "FM4", "M6A", "M8A", "NA4", "energy ratio", "sidebands"];

/// The table of one record or of a series.
pub fn table(series: &Series) -> String {
    let unit = series.results.unit.as_deref().unwrap_or("unit not stated");
    let mut text = format!("  channel {}, {unit}\n", series.results.channel);
    let of_wheel = if series.is_series() { of_series } else { of_record };
    series.wheels.iter().for_each(|wheel| text += &of_wheel(series, wheel));
    text
}

/// A line of a table: `label`, and each of `cells` in `width` characters.
fn line<T: Display>(label: impl Display, cells: impl IntoIterator<Item = T>, width: usize) -> String {
    let cells: String = cells.into_iter().map(|cell| format!("{cell:>width$}")).collect();
    format!("  {label}{cells}\n")
}

fn of_record(series: &Series, wheel: &Wheel) -> String {
    let Some(record) = series.of(wheel).next() else { return String::new() };
    let mut text = format!(
        "\n  {}, {} teeth: average of {} revolutions at {} Hz\n",
        wheel.name,
        wheel.teeth,
        record.revolutions,
        short(record.mean_speed_hz)
    );
    let mut add = |label: &str, cells: &[String]| text += &line(format_args!("{label:<12}"), cells, 14);
    add("", &["rms", "peak to peak", "crest", "skewness", "kurtosis"].map(str::to_owned));
    let indicators = &record.indicators;
    add("average", &shape(&indicators.average));
    add("regular", &shape(&indicators.regular));
    add("residual", &shape(&indicators.residual));
    add("difference", &shape(&indicators.difference));
    add("envelope", &shape(&indicators.envelope));
    add("", &OF_GEARS.map(str::to_owned));
    add("gear metrics", &gear(record));
    text
}

fn of_series(series: &Series, wheel: &Wheel) -> String {
    let labels: Vec<String> = series.of(wheel).map(|record| label(series, record)).collect();
    let width = labels.iter().map(|label| label.chars().count()).max().unwrap_or(0).max(6);
    let heads = ["revolutions", "average rms", "diff. rms"].into_iter().chain(OF_GEARS);
    let mut text = format!("\n  {}, {} teeth\n", wheel.name, wheel.teeth);
    text += &line(format_args!("{:<width$}", "record"), heads, 13);
    for (label, record) in labels.iter().zip(series.of(wheel)) {
        let [average, difference] = [&record.indicators.average, &record.indicators.difference];
        let first = [record.revolutions.to_string(), short(average.rms), short(difference.rms)];
        text += &line(format_args!("{label:<width$}"), first.into_iter().chain(gear(record)), 13);
    }
    text
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

/// The values of [`OF_GEARS`].
fn gear(record: &RecordEntry) -> [String; 7] {
    let of = &record.indicators;
    [of.fm0, of.fm4, of.m6a, of.m8a, of.na4, of.energy_ratio, of.sideband_level_factor].map(or_dash)
}

fn or_dash(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_string(), short)
}
