//! The stiffness of the meshes over their cycles, as data for pictures, traces and summaries.

use std::num::NonZeroUsize;
use std::ops::Range;

use super::{MeshedPair, Stages};
use crate::error::ScenarioError;
use crate::mesh::{Mesh, MeshCurve, PairKind};

impl Stages {
    /// The stiffness of each mesh over one gear revolution, at the points that the time loop has.
    ///
    /// ```
    /// use meshtone::scenario::{GearPair, Scenario};
    ///
    /// let stages = meshtone::stages(&Scenario::new(GearPair::example()))?;
    /// let curve = &stages.mesh_curves()[0];
    /// assert_eq!(curve.stiffness_n_per_mm.len(), 38 * curve.points_per_pitch);
    /// assert_eq!(stages.mesh_curves_over(-1..3)[0].stiffness_n_per_mm.len(), 4 * curve.points_per_pitch);
    /// # Ok::<(), meshtone::scenario::ScenarioError>(())
    /// ```
    pub fn mesh_curves(&self) -> Vec<MeshCurve> {
        self.curves_of(&self.meshes, None)
    }

    /// As [`Self::mesh_curves`], over other pitches than the gear's first revolution.
    ///
    /// # Arguments
    /// * `pitches` - counted from the start of the simulation
    pub fn mesh_curves_over(&self, pitches: Range<i64>) -> Vec<MeshCurve> {
        self.curves_of(&self.meshes, Some(pitches))
    }

    /// The stiffness of each mesh at the points of the published code's coarse grid, under every model.
    ///
    /// # Arguments
    /// * `pitches` - counted from the start of the simulation; one gear revolution where none are given
    ///
    /// # Errors
    /// Damaged teeth that were put beyond a wheel's last one.
    pub fn mesh_curves_on_coarse_grid(
        &self,
        pitches: Option<Range<i64>>,
    ) -> Result<Vec<MeshCurve>, ScenarioError> {
        let mut meshes = Vec::with_capacity(self.meshes.len());
        for (number, pair) in self.pairs.iter().enumerate() {
            let points = NonZeroUsize::new(pair.cycle.points_per_pitch).unwrap_or(NonZeroUsize::MIN);
            meshes.extend(self.meshes_at(points)?.into_iter().nth(number));
        }
        Ok(self.curves_of(&meshes, pitches))
    }

    /// (N/mm) Stiffness of a sound pair of teeth of the first mesh, and of the first damaged tooth with a sound mate, where there is one.
    ///
    /// # Arguments
    /// * `positions_rev` - (rev) pinion revolutions since the pair entered contact
    pub(super) fn mesh_pair_stiffness_n_per_mm(&self, positions_rev: &[f64]) -> [Option<Vec<f64>>; 2] {
        let Some(mesh) = self.meshes.first() else { return [None, None] };
        let (pairs, pitches) = (self.tooth_pairs(), f64::from(self.layout.gears[0].pinion_teeth));
        let is_first =
            |kind: &&PairKind| matches!((kind.pinion, kind.gear), (Some(0), None) | (None, Some(0)));
        let classes = mesh.sequence.classes();
        [classes.first(), classes.iter().find(is_first)].map(|kind| {
            let stiffness = |kind, position: &f64| pairs.at(kind, position * pitches).stiffness_n_per_mm;
            kind.map(|kind| positions_rev.iter().map(|position| stiffness(kind, position)).collect())
        })
    }

    /// (N) How the pairs of the first mesh share the nominal load at rest, at every point of some pitches: the number of each pair that is in
    /// contact there, with its force. Pair n enters contact n pitches after the start of the simulation. None of the published model,
    /// whose pairs share nothing.
    ///
    /// # Arguments
    /// * `pitches` - counted from the start of the simulation
    pub fn pair_forces_n(&self, pitches: Range<i64>) -> Vec<(i64, Vec<f64>)> {
        let of_mesh =
            |(mesh, pair): (&Mesh, &MeshedPair)| mesh.shared_n(pair.static_force_n, pitches.clone());
        self.meshes.iter().zip(&self.pairs).take(1).flat_map(of_mesh).collect()
    }
}
