//! Scenarios that a model cannot simulate, although other models can.

use crate::damage::Fault;
use crate::error::ScenarioError;
use crate::keys::{Check, Keys};
use crate::machine::{DampingRatio, Rig};
use crate::model::Model;
use crate::scenario::Scenario;
use crate::wheel::WheelName;

/// Refuses keys that have no meaning under the scenario's model and whose defaults cannot stand for them.
pub(super) fn check(scenario: &Scenario) -> Check {
    match scenario.model {
        Model::Contact => Ok(()),
        Model::Linear => refuse_keys_of_published(scenario),
        Model::Published => refuse_unknown_to_published(scenario),
    }
}

/// An error about a default that the model always has, with what to do instead.
pub(super) fn with_help(model: Model, error: ScenarioError) -> ScenarioError {
    if model == Model::Published { error.with_help(OTHER_MODELS_HELP) } else { error }
}

/// The kinds of damage that the published model knows.
const KINDS_OF_PUBLISHED: [&str; 5] =
    ["missing-tooth", "tooth-breakage", "partial-face", "through-face", "tooth-destruction"];

fn unknown_kind(fault: &Fault) -> ScenarioError {
    let kind = format!("\"{}\"", fault.damage.kind());
    ScenarioError::new("fault.kind", kind, "is not known to the published model")
        .with_help("write model = \"linear\" or model = \"contact\"")
}

/// Refuses keys that only a machine has whose wheels tilt on springs and whose modes are those of the closed mean mesh.
fn refuse_keys_of_published(scenario: &Scenario) -> Check {
    let (rig, default) = (&scenario.rig, Rig::start());
    let stiffness = rig.wheel_rotational_stiffness_nm_per_rad;
    let (key, value, what) = if stiffness != default.wheel_rotational_stiffness_nm_per_rad {
        let what = "the wheels tilt with their shafts, which bend between their bearings";
        ("rig.wheel_rotational_stiffness_nm_per_rad", format!("{stiffness:?}"), what)
    } else if let DampingRatio::PerMode(ratios) = rig.damping_ratio {
        let what = "the damping ratio is one for all modes";
        ("rig.damping_ratio", format!("{ratios:?}"), what)
    } else if let Some(given) = scenario.solver.initial_displacement {
        let what = "the simulation starts in the static equilibrium of the loaded mesh";
        ("solver.initial_displacement", format!("{given:?}"), what)
    } else {
        return Ok(());
    };
    let problem = format!("concerns the published model alone: under \"linear\" {what}");
    Err(ScenarioError::new(key, value, problem).with_help("remove the key, or set model = \"published\""))
}

/// What a refused scenario may do instead.
const OTHER_MODELS_HELP: &str = "set model = \"linear\" or \"contact\" (or leave --model out), which have any number of faults on any teeth";
const ONLY_STANDARD: &str =
    "the published model knows only standard wheels, without profile shift and at their standard distance";
const STANDARD_HELP: &str =
    "set model = \"linear\" or \"contact\" (or leave --model out), which have any; or remove the key";
const ONE_PLACE: &str = "the published model knows only one fault, on the gear's first tooth";

/// Refuses other wheels than standard ones and other faults than one, always on the same tooth.
fn refuse_unknown_to_published(scenario: &Scenario) -> Check {
    if let Some((key, value)) = scenario.gears.beyond_standard().first() {
        return Err(ScenarioError::new(*key, format!("{value:?}"), ONLY_STANDARD).with_help(STANDARD_HELP));
    }
    let error = match scenario.faults.as_slice() {
        [] => return Ok(()),
        // Before its place, which the file may not say.
        [fault] if !KINDS_OF_PUBLISHED.contains(&fault.damage.kind()) => return Err(unknown_kind(fault)),
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
    Err(error.with_help(OTHER_MODELS_HELP))
}
