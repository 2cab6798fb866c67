//! The files that the indicators are written to.

use std::path::Path;
use std::thread;

use meshtone::signal::Record;
use meshtone_io::atomic_file::StagedFile;
use meshtone_io::indicators::RecordEntry;
use meshtone_io::own_file::undisturbed;
use meshtone_io::summary::write_json;
use meshtone_plot::Figure;

use super::results::Series;
use crate::failure::Failure;
use crate::replacement::{replace, stage_figure};

const JSON: &str = "indicators.json";
const TABLE: &str = "indicators.parquet";
const BEARINGS_TABLE: &str = "bearings.parquet";
const AVERAGES: &str = "averages.parquet";
const SPECTRA: &str = "spectra.parquet";
const CSV: [&str; 4] = ["indicators.csv", "averages.csv", "spectra.csv", "bearings.csv"];
const RECORD: [&str; 2] = ["indicators.svg", "indicators.png"];
const TREND: [&str; 2] = ["trend.svg", "trend.png"];
const ORDER_MAP: [&str; 2] = ["order_map.svg", "order_map.png"];
const BEARINGS: [&str; 2] = ["bearings.svg", "bearings.png"];
/// All files that may stand in the directory.
pub const FILES: [&str; 17] = [
    JSON,
    TABLE,
    BEARINGS_TABLE,
    AVERAGES,
    SPECTRA,
    CSV[0],
    CSV[1],
    CSV[2],
    CSV[3],
    RECORD[0],
    RECORD[1],
    TREND[0],
    TREND[1],
    ORDER_MAP[0],
    ORDER_MAP[1],
    BEARINGS[0],
    BEARINGS[1],
];

/// The figures, as far as there are any.
#[derive(Default)]
pub struct Figures {
    /// The figure of the last record.
    pub record: Option<Figure>,
    /// The figure of the indicators over the series.
    pub trend: Option<Figure>,
    /// The figure of the orders over the time of a run-up.
    pub order_map: Option<Figure>,
    /// The figure of the last recording's bearings.
    pub bearings: Option<Figure>,
}

/// Writes all files, each whole or not at all.
///
/// All are complete beside their targets before the first takes its name.
///
/// # Arguments
/// * `directory` - of the files
/// * `series`, `figures` - what is written
/// * `csv` - whether the tables are written as CSV too
pub fn write(directory: &Path, series: &Series, figures: &Figures, csv: bool) -> Result<(), Failure> {
    let results = &series.results;
    let stage = |figure: &Option<Figure>, names| match figure {
        Some(figure) => stage_figure(directory, names, figure),
        None => Ok(Vec::new()),
    };
    let (record, others) = thread::scope(|scope| {
        let record = scope.spawn(|| stage(&figures.record, RECORD));
        let others = stage(&figures.trend, TREND).and_then(|mut staged| {
            staged.extend(stage(&figures.order_map, ORDER_MAP)?);
            staged.extend(stage(&figures.bearings, BEARINGS)?);
            Ok(staged)
        });
        let record = record.join().unwrap_or_else(|_| Err(Failure::failed("cannot draw the figure")));
        (record, others)
    });
    let mut staged = record?;
    staged.extend(others?);
    let latest = series.latest.iter().flat_map(|latest| &latest.wheels);
    let records: Vec<(&RecordEntry, &Record)> =
        latest.filter_map(|(wheel, _, record)| Some((series.of(wheel).last()?, record))).collect();
    let [averages, spectra] = results.curve_tables(&records);
    let tables = [
        (TABLE, Some(results.record_table())),
        (AVERAGES, Some(averages)),
        (SPECTRA, Some(spectra)),
        (BEARINGS_TABLE, (!results.bearings.is_empty()).then(|| results.bearing_table())),
    ];
    for ((name, table), text) in tables.into_iter().zip(CSV) {
        let Some(table) = table else { continue };
        if csv {
            staged.push(StagedFile::write(&directory.join(text), |file| table.write_csv(file))?);
        }
        staged.push(StagedFile::write(&directory.join(name), |file| table.write_parquet(file))?);
    }
    staged.push(StagedFile::write(&directory.join(JSON), |file| write_json(&results.to_json(), file))?);
    Ok(undisturbed(|| replace(directory, &FILES, &FILES, staged))?)
}
