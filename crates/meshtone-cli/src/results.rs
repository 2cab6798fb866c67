//! The files that a run writes.

use std::fs;
use std::path::Path;
use std::thread;

use meshtone::Trace;
use meshtone_io::atomic_file::{StagedFile, WriteFileError};
use meshtone_io::own_file::undisturbed;
use meshtone_io::run_identity::RunIdentity;
use meshtone_io::signals::{SignalFormat, SignalTable};
use meshtone_io::summary::write_json;
use meshtone_io::trace_npz::write_trace;
use meshtone_plot::{Figure, PlotError};
use serde_json::Value;

use crate::failure::Failure;
use crate::replacement::{cannot_draw, finish, replace, stage_figure};

/// The file of signals that also contains the scenario.
pub const SIGNALS: &str = SignalFormat::Parquet.file_name();
/// The summary's file.
pub const SUMMARY: &str = "summary.json";
/// The panel's files.
pub const PANEL: [&str; 2] = ["panel.svg", "panel.png"];
/// The key of the summary that states the names of the other files of the run.
const FILES: &str = "files";
/// All files that may stand in a run's directory, the summary first.
pub const RESULTS: [&str; 8] = [
    SUMMARY,
    SIGNALS,
    SignalFormat::Csv.file_name(),
    SignalFormat::Mat.file_name(),
    SignalFormat::Npz.file_name(),
    SignalFormat::Wav.file_name(),
    PANEL[0],
    PANEL[1],
];

/// The results of a run, of a pair or of a gearbox.
pub struct Results<'a> {
    pub run: RunIdentity,
    pub signals: SignalTable<'a>,
    /// The main numbers.
    pub summary: Value,
    /// Every stage's output, and where to.
    pub trace: Option<(&'a Trace, &'a Path)>,
}

/// Writes all files, each whole or not at all.
///
/// All are complete beside their targets before the first takes its name. What an earlier run wrote is
/// removed where this run writes no such file: it would show something else. The summary states which files a run wrote, so that a
/// file of another origin with such a name, as a measured `signals.csv`, stays.
///
/// # Arguments
/// * `directory` - where to
/// * `results` - what is written
/// * `formats` - of the signals, a file each
/// * `draw` - draws the panel, unless none is wanted
pub fn write(
    directory: &Path,
    results: &Results,
    formats: &[SignalFormat],
    draw: Option<impl FnOnce() -> Result<Figure, PlotError> + Send>,
) -> Result<(), Failure> {
    let (panel, signals) = thread::scope(|scope| {
        let panel = scope.spawn(|| match draw {
            Some(draw) => stage_panel(directory, results.run, draw()),
            None => Ok(Vec::new()),
        });
        let stage = |format: &SignalFormat| {
            let path = directory.join(format.file_name());
            StagedFile::write(&path, |file| results.signals.write(file, *format))
        };
        let signals: Result<Vec<_>, _> = formats.iter().map(stage).collect();
        let panel = panel.join().unwrap_or_else(|_| Err(Failure::failed("cannot draw the panel")));
        (panel, signals)
    });
    let traced = |(trace, path): (&Trace, &Path)| {
        StagedFile::write(path, |file| write_trace(file, results.run, trace))
    };
    let mut staged = signals?;
    let trace = results.trace.map(traced).transpose()?;
    // What has been computed is kept even where the picture of it fails.
    let drawn = panel.map(|panel| staged.extend(panel));
    let mut summary = results.summary.clone();
    summary[FILES] = staged.iter().filter_map(|file| file.path.file_name()?.to_str()).collect();
    staged.push(StagedFile::write(&directory.join(SUMMARY), |file| write_json(&summary, file))?);
    // The trace may lie elsewhere; it carries the run's identity.
    trace.map(StagedFile::commit).transpose()?;
    undisturbed(|| replace(directory, &RESULTS, &earlier_files(directory), staged))?;
    drawn.map_err(|failure| failure.with_help("the other results are written; see --no-panel"))
}

/// Writes the files of a drawn panel, to be committed.
pub fn stage_panel(
    directory: &Path,
    run: RunIdentity,
    figure: Result<Figure, PlotError>,
) -> Result<Vec<StagedFile>, Failure> {
    let figure = figure.map_err(cannot_draw);
    let staged = figure.and_then(|figure| stage_figure(directory, PANEL, &figure.of_run(&run.to_string())));
    // The panel has no option --no-figure.
    staged.map_err(|failure| Failure { help: None, ..failure })
}

/// The files of an earlier run in a directory, the summary first: those that its summary states, and the panel, which
/// `meshtone panel` may have drawn since.
fn earlier_files(directory: &Path) -> Vec<&'static str> {
    let text = fs::read(directory.join(SUMMARY)).unwrap_or_default();
    let summary: Value = serde_json::from_slice(&text).unwrap_or_default();
    let Some(files) = summary[FILES].as_array() else {
        return vec![SUMMARY];
    };
    let is_listed = |name: &&str| files.iter().any(|file| file == name);
    RESULTS.into_iter().filter(|name| *name == SUMMARY || PANEL.contains(name) || is_listed(name)).collect()
}

/// Gives the results of a run that was interrupted behind the last of its work their names. Returns whether there were any.
pub fn finish_interrupted(directory: &Path) -> Result<bool, WriteFileError> {
    finish(directory, &RESULTS, &earlier_files(directory))
}
