//! Which scenarios are simulated side by side.

use super::group::Numbered;
use crate::mesh::is_slanted;
use crate::scenario::Scenario;
use crate::solver::LANES;

/// The properties of a scenario that decide how much a step costs; a group costs what its most expensive simulation does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Cost {
    /// Whether it is simulated alone: the published model has a solver of its own, and shafts of beams have so many modes that one simulation
    /// fills the lanes.
    alone: bool,
    /// Whether motor or brake vary: the step is compiled apart for it, and costs too much to mix with the rest.
    varies: bool,
    /// Whether its face is probably cut into slices, so that it is simulated alone: it would leave a lane of the rest idle.
    is_sliced: bool,
    /// Whether its teeth leave their path with corners of their own: their law is another one.
    has_corners: bool,
    /// Whether it has more modes than spur wheels alone: helical ones, or a force that turns with a shaft.
    has_more_modes: bool,
    /// Whether its flanks close by more at one end of the face, or its teeth have lost a part of it, so that its tilt is probably an unknown.
    leans: bool,
}

impl Cost {
    fn of(scenario: &Scenario) -> Self {
        let gears = scenario.gears();
        let unbalanced = scenario.wheels.iter().any(|wheel| wheel.unbalance.g_mm > 0.0);
        Self {
            alone: !scenario.model.has_meshes()
                || !scenario.shafts().is_empty()
                || scenario.wheels.iter().any(|wheel| wheel.helix_wobble_um > 0.0),
            is_sliced: gears.is_crowned()
                || gears.is_helical() && (gears.is_relieved() || !scenario.faults.is_empty()),
            has_corners: scenario.model.teeth_part() && is_slanted(gears.overlap_ratio()),
            has_more_modes: gears.is_helical() || unbalanced,
            varies: !scenario.operation.is_constant() || scenario.solver.initial_velocity.is_some(),
            leans: scenario.meshes[0].misalignment_um != 0.0
                || scenario.wheels.iter().any(|wheel| wheel.helix_share > 0.0)
                || scenario.faults.iter().any(|fault| fault.damage.moves_forces()),
        }
    }

    /// Whether simulations of both costs may be in one group.
    fn goes_with(self, other: Self) -> bool {
        let is_like = |of: fn(Self) -> bool| of(self) == of(other);
        !self.alone
            && !other.alone
            && is_like(|cost| cost.varies)
            && is_like(|cost| cost.is_sliced)
            && is_like(|cost| cost.has_corners)
    }
}

/// Divides scenarios into groups of at most [`LANES`], of like kinds and of similar length.
pub(super) fn groups(scenarios: Vec<Numbered>) -> Vec<Vec<Numbered>> {
    let mut keyed: Vec<_> = scenarios
        .into_iter()
        .map(|(index, scenario)| ((Cost::of(&scenario), samples(&scenario), index), scenario))
        .collect();
    keyed.sort_by_key(|(key, _)| *key);
    let mut groups: Vec<Vec<Numbered>> = Vec::new();
    let mut last: Option<Cost> = None;
    for ((cost, _, index), scenario) in keyed {
        match groups.last_mut() {
            Some(group) if last.is_some_and(|last| last.goes_with(cost)) && group.len() < LANES => {
                group.push((index, scenario))
            }
            _ => groups.push(vec![(index, scenario)]),
        }
        last = Some(cost);
    }
    groups
}

/// Number of samples of a scenario, which need not be valid.
fn samples(scenario: &Scenario) -> usize {
    scenario.time_grid().samples
}
