//! The figure of the last record, and that of the trend.

use std::path::{Path, PathBuf};

use meshtone::scenario::WheelName;
use meshtone::signal::{OrderMapSettings, TrainTurning, order_map};
use meshtone_io::indicators::RecordEntry;
use meshtone_plot::Figure;
use meshtone_plot::bearings::{self as bearings_figure, BearingsFigure};
use meshtone_plot::order_map::{self as order_map_figure, OrderMapFigure};
use meshtone_plot::record::{self, RecordFigure, SignalView, WheelView};
use meshtone_plot::trend::{self, Along, Trend, TrendFigure};

use super::options::ProcessingOptions;
use super::results::{LatestRecords, Series};
use super::train::Turned;

const MESHTONE: &str = concat!("Meshtone ", env!("CARGO_PKG_VERSION"));

/// The last part of a path.
pub fn name(path: &Path) -> String {
    let last = path.file_name().map(|name| name.to_string_lossy().into_owned());
    last.unwrap_or_else(|| path.display().to_string())
}

/// The figure of the last record; none of a machine without wheels.
///
/// The facts below its title say how its signals were made, the source of the phase and what was removed from the average, because the
/// signals cannot be compared with others without that.
pub fn of_record(series: &Series, latest: &LatestRecords, processing: &ProcessingOptions) -> Option<Figure> {
    if latest.wheels.is_empty() {
        return None;
    }
    let channel = &latest.input.channel;
    let mut facts = vec![format!("phase from the {}", latest.turned.source)];
    if series.is_series() {
        let records = if processing.revolutions.is_some() { "segments" } else { "recordings" };
        facts.insert(0, format!("the last of {} {records}", counted(series)));
    }
    let mut removed = vec!["mesh orders".to_string()];
    if processing.sidebands > 0 {
        removed.push(format!("±{} sidebands", processing.sidebands));
    }
    if processing.low_orders > 0 {
        removed.push(format!("shaft orders 1 to {}", processing.low_orders));
    }
    if latest.wheels.iter().any(|(wheel, ..)| wheel.shaft.is_some()) {
        removed.push("orders of other shafts and meshes".to_owned());
    }
    facts.push(format!("difference without {}", removed.join(", ")));
    let foreign = series.results.recordings.last().and_then(|recording| recording.foreign_lines.as_deref());
    match foreign {
        None | Some([]) => {}
        Some([only]) => facts.push(format!("one foreign line, at {:.2} Hz", only.frequency_hz)),
        Some(lines @ [strongest, ..]) => {
            let (count, hz) = (lines.len(), strongest.frequency_hz);
            facts.push(format!("{count} foreign lines, the strongest at {hz:.2} Hz"));
        }
    }
    facts.push(MESHTONE.to_owned());
    let wheels: Vec<WheelView> = latest
        .wheels
        .iter()
        .map(|(wheel, mean_speed_hz, record)| WheelView {
            name: &wheel.name,
            teeth: wheel.teeth,
            shaft: wheel.shaft.as_deref(),
            other_teeth: &wheel.separation.other_teeth,
            other_orders: &wheel.separation.other_orders,
            mean_speed_hz: *mean_speed_hz,
            sidebands: processing.sidebands as usize,
            low_orders: processing.low_orders as usize,
            first_tooth: &wheel.first_tooth,
            damaged_teeth: &wheel.damaged_teeth,
            record,
        })
        .collect();
    let signal = SignalView {
        quantity: &channel.name,
        unit: channel.unit.as_deref(),
        sampling_rate_hz: latest.input.sampling_rate_hz,
        start_s: latest.input.start_s,
        samples: &channel.samples,
    };
    let title = title(std::slice::from_ref(&latest.input.source), series);
    Some(record::draw(&RecordFigure { title: &title, facts: &facts, signal, wheels: &wheels }))
}

