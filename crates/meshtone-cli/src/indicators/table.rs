//! The indicators, for reading.

use std::fmt::Display;

use meshtone::signal::ShapeIndicators;
use meshtone_io::indicators::{BearingEntry, LimitEntry, RecordEntry, RecordingEntry};

use super::limits::Iso20816;
use super::process::Wheel;
use super::results::Series;
use crate::table::short;

const OF_GEARS: [&str; 7] = ["FM0", "FM4", "M6A", "M8A", "NA4", "energy ratio", "sidebands"];

/// Foreign lines that are printed; the others are counted.
const LINES: usize = 10;
/// (-) Part of the orders that are the machine's own from which on the table recommends a longer recording: a line is rather missed than found.
const MOST_OWN: f64 = 0.5;
/// Kurtosis of a difference signal of a planetary set that is impulsive: sound simulated sets have 3.2 to 4.4.
const IMPULSIVE: f64 = 5.0;
/// How many times that of the next wheel it is where a wheel stands out.
const BESIDE_NEXT: f64 = 1.15;

/// The table of one record or of a series.
///
/// # Arguments
/// * `series` - all records
/// * `machine` - its class and mounting, where they were stated
pub fn table(series: &Series, machine: Option<Iso20816>) -> String {
    let unit = series.results.unit.as_deref().unwrap_or("unit not stated");
    let mut text = format!("  channel {}, {unit}\n", series.results.channel);
    if series.is_series() {
        series.wheels.iter().for_each(|wheel| text += &of_series(series, wheel));
    } else {
        for (number, wheel) in series.wheels.iter().enumerate() {
            let is_on_shaft = |other: &&Wheel| other.shaft.is_some() && other.shaft == wheel.shaft;
            // Wheels on one shaft have one average.
            if !series.wheels[..number].iter().any(|other| is_on_shaft(&other)) {
                let others = series.wheels[number + 1..].iter().filter(is_on_shaft);
                text += &of_record(series, &std::iter::once(wheel).chain(others).collect::<Vec<_>>());
            }
        }
    }
    text += &standing_out(series);
    text += &foreign_lines(series, unit);
    text += &series.results.bearings.iter().map(|entry| bearing(series, entry)).collect::<String>();
    text += &limits(series);
    text + &velocities(series, machine)
}

/// Which wheel of planetary sets has the most impulsive difference signal, where one stands out.
fn standing_out(series: &Series) -> String {
    let of_sets = series.wheels.iter().filter(|wheel| wheel.tooth_order_of_carrier_against_ring.is_some());
    let mut wheels: Vec<(f64, &str)> = of_sets
        .filter_map(|wheel| Some((series.of(wheel).last()?.indicators.difference.kurtosis?, &*wheel.name)))
        .collect();
    wheels.sort_by(|a, b| b.0.total_cmp(&a.0));
    let [(largest, wheel), (next, other), ..] = wheels[..] else { return String::new() };
    let [largest_in_words, next_in_words] = [largest, next].map(short);
    let said = if largest <= IMPULSIVE {
        format!(
            "no wheel of a planetary set stands out: kurtosis of the difference {largest_in_words} at most (cracks, and damage of one flank of a \
             planet, may not show)"
        )
    } else if largest > BESIDE_NEXT * next {
        format!(
            "{wheel} stands out: kurtosis of the difference {largest_in_words}, of {other} {next_in_words} (from a sensor that measures outwards \
             it may be a neighbour of that planet)"
        )
    } else {
        format!(
            "{wheel} and {other} stand out alike: kurtosis of the difference {largest_in_words} and {next_in_words}; a sensor along the \
             circumference of the ring tells planets apart better than one across it"
        )
    };
    format!("\n  {said}\n")
}

