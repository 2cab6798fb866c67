//! `meshtone enhance`

use std::path::{Path, PathBuf};

use clap::Args;
use meshtone::scenario::Scenario;
use meshtone::tuning::HybridError;
use meshtone_io::atomic_file::write_atomically;
use meshtone_io::experiment::{EnhancedRecord, Tuned, enhance, read_tuned, write_enhanced};
use meshtone_io::scenario_file::{FileKind, ScenarioFile};
use serde_json::json;

use crate::check::check;
use crate::failure::Failure;
use crate::output_directory::{OutputDirectory, named_after};
use crate::shown::Shown;
use crate::terminal::warn;
use crate::warnings;

const ENHANCED: &str = "enhanced.parquet";
/// All are held in memory: some 50 kB each.
const MOST_DRAWS: u64 = 20_000;

/// Make enhanced difference signals of a scenario, with the result of `tune`
///
/// Simulates the scenario and its healthy counterpart, takes the difference signals of the wheel that was tuned to and modifies them: duration,
/// fault-to-harmonics ratio, noise. Writes enhanced.parquet with one row for each draw of the noise.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Enhance {
    /// The scenario
    #[arg(value_name = "SCENARIO.toml")]
    scenario: PathBuf,
    /// Result of `meshtone tune`; numbers of the scenario that were tuned as well are put into it
    #[arg(long, value_name = "tuned.toml")]
    tuned: PathBuf,
    /// Number of draws of the noise
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u64).range(1..=MOST_DRAWS))]
    draws: u64,
    /// Seed of the noise
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Directory to write to. [default: <file name without .toml>_enhanced in the current directory]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    #[command(flatten)]
    shown: Shown,
}

const EXAMPLES: &str = "\
Example:
  meshtone enhance broken.toml --tuned breakage_tuning/tuned.toml --draws 100 -o broken_enhanced";

impl Enhance {
    pub fn run(&self) -> Result<(), Failure> {
        let file = ScenarioFile::read(&self.scenario)?;
        let tuned = read_tuned(&self.tuned).map_err(|error| Failure::of_file(FileKind::Tuned, error))?;
        let scenario = tuned
            .apply(&file.scenario)
            .map_err(|error| Failure::bad_input(format!("{}: {error}", self.tuned.display())))?;
        let (warnings, _) = check(&scenario).map_err(|error| file.refuse(error))?;
        if let Some(warning) = tuned.warning_for(&scenario) {
            warn(format_args!("{}: {warning}", self.tuned.display()));
        }
        warnings::print(&file, &warnings);
        let directory = self.output.clone().unwrap_or_else(|| named_after(&self.scenario, "enhanced"));
        let read: Vec<&Path> = file.sources().chain([self.tuned.as_path()]).collect();
        let output = OutputDirectory::for_files(&directory, &[ENHANCED], &read)?;
        self.write(&scenario, &tuned, &output.path.join(ENHANCED))
    }

    fn write(&self, scenario: &Scenario, tuned: &Tuned, path: &Path) -> Result<(), Failure> {
        let draws = enhance(scenario, tuned, self.seed, self.draws).map_err(|error| {
            let of = match error {
                HybridError::NoSuchWheel { .. } => &self.tuned,
                _ => &self.scenario,
            };
            Failure::bad_input(format!("{}: {error}", of.display()))
        })?;
        write_atomically(path, |file| write_enhanced(file, scenario, tuned, self.seed, &draws))?;
        let records = &draws.records;
        let mean =
            |of: &dyn Fn(&EnhancedRecord) -> f64| records.iter().map(of).sum::<f64>() / records.len() as f64;
        let (draws, values, to) = (records.len(), records[0].relative_difference.len(), path.display());
        let [rms, kurtosis] = [mean(&|record| record.relative_rms), mean(&|record| record.kurtosis)];
        let table = || {
            format!(
                "  {draws} draws of {values} values, mean rms {rms:.3} times the healthy one's, mean kurtosis {kurtosis:.2}\n\n{to}\n"
            )
        };
        let numbers = || json!({ "draws": draws, "values": values, "mean_relative_rms": rms, "mean_kurtosis": kurtosis });
        self.shown.print(&to, table, numbers)
    }
}
