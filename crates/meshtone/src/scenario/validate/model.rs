//! Scenarios that a model cannot simulate, although other models can.

use crate::damage::Damage;
use crate::error::ScenarioError;
use crate::keys::{Check, Keys, require};
use crate::machine::{DampingRatio, Rig};
use crate::model::{Model, PUBLISHED_KEYS, PublishedKey};
use crate::scenario::Scenario;
use crate::wheel::{Gears, TipRelief, WheelName};

/// Refuses keys that have no meaning under the scenario's model and whose defaults cannot stand for them.
pub(super) fn check(scenario: &Scenario, rig: &Rig) -> Check {
    if scenario.model.has_meshes() {
        refuse_keys_of_published(scenario, rig)
    } else {
        refuse_unknown_to_published(scenario)
    }
}

/// An error about a default that the model always has, with what to do instead.
pub(super) fn with_help(model: Model, error: ScenarioError) -> ScenarioError {
    if model.has_meshes() { error } else { error.with_help(OTHER_MODELS_HELP) }
}

/// The kinds of damage that the published model knows.
const KINDS_OF_PUBLISHED: [&str; 5] =
    ["missing-tooth", "tooth-breakage", "partial-face", "through-face", "tooth-destruction"];

/// The refusal of a kind that the published model does not know.
pub(crate) fn unknown_kind(damage: &Damage) -> ScenarioError {
    let kind = format!("\"{}\"", damage.kind());
    ScenarioError::new("fault.kind", kind, "is not supported by the published model")
        .with_help("write model = \"linear\" or model = \"contact\"")
}

/// Refuses keys that only a machine has whose wheels tilt on springs and whose modes are those of the closed mean mesh.
fn refuse_keys_of_published(scenario: &Scenario, rig: &Rig) -> Check {
    let model = scenario.model;
    let stiffness = rig.wheel_rotational_stiffness_nm_per_rad;
    let is_given = stiffness != Rig::start().wheel_rotational_stiffness_nm_per_rad;
    let ratios = match rig.damping_ratio {
        DampingRatio::PerMode(ratios) => Some(format!("{ratios:?}")),
        _ => None,
    };
    let displacement = scenario.solver.initial_displacement.map(|given| format!("{given:?}"));
    let values = [is_given.then(|| format!("{stiffness:?}")), ratios, displacement];
    let mut given =
        PUBLISHED_KEYS.iter().zip(values).filter(|(of_published, _)| !model.ignores(of_published.key));
    match given.find_map(|(of_published, value)| Some((of_published, value?))) {
        None => Ok(()),
        Some((PublishedKey { key, why, .. }, value)) => {
            let problem = format!("applies only to the published model: under \"{}\" {why}", model.name());
            let help = "remove the key, or set model = \"published\"";
            Err(ScenarioError::new(*key, value, problem).with_help(help))
        }
    }
}

/// What a refused scenario may do instead.
const OTHER_MODELS_HELP: &str = "set model = \"linear\" or \"contact\" (or leave --model out), which have any number of faults on any teeth";
const ONLY_STANDARD: &str =
    "the published model supports only standard wheels, without profile shift and at their standard distance";
const ONLY_SPUR: &str = "the published model supports only spur wheels";
const STANDARD_HELP: &str =
    "set model = \"linear\" or \"contact\" (or leave --model out), which have any; or remove the key";
const ONE_PLACE: &str = "the published model supports only one fault, on the gear's first tooth";

/// Refuses helical wheels and other wheels than standard ones, those whose tips the relief takes away, and other faults than one, always on the same tooth.
fn refuse_unknown_to_published(scenario: &Scenario) -> Check {
    let gears = scenario.gears();
    if let Some((key, value)) = gears.beyond_standard().first() {
        let problem = if *key == "gears.helix_angle_deg" { ONLY_SPUR } else { ONLY_STANDARD };
        return Err(ScenarioError::new(*key, format!("{value:?}"), problem).with_help(STANDARD_HELP));
    }
    if scenario.operation.overruns() {
        let problem = "the published model knows one flank of a tooth, which the motor presses; the torque must be 0 N m or more";
        return Err(ScenarioError::new(
            "operation.brake_torque_nm",
            format!("{:?}", scenario.operation.brake_torque_nm),
            problem,
        )
        .with_help(STANDARD_HELP));
    }
    relief_leaves_tips(&gears)?;
    let error = match scenario.faults.as_slice() {
        [] => return Ok(()),
        // Before its place, which the file may not say.
        [fault] if !KINDS_OF_PUBLISHED.contains(&fault.damage.kind()) => {
            return Err(unknown_kind(&fault.damage));
        }
        [fault] if fault.side() != WheelName::Gear => {
            ScenarioError::new("fault.wheel", format!("{:?}", fault.wheel), ONE_PLACE)
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

/// The relief that all wheels have under the published model must leave some of the tip: the compliances take what is beyond the tooth's
/// centre line for a negative thickness.
fn relief_leaves_tips(gears: &Gears) -> Check {
    let TipRelief { length_mm, depth_mm } = TipRelief::PUBLISHED;
    let left_mm = gears.half_thicknesses_below_tip_mm(length_mm).into_iter().fold(f64::INFINITY, f64::min);
    // A pair has one reduction of both wheels.
    let [reduction_mm, _] = gears.uniform_flank_reduction_mm;
    let problem = format!(
        "the published model thins all tips by {depth_mm} mm, which with gears.uniform_flank_reduction_mm must be less than the {left_mm:.4} mm that the \
         tooth is thick from its centre line, {length_mm} mm below the tip"
    );
    require("gears.module_mm", gears.module_mm, depth_mm + reduction_mm < left_mm, problem)
        .map_err(|error| error.with_help("take a larger module, or another model"))
}
