//! What a scenario must satisfy before anything is computed.

mod fault;
mod gears;
mod largest_cause;
mod memory_limit;
mod operation;
mod quality;
mod rig;
mod rules;
mod size;
mod solver;

pub use memory_limit::{MEMORY_LIMIT_BYTES, MemoryLimit};

use super::{Scenario, ScenarioError, ScenarioWarning};

impl Scenario {
    /// Checks every value, alone and against the others, as far as no tooth geometry is needed.
    ///
    /// # Returns
    /// What can be simulated but deserves attention: teeth that are undercut, a tip relief that adds metal.
    ///
    /// # Errors
    /// The first value that is impossible, or certainly a mistake. A simulation that needs more
    /// than [`MEMORY_LIMIT_BYTES`] is refused too.
    ///
    /// ```
    /// use meshtone::scenario::Scenario;
    ///
    /// let mut scenario = Scenario::new(3.0, 14, 38, 15.0, 40.0, 10.0);
    /// let warnings = scenario.validate()?;
    /// assert_eq!(warnings[0].key, "gears.pinion_teeth");
    ///
    /// scenario.quality.din_grade = 13;
    /// assert_eq!(scenario.validate().unwrap_err().key, "quality.din_grade");
    /// # Ok::<(), meshtone::scenario::ScenarioError>(())
    /// ```
    pub fn validate(&self) -> Result<Vec<ScenarioWarning>, ScenarioError> {
        self.validate_within(MemoryLimit::default())
    }

    /// As [`Scenario::validate`], with another limit of memory.
    ///
    /// # Arguments
    /// * `limit` - most that [`Scenario::memory_estimate_bytes`] may be
    ///
    /// # Errors
    /// As [`Scenario::validate`].
    ///
    /// ```
    /// use meshtone::scenario::{MemoryLimit, Scenario};
    ///
    /// let mut scenario = Scenario::new(3.0, 17, 38, 15.0, 40.0, 10.0);
    /// scenario.solver.sampling_rate_hz = 1e8;
    /// let error = scenario.validate_within(MemoryLimit::Machine { free_bytes: 1 << 30 }).unwrap_err();
    /// assert_eq!(error.key, "solver.sampling_rate_hz");
    /// assert!(error.problem.ends_with("only 1.0 GiB are free on this machine"));
    /// ```
    pub fn validate_within(&self, limit: MemoryLimit) -> Result<Vec<ScenarioWarning>, ScenarioError> {
        check_values(self)?;
        let honoured = self.as_honoured();
        if honoured != *self {
            check_values(&honoured).map_err(|error| {
                let problem = format!("{} (the published model always has the default)", error.problem);
                ScenarioError { problem, help: Some(PUBLISHED_HELP.to_string()), ..error }
            })?;
        }
        operation::check_duration(&honoured)?;
        size::check(&honoured, limit)?;
        Ok(gears::warnings(&honoured.gears))
    }
}

const PUBLISHED_HELP: &str = "set convention = \"corrected\", which honours every key";

/// Every value, whether or not the convention honours it.
fn check_values(scenario: &Scenario) -> Result<(), ScenarioError> {
    gears::check(&scenario.gears)?;
    operation::check(&scenario.operation)?;
    quality::check(&scenario.quality, &scenario.gears)?;
    fault::check(scenario.fault.as_ref(), &scenario.gears)?;
    rig::check(&scenario.rig, &scenario.gears)?;
    solver::check(&scenario.solver)
}
