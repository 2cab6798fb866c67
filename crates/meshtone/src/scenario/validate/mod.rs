//! What a scenario must satisfy before anything is computed.

mod fault;
mod gears;
mod operation;
mod quality;
mod rig;
mod rules;
mod size;
mod solver;

pub use size::MEMORY_LIMIT_BYTES;

use super::{Scenario, ScenarioError, ScenarioWarning};

impl Scenario {
    /// Checks every value, alone and against the others, as far as no tooth geometry is needed.
    ///
    /// # Returns
    /// What can be simulated but deserves attention: teeth that are undercut.
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
        self.validate_within(MEMORY_LIMIT_BYTES)
    }

    /// As [`Scenario::validate`], with another limit of memory.
    ///
    /// # Arguments
    /// * `memory_limit_bytes` - (bytes) most that [`Scenario::memory_estimate_bytes`] may be
    ///
    /// # Errors
    /// As [`Scenario::validate`].
    pub fn validate_within(&self, memory_limit_bytes: u64) -> Result<Vec<ScenarioWarning>, ScenarioError> {
        gears::check(&self.gears)?;
        operation::check(&self.operation)?;
        quality::check(&self.quality, &self.gears)?;
        fault::check(self.fault.as_ref(), &self.gears)?;
        rig::check(&self.rig, &self.gears)?;
        solver::check(&self.solver)?;
        operation::check_duration(self)?;
        size::check(self, memory_limit_bytes)?;
        Ok(gears::warnings(&self.gears))
    }
}
