//! Stiffness of the mesh over a gear revolution, and how the pairs share the load around the first damaged tooth.

use std::ops::Range;

use meshtone::Stages;
use meshtone::mesh::Mesh;
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
    /// (N/mm) Stiffness of all pairs in contact.
    pub stiffness_n_per_mm: Vec<f64>,
    /// (N/mm) Of sound wheels, over a pitch, at the same step.
    pub healthy_n_per_mm: Vec<f64>,
    /// (pitches) First place of the forces, and their step.
    pub forces_from: f64,
    /// (pitches) Their step.
    pub forces_step: f64,
    /// The pairs in contact there, by their numbers, with the force of each at every place, in N: of teeth at rest under the nominal
    /// load. None of the published model, whose pairs share nothing.
    pub pairs: Vec<(i64, Vec<f64>)>,
}

impl MeshCycle {
    /// The mesh of a simulation.
    ///
    /// # Arguments
    /// * `stages` - what is simulated
    pub fn new(stages: &Stages) -> Self {
        let per_pitch = stages.mesh.points_per_pitch().max(1);
        let stride = per_pitch.div_ceil(STIFFNESS_POINTS);
        let every = |values: Vec<f64>| values.into_iter().step_by(stride).collect();
        let shown = shown(stages);
        let stride_of_forces = per_pitch.div_ceil(FORCE_POINTS);
        Self {
            stiffness_step: stride as f64 / per_pitch as f64,
            stiffness_n_per_mm: every(stages.mesh.stiffness_n_per_mm()),
            healthy_n_per_mm: every(stages.mesh.healthy_stiffness_n_per_mm()),
            forces_from: shown.start as f64,
            forces_step: stride_of_forces as f64 / per_pitch as f64,
            pairs: pair_forces(stages, &shown)
                .into_iter()
                .map(|(pair, force)| (pair, force.into_iter().step_by(stride_of_forces).collect()))
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
            "stiffness_n_per_mm": packet.array(self.stiffness_n_per_mm.iter().copied()),
            "healthy_n_per_mm": packet.array(self.healthy_n_per_mm.iter().copied()),
            "forces_from": self.forces_from,
            "forces_step": self.forces_step,
            "pairs": pairs,
        })
    }
}

/// (pitches) Where the forces are drawn.
fn shown(stages: &Stages) -> Range<i64> {
    let first = stages.damaged.iter().map(|tooth| tooth.first_tooth() as i64).min().unwrap_or(0);
    first + SHOWN.start..first + SHOWN.end
}

/// (N) Forces of the pairs in contact, at every point of some pitches.
fn pair_forces(stages: &Stages, pitches: &Range<i64>) -> Vec<(i64, Vec<f64>)> {
    match &stages.mesh {
        Mesh::Contact(mesh) => {
            // What comes before the first pair is the end of the cycle.
            let cycle = mesh.sequence.cycle() as i64;
            let at_rest = mesh.at_rest(
                stages.static_force_n(),
                (pitches.start + cycle) as usize..(pitches.end + cycle) as usize,
            );
            let numbered = at_rest.pair_force_n.into_iter().enumerate();
            let pair = |(row, force)| (at_rest.first_pair + row as i64 - cycle, force);
            numbered
                .map(pair)
                .filter(|(_, force): &(i64, Vec<f64>)| force.iter().any(|&force| force > 0.0))
                .collect()
        }
        Mesh::Pairs(mesh) => {
            let per_pitch = mesh.points_per_pitch as i64;
            let points = pitches.start * per_pitch..pitches.end * per_pitch;
            let stiffness = |pair: i64, point: i64| {
                let since = usize::try_from(point - pair * per_pitch).ok();
                let table = &mesh.classes[mesh.sequence.class(pair)].stiffness_n_per_m;
                since.and_then(|since| table.get(since)).copied().unwrap_or(0.0)
            };
            let oldest = pitches.start - (mesh.contact_points() as i64).div_euclid(per_pitch);
            let pairs = oldest..pitches.end;
            let whole: Vec<f64> =
                points.clone().map(|point| pairs.clone().map(|pair| stiffness(pair, point)).sum()).collect();
            let force_n = stages.static_force_n();
            let share = |pair: i64| {
                let of_point = |(point, whole): (i64, &f64)| {
                    if *whole > 0.0 { force_n * stiffness(pair, point) / whole } else { 0.0 }
                };
                points.clone().zip(&whole).map(of_point).collect()
            };
            pairs.clone().map(|pair| (pair, share(pair))).collect()
        }
        _ => Vec::new(),
    }
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
