//! `meshtone wheels`

use std::path::PathBuf;

use clap::Args;
use meshtone::scenario::ScenarioError;
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
}

const EXAMPLES: &str = "\
Example:
  meshtone wheels healthy.toml -o wheels.npz
  meshtone simulate pit.toml chip.toml --errors-file wheels.npz -o pit_and_chip";

impl Wheels {
    pub fn run(&self) -> Result<(), Failure> {
        let file = ScenarioFile::read(&self.scenario)?;
        if is_same_file(&self.output, &self.scenario) {
            let problem = format!("-o {}: is the scenario file", self.output.display());
            return Err(Failure::bad_input(problem).with_help("name another file with -o"));
        }
        let mut scenario = file.scenario.clone();
        // The errors are those of the wheels before the damage.
        scenario.faults.clear();
        let stages = meshtone::stages(&scenario).map_err(|error| file.refuse(error))?;
        let deviations = stages.wheel_deviations();
        let errors = stages.profile_errors.ok_or_else(|| file.refuse(ideal_teeth()))?;
        Ok(write_wheels_npz(&self.output, &errors, &deviations)?)
    }
}

fn ideal_teeth() -> ScenarioError {
    let problem = "must be a grade of DIN 3962, from 1 (best) to 12: the teeth of grade 0 are ideal and have no \
                   errors to write";
    ScenarioError::new("quality.din_grade", 0, problem)
}
