//! The key that makes a simulation too large.

use super::super::{Scenario, ScenarioError, Solver};
use crate::operation::least_common_multiple;

/// (rev/s) An ordinary speed of a pinion.
const ORDINARY_SPEED_HZ: f64 = 40.0;

/// The error about the key that brings the memory down most when it is given an ordinary value.
///
/// Only keys are candidates that are not at their default, so that the one named stands in the user's file.
///
/// # Arguments
/// * `scenario` - a scenario that needs too much memory
/// * `problem` - how much it needs, and how much is allowed
pub(super) fn refuse(scenario: &Scenario, problem: &str) -> ScenarioError {
    let candidates =
        [sampling_rate(scenario), speed_profile(scenario), speed(scenario), teeth(scenario), drawn(scenario)];
    let candidates = candidates.into_iter().flatten();
    let smallest = candidates.min_by_key(|candidate| candidate.ordinary.memory_estimate_bytes());
    let Some(Candidate { key, value, help, .. }) = smallest else {
        return ScenarioError::new("solver.sampling_rate_hz", scenario.solver.sampling_rate_hz, problem);
    };
    ScenarioError::new(key, value, problem).with_help(help)
}

/// A key that may be to blame.
struct Candidate {
    key: &'static str,
    value: String,
    /// The scenario with an ordinary value instead.
    ordinary: Scenario,
    help: String,
}

fn sampling_rate(scenario: &Scenario) -> Option<Candidate> {
    let mut ordinary = scenario.clone();
    ordinary.solver.sampling_rate_hz = Solver::default().sampling_rate_hz;
    let rate = scenario.solver.sampling_rate_hz;
    (scenario.solver.sampling_rate_hz != ordinary.solver.sampling_rate_hz).then(|| Candidate {
        key: "solver.sampling_rate_hz",
        value: format!("{rate:?}"),
        help: format!("lower it: its default is {:e} S/s", ordinary.solver.sampling_rate_hz),
        ordinary,
    })
}

fn speed_profile(scenario: &Scenario) -> Option<Candidate> {
    let end_s = *scenario.operation.speed_profile_hz.as_ref()?.time_s.last()?;
    let mut ordinary = scenario.clone();
    ordinary.operation.speed_profile_hz = None;
    Some(Candidate {
        key: "operation.speed_profile_hz",
        value: String::new(),
        ordinary,
        help: format!("shorten the profile: all its time is simulated, here {end_s:?} s"),
    })
}

fn speed(scenario: &Scenario) -> Option<Candidate> {
    let speed_hz = scenario.operation.pinion_speed_hz;
    let mut ordinary = scenario.clone();
    ordinary.operation.pinion_speed_hz = ORDINARY_SPEED_HZ;
    let revolutions = crate::operation::nominal_revolutions(scenario.gears.gear_teeth);
    let seconds = f64::from(revolutions) / speed_hz;
    Some(Candidate {
        key: "operation.pinion_speed_hz",
        value: format!("{speed_hz:?}"),
        ordinary,
        help: format!(
            "raise it: {revolutions} revolutions of the pinion are simulated, which take {seconds:.4e} s at \
             this speed"
        ),
    })
}

fn teeth(scenario: &Scenario) -> Option<Candidate> {
    let gears = &scenario.gears;
    let multiple = least_common_multiple(gears.pinion_teeth, gears.gear_teeth);
    let mut ordinary = scenario.clone();
    ordinary.gears.pinion_teeth = gears.gear_teeth;
    Some(Candidate {
        key: "gears.gear_teeth",
        value: gears.gear_teeth.to_string(),
        ordinary,
        help: format!(
            "use tooth counts with a common factor, or fewer teeth: a revolution of the pinion has at least 7 \
             samples for each unit of the counts' least common multiple, here {multiple}, and twice as many \
             revolutions as the gear has teeth are simulated"
        ),
    })
}

fn drawn(scenario: &Scenario) -> Option<Candidate> {
    let mut ordinary = scenario.clone();
    ordinary.faults.retain(|fault| !fault.damage.is_drawn());
    (ordinary.faults.len() < scenario.faults.len()).then(|| Candidate {
        key: "fault",
        value: String::new(),
        help: format!(
            "let roughness or pits be drawn for fewer teeth: each of them is a kind of its own, and has a table with each kind that \
             it meets, {} in all",
            scenario.pair_classes()
        ),
        ordinary,
    })
}
