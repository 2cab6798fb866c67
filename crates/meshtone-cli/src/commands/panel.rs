//! `meshtone panel`

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use clap::Args;
use meshtone::scenario::ScenarioError;
use meshtone::sensor::Channels;
use meshtone_io::ReadResultsError;
use meshtone_io::atomic_file::StagedFile;
use meshtone_io::own_file::undisturbed;
use meshtone_io::recording::signals_in;
use meshtone_io::run_identity::RunIdentity;
use meshtone_io::signals::{Recorded, read_signals};
use meshtone_io::summary::read_run;
use meshtone_plot::panel;

use crate::failure::Failure;
use crate::other_kind::or_other_kind;
use crate::output_directory::claim;
use crate::results::{PANEL, SIGNALS, SUMMARY, finish_interrupted, stage_panel};
use crate::terminal::{print, warn};

/// Description of the input of the panel.
const WRITTEN: &str = "a directory that `meshtone simulate` wrote";

/// Draw the panel of a simulation's results again
///
/// Everything is taken from DIR/signals.parquet, which also contains the scenario. DIR/panel.svg and
/// DIR/panel.png are replaced.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  meshtone panel broken")]
pub struct Panel {
    /// Directory that `meshtone simulate` wrote its results to
    #[arg(value_name = "DIR")]
    directory: PathBuf,
    /// Do not print the files' names; warnings and errors are still printed
    #[arg(short, long)]
    quiet: bool,
}

impl Panel {
    pub fn run(&self) -> Result<(), Failure> {
        // Nothing is named while another program replaces it.
        let _claim = self.directory.is_dir().then(|| claim(&self.directory)).transpose()?;
        if finish_interrupted(&self.directory)? {
            warn(format_args!(
                "the last run into {} was interrupted while it gave its results their names, which they have now",
                self.directory.display()
            ));
        }
        let path = self.directory.join(SIGNALS);
        if let Some(other) = signals_in(&self.directory).filter(|signals| *signals != path) {
            let problem =
                format!("{}: does not contain the scenario, which the panel shows", other.display());
            return Failure::refuse(
                problem,
                "simulate again with `--format parquet`, or with `--format parquet,mat` and alike",
            );
        }
        let files = self.panel_of(&path)?;
        undisturbed(|| files.into_iter().try_for_each(StagedFile::commit))?;
        let [svg, png] = PANEL.map(|name| self.directory.join(name));
        if self.quiet { Ok(()) } else { print(&format!("{}\n{}\n", svg.display(), png.display())) }
    }

    /// The panel of what a file of signals is of.
    fn panel_of(&self, path: &Path) -> Result<Vec<StagedFile>, Failure> {
        let Recorded { scenario, channels, version, run } = read_signals(path).map_err(|error| {
            let is_there = path.try_exists().unwrap_or(false);
            if is_there { error.into() } else { or_other_kind(&self.directory, WRITTEN, error.into()) }
        })?;
        self.check_summary(run)?;
        let unfit = |error: ScenarioError| ReadResultsError::scenario(path, &error);
        let stages = meshtone::stages(scenario).map_err(unfit)?;
        check_rate(path, &channels, stages.time.sampling_rate_hz)?;
        let panel = panel::draw(&stages.with_channels(channels));
        self.warn_of_version(&version);
        stage_panel(&self.directory, run, panel)
    }

    /// Signals without a summary can be drawn all the same; but a panel is not to make the files of two runs look like
    /// those of one.
    fn check_summary(&self, signals: RunIdentity) -> Result<(), Failure> {
        const HELP: &str = "simulate again: `meshtone simulate SCENARIO.toml -o DIR`";
        let path = self.directory.join(SUMMARY);
        match read_run(&path) {
            Ok(summary) if summary == signals => Ok(()),
            Ok(summary) => {
                let problem = format!(
                    "{} is of the run {summary}, but {SIGNALS} beside it of the run {signals}",
                    path.display()
                );
                Failure::refuse(problem, HELP)
            }
            Err(ReadResultsError::Unreadable { source, .. }) if source.kind() == ErrorKind::NotFound => {
                warn(format_args!(
                    "there is no {}, so the results are not complete: the run may have been interrupted, and \
                     what stands beside {SIGNALS} may be of another run; {HELP}",
                    path.display()
                ));
                Ok(())
            }
            Err(error @ ReadResultsError::Unreadable { .. }) => Err(Failure::failed(error.to_string())),
            Err(error) => Failure::refuse(error.to_string(), HELP),
        }
    }

    fn warn_of_version(&self, version: &str) {
        const THIS: &str = env!("CARGO_PKG_VERSION");
        if version != THIS {
            warn(format_args!(
                "{} was written by version {version}; what the panel shows beside the signals is computed \
                 by version {THIS}",
                self.directory.join(SIGNALS).display(),
            ));
        }
    }
}

/// Refuses signals that are not sampled as what they are of.
fn check_rate(path: &Path, channels: &Channels, expected: f64) -> Result<(), ReadResultsError> {
    let rate = channels.sampling_rate_hz;
    if rate == expected {
        return Ok(());
    }
    let problem = format!("is sampled at {rate} S/s, but its scenario at {expected} S/s");
    Err(ReadResultsError::foreign(path, problem))
}