/// The verdict about a bearing in a recording, and its lines.
fn bearing(series: &Series, entry: &BearingEntry) -> String {
    let BearingEntry { name, shaft, mean_speed_hz, band, .. } = entry;
    let of = match series.results.recordings.get(entry.recording - 1) {
        Some(recording) if series.results.recordings.len() > 1 => {
            format!(" in {}", super::figures::name(&recording.source))
        }
        _ => String::new(),
    };
    let kurtosis =
        entry.band_kurtosis.map_or_else(String::new, |value| format!(", kurtosis {}", short(value)));
    let mut text =
        format!("\n  bearing {name} on {shaft} at {} Hz{of}: {}\n", short(*mean_speed_hz), entry.verdict.0);
    text += &format!("    {}\n", entry.verdict.1);
    text += &entry.unexplained.iter().map(|comb| format!("    {comb}\n")).collect::<String>();
    text +=
        &format!("    squared envelope of {} to {} Hz{kurtosis}\n", short(band.from_hz), short(band.to_hz));
    let heads = ["order", "found at", "amplitude", "over the median"];
    text += &line(format_args!("{:<12}", ""), heads, 17);
    for of in &entry.lines {
        let cells = [
            format!("{:.4}", of.order),
            format!("{:.4}", of.found_order),
            short(of.amplitude),
            format!("{:.1}", of.over_median),
        ];
        let beside = if of.is_beside_shaft_order { "  or a whole order of the shaft" } else { "" };
        let row = line(format_args!("{:<12}", of.name()), cells, 17);
        text += &format!("{}{beside}\n", row.trim_end());
    }
    text
}

/// Rms of the velocity of each recording, where the channel is an acceleration.
fn velocities(series: &Series, machine: Option<Iso20816>) -> String {
    let recordings = series.results.recordings.iter();
    let values: Vec<String> = recordings
        .filter_map(|recording| {
            let zone = recording.velocity_zone.map_or_else(String::new, |zone| format!(" (zone {zone})"));
            recording.velocity_rms_mm_per_s.map(|velocity| short(velocity) + &zone)
        })
        .collect();
    if values.is_empty() {
        return String::new();
    }
    let zones = machine.map_or_else(String::new, |machine| format!("    zones of {}\n", machine.in_words()));
    format!("\n  velocity from 10 to 1000 Hz, rms in mm/s: {}\n{zones}", values.join(", "))
}

/// Which limits of the trend were crossed, and where first.
fn limits(series: &Series) -> String {
    let limits = &series.results.limits;
    if limits.is_empty() {
        return String::new();
    }
    let crossed = limits.iter().filter_map(|of| {
        let (recording, segment) = of.crossed_at?;
        let source =
            series.results.recordings.get(recording - 1).map(|entry| super::figures::name(&entry.source));
        let segment = segment.map_or_else(String::new, |segment| format!(", segment {segment}"));
        let LimitEntry { wheel, indicator, limit, .. } = of;
        Some(format!("    {indicator} of {wheel}: first above {} at {}{segment}\n", short(*limit), source?))
    });
    let crossed: String = crossed.collect();
    let none = if crossed.is_empty() { "    none was crossed\n" } else { "" };
    format!("\n  limits of the trend (mean + 3 σ of the first records)\n{none}{crossed}")
}

