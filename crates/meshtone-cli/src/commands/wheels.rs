//! `meshtone wheels`

use std::path::PathBuf;

use clap::Args;
use meshtone::scenario::{ProfileErrors, ScenarioError};
use meshtone::wheel::{ERROR_POINTS, ErrorTable};
use meshtone_io::scenario_file::{ScenarioFile, write_wheels_npz};

use crate::failure::Failure;
use crate::same_file::is_same_file;

/// Draw the deviations of both wheels once, so that several simulations share the wheels
///
/// Writes the profile errors that the scenario would draw for its grade and seed, 100 per tooth, in mm; under the
/// model of contact the wheels' run-out and helix slope too, in µm. A scenario takes them by `errors_file = "FILE.npz"` in its section [quality], or `meshtone simulate` by --errors-file.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Wheels {
    /// Scenario file
    #[arg(value_name = "SCENARIO.toml")]
    scenario: PathBuf,
    /// File to write; it is replaced if it exists
    #[arg(short, long, value_name = "FILE.npz")]
    output: PathBuf,
    /// Print nothing but errors: this command never does
    #[arg(short, long)]
    quiet: bool,
}

const EXAMPLES: &str = "\
Example:
  meshtone wheels healthy.toml -o wheels.npz
  meshtone simulate pit.toml chip.toml --errors-file wheels.npz -o pit_and_chip";

impl Wheels {
    pub fn run(&self) -> Result<(), Failure> {
        let file = ScenarioFile::read_pair(&self.scenario)?;
        if is_same_file(&self.output, &self.scenario) {
            let problem = format!("-o {}: is the scenario file", self.output.display());
            return Failure::refuse(problem, "name another file with -o");
        }
        let mut scenario = file.scenario.clone();
        // The errors are those of the wheels before the damage.
        scenario.faults.clear();
        let stages = meshtone::stages(&scenario).map_err(|error| file.refuse(error))?;
        let deviations = stages.wheel_deviations().swap_remove(0);
        // Run-out and helix slopes may be all that these wheels deviate by.
        let is_off = |given: Option<f64>| given.is_some_and(|value| value != 0.0);
        let has_others =
            deviations.iter().any(|wheel| is_off(wheel.run_out_um) || is_off(wheel.helix_slope_um));
        let ideal = |teeth: u32| ErrorTable::filled(ERROR_POINTS, teeth as usize, 0.0);
        let ideal_profiles = || ProfileErrors {
            pinion_profile_errors_mm: ideal(scenario.wheels[0].teeth),
            gear_profile_errors_mm: ideal(scenario.wheels[1].teeth),
        };
        let errors = stages.pairs[0].profile_errors.clone().or_else(|| has_others.then(ideal_profiles)).ok_or_else(|| {
            let problem = "must be a grade of DIN 3961, from 1 (best) to 12: the teeth of grade 0 are ideal \
                           and have no errors to write";
            file.refuse(ScenarioError::new("quality.din_grade", 0, problem))
        })?;
        Ok(write_wheels_npz(&self.output, &errors, &deviations)?)
    }
}
