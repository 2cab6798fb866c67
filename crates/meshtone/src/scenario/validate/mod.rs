//! Checks of a scenario before anything is computed.

mod duration;
mod largest_cause;
mod memory_limit;
mod model;
mod size;
mod speed;

pub use memory_limit::{MEMORY_LIMIT_BYTES, MemoryLimit};
pub(crate) use model::unknown_kind;
pub(super) use speed::{DrivenSpeed, pitch_line_mm};

use super::{Scenario, ScenarioError, ScenarioWarning};
use crate::damage::check_faults;
use crate::keys::check_keys;
use crate::sensor::check_sensors;
use crate::wheel::NamedGears;

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
    /// scenario.quality.din_grade = 13;
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
        check_values(self)?;
        let honoured = self.without_ignored_keys();
        if honoured != *self {
            check_values(&honoured).map_err(|error| {
                let name = self.model.name();
                let problem = format!("{} (the {name} model always has the default)", error.problem);
                model::with_help(self.model, ScenarioError { problem, ..error })
            })?;
        }
        duration::check(&honoured)?;
        size::check(&honoured, limit)?;
        let speed = DrivenSpeed {
            operation: &honoured.operation,
            key: "operation.pinion_speed_hz",
            pitch_line_mm: pitch_line_mm(honoured.gears.transverse_module_mm(), honoured.gears.pinion_teeth),
        };
        speed.check()?;
        let mut warnings = NamedGears::of_pair(&honoured.gears).warnings();
        warnings.extend(speed.warnings());
        warnings.extend(honoured.operation.ended_profiles(honoured.time_grid().kept_from_s()));
        warnings.extend(honoured.quality.warnings());
        warnings.extend(honoured.rig.support.former_defaults());
        Ok(warnings)
    }
}

/// Every value, whether or not the model honours it.
fn check_values(scenario: &Scenario) -> Result<(), ScenarioError> {
    scenario.gears.check()?;
    check_keys(&scenario.operation, "operation")?;
    scenario.operation.check()?;
    scenario.quality.check(&scenario.gears)?;
    let numbers: Vec<usize> = (0..scenario.faults.len()).collect();
    let gears = NamedGears::of_pair(&scenario.gears);
    check_faults(&scenario.faults, &numbers, numbers.len(), &gears)?;
    model::check(scenario)?;
    scenario.rig.check(&scenario.gears)?;
    check_sensors(&scenario.sensors, scenario.model)?;
    check_keys(&scenario.solver, "solver")
}
