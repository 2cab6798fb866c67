//! The files that the indicators are written to.

use std::path::Path;
use std::thread;

use meshtone_io::atomic_file::StagedFile;
use meshtone_io::indicators::IndicatorResults;
use meshtone_io::own_file::undisturbed;
use meshtone_plot::Figure;

use crate::failure::Failure;
use crate::replacement::{replace, stage_figure};

const JSON: &str = "indicators.json";
const TABLE: &str = "indicators.parquet";
const RECORD: [&str; 2] = ["indicators.svg", "indicators.png"];
const TREND: [&str; 2] = ["trend.svg", "trend.png"];
/// All files that may stand in the directory.
pub const FILES: [&str; 6] = [JSON, TABLE, RECORD[0], RECORD[1], TREND[0], TREND[1]];

/// Writes all files, each whole or not at all.
///
/// All are complete beside their targets before the first takes its name.
pub fn write(
    directory: &Path,
    results: &IndicatorResults,
    record: Option<&Figure>,
    trend: Option<&Figure>,
) -> Result<(), Failure> {
    let stage = |figure: Option<&Figure>, names| match figure {
        Some(figure) => stage_figure(directory, names, figure),
        None => Ok(Vec::new()),
    };
    let (record, trend) = thread::scope(|scope| {
        let record = scope.spawn(|| stage(record, RECORD));
        let trend = stage(trend, TREND);
        let record = record.join().unwrap_or_else(|_| Err(Failure::failed("cannot draw the figure")));
        (record, trend)
    });
    let mut staged = record?;
    staged.extend(trend?);
    staged.push(StagedFile::write(&directory.join(TABLE), |file| results.write_parquet(file))?);
    let json = StagedFile::write(&directory.join(JSON), |file| results.write_json(file))?;
    Ok(undisturbed(|| replace(directory, &FILES, staged, json))?)
}
