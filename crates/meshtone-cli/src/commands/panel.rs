//! `meshtone panel`

use std::path::PathBuf;

use clap::Args;
use meshtone_io::atomic_file::StagedFile;
use meshtone_io::signals::{ReadSignalsError, read_signals};

use crate::failure::Failure;
use crate::results::{PANEL, SIGNALS, stage_panel};
use crate::terminal::print_error_line;

/// Draw the panel of a simulation's results again
///
/// Everything is taken from DIR/signals.parquet, which also holds the scenario. DIR/panel.svg and DIR/panel.png
/// are replaced.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  meshtone panel broken")]
pub struct Panel {
    /// Directory that `meshtone simulate` wrote its results to
    #[arg(value_name = "DIR")]
    directory: PathBuf,
}

impl Panel {
    pub fn run(&self) -> Result<(), Failure> {
        let path = self.directory.join(SIGNALS);
        let recorded = read_signals(&path)?;
        let refuse = |problem: String| ReadSignalsError::Foreign { path: path.clone(), problem };
        let stages = meshtone::stages(&recorded.scenario)
            .map_err(|error| ReadSignalsError::Scenario { path: path.clone(), error: Box::new(error) })?;
        let (rate, expected) = (recorded.channels.sampling_rate_hz, stages.time.sampling_rate_hz);
        if rate != expected {
            return Err(
                refuse(format!("is sampled at {rate} S/s, but its scenario at {expected} S/s")).into()
            );
        }
        if recorded.version != env!("CARGO_PKG_VERSION") {
            print_error_line(format!(
                "warning: {} was written by version {}; what the panel shows beside the signals is computed \
                 by version {}",
                path.display(),
                recorded.version,
                env!("CARGO_PKG_VERSION")
            ));
        }
        let files = stage_panel(&self.directory, &stages, &recorded.channels)?;
        files.into_iter().try_for_each(StagedFile::commit)?;
        let [svg, png] = PANEL.map(|name| self.directory.join(name));
        crate::terminal::print(&format!("{}\n{}\n", svg.display(), png.display()))
    }
}
