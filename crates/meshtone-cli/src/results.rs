//! The files that a run writes.

use std::fs;
use std::io::{BufWriter, ErrorKind, Write};
use std::path::Path;
use std::thread;

use meshtone::scenario::Scenario;
use meshtone::sensor::Channels;
use meshtone::{Simulation, Stages, Trace};
use meshtone_io::atomic_file::{StagedFile, WriteFileError};
use meshtone_io::own_file::undisturbed;
use meshtone_io::run_identity::RunIdentity;
use meshtone_io::signals::write_signals;
use meshtone_io::summary::Summary;
use meshtone_io::trace_npz::write_trace;
use meshtone_plot::panel;

use crate::earlier_results;
use crate::failure::Failure;

/// The signals' file.
pub const SIGNALS: &str = "signals.parquet";
/// The summary's file.
pub const SUMMARY: &str = "summary.json";
/// The panel's files.
pub const PANEL: [&str; 2] = ["panel.svg", "panel.png"];
/// All files that stand in a run's directory.
pub const RESULTS: [&str; 4] = [SIGNALS, SUMMARY, PANEL[0], PANEL[1]];

/// What a run writes.
pub struct Results<'r> {
    /// What was simulated, as the user asked for it.
    pub scenario: &'r Scenario,
    /// Its results.
    pub simulation: &'r Simulation,
    /// Its main numbers.
    pub summary: &'r Summary,
    /// Every stage's output, and where to.
    pub trace: Option<(&'r Trace, &'r Path)>,
    /// Whether to draw the panel.
    pub with_panel: bool,
}

impl Results<'_> {
    /// Writes all files, each whole or not at all.
    ///
    /// All are complete beside their targets before the first takes its name. A panel that an earlier run left is
    /// removed where this run draws none: it would show something else.
    pub fn write(&self, directory: &Path) -> Result<(), Failure> {
        let (panel, signals) = thread::scope(|scope| {
            let panel = scope.spawn(|| self.with_panel.then(|| self.stage_panel(directory)).transpose());
            let signals = StagedFile::write(&directory.join(SIGNALS), |file| {
                write_signals(file, self.scenario, &self.simulation.channels)
            });
            let panel = panel.join().unwrap_or_else(|_| Err(Failure::failed("cannot draw the panel")));
            (panel, signals)
        });
        let signals = signals?;
        let trace = self
            .trace
            .map(|(trace, path)| StagedFile::write(path, |file| write_trace(file, self.summary.run, trace)));
        let trace = trace.transpose()?;
        let summary = StagedFile::write(&directory.join(SUMMARY), |file| {
            let mut file = BufWriter::new(file);
            self.summary.write_json(&mut file)?;
            file.flush()
        })?;
        // What has been computed is kept even where the picture of it fails.
        let (panel, failure) = match panel {
            Ok(panel) => (panel, None),
            Err(failure) => (None, Some(failure.with_help("the other results are written; see --no-panel"))),
        };
        // The trace may lie elsewhere; it carries the run's identity, as every file does.
        trace.map(StagedFile::commit).transpose()?;
        undisturbed(|| replace(directory, signals, panel, summary))?;
        failure.map_or(Ok(()), Err)
    }

    fn stage_panel(&self, directory: &Path) -> Result<[StagedFile; 2], Failure> {
        stage_panel(directory, self.summary.run, &self.simulation.stages, &self.simulation.channels)
    }
}

/// Draws the panel and writes its files, to be committed.
pub fn stage_panel(
    directory: &Path,
    run: RunIdentity,
    stages: &Stages,
    channels: &Channels,
) -> Result<[StagedFile; 2], Failure> {
    let cannot = |error| Failure::failed(format!("cannot draw the panel: {error}"));
    let figure = panel::draw(stages, channels).map_err(cannot)?.of_run(&run.to_string());
    let [svg_path, png_path] = PANEL.map(|name| directory.join(name));
    thread::scope(|scope| {
        // Until it lies on the disk the other file can be drawn.
        let svg =
            scope.spawn(|| StagedFile::write(&svg_path, |file| file.write_all(figure.svg().as_bytes())));
        let png = figure.png().map_err(cannot)?;
        let png = StagedFile::write(&png_path, |file| file.write_all(&png))?;
        let svg = svg.join().map_err(|_| Failure::failed("cannot write the panel"))??;
        Ok([svg, png])
    })
}

/// Gives the files their names, in the place of an earlier run's.
///
/// The summary of the earlier run is removed first and this run's named last, so that a directory without a summary is
/// one in which a run was interrupted; [`earlier_results`] then knows what was there before.
fn replace(
    directory: &Path,
    signals: StagedFile,
    panel: Option<[StagedFile; 2]>,
    summary: StagedFile,
) -> Result<(), WriteFileError> {
    earlier_results::keep(directory);
    let named = remove(directory, &[SUMMARY])
        .and_then(|()| signals.commit())
        .and_then(|()| match panel {
            Some(files) => files.into_iter().try_for_each(StagedFile::commit),
            None => remove(directory, &PANEL),
        })
        .and_then(|()| summary.commit());
    match named {
        Ok(()) => earlier_results::forget(directory),
        Err(_) => {
            earlier_results::put_back(directory)?;
        }
    }
    named
}

fn remove(directory: &Path, names: &[&str]) -> Result<(), WriteFileError> {
    names.iter().map(|name| directory.join(name)).try_for_each(|path| match fs::remove_file(&path) {
        Err(source) if source.kind() != ErrorKind::NotFound => Err(WriteFileError { path, source }),
        _ => Ok(()),
    })
}
