//! `meshtone enhance`

use std::path::{Path, PathBuf};

use clap::Args;
use meshtone::hybrid::{HybridError, SimulatedCases, TuningIndicator, difference_signals};
use meshtone::scenario::{Fault, Scenario};
use meshtone_io::atomic_file::write_atomically;
use meshtone_io::experiment::{EnhancedHead, EnhancedRecord, Tuned, read_tuned, write_enhanced};
use meshtone_io::scenario_file::ScenarioFile;

use crate::check::check;
use crate::failure::Failure;
use crate::memory;
use crate::output_directory::{OutputDirectory, named_after};
use crate::terminal::{print, print_error_line};

const ENHANCED: &str = "enhanced.parquet";
/// All are held in memory: some 50 kB each.
const MOST_DRAWS: u64 = 20_000;

/// Make enhanced difference signals of a scenario, with what `tune` found
///
/// Simulates the scenario and its healthy counterpart, takes the difference signals of the gear and modifies them: duration,
/// fault-to-harmonics ratio, noise. Writes enhanced.parquet with one row for each draw of the noise.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Enhance {
    /// The scenario
    #[arg(value_name = "SCENARIO.toml")]
    scenario: PathBuf,
    /// What `meshtone tune` found; numbers of the scenario that were tuned as well are put into it
    #[arg(long, value_name = "tuned.toml")]
    tuned: PathBuf,
    /// How many draws of the noise
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u64).range(1..=MOST_DRAWS))]
    draws: u64,
    /// Seed of the noise
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Directory to write to. [default: <file name without .toml>_enhanced in the current directory]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Print nothing but warnings and errors
    #[arg(short, long)]
    quiet: bool,
}

const EXAMPLES: &str = "\
Example:
  meshtone enhance broken.toml --tuned breakage_tuning/tuned.toml --draws 100 -o broken_enhanced";

impl Enhance {
    pub fn run(&self) -> Result<(), Failure> {
        let file = ScenarioFile::read_within(&self.scenario, memory::limit())?;
        let tuned = read_tuned(&self.tuned)?;
        let scenario = tuned
            .apply(&file.scenario)
            .map_err(|error| Failure::bad_input(format!("{}: {error}", self.tuned.display())))?;
        let (warnings, _) = check(&scenario).map_err(|error| file.refuse(error))?;
        if let Some(warning) = tuned.warning_for(&scenario) {
            print_error_line(format!("warning: {}: {warning}", self.tuned.display()));
        }
        for warning in warnings {
            print_error_line(format!("warning: {}: {warning}", self.scenario.display()));
        }
        let directory = OutputDirectory::for_files(&self.directory()?, &[ENHANCED])?;
        self.write(&scenario, &tuned, &directory.path().join(ENHANCED))?;
        directory.keep();
        Ok(())
    }

    fn directory(&self) -> Result<PathBuf, Failure> {
        let default = || named_after(&self.scenario, "_enhanced");
        self.output
            .clone()
            .or_else(default)
            .ok_or_else(|| Failure::bad_input(format!("{} is no scenario file", self.scenario.display())))
    }

    fn write(&self, scenario: &Scenario, tuned: &Tuned, path: &Path) -> Result<(), Failure> {
        let (healthy_rms_g, records) = self
            .enhance(scenario, tuned)
            .map_err(|error| Failure::bad_input(format!("{}: {error}", self.scenario.display())))?;
        let head = EnhancedHead { scenario, tuned, seed: self.seed, healthy_rms_g };
        write_atomically(path, |file| write_enhanced(file, head, &records))?;
        if self.quiet {
            return Ok(());
        }
        let mean =
            |of: &dyn Fn(&EnhancedRecord) -> f64| records.iter().map(of).sum::<f64>() / records.len() as f64;
        print(&format!(
            "  {} draws of {} values, mean rms {:.3} times the healthy one's, mean kurtosis {:.2}\n\n{}\n",
            records.len(),
            records[0].relative_difference.len(),
            mean(&|record| record.relative_rms),
            mean(&|record| record.kurtosis),
            path.display()
        ))
    }

    fn enhance(&self, scenario: &Scenario, tuned: &Tuned) -> Result<(f64, Vec<EnhancedRecord>), HybridError> {
        let healthy = Scenario { fault: None, ..scenario.clone() };
        let both = if scenario.fault.is_some() { vec![healthy, scenario.clone()] } else { vec![healthy] };
        let mut signals = difference_signals(both, &tuned.chain(scenario.gears.gear_teeth))?;
        // A healthy signal does not show where a fault would be.
        let centre_rev = match signals.len() {
            1 => tuned.centre_rev,
            _ => SimulatedCases::new(signals.clone())?.centre_rev(),
        };
        let healthy = signals.swap_remove(0);
        let difference = signals.pop().unwrap_or_else(|| healthy.clone());
        let enhanced = tuned.enhancement.without_noise(&difference, &healthy, centre_rev)?;
        let noise = 1.0 + tuned.enhancement.noise_level.powi(2);
        let healthy_rms_g = enhanced.healthy_rms * noise.sqrt();
        let label = scenario.fault.as_ref().map_or("healthy", Fault::kind);
        // Files of different scenarios must not share their noise.
        let noise_seed = self.seed ^ identity(scenario);
        let record = |draw: u64| {
            let mut signal = enhanced.with_noise(noise_seed, draw)?;
            signal.iter_mut().for_each(|value| *value /= healthy_rms_g);
            Ok(EnhancedRecord {
                label: label.to_owned(),
                draw,
                relative_rms: TuningIndicator::Rms.measure(&signal)?,
                kurtosis: TuningIndicator::Kurtosis.measure(&signal)?,
                relative_difference: signal,
            })
        };
        Ok((healthy_rms_g, (0..self.draws).map(record).collect::<Result<_, HybridError>>()?))
    }
}

/// A number that stands for the whole scenario (FNV-1a of its file).
fn identity(scenario: &Scenario) -> u64 {
    scenario.to_toml().bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}
