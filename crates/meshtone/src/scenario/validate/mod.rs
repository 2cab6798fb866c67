//! What a scenario must satisfy before anything is computed.

mod duration;
mod largest_cause;
mod memory_limit;
mod size;
mod speed;

pub use memory_limit::{MEMORY_LIMIT_BYTES, MemoryLimit};

use super::{Gears, Model, Scenario, ScenarioError, ScenarioWarning, WheelName};
use crate::damage::{check_faults, published};
use crate::keys::{Keys, check_keys};
use crate::sensor::check_sensors;

impl Scenario {
    /// Checks every value, alone and against the others, as far as no tooth geometry is needed.
    ///
    /// # Returns
    /// What can be simulated but deserves attention: teeth that are undercut, a tip relief that adds metal, a speed that few
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

    /// As [`Scenario::validate`], with another limit of memory.
    ///
    /// # Arguments
    /// * `limit` - most that [`Scenario::memory_estimate_bytes`] may be
    ///
    /// # Errors
    /// As [`Scenario::validate`].
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
        let honoured = self.as_honoured();
        if honoured != *self {
            check_values(&honoured).map_err(|error| {
                let model = self.model.name();
                let problem = format!("{} (the {model} model always has the default)", error.problem);
                let error = ScenarioError { problem, ..error };
                if self.model == Model::Published { error.with_help(PUBLISHED_HELP) } else { error }
            })?;
        }
        duration::check(&honoured)?;
        size::check(&honoured, limit)?;
        speed::check(&honoured)?;
        let mut warnings = gears_of_model(&honoured).warnings();
        warnings.extend(speed::warnings(&honoured));
        warnings.extend(honoured.quality.warnings());
        Ok(warnings)
    }
}

const PUBLISHED_HELP: &str = "set model = \"linear\" or \"contact\" (or leave --model out), which have any number of faults on any teeth";

/// Every value, whether or not the model honours it.
fn check_values(scenario: &Scenario) -> Result<(), ScenarioError> {
    gears_of_model(scenario).check()?;
    scenario.operation.check()?;
    scenario.quality.check(&scenario.gears)?;
    check_faults(&scenario.faults, &scenario.gears)?;
    known_to_the_model(scenario)?;
    scenario.rig.check(&scenario.gears)?;
    check_sensors(&scenario.sensors, scenario.model)?;
    check_keys(&scenario.solver, "solver")
}

/// The wheels as the model has them: under `contact` the relief that thins the tips is not there, and its default need not fit.
fn gears_of_model(scenario: &Scenario) -> Gears {
    let mut gears = scenario.gears.clone();
    let default = Gears::start().tip_relief;
    if scenario.model == Model::Contact && gears.tip_relief == default {
        gears.tip_relief = None;
    }
    gears
}

/// The published code has standard wheels and one damaged tooth, always the same.
fn known_to_the_model(scenario: &Scenario) -> Result<(), ScenarioError> {
    if scenario.model != Model::Published {
        return Ok(());
    }
    if let Some((key, value)) = scenario.gears.beyond_standard().first() {
        return Err(ScenarioError::new(*key, format!("{value:?}"), ONLY_STANDARD).with_help(STANDARD_HELP));
    }
    let faults = &scenario.faults;
    let error = match faults.as_slice() {
        [] => return Ok(()),
        // Before its place, which the file may not say.
        [fault] if !published::knows(&fault.damage) => {
            return Err(published::unknown_kind(fault.damage.kind()));
        }
        [fault] if fault.wheel != WheelName::Gear => {
            ScenarioError::new("fault.wheel", format!("\"{}\"", fault.wheel.name()), ONE_PLACE)
        }
        [fault] if fault.tooth.only() != Some(1) => {
            ScenarioError::new("fault.tooth", &fault.tooth, ONE_PLACE)
        }
        [_] => return Ok(()),
        several => {
            ScenarioError::new("fault[1]", "", format!("is one of {} faults; {ONE_PLACE}", several.len()))
        }
    };
    Err(error.with_help(PUBLISHED_HELP))
}

const ONLY_STANDARD: &str =
    "the published model knows only standard wheels, without profile shift and at their standard distance";
const STANDARD_HELP: &str =
    "set model = \"linear\" or \"contact\" (or leave --model out), which have any; or remove the key";

const ONE_PLACE: &str = "the published model knows only one fault, on the gear's first tooth";
