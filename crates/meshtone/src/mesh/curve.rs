//! The stiffness of a mesh over its cycle, as data for pictures, traces and summaries: no reader needs to know the model.

use std::ops::Range;

use super::gear_mesh::Mesh;

/// The stiffness of a mesh, point by point.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct MeshCurve {
    /// Number of points from one pair to the next.
    pub points_per_pitch: usize,
    /// (N/mm) Stiffness of all pairs in contact: over one gear revolution from its first tooth's start of contact, or over the
    /// pitches that were asked for.
    pub stiffness_n_per_mm: Vec<f64>,
    /// (N/mm) The same of sound wheels, over one pitch.
    pub healthy_stiffness_n_per_mm: Vec<f64>,
    /// (N/mm) Mean stiffness over the mesh cycle.
    pub mean_stiffness_n_per_mm: f64,
    /// (-) Face load factor K_Hβ of sound teeth under the nominal load; none where the model does not distribute the load along the
    /// face.
    pub face_load_factor: Option<f64>,
}

/// The pitches of a cycle at which a window of pitches is found that may begin before its start.
pub(crate) fn in_cycle(pitches: Range<i64>, cycle: usize) -> Range<usize> {
    let start = pitches.start.rem_euclid(cycle.max(1) as i64) as usize;
    start..start + (pitches.end - pitches.start).max(0) as usize
}

impl Mesh {
    /// The stiffness over some pitches, counted from the start of the simulation; over one gear revolution where none are given.
    pub(crate) fn curve(&self, pitches: Option<Range<i64>>) -> MeshCurve {
        let revolution = 0..self.sequence.gear_teeth();
        let window = pitches.map_or(revolution, |pitches| in_cycle(pitches, self.sequence.cycle()));
        MeshCurve {
            points_per_pitch: self.points_per_pitch,
            stiffness_n_per_mm: self.stiffness_n_per_mm(window),
            healthy_stiffness_n_per_mm: self.healthy_stiffness_n_per_mm(),
            mean_stiffness_n_per_mm: self.mean_stiffness_n_per_m * 1e-3,
            face_load_factor: (self.backlash_m.is_some()).then_some(self.along_face.face_load_factor),
        }
    }

    /// (N) The pairs' forces at rest under a force: of pairs that carry some of it in these pitches.
    pub(crate) fn shared_n(&self, force_n: f64, pitches: Range<i64>) -> Vec<(i64, Vec<f64>)> {
        // The pairs before the first one are those of the end of the cycle.
        let cycle = self.sequence.cycle() as i64;
        let at_rest = self.at_rest(force_n, (pitches.start + cycle) as usize..(pitches.end + cycle) as usize);
        let numbered = (at_rest.first_pair - cycle..).zip(at_rest.pair_force_n);
        numbered.filter(|(_, force_n)| force_n.iter().any(|&force_n| force_n > 0.0)).collect()
    }
}