/// The figure of the orders of the first wheel's shaft over time, where the last recording is a run-up: where the speed changes so much that
/// resonances pass over orders. Of another the average says all. A recording that has too few revolutions for a map has no figure.
pub fn of_order_map(series: &Series, latest: &LatestRecords) -> Option<Figure> {
    let input = &latest.input;
    let Turned { train, turning, source, wheels, .. } = &latest.turned;
    let wheel = wheels.first()?;
    let turning = match turning {
        TrainTurning::Shaft { shaft, phase, .. } => {
            train.carried(phase, *shaft, train.wheels[0].shaft).ok()?
        }
        TrainTurning::SimulatedPair(shafts) => shafts.varying_phase(WheelName::Pinion).ok()??,
    };
    if !turning.is_run_up(input.sampling_rate_hz) {
        return None;
    }
    let highest_order = Some(OrderMapSettings::MESH_ORDERS * f64::from(wheel.teeth));
    let settings = OrderMapSettings { highest_order, ..OrderMapSettings::default() };
    let map = order_map(&input.channel.samples, &turning, input.sampling_rate_hz, &settings).ok()?;
    let facts = [format!("phase from the {source}"), MESHTONE.to_owned()];
    let title = title(std::slice::from_ref(&input.source), series);
    Some(order_map_figure::draw(&OrderMapFigure {
        title: &title,
        facts: &facts,
        unit: input.channel.unit.as_deref(),
        wheel: &wheel.name,
        teeth: wheel.teeth,
        start_s: input.start_s,
        map: &map,
    }))
}

/// The figure of the last recording's bearings, where any are looked for.
///
/// # Arguments
/// * `separation` - what was removed from the recording, as the option names it
pub fn of_bearings(series: &Series, latest: &LatestRecords, separation: Option<&str>) -> Option<Figure> {
    let records = latest.bearings.as_ref()?;
    let recording = series.results.recordings.len();
    let entries: Vec<_> =
        series.results.bearings.iter().filter(|entry| entry.recording == recording).collect();
    let names: Vec<(&str, &str)> =
        entries.iter().map(|entry| (entry.name.as_str(), entry.shaft.as_str())).collect();
    let mut facts = vec![format!("phase from the {}", latest.turned.source)];
    facts.extend(entries.iter().map(|entry| format!("{} at {:.4} Hz", entry.shaft, entry.mean_speed_hz)));
    facts.dedup();
    facts.extend(separation.map(|name| format!("separation: {name}")));
    facts.push("×: over the median beside the line".to_owned());
    facts.push(MESHTONE.to_owned());
    let title = title(std::slice::from_ref(&latest.input.source), series);
    Some(bearings_figure::draw(&BearingsFigure {
        title: &title,
        facts: &facts,
        amplitude_unit: entries.first().and_then(|entry| entry.amplitude_unit.as_deref()),
        bearings: &names,
        records,
    }))
}

/// The figure of the indicators over the series.
pub fn of_trend(
    series: &Series,
    indicators: Vec<Trend>,
    source: &str,
    processing: &ProcessingOptions,
) -> Figure {
    let paths: Vec<PathBuf> =
        series.results.recordings.iter().map(|recording| recording.source.clone()).collect();
    let counted_records = match processing.revolutions {
        None => format!("{} recordings", counted(series)),
        Some(revolutions) => format!("{} segments of {revolutions} revolutions", counted(series)),
    };
    let mut facts = vec![counted_records, format!("phase from the {source}")];
    facts.extend(processing.sound_records.map(|first| format!("limits: mean + 3 σ of the first {first}")));
    facts.push(MESHTONE.to_owned());
    let wheels: Vec<String> =
        series.wheels.iter().map(|wheel| format!("{}, {} teeth", wheel.name, wheel.teeth)).collect();
    let names: Vec<String> = paths.iter().map(|path| stem(path)).collect();
    let (along, places) = places(series, &names, processing.revolutions.is_some());
    let figure = TrendFigure {
        title: &title(&paths, series),
        facts: &facts,
        along,
        wheels: &wheels,
        places: &places,
        indicators,
    };
    trend::draw(&figure)
}