/// The lines of the last recording that belong to no shaft and no mesh, where they were looked for.
fn foreign_lines(series: &Series, unit: &str) -> String {
    let Some(RecordingEntry {
        source,
        foreign_lines: Some(lines),
        own_orders_part: Some(own),
        foreign_lines_need_s,
        ..
    }) = series.results.recordings.last()
    else {
        return String::new();
    };
    let of = if series.results.recordings.len() > 1 {
        format!(" of {}", super::figures::name(source))
    } else {
        String::new()
    };
    if lines.is_empty() {
        let percent = 100.0 * own;
        let searched = match foreign_lines_need_s {
            Some(needed_s) => format!(
                "the recording{of} is too short to distinguish foreign lines from hunting-tooth orders: it needs {:.1} s",
                (10.0 * needed_s).ceil() / 10.0
            ),
            None => format!(
                "no foreign line was found{of}; {percent:.0} % of all orders are too near one of a shaft or a mesh to distinguish a line there"
            ),
        };
        let longer =
            if foreign_lines_need_s.is_none() && *own > MOST_OWN { ": record for longer" } else { "" };
        return format!("\n  {searched}{longer}\n");
    }
    let on = if series.wheels.len() > 2 { "the input" } else { "the shaft" };
    let mut text = format!("\n  lines{of} that belong to no shaft and no mesh\n");
    text += &line("", ["Hz", &format!("order of {on}"), &format!("amplitude, {unit}"), "of energy"], 20);
    for tone in lines.iter().take(LINES) {
        let mains = if tone.may_be_mains { "  a harmonic of the mains" } else { "" };
        let cells = [
            format!("{:.2}", tone.frequency_hz),
            format!("{:.4}", tone.order),
            short(tone.amplitude),
            format!("{:.2} %", 100.0 * tone.part),
        ];
        text += &format!("{}{mains}\n", line("", cells, 20).trim_end());
    }
    if let Some(more @ 1..) = lines.len().checked_sub(LINES) {
        text += &format!("  … and {more} more, in indicators.json\n");
    }
    text
}

/// A line of a table: `label`, and each of `cells` in `width` characters.
fn line<T: Display>(label: impl Display, cells: impl IntoIterator<Item = T>, width: usize) -> String {
    let cells: String = cells.into_iter().map(|cell| format!("{cell:>width$}")).collect();
    format!("  {label}{cells}\n")
}

/// The average over the revolutions of a shaft, and the gear metrics of each wheel on it.
fn of_record(series: &Series, wheels: &[&Wheel]) -> String {
    let Some(record) = wheels.first().and_then(|wheel| series.of(wheel).next()) else { return String::new() };
    let names: Vec<String> =
        wheels.iter().map(|wheel| format!("{}, {} teeth", wheel.name, wheel.teeth)).collect();
    let shaft = wheels[0].shaft.as_ref().map(|shaft| format!("shaft {shaft} with "));
    let order = wheels[0].tooth_order_of_carrier_against_ring;
    let order = order.map(|order| {
        format!("; a damaged tooth shows at order {} of the carrier against the ring", short(order))
    });
    let mut text = format!(
        "\n  {}{}: average of {} revolutions at {} Hz{}\n",
        shaft.unwrap_or_default(),
        names.join(", and "),
        record.revolutions,
        short(record.mean_speed_hz),
        order.unwrap_or_default()
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
    for wheel in wheels {
        let label = if wheels.len() > 1 { &wheel.name } else { "gear metrics" };
        series.of(wheel).next().into_iter().for_each(|record| add(label, &gear(record)));
    }
    text + &of_mesh(series, wheels)
}

/// The amplitudes of the mesh harmonics of each wheel on a shaft, and of the nearest sidebands.
fn of_mesh(series: &Series, wheels: &[&Wheel]) -> String {
    let mut text = String::new();
    let mut add = |label: &str, cells: Vec<String>| text += &line(format_args!("{label:<16}"), cells, 11);
    for wheel in wheels {
        let Some(record) = series.of(wheel).next() else { continue };
        let harmonics = &record.indicators.mesh_harmonics;
        let named =
            if wheels.len() > 1 { format!("{} mesh", wheel.name) } else { "mesh harmonic".to_owned() };
        add(&named, (1..=harmonics.len()).map(|number| number.to_string()).collect());
        add("amplitude", harmonics.iter().map(|of| or_dash(of.amplitude)).collect());
        add("lower sideband", harmonics.iter().map(|of| or_dash(of.lower_sidebands[0])).collect());
        add("upper sideband", harmonics.iter().map(|of| or_dash(of.upper_sidebands[0])).collect());
    }
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
