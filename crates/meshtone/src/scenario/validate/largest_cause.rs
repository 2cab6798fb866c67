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
    let candidates = [
        sampling_rate(scenario),
        length(scenario, "solver.duration_s", |solver| &mut solver.duration_s),
        length(scenario, "solver.pinion_revolutions", |solver| &mut solver.pinion_revolutions),
        speed_profile(scenario),
        speed(scenario),
        Some(teeth(scenario)),
        drawn(scenario),
    ];
    let smallest = candidates.into_iter().flatten().min_by_key(|candidate| candidate.ordinary_bytes);
    let Some(Candidate { key, value, help, .. }) = smallest else {
        return ScenarioError::new("solver.sampling_rate_hz", scenario.solver.sampling_rate_hz, problem);
    };
    ScenarioError::new(key, value, problem).with_help(help)
}

/// A key that may be to blame.
struct Candidate {
    key: &'static str,
    value: String,
    /// (bytes) Memory of the scenario with an ordinary value instead.
    ordinary_bytes: u64,
    help: String,
}

impl Candidate {
    /// A key to which `set` gives an ordinary value.
    fn new(
        scenario: &Scenario,
        key: &'static str,
        value: String,
        help: String,
        set: impl FnOnce(&mut Scenario),
    ) -> Self {
        let mut ordinary = scenario.clone();
        set(&mut ordinary);
        Self { key, value, ordinary_bytes: ordinary.memory_estimate_bytes(), help }
    }
}

fn sampling_rate(scenario: &Scenario) -> Option<Candidate> {
    let (rate_hz, ordinary_hz) = (scenario.solver.sampling_rate_hz, Solver::default().sampling_rate_hz);
    let help = format!("lower it: its default is {ordinary_hz:e} S/s");
    (rate_hz != ordinary_hz).then(|| {
        Candidate::new(scenario, "solver.sampling_rate_hz", format!("{rate_hz:?}"), help, |ordinary| {
            ordinary.solver.sampling_rate_hz = ordinary_hz;
        })
    })
}

fn length(
    scenario: &Scenario,
    key: &'static str,
    of: fn(&mut Solver) -> &mut Option<f64>,
) -> Option<Candidate> {
    let value = (*of(&mut scenario.solver.clone()))?;
    let help = "lower it: every sample is kept in memory".to_owned();
    Some(Candidate::new(scenario, key, format!("{value:?}"), help, |ordinary| {
        *of(&mut ordinary.solver) = None;
    }))
}

fn speed_profile(scenario: &Scenario) -> Option<Candidate> {
    let end_s = *scenario.operation.speed_profile_hz.as_ref()?.time_s.last()?;
    let help = format!("shorten the profile: all its time is simulated, here {end_s:?} s");
    Some(Candidate::new(scenario, "operation.speed_profile_hz", String::new(), help, |ordinary| {
        ordinary.operation.speed_profile_hz = None;
    }))
}

/// Where no length is given, which then takes longer the slower the pinion is.
fn speed(scenario: &Scenario) -> Option<Candidate> {
    let Solver { duration_s: None, pinion_revolutions: None, .. } = scenario.solver else { return None };
    let speed_hz = scenario.operation.pinion_speed_hz;
    let revolutions = crate::operation::nominal_revolutions(scenario.gears().gear_teeth);
    let seconds = f64::from(revolutions) / speed_hz;
    let help = format!(
        "raise it: {revolutions} revolutions of the pinion are simulated, which take {seconds:.4e} s at this speed"
    );
    Some(Candidate::new(scenario, "operation.pinion_speed_hz", format!("{speed_hz:?}"), help, |ordinary| {
        ordinary.operation.pinion_speed_hz = ORDINARY_SPEED_HZ;
    }))
}

fn teeth(scenario: &Scenario) -> Candidate {
    let gears = &scenario.gears();
    let multiple = least_common_multiple(gears.pinion_teeth, gears.gear_teeth);
    let help = format!(
        "use tooth counts with a common factor, or fewer teeth: the cycle is divided by the counts' least common multiple, here \
         {multiple}, and without solver.duration_s twice as many revolutions as the gear has teeth are simulated"
    );
    Candidate::new(scenario, "gears.gear_teeth", gears.gear_teeth.to_string(), help, |ordinary| {
        ordinary.wheels[0].teeth = gears.gear_teeth;
    })
}

fn drawn(scenario: &Scenario) -> Option<Candidate> {
    let help = format!(
        "let roughness or pits be drawn for fewer teeth: each of them is a kind of its own, and has a table with each kind that \
         it meets, {} in all",
        scenario.pair_classes()
    );
    scenario.faults.iter().any(|fault| fault.damage.is_drawn()).then(|| {
        Candidate::new(scenario, "fault", String::new(), help, |ordinary| {
            ordinary.faults.retain(|fault| !fault.damage.is_drawn());
        })
    })
}