/// Abscissas of the records of each wheel: at the number of their recording, or at their time in it.
fn places<'n>(series: &Series, names: &'n [String], in_segments: bool) -> (Along<'n>, Vec<Vec<f64>>) {
    let recordings = &series.results.recordings;
    let along = Along::Recordings { names };
    let at = |place: &dyn Fn(f64) -> f64| -> Vec<Vec<f64>> {
        series.middles.iter().map(|middles| middles.iter().map(|middle| place(*middle)).collect()).collect()
    };
    match &recordings[..] {
        [only] if in_segments => {
            let length_s = only.samples as f64 / only.sampling_rate_hz;
            let along = Along::Time { start_s: only.start_s, end_s: only.start_s + length_s };
            (along, at(&|middle| only.start_s + length_s * middle))
        }
        _ if in_segments => (along, at(&|middle| middle + 0.5)),
        _ => (along, at(&|middle| middle.floor() + 1.0)),
    }
}

/// The date in the name of a file, or else the name without its ending, shortened to what an axis has room for.
fn stem(path: &Path) -> String {
    const DATE: usize = "2026-11-29".len();
    const LONGEST: usize = 12;
    let name = path.file_stem().map_or_else(|| name(path), |stem| stem.to_string_lossy().into_owned());
    let letters: Vec<char> = name.chars().collect();
    let is_date = |part: &&[char]| {
        part.iter().enumerate().all(|(place, letter)| match place {
            4 | 7 => matches!(letter, '-' | '_' | '.'),
            _ => letter.is_ascii_digit(),
        })
    };
    match letters.windows(DATE).find(is_date) {
        Some(date) => date.iter().collect(),
        // The ends of names differ.
        None => letters[letters.len().saturating_sub(LONGEST)..].iter().collect(),
    }
}

/// Records of each wheel.
fn counted(series: &Series) -> usize {
    series.wheels.iter().map(|wheel| series.of(wheel).count()).max().unwrap_or(0)
}

/// `run01.csv … run12.csv`.
pub fn several_names(paths: &[PathBuf]) -> String {
    match paths {
        [first, .., last] => format!("{} … {}", name(first), name(last)),
        several => several.iter().map(|path| name(path)).collect(),
    }
}

/// `run01.csv … run12.csv: bearing`.
fn title(paths: &[PathBuf], series: &Series) -> String {
    format!("{}: {}", several_names(paths), series.results.channel)
}

/// The indicators that the figure of the trend shows.
pub fn trends(series: &Series) -> Vec<Trend> {
    type Value = fn(&RecordEntry) -> Option<f64>;
    let unit = series.results.unit.as_deref().unwrap_or("unit not stated");
    let shown: [(&str, &str, Value); 9] = [
        ("RMS of the average", unit, |record| Some(record.indicators.average.rms)),
        ("RMS of the difference", unit, |record| Some(record.indicators.difference.rms)),
        ("Peak to peak of the difference", unit, |record| Some(record.indicators.difference.peak_to_peak)),
        ("FM0", "", |record| record.indicators.fm0),
        ("FM4, kurtosis of the difference", "", |record| record.indicators.fm4),
        ("NA4", "", |record| record.indicators.na4),
        ("M6A", "", |record| record.indicators.m6a),
        ("Energy ratio", "", |record| record.indicators.energy_ratio),
        ("Sideband level factor", "", |record| record.indicators.sideband_level_factor),
    ];
    let trend = |(name, unit, value): (&str, &str, Value)| Trend {
        name: name.to_string(),
        unit: unit.to_string(),
        values: series.wheels.iter().map(|wheel| series.of(wheel).map(value).collect()).collect(),
        limits: Vec::new(),
    };
    shown.map(trend).to_vec()
}
