//! Which scenarios are simulated side by side.

use super::group::Numbered;
use crate::damage::MeshEffect;
use crate::model::Model;
use crate::scenario::Scenario;
use crate::solver::LANES;

/// What decides how much a step costs; a group costs what its most expensive simulation does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Kind {
    law: Law,
    motion: Motion,
}

/// Which mesh law a scenario has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Law {
    Linear,
    Published,
    Contact,
}

/// What the time loop of a scenario is compiled for; see [`crate::solver`]'s sizes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Motion {
    Steady(MeshEffect),
    General,
}

impl Kind {
    fn of(scenario: &Scenario) -> Self {
        let (operation, solver) = (&scenario.operation, &scenario.solver);
        let steady = operation.speed_profile_hz.is_none()
            && operation.torque_profile_nm.is_none()
            && operation.speed_fluctuation_hz == 0.0
            && operation.torque_fluctuation_nm == 0.0;
        let at_rest = solver.initial_displacement.is_none() && solver.initial_velocity.is_none();
        let effects = scenario.faults.iter().map(|fault| fault.damage.effect());
        let effect = effects.max().unwrap_or(MeshEffect::Flat);
        let motion = if steady && at_rest { Motion::Steady(effect) } else { Motion::General };
        let law = match scenario.model {
            Model::Linear => Law::Linear,
            Model::Published => Law::Published,
            Model::Contact => Law::Contact,
        };
        Self { law, motion }
    }
}

impl Kind {
    /// Whether simulations of both kinds may be in one group. What varies its speed or load is compiled apart, and costs too
    /// much to mix with the rest.
    fn goes_with(self, other: Self) -> bool {
        self.law == other.law && (self.motion == Motion::General) == (other.motion == Motion::General)
    }
}

/// Divides scenarios into groups of at most [`LANES`], of like kinds and of similar length.
pub(super) fn groups(scenarios: Vec<Numbered>) -> Vec<Vec<Numbered>> {
    let mut keyed: Vec<_> = scenarios
        .into_iter()
        .map(|(index, scenario)| ((Kind::of(&scenario), samples(&scenario), index), scenario))
        .collect();
    keyed.sort_by_key(|(key, _)| *key);
    let mut groups: Vec<Vec<Numbered>> = Vec::new();
    let mut last: Option<Kind> = None;
    for ((kind, _, index), scenario) in keyed {
        match groups.last_mut() {
            Some(group) if last.is_some_and(|last| last.goes_with(kind)) && group.len() < LANES => {
                group.push((index, scenario))
            }
            _ => groups.push(vec![(index, scenario)]),
        }
        last = Some(kind);
    }
    groups
}

/// Number of samples of a scenario, which need not be valid.
fn samples(scenario: &Scenario) -> usize {
    scenario.time_grid().samples
}
