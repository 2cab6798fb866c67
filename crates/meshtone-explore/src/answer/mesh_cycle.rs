//! Stiffness of the mesh over a gear revolution, and how the pairs share the load around the first damaged tooth.

use std::ops::Range;

use meshtone::Stages;
use meshtone::wheel::WheelName;
use meshtone_plot::DamagedTooth;
use serde_json::{Value, json};

use crate::packet::Packet;

/// Pitches around the first damaged pair, or the first of all, over which the pairs' forces are drawn.
const SHOWN: Range<i64> = -1..4;
/// Points in a pitch of the pairs' forces, and of the stiffness over the revolution, about.
const FORCE_POINTS: usize = 80;
const STIFFNESS_POINTS: usize = 40;

/// What the mesh does over its cycle. Pair n enters contact n pitches after the start of the simulation.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshCycle {
    /// (pitches) Step of the stiffness over the gear's revolution, from pitch 0.
    pub stiffness_step: f64,
    /// (N/µm) Stiffness of all pairs in contact.
    pub stiffness_n_per_um: Vec<f64>,
    /// (N/µm) Of sound wheels, over a pitch, at the same step.
    pub healthy_n_per_um: Vec<f64>,
    /// (pitches) First place of the forces, and their step.
    pub forces_from: f64,
    /// (pitches) Their step.
    pub forces_step: f64,
    /// The pairs in contact there, by their numbers, with the force of each at every place, in N: of teeth at rest under the nominal
    /// load. None of the published model, whose pairs share nothing.
    pub pairs: Vec<(i64, Vec<f64>)>,
}

impl MeshCycle {
    /// The first mesh of a simulation.
    ///
    /// # Arguments
    /// * `stages` - what is simulated
    pub fn new(stages: &Stages) -> Self {
        let curve = stages.mesh_curves().into_iter().next();
        let per_pitch = curve.as_ref().map_or(1, |curve| curve.points_per_pitch.max(1));
        let (mesh, healthy) = curve.map_or_else(Default::default, |curve| {
            (curve.stiffness_n_per_mm, curve.healthy_stiffness_n_per_mm)
        });
        let stride = per_pitch.div_ceil(STIFFNESS_POINTS);
        let every =
            |of_mm: Vec<f64>| of_mm.into_iter().step_by(stride).map(|stiffness| 1e-3 * stiffness).collect();
        let shown = shown(stages);
        let stride_of_forces = per_pitch.div_ceil(FORCE_POINTS);
        let pairs = stages.pair_forces_n(shown.clone()).into_iter();
        Self {
            stiffness_step: stride as f64 / per_pitch as f64,
            stiffness_n_per_um: every(mesh),
            healthy_n_per_um: every(healthy),
            forces_from: shown.start as f64,
            forces_step: stride_of_forces as f64 / per_pitch as f64,
            pairs: pairs
                .map(|(pair, force_n)| (pair, force_n.into_iter().step_by(stride_of_forces).collect()))
                .collect(),
        }
    }

    /// As JSON, with its arrays in a packet.
    pub fn json(&self, packet: &mut Packet) -> Value {
        let pairs: Vec<Value> = (self.pairs.iter())
            .map(|(pair, force)| json!({ "pair": pair, "force_n": packet.array(force.iter().copied()) }))
            .collect();
        json!({
            "stiffness_step": self.stiffness_step,
            "stiffness_n_per_um": packet.array(self.stiffness_n_per_um.iter().copied()),
            "healthy_n_per_um": packet.array(self.healthy_n_per_um.iter().copied()),
            "forces_from": self.forces_from,
            "forces_step": self.forces_step,
            "pairs": pairs,
        })
    }
}

/// (pitches) Where the forces are drawn.
fn shown(stages: &Stages) -> Range<i64> {
    let of_wheels = WheelName::BOTH.map(|wheel| DamagedTooth::of_stages(stages, wheel));
    let first = of_wheels.iter().flatten().map(|tooth| i64::from(tooth.tooth) - 1).min().unwrap_or(0);
    first + SHOWN.start..first + SHOWN.end
}

#[cfg(test)]
mod tests {
    use meshtone::scenario::{Fault, GearPair, MissingTooth, Model, Scenario};

    use super::*;

    fn cycle(model: Model, faults: Vec<Fault>) -> (MeshCycle, f64) {
        let pair = GearPair::example();
        let mut scenario = Scenario::new(pair).with_faults(faults);
        scenario.model = model;
        let stages = meshtone::stages(&scenario).unwrap();
        (MeshCycle::new(&stages), stages.static_force_n())
    }

    /// At every place the pairs carry the load together.
    #[test]
    fn pairs_share_the_load() {
        for model in [Model::Contact, Model::Linear] {
            let (cycle, static_force_n) = cycle(model, Vec::new());
            let places = cycle.pairs[0].1.len();
            for place in 0..places {
                let sum: f64 = cycle.pairs.iter().map(|(_, force)| force[place]).sum();
                assert!((sum / static_force_n - 1.0).abs() < 1e-9, "{model:?} {place}: {sum} N");
            }
        }
        assert!(cycle(Model::Published, Vec::new()).0.pairs.is_empty());
    }

    #[test]
    fn a_missing_tooth_carries_nothing_where_it_would() {
        let (cycle, _) = cycle(Model::Contact, vec![Fault::on_first_gear_tooth(MissingTooth)]);
        assert!(cycle.pairs.iter().all(|(pair, _)| *pair != 0));
        assert_eq!(cycle.forces_from, -1.0);
    }
}
