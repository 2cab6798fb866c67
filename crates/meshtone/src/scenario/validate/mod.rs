//! Checks of a scenario before anything is computed.

mod duration;
mod largest_cause;
mod memory_limit;
mod model;
mod rig;
mod shafts;
mod size;
mod speed;

pub use memory_limit::{MEMORY_LIMIT_BYTES, MemoryLimit};
pub(crate) use model::unknown_kind;
use speed::{DrivenSpeed, pitch_line_mm};

use super::{Scenario, ScenarioError, ScenarioWarning};

impl Scenario {
    /// Checks every value, alone and against the others, as far as no tooth geometry is needed.
    ///
    /// # Returns
    /// Warnings about a scenario that can be simulated: teeth that are undercut, tips that are thin, a speed that few
    /// spur gears reach.
    ///
    /// # Errors
    /// The first value that is impossible, or certainly a mistake. A simulation that needs more
    /// than [`MEMORY_LIMIT_BYTES`] is refused too.
    ///
    /// ```
    /// use meshtone::scenario::{GearPair, Scenario};
    ///
    /// let mut scenario = Scenario::new(GearPair { pinion_teeth: 14, ..GearPair::example() });
    /// let warnings = scenario.validate()?;
    /// assert_eq!(warnings[0].key, "gears.pinion_teeth");
    ///
    /// scenario.wheels.iter_mut().for_each(|wheel| wheel.din_grade = 13);
    /// assert_eq!(scenario.validate().unwrap_err().key, "quality.din_grade");
    /// # Ok::<(), meshtone::scenario::ScenarioError>(())
    /// ```
    pub fn validate(&self) -> Result<Vec<ScenarioWarning>, ScenarioError> {
        self.validate_within(MemoryLimit::default())
    }

    /// Does what [`Scenario::validate`] does, with another limit of memory.
    ///
    /// # Arguments
    /// * `limit` - most that [`Scenario::memory_estimate_bytes`] may be
    ///
    /// # Errors
    /// Those of [`Scenario::validate`].
    ///
    /// ```
    /// use meshtone::scenario::{GearPair, MemoryLimit, Scenario};
    ///
    /// let mut scenario = Scenario::new(GearPair::example());
    /// scenario.solver.sampling_rate_hz = 1e8;
    /// let error = scenario.validate_within(MemoryLimit::Machine { free_bytes: 1 << 30 }).unwrap_err();
    /// assert_eq!(error.key, "solver.sampling_rate_hz");
    /// assert!(error.problem.ends_with("only 1.0 GiB are free on this machine"));
    /// ```
    pub fn validate_within(&self, limit: MemoryLimit) -> Result<Vec<ScenarioWarning>, ScenarioError> {
        self.check_structure(limit)
    }
}
