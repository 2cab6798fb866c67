//! The files that the indicators are written to.

use std::fs;
use std::io::{BufWriter, ErrorKind, Write};
use std::path::Path;
use std::thread;

use meshtone_io::atomic_file::{StagedFile, WriteFileError};
use meshtone_io::indicators::IndicatorResults;
use meshtone_io::own_file::undisturbed;
use meshtone_plot::Figure;

use crate::failure::Failure;

const JSON: &str = "indicators.json";
const TABLE: &str = "indicators.parquet";
const RECORD: [&str; 2] = ["indicators.svg", "indicators.png"];
const TREND: [&str; 2] = ["trend.svg", "trend.png"];
/// All files that may stand in the directory.
pub const FILES: [&str; 6] = [JSON, TABLE, RECORD[0], RECORD[1], TREND[0], TREND[1]];

/// Writes all files, each whole or not at all.
///
/// All are complete beside their targets before the first takes its name. The JSON of earlier results is removed first and
/// the new one named last, so that a directory without one is not complete. Figures of earlier results that have no
/// successor are removed.
pub fn write(
    directory: &Path,
    results: &IndicatorResults,
    record: Option<&Figure>,
    trend: Option<&Figure>,
) -> Result<(), Failure> {
    let (record, trend) = thread::scope(|scope| {
        let record = scope.spawn(|| stage(directory, record, RECORD));
        let trend = stage(directory, trend, TREND);
        let record = record.join().unwrap_or_else(|_| Err(Failure::failed("cannot draw the figure")));
        (record, trend)
    });
    let figures = [record?, trend?];
    let table = StagedFile::write(&directory.join(TABLE), |file| results.write_parquet(file))?;
    let json = StagedFile::write(&directory.join(JSON), |file| {
        let mut file = BufWriter::new(file);
        results.write_json(&mut file)?;
        file.flush()
    })?;
    undisturbed(|| {
        remove(directory, &[JSON])?;
        table.commit()?;
        for (files, names) in figures.into_iter().zip([RECORD, TREND]) {
            match files {
                Some(files) => files.into_iter().try_for_each(StagedFile::commit)?,
                None => remove(directory, &names)?,
            }
        }
        Ok(json.commit()?)
    })
}

fn stage(
    directory: &Path,
    figure: Option<&Figure>,
    names: [&str; 2],
) -> Result<Option<[StagedFile; 2]>, Failure> {
    let Some(figure) = figure else { return Ok(None) };
    let png = figure.png().map_err(|error| Failure::failed(format!("cannot draw the figure: {error}")))?;
    let [svg_path, png_path] = names.map(|name| directory.join(name));
    Ok(Some([
        StagedFile::write(&svg_path, |file| file.write_all(figure.svg().as_bytes()))?,
        StagedFile::write(&png_path, |file| file.write_all(&png))?,
    ]))
}

fn remove(directory: &Path, names: &[&str]) -> Result<(), WriteFileError> {
    names.iter().map(|name| directory.join(name)).try_for_each(|path| match fs::remove_file(&path) {
        Err(source) if source.kind() != ErrorKind::NotFound => Err(WriteFileError { path, source }),
        _ => Ok(()),
    })
}
