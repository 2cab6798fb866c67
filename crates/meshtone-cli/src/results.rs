//! The files that a run writes.

use std::path::Path;
use std::thread;

use meshtone::scenario::Scenario;
use meshtone::sensor::Channels;
use meshtone::{GearboxSimulation, Simulation, Stages, Trace};
use meshtone_io::atomic_file::{StagedFile, WriteFileError};
use meshtone_io::own_file::undisturbed;
use meshtone_io::run_identity::RunIdentity;
use meshtone_io::signals::{write_gearbox_signals, write_signals};
use meshtone_io::summary::{GearboxSummary, Summary, write_json};
use meshtone_io::trace_npz::write_trace;
use meshtone_plot::{Figure, PlotError, panel};

use crate::earlier_results;
use crate::failure::Failure;
use crate::replacement::{cannot_draw, replace, stage_figure};

/// The signals' file.
pub const SIGNALS: &str = "signals.parquet";
/// The summary's file.
pub const SUMMARY: &str = "summary.json";
/// The panel's files.
pub const PANEL: [&str; 2] = ["panel.svg", "panel.png"];
/// All files that stand in a run's directory, the summary first.
pub const RESULTS: [&str; 4] = [SUMMARY, SIGNALS, PANEL[0], PANEL[1]];

/// Writes all files, each whole or not at all.
///
/// All are complete beside their targets before the first takes its name. A panel that an earlier run left is
/// removed where this run draws none: it would show something else.
///
/// # Arguments
/// * `directory` - where to
/// * `scenario` - what was simulated, as the user asked for it
/// * `simulation`, `summary` - its results, and their main numbers
/// * `trace` - every stage's output, and where to
/// * `with_panel` - whether to draw the panel
pub fn write(
    directory: &Path,
    scenario: &Scenario,
    simulation: &Simulation,
    summary: &Summary,
    trace: Option<(&Trace, &Path)>,
    with_panel: bool,
) -> Result<(), Failure> {
    let (panel, signals) = thread::scope(|scope| {
        let panel = scope.spawn(|| match with_panel {
            true => stage_panel(directory, summary.head.run, &simulation.stages, &simulation.channels),
            false => Ok(Vec::new()),
        });
        let signals = StagedFile::write(&directory.join(SIGNALS), |file| {
            write_signals(file, scenario, &simulation.channels)
        });
        let panel = panel.join().unwrap_or_else(|_| Err(Failure::failed("cannot draw the panel")));
        (panel, signals)
    });
    let traced = |(trace, path): (&Trace, &Path)| {
        StagedFile::write(path, |file| write_trace(file, summary.head.run, trace))
    };
    let staged = Staged {
        signals: signals?,
        trace: trace.map(traced).transpose()?,
        summary: StagedFile::write(&directory.join(SUMMARY), |file| write_json(summary, file))?,
        panel,
    };
    staged.commit(directory)
}

/// Writes all files of a gearbox's simulation, each whole or not at all.
///
/// # Arguments
/// * `directory` - where to
/// * `simulation`, `summary` - its results, and their main numbers
/// * `trace` - where every stage's output goes, if anywhere
/// * `with_panel` - whether to draw the panel
pub fn write_gearbox(
    directory: &Path,
    simulation: &GearboxSimulation,
    summary: &GearboxSummary,
    trace: Option<&Path>,
    with_panel: bool,
) -> Result<(), Failure> {
    let traced = |path| {
        StagedFile::write(path, |file| {
            write_trace(file, summary.head.run, &meshtone::gearbox_trace(simulation))
        })
    };
    let staged = Staged {
        signals: StagedFile::write(&directory.join(SIGNALS), |file| {
            write_gearbox_signals(file, &simulation.stages.gearbox, &simulation.channels)
        })?,
        trace: trace.map(traced).transpose()?,
        summary: StagedFile::write(&directory.join(SUMMARY), |file| write_json(summary, file))?,
        panel: match with_panel {
            true => stage_gearbox_panel(directory, summary.head.run, simulation),
            false => Ok(Vec::new()),
        },
    };
    staged.commit(directory)
}

/// The files of a run, complete beside their targets.
struct Staged {
    signals: StagedFile,
    trace: Option<StagedFile>,
    summary: StagedFile,
    panel: Result<Vec<StagedFile>, Failure>,
}

impl Staged {
    /// Gives the files their names, in place of those of an earlier run in the directory.
    fn commit(self, directory: &Path) -> Result<(), Failure> {
        // What has been computed is kept even where the picture of it fails.
        let (mut staged, drawn) = match self.panel {
            Ok(panel) => (panel, Ok(())),
            Err(failure) => {
                (Vec::new(), Err(failure.with_help("the other results are written; see --no-panel")))
            }
        };
        staged.push(self.signals);
        // The trace may lie elsewhere; it carries the run's identity, as every file does.
        self.trace.map(StagedFile::commit).transpose()?;
        undisturbed(|| replace_earlier(directory, staged, self.summary))?;
        drawn
    }
}

/// Draws the panel of a gearbox and writes its files, to be committed.
pub fn stage_gearbox_panel(
    directory: &Path,
    run: RunIdentity,
    simulation: &GearboxSimulation,
) -> Result<Vec<StagedFile>, Failure> {
    stage_drawn(directory, run, panel::draw_gearbox(simulation))
}

/// Draws the panel and writes its files, to be committed.
pub fn stage_panel(
    directory: &Path,
    run: RunIdentity,
    stages: &Stages,
    channels: &Channels,
) -> Result<Vec<StagedFile>, Failure> {
    stage_drawn(directory, run, panel::draw(stages, channels))
}

fn stage_drawn(
    directory: &Path,
    run: RunIdentity,
    figure: Result<Figure, PlotError>,
) -> Result<Vec<StagedFile>, Failure> {
    let figure = figure.map_err(cannot_draw);
    let staged = figure.and_then(|figure| stage_figure(directory, PANEL, &figure.of_run(&run.to_string())));
    // The panel has no option --no-figure.
    staged.map_err(|failure| Failure { help: None, ..failure })
}

/// Gives the files their names; where that fails, the results of the earlier run are put back.
fn replace_earlier(
    directory: &Path,
    staged: Vec<StagedFile>,
    summary: StagedFile,
) -> Result<(), WriteFileError> {
    earlier_results::keep(directory);
    let named = replace(directory, &RESULTS, staged, summary);
    if named.is_ok() {
        earlier_results::forget(directory);
    } else {
        earlier_results::put_back(directory)?;
    }
    named
}
